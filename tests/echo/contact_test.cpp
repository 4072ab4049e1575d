// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/echo/acquire/aperture_coupling.h"
#include "artus/echo/renderer.h"
#include "tests/echo/echo_fixture.h"

namespace artus {
namespace {

const std::array<test::FlatLayer, 1> kContactBlock{{{"muscle", 60e-3}}};

/// Elements of the footprint of which those from `first` on are lifted.
std::vector<float> lifted_from(std::size_t first) {
  std::vector<float> coupling(128, 1.0F);
  for (std::size_t i = first; i < coupling.size(); ++i) coupling[i] = 0;
  return coupling;
}

TEST(Contact, LiftedElementsAreBlackBelowTheRingingLens) {
  Renderer renderer(test::make_block_scene(kContactBlock), Transducer{}, ImageSettings{});
  const Frame whole = renderer.render(test::probe_at());
  renderer.set_contact(lifted_from(64));
  const Frame& half = renderer.render(test::probe_at());
  EXPECT_GT(test::envelope_line(half, 200)[1], 0.5F);
  EXPECT_LT(test::envelope_line(whole, 200)[1], 0.1F);
  // 30 lines (4.7 mm) behind the edge, the aperture reaches coupled elements below 18.8 mm
  for (std::size_t i = 330; i < 450; ++i) {
    ASSERT_LT(test::envelope_line(half, 160)[i], 1e-4F) << i;
  }
  for (std::size_t i = 30; i < 100; ++i) {
    ASSERT_EQ(test::envelope_line(half, 60)[i], test::envelope_line(whole, 60)[i]) << i;
  }
}

TEST(Contact, LosesTheSquareOfTheLiftedShareOfTheAperture) {
  const Transducer transducer;
  ApertureCoupling coupling(transducer);
  coupling.set(lifted_from(64));
  // the aperture of 10 mm at 20 mm depth, centred on the edge of the lifted half: half is left
  EXPECT_NEAR(coupling.gain(127, 20e-3), 0.25, 0.01);
  EXPECT_EQ(coupling.gain(10, 1e-3), 1);
  EXPECT_EQ(coupling.gain(200, 1e-3), 0);
  EXPECT_EQ(coupling.at_line(0), 1);
  EXPECT_EQ(coupling.at_line(255), 0);
  double before = 0;
  for (double z = 0; z < 40e-3; z += 0.5e-3) {  // deeper: more of the aperture is coupled
    const double now = coupling.gain(150, z);
    EXPECT_GE(now, before);
    before = now;
  }
  EXPECT_GT(before, 0);
}

TEST(Contact, FullCouplingChangesNothingAndNonsenseCountsAsAir) {
  Renderer renderer(test::make_block_scene(kContactBlock), Transducer{}, ImageSettings{});
  const Frame plain = renderer.render(test::probe_at());
  renderer.set_contact(std::vector<float>(17, 1.0F));
  EXPECT_EQ(renderer.render(test::probe_at()).envelope, plain.envelope);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  renderer.set_contact(std::vector<float>{nan, -3.0F});
  const Frame& nothing = renderer.render(test::probe_at());
  for (int l = 0; l < nothing.n_lines; ++l) {
    for (const float a : test::envelope_line(nothing, l).subspan(400)) ASSERT_LT(a, 1e-3F);
  }
  renderer.set_contact({});
  EXPECT_EQ(renderer.render(test::probe_at()).envelope, plain.envelope);
}

}  // namespace
}  // namespace artus
