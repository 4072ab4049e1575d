// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/plunger/bevel.h"

#include <algorithm>
#include <array>
#include <span>

#include <gtest/gtest.h>

#include "artus/detail/haptics/needle/needle_tick_step.h"
#include "artus/haptics/needle_feel.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

/// A needle that goes down through layers, and `look(depth, shares)` at every micrometre.
class Descent {
 public:
  explicit Descent(std::span<const test::FlatLayer> layers)
      : joint_(std::make_shared<const CompiledJoint>(test::make_layered_block(layers, 0.1, 0.1))),
        places_(make_bevel_places(*make_joint_spaces(*joint_))) {}

  [[nodiscard]] std::uint32_t space_of(const char* region) const {
    return places_.of_region[test::region_named(*joint_, region)];
  }
  [[nodiscard]] std::uint32_t air() const { return places_.of_region[kOutside]; }

  /// m by which liquid in a region lifts what is above it.
  void lift(const char* region, double by) { lifted_[space_of(region)] = by; }

  template <class Look>
  void go(double from, double to, double bevel, Look look) const {
    const Scene scene(joint_);
    NeedleTickStep tick(make_layer_table(*joint_, {}), {});
    for (int k = 0; from + 1e-6 * k < to; ++k) {
      const double depth = from + 1e-6 * k;
      TimedPose pose;
      pose.X_JN = make_pose(Vec3(0, 0, depth), Vec3::UnitZ(), Vec3::UnitX());
      pose.time = 1e-3 * k;
      tick.step(pose, scene);
      const auto shares = bevel_shares(tick.model().contact(), bevel, places_, lifted_);
      ASSERT_NEAR(shares[0].share + shares[1].share, 1, 1e-12);
      look(depth, shares);
    }
  }

 private:
  std::shared_ptr<const CompiledJoint> joint_;
  BevelPlaces places_;
  std::vector<double> lifted_ = std::vector<double>(places_.kinds.size(), 0.0);
};

double share_of(const std::array<TipShare, 2>& shares, std::uint32_t space) {
  double share = 0;
  for (const TipShare& s : shares) share += s.space == space ? s.share : 0;
  return share;
}

TEST(Bevel, IsInTheLayersThatItsOpeningIsIn) {
  const std::array<test::FlatLayer, 3> layers{
      {{"skin", 2e-3}, {"muscle", 10e-3}, {"tendon", 10e-3}}};
  const Descent descent(layers);
  const auto muscle = descent.space_of("muscle");
  const auto tendon = descent.space_of("tendon");
  const double bevel = 1e-3;
  double half = -1;
  descent.go(-5e-3, 15e-3, bevel, [&](double depth, const std::array<TipShare, 2>& shares) {
    if (depth < 0) {
      EXPECT_EQ(shares[0].space, descent.air());
    }
    if (depth > 4e-3 && depth < 11e-3) {
      EXPECT_EQ(shares[0].space, muscle);
      EXPECT_EQ(shares[0].share, 1);
    }
    if (depth > 12e-3 && depth < 12.999e-3) {
      EXPECT_EQ(shares[0].space, tendon);
      EXPECT_EQ(shares[1].space, muscle);
      EXPECT_NEAR(shares[0].share, (depth - 12e-3) / bevel, 1e-5);
      half = shares[0].share;
    }
  });
  EXPECT_GT(half, 0.9);
}

TEST(Bevel, AFilmBesideACavityIsTheCavitys) {
  const std::array<test::FlatLayer, 5> layers{
      {{"skin", 2e-3}, {"muscle", 6e-3}, {"fat", 0.3e-3}, {"bursa", 1e-3}, {"tendon", 8e-3}}};
  const Descent descent(layers);
  const auto bursa = descent.space_of("bursa");
  const auto fat = descent.space_of("fat");
  const double bevel = 2e-3;
  int seen = 0;
  descent.go(-2e-3, 13e-3, bevel, [&](double depth, const std::array<TipShare, 2>& shares) {
    // What is passed of fat before the bursa is reached is fat; from then on the fat and 0.2 mm of
    // the muscle above it are the bursa's, and so is as much of the tendon as lies within 0.5 mm.
    if (depth > 8.01e-3 && depth < 8.29e-3) {
      EXPECT_EQ(share_of(shares, bursa), 0) << depth;
      EXPECT_NEAR(share_of(shares, fat), (depth - 8e-3) / bevel, 1e-5);
    }
    if (depth > 8.31e-3 && depth < 9.79e-3) {
      EXPECT_NEAR(share_of(shares, bursa), (depth - 7.8e-3) / bevel, 1e-5) << depth;
      EXPECT_EQ(share_of(shares, fat), 0);
    }
    if (depth > 9.81e-3 && depth < 10.99e-3) {
      EXPECT_NEAR(share_of(shares, bursa), (9.8e-3 - std::max(7.8e-3, depth - bevel)) / bevel, 1e-5)
          << depth;
      EXPECT_NEAR(share_of(shares, descent.space_of("tendon")), (depth - 9.8e-3) / bevel, 1e-5);
      ++seen;
    }
    if (depth > 11.81e-3) {
      EXPECT_EQ(share_of(shares, bursa), 0) << depth;
    }
  });
  EXPECT_GT(seen, 900);
}

TEST(Bevel, WhatLiquidLiftsOffTheTipIsTheCavitys) {
  const std::array<test::FlatLayer, 4> layers{
      {{"skin", 2e-3}, {"muscle", 6e-3}, {"bursa", 1e-3}, {"tendon", 8e-3}}};
  Descent descent(layers);
  descent.lift("bursa", 2e-3);
  const auto bursa = descent.space_of("bursa");
  const auto muscle = descent.space_of("muscle");
  int seen = 0;
  // The roof is 2 mm higher, and half a millimetre of it tears; the floor is where it was.
  descent.go(4e-3, 12e-3, 1e-3, [&](double depth, const std::array<TipShare, 2>& shares) {
    if (depth < 5.99e-3) {
      EXPECT_EQ(share_of(shares, muscle), 1) << depth;
    }
    if (depth > 6.51e-3 && depth < 9.49e-3 && std::abs(depth - 9e-3) > 2e-6) {
      EXPECT_EQ(shares[0].space, bursa) << depth;
      EXPECT_NEAR(share_of(shares, bursa), 1, 1e-9) << depth;
      ++seen;
    }
    if (depth > 10.51e-3) {
      EXPECT_EQ(share_of(shares, bursa), 0) << depth;
    }
  });
  EXPECT_GT(seen, 2900);
}

}  // namespace
}  // namespace artus
