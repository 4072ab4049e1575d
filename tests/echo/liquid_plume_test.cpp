// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/liquid_plume.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "artus/echo/renderer.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

constexpr double kRoof = 10e-3;   // m
constexpr double kFloor = 16e-3;  // m
constexpr double kFrame = 1.0 / 30;

Liquid water() {
  Liquid liquid;
  liquid.name = "saline";
  return liquid;
}

/// Skin and muscle, liquid that was injected from 10 to 16 mm, bone; depth is z.
std::shared_ptr<const Scene> filled_body() {
  const std::vector<FlatLayer> layers{
      {"skin", 2e-3}, {"muscle", 8e-3}, {"bursa", kFloor - kRoof}, {"bone", 8e-3}};
  CompiledJoint joint = test::make_layered_block(layers, 60e-3, 60e-3);
  for (Tissue& tissue : joint.tissues)
    if (tissue.name == "bursa") {
      tissue.name = "injected_saline";
      tissue.acoustic.backscatter = 0;
    }
  return std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(std::move(joint)));
}

PlumeSource source_at(double depth, double given) {
  PlumeSource source;
  source.p_J = Vec3(0, 0, depth);
  source.axis_J = Vec3::UnitX();
  source.given = given;
  return source;
}

/// `flow` m^3/s for `images`, then none for `still`.
LiquidPlume after(const Scene& scene, const Liquid& liquid, double flow, int images, int still) {
  LiquidPlume plume(liquid);
  for (int k = 1; k <= images; ++k)
    plume.step(scene, source_at(11e-3, flow * kFrame * k), -Vec3::UnitZ(), kFrame);
  for (int k = 0; k < still; ++k)
    plume.step(scene, source_at(11e-3, flow * kFrame * images), -Vec3::UnitZ(), kFrame);
  return plume;
}

TEST(LiquidPlume, StaysInTheLiquidWhateverTheJetDoes) {
  const auto scene = filled_body();
  for (const double flow : {1e-8, 1e-7, 1e-6}) {
    const LiquidPlume plume = after(*scene, water(), flow, 60, 60);
    for (const DriftingPoint& point : plume.points()) {
      EXPECT_GT(point.p_J.z(), kRoof);
      EXPECT_LT(point.p_J.z(), kFloor);
      EXPECT_TRUE(point.v_J.allFinite());
    }
    EXPECT_TRUE(flow <= 1e-8 || plume.points().size() > 20U) << flow;
    EXPECT_LE(plume.points().size(), 800U);
  }
}

TEST(LiquidPlume, IsNotWhereNothingWasInjected) {
  const auto scene = filled_body();
  LiquidPlume plume(water());
  for (int k = 1; k <= 30; ++k)
    plume.step(*scene, source_at(6e-3, 1e-7 * kFrame * k), -Vec3::UnitZ(), kFrame);
  EXPECT_TRUE(plume.points().empty());
  LiquidPlume none(water());
  for (int k = 0; k < 30; ++k) none.step(*scene, source_at(11e-3, 0), -Vec3::UnitZ(), kFrame);
  EXPECT_TRUE(none.points().empty());
}

TEST(LiquidPlume, ComesToRestAndRisesByStokesLaw) {
  const auto scene = filled_body();
  LiquidPlume plume = after(*scene, water(), 1e-7, 30, 90);
  std::vector<DriftingPoint> before(plume.points().begin(), plume.points().end());
  ASSERT_GT(before.size(), 20U);
  plume.step(*scene, std::nullopt, -Vec3::UnitZ(), kFrame);
  int seen = 0;
  for (const DriftingPoint& point : plume.points()) {
    const auto same = std::find_if(before.begin(), before.end(),
                                   [&](const DriftingPoint& p) { return p.phase == point.phase; });
    ASSERT_NE(same, before.end());
    if (same->p_J.z() < kRoof + 1e-3) continue;   // gathered under the roof
    const double radius = point.amplitude / 500;  // 0.025 at 50 um
    const double rise = 2.0 / 9 * 1000 * 9.81 * radius * radius / 1e-3;
    EXPECT_NEAR((same->p_J.z() - point.p_J.z()) / kFrame, rise, 0.05 * rise + 2e-4);
    ++seen;
  }
  EXPECT_GT(seen, 3);
}

TEST(LiquidPlume, TheJetIsThereOnlyWhileItFlows) {
  const auto scene = filled_body();
  const auto fast = [](const LiquidPlume& plume) {
    return std::count_if(plume.points().begin(), plume.points().end(),
                         [](const DriftingPoint& point) { return point.v_J.norm() > 0.05; });
  };
  EXPECT_GE(fast(after(*scene, water(), 1e-7, 10, 0)), 16);
  EXPECT_EQ(fast(after(*scene, water(), 1e-7, 10, 60)), 0);
  Liquid thick = water();
  thick.viscosity = {10, 10, 0, 1};
  EXPECT_LT(fast(after(*scene, thick, 1e-7, 10, 0)), 5) << "no jet goes far in honey";
}

