// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/acquire/propagation.h"
#include "artus/detail/raycast/moving_scene.h"
#include "artus/echo/labels.h"
#include "artus/echo/renderer.h"
#include "tests/echo/echo_fixture.h"
#include "tests/support/moved_block.h"

namespace artus {
namespace {

test::MovedBlock layers() {
  const std::array<test::FlatLayer, 4> list{
      {{"skin", 3e-3}, {"fat", 6e-3}, {"muscle", 21e-3}, {"tendon", 30e-3}}};
  return test::make_moved_block(list, [](CompiledJoint& joint) {
    for (Region& region : joint.regions) region.fibre_axis = Vec3::UnitX();
  });
}

test::MovedBlock muscle() {
  const std::array<test::FlatLayer, 1> list{{{"muscle", 60e-3}}};
  return test::make_moved_block(
      list, [](CompiledJoint& joint) { test::acoustic_of(joint, "muscle").attenuation = 0; });
}

Frame look(const std::shared_ptr<const Scene>& scene, const Pose& X_JP = test::probe_at(),
           const ImageSettings& settings = {}) {
  return render_bmode(scene, X_JP, std::nullopt, {}, settings);
}

/// Correlation of the complex echoes of two frames in the middle of the picture, the second read
/// `samples` on, 0..1.
double correlation_of(const Frame& a, const Frame& b, std::ptrdiff_t samples) {
  std::complex<double> product = 0;
  double a2 = 0;
  double b2 = 0;
  const auto n = static_cast<std::size_t>(a.n_samples);
  for (std::size_t l = 20; l < 236; ++l) {
    for (std::size_t i = 200; i < 800; ++i) {
      const auto j = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(l * n + i) + samples);
      const std::complex<double> u(a.in_phase[l * n + i], a.quadrature[l * n + i]);
      const std::complex<double> v(b.in_phase[j], b.quadrature[j]);
      product += u * std::conj(v);
      a2 += std::norm(u);
      b2 += std::norm(v);
    }
  }
  return std::abs(product) / std::sqrt(a2 * b2);
}

TEST(MovedTissue, ShowsTheBytesOfTheRigidBodyWhereItIsAtRest) {
  const test::MovedBlock block = layers();
  const Frame rigid = look(std::make_shared<const Scene>(block.joint));
  const Frame rest = look(make_scene(block.at_rest()));
  EXPECT_EQ(rigid.image, rest.image);
  EXPECT_EQ(rigid.in_phase, rest.in_phase);
}

TEST(MovedTissue, ShowsTheSameBytesAgainAndAtAnyNumberOfThreads) {
  const test::MovedBlock block = layers();
  const auto u = [](const Vec3& p) {
    return Vec3(0.02 * p.x(), 0, -0.05 * p.z() + 1e-3);
  };
  ImageSettings settings;
  settings.n_threads = 1;
  const Frame once = look(make_scene(block.moved(u)), test::probe_at(), settings);
  for (const int threads : {2, 7}) {
    settings.n_threads = threads;
    EXPECT_EQ(once.in_phase, look(make_scene(block.moved(u)), test::probe_at(), settings).in_phase);
  }
}

TEST(MovedTissue, CarriesItsSpeckleAlong) {
  const test::MovedBlock block = muscle();
  const ImageSettings settings = test::bare_settings();
  const Frame still = look(make_scene(block.at_rest()), test::probe_at(), settings);
  const double speed = block.joint->tissue_of(kFirstRegion).acoustic.speed_of_sound;
  const double a_sample = still.sample_depth * speed / kDisplaySpeedOfSound;
  for (const int samples : {7, 26}) {
    const auto body = block.moved([&](const Vec3&) { return Vec3(0, 0, samples * a_sample); });
    const Frame before = look(make_scene(block.at_rest()), test::probe_at(0, 0, 1e-3), settings);
    const Frame with =
        look(make_scene(body), test::probe_at(0, 0, 1e-3 + samples * a_sample), settings);
    EXPECT_GT(correlation_of(before, with, 0), 0.98) << "probe and tissue moved alike";
    const Frame under = look(make_scene(body), test::probe_at(0, 0, 2e-3), settings);
    const Frame rest = look(make_scene(block.at_rest()), test::probe_at(0, 0, 2e-3), settings);
    // The beam is another one so much deeper. How much that costs is what the rigid body shows to
    // a probe that is drawn back as far.
    const Frame drawn_back = look(make_scene(block.at_rest()),
                                  test::probe_at(0, 0, 2e-3 - samples * a_sample), settings);
    const double by_beam = correlation_of(rest, drawn_back, samples);
    EXPECT_NEAR(correlation_of(rest, under, samples), by_beam, 0.003) << samples;
    EXPECT_GT(by_beam, samples < 10 ? 0.97 : 0.9) << samples;
    RecordProperty("by_beam_" + std::to_string(samples), std::to_string(by_beam));
    EXPECT_LT(correlation_of(rest, under, 0), 0.1) << samples;
  }
}

TEST(MovedTissue, HasInterfacesAndSpeckleInOnePlace) {
  // A silent layer over a scattering one: the echo of the border and the first speckle below it.
  const std::array<test::FlatLayer, 2> list{{{"gel", 9e-3}, {"muscle", 51e-3}}};
  const test::MovedBlock block = test::make_moved_block(list, [](CompiledJoint& joint) {
    test::acoustic_of(joint, "gel").backscatter = 0;
    test::acoustic_of(joint, "muscle").attenuation = 0;
    test::acoustic_of(joint, "gel").attenuation = 0;
  });
  const auto u = [](const Vec3& p) {
    return Vec3(0, 0, -0.3 * p.z() + 1e-3 * p.x() / 10e-3);
  };
  const auto scene = make_scene(block.moved(u));
  ImageSettings settings = test::bare_settings();
  const LabelImage labels = render_labels(*scene, test::probe_at(0, 0, 1e-3), {}, settings);
  const Frame frame = look(scene, test::probe_at(0, 0, 1e-3), settings);
  const auto n = static_cast<std::size_t>(frame.n_samples);
  const double gel = block.joint->tissue_of(kFirstRegion).acoustic.speed_of_sound;
  for (std::size_t l = 16; l < 240; l += 8) {
    const double x = (static_cast<double>(l) / 255 - 0.5) * Transducer{}.width;
    const double border = 9e-3 + u({x, 0, 9e-3}).z() - 1e-3;
    const double shown = border * kDisplaySpeedOfSound / gel / frame.sample_depth;
    std::size_t first = 40;  // behind the lens's ringing
    const float loud = 0.1F * frame.envelope[l * n + static_cast<std::size_t>(shown) + 60];
    while (first < n && frame.envelope[l * n + first] < loud) ++first;
    EXPECT_NEAR(static_cast<double>(first), shown, 0.25e-3 / frame.sample_depth) << l;
  }
  EXPECT_GT(labels.width, 0);
}

TEST(MovedTissue, BendsItsBordersWithoutTheStepsOfTheCubes) {
  const std::array<test::FlatLayer, 2> list{{{"fat", 9e-3}, {"muscle", 51e-3}}};
  const test::MovedBlock block = test::make_moved_block(list);
  const double bend = 5;  // 1/m; a cube of 3 mm has one slope, 0.015 off at its sides
  const auto body = block.moved([&](const Vec3& p) { return Vec3(0, 0, bend * p.x() * p.x()); });
  const auto scene = make_scene(body);
  const SmoothGradient smooth(body);
  const Transducer transducer;
  const std::vector<RegionAcoustics> regions = make_region_acoustics(*block.joint, transducer);
  const BeamTracer beams(*scene, &smooth, regions, transducer, ImageSettings{});
  const auto trace = std::make_unique<BeamTrace>();
  BeamPath path;
  for (double x = -16.1e-3; x < 16e-3; x += 0.4e-3) {
    const double slope = 2 * bend * x;
    const double top = bend * x * x;
    beams.trace_bent(Vec3(x, 0.3e-3, top + 2e-3), Vec3::UnitZ(), *trace, path);
    ASSERT_GE(trace->n_echoes, 1U);
    EXPECT_NEAR(trace->echoes[0].cosine, 1 / std::sqrt(1 + slope * slope), 2e-6) << x;
  }
}

TEST(MovedTissue, TurnsItsFibresWithIt) {
  const test::MovedBlock block = test::make_moved_block(
      std::array<test::FlatLayer, 1>{{{"tendon", 60e-3}}}, [](CompiledJoint& joint) {
        for (Region& region : joint.regions) region.fibre_axis = Vec3::UnitX();
        test::acoustic_of(joint, "tendon").attenuation = 0;
      });
  const ImageSettings settings = test::bare_settings();
  const auto level = [&](const std::shared_ptr<const DeformedBody>& body, const Pose& X_JP) {
    return 10 *
           std::log10(test::mean_intensity(look(make_scene(body), X_JP, settings), 8e-3, 30e-3));
  };
  const double across = level(block.at_rest(), test::probe_at(0, 0, 2e-3));
  for (const double degrees : {4.0, 8.0}) {
    const Eigen::Matrix3d R(Eigen::AngleAxisd(degrees * kDegree, Vec3::UnitY()));
    const auto turned =
        block.moved([&](const Vec3& p) { return Vec3((R - Eigen::Matrix3d::Identity()) * p); });
    const Pose tilted = make_pose(R.transpose() * Vec3(0, 0, 2e-3), R.transpose() * Vec3::UnitZ(),
                                  R.transpose() * Vec3::UnitX());
    const double by_tissue = level(turned, test::probe_at(0, 0, 2e-3));
    const double by_probe = level(block.at_rest(), tilted);
    EXPECT_NEAR(by_tissue, by_probe, 0.7) << degrees;
    RecordProperty("dimmed_db_" + std::to_string(static_cast<int>(degrees)),
                   std::to_string(across - by_probe));
    if (degrees > 6) {
      EXPECT_LT(by_tissue, across - 3);
    }
  }
}

}  // namespace
}  // namespace artus
