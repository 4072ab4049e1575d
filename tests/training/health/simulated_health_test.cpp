// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/health/simulated_health.h"

#include <array>
#include <memory>

#include <gtest/gtest.h>

#include "tests/session/session_support.h"
#include "tests/support/layered_body.h"
#include "tests/support/meshed_block.h"

namespace artus {
namespace {

/// m^3 within the walls of the bursa.
double volume_of_bursa(const Scene& scene) {
  const CompiledJoint body = body_in(scene);
  const RegionId bursa = test::region_named(body, "bursa");
  double six = 0;
  for (const Interface& f : body.mesh.interfaces) {
    if ((f.front == bursa) == (f.back == bursa)) continue;
    const auto p = [&](std::size_t k) {
      return body.mesh.vertices[f.vertices[k]];
    };
    six += (f.back == bursa ? 1 : -1) * p(0).dot(p(1).cross(p(2)));
  }
  return six / 6;
}

TEST(SimulatedHealth, ABodyIsExaminedOnceAllThatWasGivenIsDrawn) {
  const std::array<FlatLayer, 5> layers{
      {{"skin", 2e-3}, {"fat", 5e-3}, {"bursa", 2e-3}, {"tendon", 5e-3}, {"bone", 20e-3}}};
  const auto scene = std::make_shared<const Scene>(
      std::make_shared<const CompiledJoint>(test::make_meshed_block(layers, 0.064, 0.048, 4e-3)));
  SessionParams params = test::make_small_session();
  params.deform = true;
  Simulation simulation(scene, params);
  FrameInput shown;
  shown.number = 1;
  shown.controls = controls_of(params);
  shown.has_probe = 1;
  Pose X_JP = scene->joint().X_JP_default;
  X_JP.translation() -= 5e-3 * X_JP.linear().col(2);
  shown.X_JP = to_plain(X_JP);
  EXPECT_FALSE(find_health_question(simulation, shown)) << "nothing was given";

  constexpr double kGiven = 2e-6;
  shown.sites[0].p_J[2] = 8e-3;
  shown.sites[0].volume = kGiven;
  shown.sites[0].region = test::region_named(scene->joint(), "bursa");
  shown.sites[0].cavity = 1;
  shown.n_sites = 1;
  const auto question = find_health_question(simulation, shown);
  ASSERT_TRUE(question) << "though a shape takes some images";
  EXPECT_EQ(question->liquid.volume, kGiven);
  EXPECT_NEAR(volume_of_bursa(*question->after) - volume_of_bursa(*question->before), kGiven,
              0.01 * kGiven);
}

}  // namespace
}  // namespace artus