TEST(LiquidPlume, GrainsSinkAndThickLiquidHoldsThem) {
  const auto scene = filled_body();
  Liquid suspension = water();
  suspension.solids = 0.03;
  suspension.backscatter = 0.3;
  suspension.grain_radius = 5e-6;
  const auto mean_depth = [](const LiquidPlume& plume) {
    double sum = 0;
    int n = 0;
    for (const DriftingPoint& point : plume.points())
      if (point.tail == 0 && std::abs(point.amplitude - 0.009) < 1e-9) {
        sum += point.p_J.z();
        ++n;
      }
    return sum / n;
  };
  const double early = mean_depth(after(*scene, suspension, 1e-7, 30, 60));
  EXPECT_GT(mean_depth(after(*scene, suspension, 1e-7, 30, 900)), early + 0.5e-3);
  suspension.viscosity.zero = 100;
  const double thick = mean_depth(after(*scene, suspension, 1e-7, 30, 60));
  EXPECT_NEAR(mean_depth(after(*scene, suspension, 1e-7, 30, 900)), thick, 0.1e-3);
}

TEST(LiquidPlume, IsTheSameTwiceAndForgetsWhenCleared) {
  const auto scene = filled_body();
  const LiquidPlume a = after(*scene, water(), 1e-7, 40, 10);
  LiquidPlume b = after(*scene, water(), 1e-7, 40, 10);
  ASSERT_EQ(a.points().size(), b.points().size());
  for (std::size_t i = 0; i < a.points().size(); ++i)
    EXPECT_EQ(a.points()[i].p_J, b.points()[i].p_J);
  b.clear();
  EXPECT_TRUE(b.points().empty());
}

/// The probe on the skin, looking down z.
Frame seen(const std::shared_ptr<const Scene>& scene, std::span<const DriftingPoint> points,
           bool doppler) {
  Transducer probe;
  probe.n_lines = 64;
  ImageSettings settings;
  settings.depth = 22e-3;
  settings.doppler = doppler;
  Renderer renderer(scene, probe, settings);
  renderer.set_drifting_points(points);
  return renderer.render(make_pose(Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX()));
}

double peak_at(const Frame& frame, double depth) {
  const auto middle = static_cast<std::size_t>(std::lround(depth / frame.sample_depth));
  float most = 0;
  for (std::size_t l = 0; l < static_cast<std::size_t>(frame.n_lines); ++l)
    for (std::size_t s = middle - 4; s <= middle + 4; ++s)
      most = std::max(most, frame.envelope[l * static_cast<std::size_t>(frame.n_samples) + s]);
  return most;
}

TEST(DriftingEcho, ABubbleIsSeenWhereItIsWithItsTailAndNotBehindBone) {
  const auto scene = filled_body();
  const Frame clear = seen(scene, {}, false);
  DriftingPoint bubble;
  bubble.p_J = Vec3(0, 0, 12e-3);
  bubble.amplitude = 0.05;
  const Frame one = seen(scene, std::span(&bubble, 1), false);
  EXPECT_GT(peak_at(one, 12e-3), 20 * peak_at(clear, 12e-3));
  EXPECT_LT(peak_at(one, 13.5e-3), 2 * peak_at(clear, 13.5e-3) + 1e-5);
  bubble.tail = 2e-3;
  const Frame ringing = seen(scene, std::span(&bubble, 1), false);
  EXPECT_NEAR(20 * std::log10(peak_at(ringing, 13e-3) / peak_at(ringing, 12e-3)), -12, 3);
  bubble.p_J.z() = 19e-3;
  const Frame behind = seen(scene, std::span(&bubble, 1), false);
  EXPECT_EQ(behind.envelope, clear.envelope);
}

TEST(DriftingEcho, DopplerColoursWhatIsFastAndNotWhatDrifts) {
  const auto scene = filled_body();
  const auto coloured = [&](double speed) {
    DriftingPoint point;
    point.p_J = Vec3(0, 0, 12e-3);
    point.v_J = Vec3(0, 0, speed);
    point.amplitude = 0.05;
    const Frame frame = seen(scene, std::span(&point, 1), true);
    std::vector<double> found;
    for (const float v : frame.velocity)
      if (!std::isnan(v)) found.push_back(v);
    return found;
  };
  EXPECT_TRUE(coloured(1e-3).empty());
  const auto away = coloured(0.06);
  ASSERT_FALSE(away.empty());
  for (const double v : away) EXPECT_NEAR(v, -0.06, 1e-6);
  for (const double v : coloured(0.16)) EXPECT_NEAR(v, 0.04, 1e-6);  // wraps round at 0.1 m/s
}

}  // namespace
}  // namespace artus
