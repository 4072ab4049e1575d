// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/needle_contact.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "artus/detail/haptics/needle/insertion_cone.h"
#include "artus/detail/haptics/needle/needle_model.h"
#include "tests/haptics/needle/tick_builder.h"

namespace artus {
namespace {

constexpr double kDt = 1e-3;

// Layers along z from 0 down, as the flat block a scene would give, without a scene.
class FlatBody {
 public:
  struct Layer {
    double from;
    RegionId region;
  };
  FlatBody(std::vector<Layer> layers, std::vector<Haptic> tissues)
      : layers_(std::move(layers)), table_(test::table_of(tissues)) {}

  [[nodiscard]] std::vector<TissueInterval> intervals(const Segment& s) const {
    const Vec3 d = s.end - s.start;
    const double length = d.norm();
    const double slope = d.z() / length;
    std::vector<TissueInterval> out;
    double at = 0;
    RegionId region = region_at(s.start.z());
    for (const Layer& layer : layers_) {
      if (slope <= 0) break;
      const double depth = (layer.from - s.start.z()) / slope;
      if (depth <= at || depth >= length) continue;
      out.push_back({at, depth, region, Vec3::Zero(), 0});
      at = depth;
      region = layer.region;
    }
    out.push_back({at, length, region, Vec3::Zero(), 0});
    return out;
  }
  [[nodiscard]] const LayerTable& table() const { return table_; }

 private:
  [[nodiscard]] RegionId region_at(double z) const {
    RegionId region = kOutside;
    for (const Layer& layer : layers_) {
      if (z >= layer.from) region = layer.region;
    }
    return region;
  }
  std::vector<Layer> layers_;
  LayerTable table_;
};

Haptic membrane(double cutting, double puncture) {
  Haptic h = test::soft(cutting);
  h.puncture_force = puncture;
  return h;
}

Haptic bone() {
  Haptic h = test::soft(4, 2000, 0);
  h.hard = true;
  return h;
}

FlatBody skin_muscle_bursa_bone() {
  return {{{0, 2}, {0.004, 3}, {0.020, 4}, {0.023, 5}},
          {membrane(1, 1.5), test::soft(2), membrane(1.5, 2), bone()}};
}

class ContactTest : public ::testing::Test {
 protected:
  ContactTest() : body(skin_muscle_bursa_bone()), model(NeedleParams{}, body.table(), kDt) {}

  void step(const Vec3& tip, const Vec3& axis = Vec3::UnitZ()) {
    const Pose pose = make_pose(tip, axis, Vec3::UnitX());
    model.step(pose, body.intervals(model.query_segment(pose)));
    states.push_back(model.contact().state());
    events |= model.contact().events();
  }
  void move(double from, double to, double speed = 0.01) {
    const int n = static_cast<int>(std::abs(to - from) / (speed * kDt));
    for (int i = 1; i <= n; ++i) step(Vec3(0, 0, from + (to - from) * i / n));
  }
  [[nodiscard]] ContactState state() const { return model.contact().state(); }
  [[nodiscard]] std::vector<ContactState> sequence() const {
    std::vector<ContactState> out;
    for (const ContactState s : states) {
      if (out.empty() || out.back() != s) out.push_back(s);
    }
    return out;
  }

