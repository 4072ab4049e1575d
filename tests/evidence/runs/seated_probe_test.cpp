// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/seated_probe.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/evidence/runs/run_images.h"
#include "artus/detail/simulation/fluid_scene.h"
#include "tests/support/layered_body.h"
#include "tests/support/meshed_block.h"

namespace artus {
namespace {

const std::vector<PlannedInjection> kLines{{"first", {-.02, 0, 0}, {-.012, 0, .0235}},
                                           {"second", {-.02, 0, 0}, {-.015, .002, .0235}},
                                           {"third", {-.02, .003, 0}, {-.014, .003, .0235}}};

std::shared_ptr<const Scene> soft_layers() {
  const std::vector<FlatLayer> layers{{"skin", .004},   {"muscle", .018},    {"bursa", .003},
                                      {"tendon", .006}, {"cartilage", .003}, {"bone", .02}};
  static const auto kScene = std::make_shared<const Scene>(
      std::make_shared<const CompiledJoint>(test::make_meshed_block(layers, .08, .06, 4e-3)));
  return kScene;
}

/// What was drawn and felt at one image.
struct Seen {
  NeedleRow needle;
  ProbeHandRow probe;
  double carried = 0;  // m by which the tissue at the tip is moved along the needle, in the picture
  double skin = 0;     // m, of the skin in the picture from the middle of the face
};

struct SoftRun {
  ThreeInjections run;
  std::vector<Seen> seen;
};

/// With `press` N on the probe, the first two needles at `speed` m/s.
SoftRun run_soft(double press = ThreeInjectionsOptions{}.probe.press_force,
                 double speed = ThreeInjectionsOptions{}.slow_speed) {
  SoftRun out;
  ThreeInjectionsOptions options;
  options.probe.press_force = press;
  options.slow_speed = speed;
  RunTissueOptions tissue;
  tissue.on_image = [&out](const ThreeInjections& run, const std::shared_ptr<const Scene>& body,
                           const FluidState& /*fluid*/) {
    Seen now{run.rows.back(), run.probe.back(), 0, 0};
    const Vec3 tip = now.needle.X_JN.translation();
    now.carried = (tip - body->tissue()->to_rest(tip).p_rest).dot(now.needle.axis);
    now.skin = body->signed_distance_to_skin(now.probe.X_JP.translation(), 10e-3);
    out.seen.push_back(now);
  };
  out.run = run_three_injections(*soft_layers(), kLines, options, {}, &tissue).value();
  return out;
}

const SoftRun& soft_run() {
  static const SoftRun kRun = run_soft();
  return kRun;
}

TEST(SeatedProbe, ClaimsOfThePublishedTestHoldInTissueThatGivesWay) {
  for (const Claim& c : soft_run().run.claims)
    EXPECT_TRUE(c.pass) << c.text << ": " << c.value << ' ' << c.bound;
}

/// The hand's law says how far the tissue at the tip is pushed in; the cubes, under the same load,
/// move it in the picture. The probe hardly presses, or it would move it as well.
TEST(SeatedProbe, NeedleTentsTheTissueOfThePictureAsTheHandFeels) {
  double most = 0;
  double off = 0;
  double square = 0;
  std::size_t n = 0;
  for (const Seen& s : run_soft(0.05).seen) {
    if (s.needle.state != ContactState::inserting) continue;
    most = std::max(most, s.needle.pushed);
    square += std::pow(s.carried - s.needle.pushed, 2);
    ++n;
  }
  ASSERT_GT(n, 50U);
  off = std::sqrt(square / static_cast<double>(n));
  EXPECT_GT(most, 2e-3) << "muscle of 2 N and 500 N/m";
  EXPECT_LT(off, 0.2 * most);
}

TEST(SeatedProbe, ProbePressesTheSkinOfThePictureWithWhatItsHandFeels) {
  double deepest = 0;
  double off = 0;
  for (const Seen& s : soft_run().seen) {
    if (s.probe.normal_force < 2.9) continue;
    deepest = std::max(deepest, s.probe.X_JP.translation().z());
    off = std::max(off, std::abs(s.skin));
  }
  EXPECT_GT(deepest, 1e-3) << "3 N press the face in";
  EXPECT_LT(off, 0.5e-3) << "and the skin lies on it";
}

/// Liquid under the face lifts the skin, which meets the face: it would stand inside it, or the
/// hand feel none of it.
TEST(SeatedProbe, SkinThatLiquidLiftsLiesOnTheFace) {
  ThreeInjectionsOptions options;
  options.dose.volume = 2e-6;
  options.dose.rate = 1e-6;
  options.slow_speed = 0.03;
  FluidScene scenes;
  std::shared_ptr<const FluidShape> shape;
  double off = 0;
  double opened = 0;
  int seen = 0;
  RunTissueOptions tissue;
  tissue.on_image = [&](const ThreeInjections& run, const std::shared_ptr<const Scene>& body,
                        const FluidState& fluid) {
    const auto filled = scenes.at(fluid, body->tissue());
    if (!filled || fluid.before || run.probe.back().normal_force < 2.9) return;
    const Vec3 face = run.probe.back().X_JP.translation();
    off = std::max(off, std::abs(filled->signed_distance_to_skin(face, 10e-3)));
    ++seen;
    if (shape == fluid.shape) return;
    shape = fluid.shape;
    opened = std::max(opened, soft_layers()->signed_distance_to_skin(face, 20e-3) -
                                  Scene(shape->joint).signed_distance_to_skin(face, 20e-3));
  };
  ASSERT_TRUE(run_three_injections(*soft_layers(), kLines, options, {}, &tissue));
  EXPECT_GT(seen, 20);
  EXPECT_GT(opened, 0.5e-3) << "m by which the skin is lifted";
  EXPECT_LT(off, 0.5e-3);
}

TEST(SeatedProbe, SameSeedGivesTheSameBytes) {
  const ThreeInjections a = run_soft(3, 0.05).run;
  const ThreeInjections b = run_soft(3, 0.05).run;
  ASSERT_EQ(a.rows.size(), b.rows.size());
  for (std::size_t i = 0; i < a.rows.size(); ++i) {
    ASSERT_EQ(needle_csv_line(a.rows[i], a.region_names),
              needle_csv_line(b.rows[i], b.region_names));
    ASSERT_EQ(a.probe[i].X_JP.matrix(), b.probe[i].X_JP.matrix());
    ASSERT_EQ(a.probe[i].normal_force, b.probe[i].normal_force);
  }
}

TEST(SeatedProbe, ABodyThatCannotGiveWayIsRefused) {
  const std::vector<FlatLayer> layers{
      {"skin", .004}, {"muscle", .018}, {"bursa", .009}, {"bone", .03}};
  const Scene hollow(
      std::make_shared<const CompiledJoint>(test::make_layered_block(layers, .2, .2)));
  const RunTissueOptions tissue;
  EXPECT_TRUE(run_three_injections(hollow, kLines));
  EXPECT_FALSE(run_three_injections(hollow, kLines, {}, {}, &tissue)) << "it has no tetrahedra";
}

}  // namespace
}  // namespace artus
