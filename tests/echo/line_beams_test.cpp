// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/line_beams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tests/echo/echo_fixture.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

/// A row of lines over round layers of fine facets.
class LineBeamsOverSpheres : public ::testing::Test {
 protected:
  LineBeamsOverSpheres() {
    for (int l = 100; l < 132; ++l) row_.push_back(place_line(transducer_, l, X_JP_));
    beams_->begin_row(settings_.n_planes);
  }

  Transducer transducer_;
  ImageSettings settings_ = [] {
    ImageSettings settings;
    settings.refraction = false;
    return settings;
  }();
  Scene scene_{std::make_shared<const CompiledJoint>(test::make_nested_spheres(
      std::array<SphereLayer, 3>{{{"fat", 40e-3}, {"muscle", 34e-3}, {"bone", 22e-3}}},
      Vec3::Zero(), 5))};
  std::vector<RegionAcoustics> regions_ = make_region_acoustics(scene_.joint(), transducer_);
  BeamTracer tracer_{scene_, nullptr, regions_, transducer_, settings_};
  BeamShape shape_{transducer_, settings_};
  Pose X_JP_ = make_pose(Vec3(0, 0, -39e-3), Vec3::UnitZ(), Vec3::UnitX());
  std::vector<PlacedLine> row_;
  std::unique_ptr<LineBeams> beams_ = std::make_unique<LineBeams>();
};

TEST_F(LineBeamsOverSpheres, MeetWhatABeamFollowedByItselfMeets) {
  const auto own = std::make_unique<BeamTrace>();
  BeamPath path;
  const double off = 40e-6 / shape_.sample_depth();
  std::size_t blended = 0;
  for (std::size_t l = 0; l < row_.size(); ++l) {
    beams_->go_to(tracer_, shape_, row_, l);
    tracer_.trace_bent(row_[l].origin_J, row_[l].direction_J, *own, path);
    const BeamTrace& central = beams_->central();
    ASSERT_EQ(central.n_first, own->n_first) << l;
    for (std::size_t k = 0; k < own->n_first; ++k) {
      EXPECT_NEAR(central.echoes[k].sample, own->echoes[k].sample, off) << l;
      if (central.echoes[k].sample != own->echoes[k].sample) ++blended;
    }
    for (const double z : {2e-3, 5e-3, 9e-3, 14e-3}) {
      std::array<double, 2> sample{};
      std::array<double, 2> log_gain{};
      ASSERT_TRUE(central.find_sample(z, sample[0], log_gain[0]));
      ASSERT_TRUE(own->find_sample(z, sample[1], log_gain[1]));
      EXPECT_NEAR(sample[0], sample[1], off);
      EXPECT_NEAR(log_gain[0], log_gain[1], 0.02);
    }
    EXPECT_LT((beams_->path().at(20e-3) - path.at(20e-3)).norm(), 1e-9);
  }
  EXPECT_GT(blended, row_.size());  // the shortcut was taken
}

TEST_F(LineBeamsOverSpheres, ASidePlaneMeetsThemFartherDown) {
  const auto bone_at = [&](const BeamTrace& trace) {
    return trace.end_sample;
  };
  for (std::size_t l = 0; l < row_.size(); ++l) {
    beams_->go_to(tracer_, shape_, row_, l);
    const double x = row_[l].origin_J.dot(X_JP_.linear().col(0));
    const double middle = bone_at(beams_->plane(2));
    for (const int p : {0, 4}) {
      const double depth = 17e-3;  // about where bone is
      const double y = shape_.plane_elevation(p, depth);
      const double deeper =
          std::sqrt(22e-3 * 22e-3 - x * x) - std::sqrt(22e-3 * 22e-3 - x * x - y * y);
      EXPECT_NEAR(bone_at(beams_->plane(p)) - middle, deeper / shape_.sample_depth(),
                  150e-6 / shape_.sample_depth())
          << l;
    }
  }
}

TEST(BeamBlend, RefusesBeamsThatMetSomethingElse) {
  const auto scene =
      test::make_block_scene(std::array<test::FlatLayer, 2>{{{"fat", 9e-3}, {"muscle", 51e-3}}});
  const Transducer transducer;
  const std::vector<RegionAcoustics> regions = make_region_acoustics(scene->joint(), transducer);
  const BeamTracer tracer(*scene, nullptr, regions, transducer, ImageSettings{});
  std::array<std::unique_ptr<BeamTrace>, 3> traces;
  BeamPath path;
  for (const std::size_t k : {0U, 1U, 2U}) {
    traces[k] = std::make_unique<BeamTrace>();
    tracer.trace_bent(Vec3(3e-4 * static_cast<double>(k), 0, 0), Vec3::UnitZ(), *traces[k], path);
  }
  const auto out = std::make_unique<BeamTrace>();
  ASSERT_TRUE(tracer.blend(*traces[0], *traces[2], 0.5, *out));
  ASSERT_EQ(out->n_echoes, traces[1]->n_echoes);
  EXPECT_NEAR(out->echoes[0].sample, traces[1]->echoes[0].sample, 1e-9);
  EXPECT_NEAR(out->echoes[0].amplitude, traces[1]->echoes[0].amplitude, 1e-12);
  traces[2]->runs[1].region = kBeyond;
  EXPECT_FALSE(tracer.blend(*traces[0], *traces[2], 0.5, *out));
  traces[1]->echoes[0].p_J += Vec3(0, 0, 1e-3);  // a step of the interface
  EXPECT_FALSE(tracer.blend(*traces[0], *traces[1], 0.5, *out));
}

TEST(BeamShape, HearsScatterersInEverySecondPlaneOfFiveAndMore) {
  const auto heard = [](int planes, Look look = Look::clinical) {
    ImageSettings settings;
    settings.n_planes = planes;
    settings.look = look;
    const BeamShape shape(Transducer{}, settings);
    std::vector<int> list;
    for (int p = 0; p < planes; ++p) {
      if (shape.hears_speckle(p)) list.push_back(p);
      EXPECT_EQ(shape.speckle_weight(p)[200] > 0, shape.hears_speckle(p));
      EXPECT_GT(shape.echo_weight(p)[200], 0);
    }
    return list;
  };
  EXPECT_EQ(heard(1), (std::vector<int>{0}));
  EXPECT_EQ(heard(3), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(heard(4), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(heard(5), (std::vector<int>{0, 2, 4}));
  EXPECT_EQ(heard(5, Look::raw), (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(heard(7), (std::vector<int>{1, 3, 5}));
  EXPECT_EQ(heard(9), (std::vector<int>{0, 2, 4, 6, 8}));
}

}  // namespace
}  // namespace artus