  FlatBody body;
  NeedleModel model;
  std::vector<ContactState> states;
  std::uint32_t events = 0;
};

TEST_F(ContactTest, InsertionGoesThroughItsStatesInOrder) {
  move(-0.002, 0.010);
  for (int i = 0; i < 300; ++i) step(Vec3(0, 0, 0.010));
  move(0.010, 0.006);
  move(0.006, 0.012);
  move(0.012, 0.0235);
  move(0.0235, -0.001);
  using S = ContactState;
  const std::vector<S> expected{S::away,        S::touching,    S::punctured,   S::inserting,
                                S::stopped,     S::withdrawing, S::reinserting, S::inserting,
                                S::touching,    S::punctured,   S::inserting,   S::bone,
                                S::withdrawing, S::away};
  EXPECT_EQ(sequence(), expected);
}

TEST_F(ContactTest, SkinDimplesUntilItsPunctureForceThenPops) {
  step(Vec3(0, 0, -0.001));
  double top = 0;
  double x = 0;
  for (; state() == ContactState::away || state() == ContactState::touching; x += 1e-5) {
    step(Vec3(0, 0, x));
    top = std::max(top, -model.forces().prepuncture);
    if (state() == ContactState::touching) {
      EXPECT_EQ(model.forces().cutting, 0) << "nothing is cut while it dimples";
    }
  }
  EXPECT_NEAR(top, 1.5, 0.05);
  EXPECT_NE(events & ContactEvent::kSkinPunctured, 0U);
  const double cutting = model.forces().cutting;
  EXPECT_LT(-cutting, 1.5) << "what the tip cuts takes over a part of the membrane's force";
  EXPECT_NEAR(-(cutting + model.forces().prepuncture), 1.5, 1e-9) << "and the tear the rest";
  const double torn = model.forces().prepuncture;
  const double tear_time = TearParams{}.time;
  for (int i = 0; i < static_cast<int>(std::lround(tear_time / kDt)); ++i) step(Vec3(0, 0, x));
  EXPECT_NEAR(model.forces().prepuncture, torn * std::exp(-1), 1e-9);
  for (int i = 0; i < 100; ++i) step(Vec3(0, 0, x));
  EXPECT_EQ(model.forces().prepuncture, 0);
}

TEST_F(ContactTest, ATornMembraneGivesBackNothingToANeedleDrawnOut) {
  move(-0.001, 0.0205, 0.05);
  double x = 0.0205;
  while (model.contact().state() != ContactState::punctured) step(Vec3(0, 0, x += 2e-5));
  ASSERT_LT(model.forces().prepuncture, -1.9);
  const double surface = x - model.contact().tick().torn_dimple;
  for (; x > surface; x -= 2e-4) step(Vec3(0, 0, x));
  step(Vec3(0, 0, surface - 1e-6));
  EXPECT_EQ(model.forces().prepuncture, 0);
}

// The surface that a swaying needle meets lies a little elsewhere in each tick: on a slope it must
// neither be lost nor found twice, whatever the tremor.
TEST_F(ContactTest, AMembraneOnASlopePopsOnceAndAtItsForceUnderATremblingNeedle) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    NeedleModel needle(NeedleParams{}, body.table(), kDt);
    const double speed = 1e-3 + 0.04 * uniform_noise(seed, 0);
    const double sway = 60e-6 * uniform_noise(seed, 1);
    int pops = 0;
    double top = 0;
    double x = -0.001;
    for (std::uint64_t i = 0; x < 0.0225; ++i, x += speed * kDt) {
      const Pose pose = make_pose(Vec3(0, 0, x), Vec3::UnitZ(), Vec3::UnitX());
      auto intervals = body.intervals(needle.query_segment(pose));
      const double off =
          sway * std::sin(0.06 * static_cast<double>(i)) + 1e-6 * normal_noise(seed, 10 + i);
      for (std::size_t k = 0; k + 1 < intervals.size(); ++k) {
        if (intervals[k + 1].region < 3) continue;  // the skin stays: it is where depth begins
        intervals[k].exit += off;
        intervals[k + 1].entry += off;
      }
      needle.step(pose, intervals);
      if ((needle.contact().events() & ContactEvent::kMembranePopped) != 0) ++pops;
      if (pops == 0 && x > 0.019) top = std::max(top, -needle.forces().prepuncture);
    }
    EXPECT_EQ(pops, 1) << seed;
    EXPECT_GT(top, 1.6) << seed << ": it popped at less than its 2 N";
  }
}

TEST_F(ContactTest, MembranePopsOnceInATrack) {
  move(-0.001, 0.0215);
  EXPECT_NE(events & ContactEvent::kMembranePopped, 0U);
  events = 0;
  move(0.0215, 0.015);
  move(0.015, 0.0215);
  EXPECT_EQ(events & ContactEvent::kMembranePopped, 0U);
}

// Bone from this depth on, whatever the line met there.
void begin_bone(std::vector<TissueInterval>& intervals, double depth) {
  const double from = intervals.front().exit + depth;  // before it the line is outside
  std::erase_if(intervals, [from](const TissueInterval& t) { return t.entry >= from; });
  intervals.back().exit = from;
  intervals.push_back({from, from + 0.02, 5, Vec3::Zero(), 0});
}

