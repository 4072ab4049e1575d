// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/operators/injection_operator.h"

#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr double kStart = -5e-3;  // m
constexpr RegionId kTarget = 3;

/// A needle along +z that follows the operator's hand at once, unless something holds it.
class Person {
 public:
  explicit Person(std::vector<OperatorPhase> phases)
      : operator_(Vec3::Zero(), Vec3::UnitZ(), kStart, std::move(phases)) {}

  /// Runs until a phase ends, or for `most` s; the time that it took.
  double until_next(double most = 10) {
    const double begin = time_;
    while (time_ - begin < most) {
      const OperatorPhase* ended = operator_.observe(time_, needle(), view);
      time_ += 1e-3;
      if (ended != nullptr) break;
    }
    return time_ - begin;
  }
  [[nodiscard]] double meant() const { return operator_.intention(time_).X_JN.translation().z(); }
  [[nodiscard]] Pose needle() const {
    Pose pose = operator_.intention(time_).X_JN;
    if (held) pose.translation().z() = *held;
    return pose;
  }
  void again() { operator_.begin_again(time_); }
  [[nodiscard]] const InjectionOperator& operator()() const { return operator_; }

  OperatorView view;
  std::optional<double> held;  // m, depth at which the needle is stuck

 private:
  InjectionOperator operator_;
  double time_ = 0;
};

TEST(InjectionOperator, GoesToADepthStaysAndComesOut) {
  Person person({push_to(10e-3, 0.01), stay(0.5), pull_to(kStart, 0.02)});
  EXPECT_EQ(person().start().translation().z(), kStart);
  EXPECT_NEAR(person.until_next(), 1.5, 5e-3);
  EXPECT_NEAR(person.meant(), 10e-3, 1e-4);
  EXPECT_NEAR(person.until_next(), 0.5, 5e-3);
  EXPECT_NEAR(person.until_next(), 0.75, 1e-2);
  EXPECT_TRUE(person().done());
  EXPECT_FALSE(person().timed_out());
}

TEST(InjectionOperator, StopsInTheLayerItLooksForWhenItSeesTheTipDeepEnough) {
  OperatorPhase phase = push_to(1e-3, 0.01);
  phase.goal = OperatorPhase::Goal::region;
  phase.region = kTarget;
  Person person({phase});
  person.view = {kTarget, 0.5e-3, 4e-3, false};
  person.until_next(0.1);
  EXPECT_FALSE(person().done());
  person.view.into_layer = 1.1e-3;
  person.until_next(0.1);
  EXPECT_TRUE(person().done());
}

TEST(InjectionOperator, GoesDeeperThanHalfALayerOnlyWhereItIsToldHowNearItsEnd) {
  OperatorPhase phase = push_to(3e-3, 0.01);
  phase.goal = OperatorPhase::Goal::region;
  phase.region = kTarget;
  for (const double before_floor : {0.0, 0.3e-3, 3e-3}) {
    phase.before_floor = before_floor;
    const double ends = before_floor == 0.3e-3 ? 2.7e-3 : 1.5e-3;  // of 3 mm
    Person person({phase});
    person.view = {kTarget, ends - 0.1e-3, 3e-3, false};
    person.until_next(0.1);
    EXPECT_FALSE(person().done()) << before_floor;
    person.view.into_layer = ends + 0.1e-3;
    person.until_next(0.1);
    EXPECT_TRUE(person().done()) << before_floor;
  }
}

TEST(InjectionOperator, IsSureOfBoneOnlyAfterAWhile) {
  OperatorPhase phase = push_to(0, 0.01);
  phase.goal = OperatorPhase::Goal::bone;
  Person person({phase});
  person.view.bone = true;
  person.until_next(0.02);
  person.view.bone = false;
  person.until_next(0.01);
  EXPECT_FALSE(person().done()) << "a tap is not yet bone";
  person.view.bone = true;
  EXPECT_NEAR(person.until_next(1), 0.03, 3e-3);
  EXPECT_TRUE(person().done());
}

TEST(InjectionOperator, BoneBeforeTheTargetEndsAPushThatMinds) {
  OperatorPhase minds = push_to(20e-3, 0.01);
  minds.stop_at_bone = true;
  Person person({minds});
  person.view.bone = true;
  EXPECT_LT(person.until_next(), 0.05);
}

TEST(InjectionOperator, HoldStaysWhereTheNeedleIsAndPressWhereTheHandMeantToBe) {
  Person holds({push_to(10e-3, 0.01), stay(1)});
  Person presses({push_to(10e-3, 0.01), press(1)});
  for (Person* person : {&holds, &presses}) {
    person->until_next(1);
    person->held = 11e-3;  // the goal is passed all at once
    person->until_next(0.1);
  }
  EXPECT_NEAR(holds.meant(), 11e-3, 1e-12);
  EXPECT_NEAR(presses.meant(), 5e-3, 1e-3);
}

TEST(InjectionOperator, GivesUpANeedleThatIsStuckAndSaysSo) {
  OperatorPhase phase = push_to(10e-3, 0.01);
  phase.duration = 2;
  Person person({phase});
  person.held = 3e-3;
  EXPECT_NEAR(person.until_next(), 2, 1e-2);
  EXPECT_TRUE(person().timed_out());
}

TEST(InjectionOperator, BeginsAgainAtItsStart) {
  Person person({press(0.1), push_to(10e-3, 0.01)});
  person.until_next();
  person.until_next();
  ASSERT_TRUE(person().done());
  person.again();
  EXPECT_FALSE(person().done());
  EXPECT_NEAR(person.meant(), kStart, 1e-12);
  EXPECT_NEAR(person.until_next(), 0.1, 3e-3);
  EXPECT_NEAR(person.until_next(), 1.5, 5e-3);
}

TEST(InjectionOperator, GoesByTheDepthInTheMaterialWhereThePictureTellsIt) {
  Person person({push_to(10e-3, 0.01), stay(0.1)});
  person.view.depth = 8e-3;  // however far the hand goes, the tissue goes along
  EXPECT_GE(person.until_next(3), 3);
  person.view.depth = 10e-3;
  EXPECT_LT(person.until_next(), 2e-3);
  EXPECT_GT(person.meant(), 20e-3);
}

TEST(InjectionOperator, KeepsATipWhereItIsMeantWhenTissueComesOntoIt) {
  OperatorPhase watched = stay(1);
  watched.keeps_depth = true;
  watched.depth = 10e-3;
  Person person({push_to(10e-3, 0.01), watched, stay(1)});
  person.until_next();
  const double before = person.meant();
  person.view.depth = 13e-3;  // 3 mm too deep all along
  EXPECT_GE(person.until_next(1.2), 1.2) << "waited for";
  EXPECT_LT(person.meant(), before - 1e-3) << "drawn back";
  EXPECT_GT(person.meant(), before - 3e-3) << "slowly";
  person.view.depth = 10.1e-3;
  EXPECT_LT(person.until_next(), 2e-3) << "there";
  const double after = person.meant();
  person.until_next(0.5);
  EXPECT_NEAR(person.meant(), after, 1e-4) << "one that does not watch stays";
}

}  // namespace
}  // namespace artus