// A line that grazes a condyle meets it millimetres behind the tip in one tick and not in the next.
TEST_F(ContactTest, BoneThatIsGrazedIsFeltNoFasterThanTheTipMovesAndIsTappedOnce) {
  move(-0.001, 0.015, 0.02);
  const double stiffness = bone().wall_stiffness;
  double before = model.forces().cutting;
  double late = 0;
  for (int i = 1; i <= 300; ++i) {
    const double x = 0.015 + 5e-6 * i;
    const Pose pose = make_pose(Vec3(0, 0, x), Vec3::UnitZ(), Vec3::UnitX());
    auto intervals = body.intervals(model.query_segment(pose));
    const bool grazed = i % 3 != 0;
    if (grazed) begin_bone(intervals, x - 0.003);  // 3 mm behind the tip
    model.step(pose, intervals);
    const double now = model.forces().cutting;
    EXPECT_LT(std::abs(now - before), 3 * stiffness * 5e-6) << i;
    before = now;
    if (i > 70) late = std::max(late, std::abs(model.forces().hard));
  }
  EXPECT_EQ(late, 0) << "a tap of 55 ms is over";
}

// A needle pressed on the rim of bone that slides off it: the bevel leaves bone over its way in.
TEST_F(ContactTest, BoneIsLeftOverTheWayThatTheTipWasInAndASwayDoesNotLoseIt) {
  move(-0.001, 0.015, 0.02);
  const double pressed = 0.5 * bone().cutting_force / bone().wall_stiffness;
  constexpr double kBone = 0.015;
  constexpr double kFar = 0.025;
  double x = kBone;
  // Where the tip is in bone that begins at `from` on its line, m.
  const auto pressed_in = [this, &x](double aside, double from) {
    const Pose pose = make_pose(Vec3(aside, 0, x), Vec3::UnitZ(), Vec3::UnitX());
    auto intervals = body.intervals(model.query_segment(pose));
    begin_bone(intervals, from);
    model.step(pose, intervals);
    events |= model.contact().events();
    return model.contact().tick().depth - model.contact().tick().bone_depth;
  };
  for (; x < kBone + pressed; x += 5e-6) pressed_in(0, kBone);
  EXPECT_NEAR(pressed_in(0, kBone), pressed, 5e-6);
  events = 0;
  for (int i = 0; i < 200; ++i) {  // sways by a fifth of it over the rim
    const double sway = 0.2 * pressed * std::abs(std::sin(0.1 * i));
    EXPECT_GT(pressed_in(sway, sway > 0.1 * pressed ? kFar : kBone), 0.75 * pressed);
    EXPECT_EQ(model.contact().state(), ContactState::bone);
  }
  EXPECT_EQ(events & ContactEvent::kBoneTouched, 0U) << "it was never off";
  double before = pressed_in(0, kBone);
  for (double aside = 5e-6; aside < pressed; aside += 5e-6) {
    const double now = pressed_in(aside, kFar);
    EXPECT_NEAR(now, before - 5e-6, 2e-6) << aside;
    before = now;
  }
  EXPECT_LT(pressed_in(1.01 * pressed, kFar), 0) << "and is off it";
  EXPECT_EQ(model.contact().region(), 3);
}

TEST_F(ContactTest, EntryWorksAtAnyAngle) {
  const Vec3 axis = Vec3(1, 0, 1).normalized();
  for (int i = -100; i < 1000; ++i) step(1e-5 * i * axis, axis);
  EXPECT_TRUE(model.contact().inserted());
  EXPECT_LT((model.contact().tick().axis - axis).norm(), 1e-12);
  EXPECT_LT(model.contact().tick().entry.norm(), 1e-9);
  EXPECT_EQ(model.contact().region(), 3);
}

TEST_F(ContactTest, DirectionMayChangeInsideTheConeAfterAWithdrawalOnly) {
  move(-0.001, 0.018);
  const auto turn_to = [this](double degrees, double depth) {
    for (int i = 0; i <= 200; ++i) {
      const double a = degrees * kDegree * i / 200;
      const Vec3 axis(std::sin(a), 0, std::cos(a));
      step(depth * axis, axis);
    }
  };
  turn_to(8, 0.018);
  EXPECT_EQ(events & ContactEvent::kRedirected, 0U) << "not withdrawn";
  EXPECT_GT(model.forces().clamping.norm(), 0.1);
  step(Vec3(0, 0, 0.018));
  move(0.018, 0.008);
  turn_to(20, 0.008);
  EXPECT_NE(events & ContactEvent::kRedirected, 0U);
  const double angle = std::atan2(model.contact().tick().axis.x(), model.contact().tick().axis.z());
  EXPECT_NEAR(angle / kDegree, 20, 2.1);
  EXPECT_LT(model.forces().clamping.norm(), 0.02);
  turn_to(44, 0.008);
  const double held = std::atan2(model.contact().tick().axis.x(), model.contact().tick().axis.z());
  // A tick's way is straight: its middle lies a hair nearer the entry, where the cone is wider.
  EXPECT_LE(held, insertion_cone(0.008, 0.035) + 1e-5) << "the cone ends the turn";
}

TEST_F(ContactTest, WhatIsFeltAlongTheNeedleGoesOnWhenALineIsTakenAnew) {
  move(-0.001, 0.018);
  const auto along = [this] {
    const NeedleForces& f = model.forces();
    return f.cutting + f.attracted + f.friction;
  };
  double worst = 0;
  double before = along();
  int taken = 0;
  for (int i = 1; i <= 1200; ++i) {  // drawn out by 12 mm while it turns by 10 degrees
    const double a = 10 * kDegree * i / 1200;
    const Vec3 axis(std::sin(a), 0, std::cos(a));
    step((0.018 - 1e-5 * i) * axis, axis);
    if (i > 300) worst = std::max(worst, std::abs(along() - before));
    before = along();
    if ((model.contact().events() & ContactEvent::kRedirected) != 0) ++taken;
  }
  EXPECT_GT(taken, 0);
  EXPECT_GT(before, 0.4) << "it is being drawn out";
  EXPECT_LT(worst, 0.02) << "N in a tick";
}

TEST_F(ContactTest, NeedleFoundInsideStartsAtRestWithoutForce) {
  step(Vec3(0, 0, 0.012));
  EXPECT_NE(events & ContactEvent::kAdopted, 0U);
  EXPECT_EQ(state(), ContactState::stopped);
  EXPECT_EQ(model.forces().total.force.norm(), 0);
}

TEST_F(ContactTest, LeavingTheSkinForgetsTheLine) {
  move(-0.001, 0.010);
  move(0.010, -0.001);
  EXPECT_EQ(state(), ContactState::away);
  EXPECT_EQ(model.forces().total.force.norm(), 0);
  events = 0;
  move(-0.001, 0.005);
  EXPECT_NE(events & ContactEvent::kSkinPunctured, 0U) << "a new puncture is needed";
}

// At the tick after the puncture a swaying needle is somewhere else at each rate.
TEST_F(ContactTest, TheLineBeginsWhereTheSkinGaveWayWhereverTheTicksFall) {
  std::vector<Vec3> entries;
  for (int i = 0; i < 10; ++i) {
    NeedleModel needle(NeedleParams{}, body.table(), kDt);
    for (double t = 1e-4 * i; !needle.contact().inserted(); t += kDt) {
      const Pose pose =
          make_pose(Vec3(0.025 * t, 0, 0.015 * t - 0.001), Vec3::UnitZ(), Vec3::UnitX());
      needle.step(pose, body.intervals(needle.query_segment(pose)));
    }
    entries.push_back(needle.contact().tick().entry);
  }
  for (const Vec3& entry : entries) EXPECT_LT((entry - entries[0]).norm(), 1e-7);
}

// Ticks on the skin itself and a hair from it: the hold runs out at the skin, not a tick later.
TEST_F(ContactTest, TissueHoldsAWithdrawnNeedleByNoMoreThanItsStiffnessTimesItsDepth) {
  const double stiffness = body.table()[2].tissue.wall_stiffness;
  move(-0.001, 0.010);
  move(0.010, 0.0001);
  double before = model.forces().attracted;
  EXPECT_GT(before, 0.04);
  for (int i = 10; i >= 0; --i) {
    const double x = 1e-5 * i;
    step(Vec3(0, 0, x));
    const double now = model.forces().attracted;
    EXPECT_LE(now, stiffness * x + 1e-9) << "at " << x;
    EXPECT_LE(std::abs(now - before), stiffness * 1e-5 + 1e-9) << "at " << x;
    before = now;
  }
  EXPECT_LT(model.forces().total.force.norm(), 1e-3) << "on the skin";
}

// A needle that is drawn back to the skin and pushed in again, by a hair inside or outside.
TEST_F(ContactTest, ANeedleThatLeftTheSkinByAHairFindsItsHole) {
  const auto run = [this](double back) {
    NeedleModel needle(NeedleParams{}, body.table(), kDt);
    std::vector<double> forces;
    const auto go = [&](double from, double to) {
      for (int i = 1; i <= 400; ++i) {
        const double z = from + (to - from) * i / 400;
        const Pose pose = make_pose(Vec3(0, 0, z), Vec3::UnitZ(), Vec3::UnitX());
        needle.step(pose, body.intervals(needle.query_segment(pose)));
        forces.push_back(needle.forces().total.force.z());
      }
    };
    go(-0.001, 0.008);
    go(0.008, back);
    go(back, 0.008);
    return forces;
  };
  const std::vector<double> inside = run(1e-7);
  const std::vector<double> outside = run(-1e-7);
  const std::vector<double> away = run(-0.001);
  double off = 0;
  double off_away = 0;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    off = std::max(off, std::abs(outside[i] - inside[i]));
    off_away = std::max(off_away, std::abs(away[i] - inside[i]));
  }
  EXPECT_LT(off, 0.1);
  EXPECT_GT(off_away, 0.5) << "a millimetre off, it must puncture the skin anew";
}

TEST_F(ContactTest, OnABorderTheSoftLayersPassIntoEachOther) {
  move(-0.001, 0.0039);
  const auto& felt = model.contact().tick().layer.tissue;
  double before = felt.cutting_force;
  EXPECT_EQ(before, 1);
  for (double x = 0.0039; x < 0.0043; x += 2e-6) {
    step(Vec3(0, 0, x));
    EXPECT_NEAR(felt.cutting_force, before, 0.0101) << x;
    before = felt.cutting_force;
  }
  EXPECT_EQ(before, 2);
  step(Vec3(0, 0, 0.0041));
  EXPECT_NEAR(felt.cutting_force, 1.5, 1e-9) << "half of the 0.2 mm";
}

// A spring's force is its stiffness times the depth, a wall's is bounded by f_R: half a wall's
// stiffness in a spring would be a blow.
TEST_F(ContactTest, FromTheWallToASpringNoForceIsAboveEither) {
  LayerHaptics wall{membrane(1, 0.5), CuttingLaw::tracking_wall, PrepunctureLaw::membrane};
  wall.tissue.wall_stiffness = 1500;
  LayerHaptics spring{test::soft(1, 800), CuttingLaw::spring, PrepunctureLaw::membrane};
  const LayerTable table({{}, {}, wall, spring});
  model = NeedleModel(NeedleParams{}, table, kDt);
  for (double x = -0.001; x < 0.006; x += 1e-5) {
    step(Vec3(0, 0, x));
    const double most = x < 0.004 ? 1 : 800 * x;
    EXPECT_LE(-model.forces().cutting, most + 1e-9) << x;
  }
  EXPECT_NEAR(-model.forces().cutting, 800 * 0.006, 0.01);
}

TEST_F(ContactTest, TotalForceIsTheSumOfItsComponents) {
  move(-0.001, 0.0235, 0.02);
  const NeedleForces& f = model.forces();
  const Vec3 axis = model.contact().tick().axis;
  const Vec3 sum =
      (f.prepuncture + f.cutting + f.attracted + f.friction + f.hard) * axis + f.clamping;
  EXPECT_LT((f.total.force - sum).norm(), 1e-15);
}

TEST_F(ContactTest, ANeedleThatComesFromBeyondTheMeshIsInTheAirUntilItMeetsSkin) {
  for (double z = -0.030; z < 0.010; z += 1e-5) {
    const Pose pose = make_pose(Vec3(0, 0, z), Vec3::UnitZ(), Vec3::UnitX());
    auto met = body.intervals(model.query_segment(pose));
    met.front().region = kBeyond;
    model.step(pose, met);
    EXPECT_TRUE(z >= 0 || state() == ContactState::away) << z;
  }
  EXPECT_NEAR(model.contact().tick().depth, 0.010, 1e-4);
}

}  // namespace
}  // namespace artus
