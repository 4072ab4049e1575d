// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/needle_coupling.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "artus/detail/haptics/needle/needle_packet.h"
#include "artus/detail/haptics/needle/needle_tick_step.h"
#include "tests/support/real_time.h"

namespace artus {
namespace {

constexpr double kCouplingTick = 1e-3;

/// Points that each hold and pull on their neighbours, as a needle's in tissue of some kPa.
NeedleCompliance tissue(double scale = 1) {
  NeedleCompliance c;
  c.points = 16;
  for (std::size_t i = 0; i < 16; ++i) {
    for (std::size_t j = 0; j < 16; ++j) {
      const double apart = std::abs(static_cast<double>(i) - static_cast<double>(j));
      c.by_load[i][j] = scale * (i == j ? 1.6e-3 : 0.9e-3 * std::exp(-0.25 * apart));
    }
  }
  return c;
}

std::vector<double> limits_to(const NeedleCoupling& needle, double depth, double each) {
  std::vector<double> limits(needle.points(), 0.0);
  for (std::size_t i = 0; i < limits.size(); ++i) limits[i] = needle.depth_of(i) < depth ? each : 0;
  return limits;
}

TEST(NeedleCoupling, WithoutComplianceTheTissueIsRigid) {
  NeedleCoupling needle(kCouplingTick);
  EXPECT_FALSE(needle.active());
  EXPECT_EQ(needle.step(1e-3, 0.01, 1, 0, {}), 0);
  EXPECT_EQ(needle.tip_displacement(), 0);
}

TEST(NeedleCoupling, TentIsTheForceTimesTheTipsComplianceAndFallsWithTheRelaxationTime) {
  NeedleCoupling needle(kCouplingTick);
  needle.take(tissue());
  const std::vector<double> none(16, 0.0);
  for (int k = 0; k < 1000; ++k) needle.step(0, 0, 1.5, 0, none);
  const double tent = needle.tip_displacement();
  EXPECT_NEAR(tent, 1.5 * 1.6e-3, 1e-9);
  // The membrane gives way: what is left to cut holds 0.3 N.
  int ticks = 0;
  const double rest = 0.3 * 1.6e-3;
  while (needle.tip_displacement() - rest > 0.1 * (tent - rest)) {
    needle.step(0, 0, 0.3, 0, none);
    ++ticks;
  }
  EXPECT_NEAR(ticks * kCouplingTick, std::log(10) * NeedleCouplingParams{}.relaxation, 2e-3);
}

TEST(NeedleCoupling, TissueSofterThanTheMeasuredStiffnessGivesWayByWhatThatLeavesIt) {
  NeedleCoupling needle(kCouplingTick);
  needle.take(tissue(5));
  const std::vector<double> none(16, 0.0);
  for (int k = 0; k < 1000; ++k) needle.step(0, 0, 1.5, 600, none);
  EXPECT_NEAR(needle.tip_displacement(), 1.5 * (1 - 1.0 / 8) / 600, 1e-9);
  for (int k = 0; k < 1000; ++k) needle.step(0, 0, 1.5, 0, none);
  EXPECT_NEAR(needle.tip_displacement(), 1.5 * 5 * 1.6e-3, 1e-9) << "no stiffness is known";
}

TEST(NeedleCoupling, TheNeedlesOwnNeighbourhoodMovesWithTheShaftAndNotBeforeTheTip) {
  NeedleCompliance with = tissue();
  for (std::size_t i = 0; i < with.points; ++i) {
    with.near_field[i] = 5e-3;
    with.by_load[i][i] += with.near_field[i];
  }
  NeedleCoupling needle(kCouplingTick);
  needle.take(tissue());
  const double depth = needle.depth_of(3);
  const double plain = needle.tip_compliance(depth);
  const double between = needle.tip_compliance(depth + 1e-3);
  needle.take(with);
  EXPECT_NEAR(needle.tip_compliance(depth), plain, 1e-12);
  EXPECT_NEAR(needle.tip_compliance(depth + 1e-3), between, 1e-12);
  // The shaft sticks: each point takes its own way, 1e-5 m, nearly all of it in its neighbourhood.
  const std::vector<double> hold(16, 1.0);
  double force = 0;
  for (int k = 0; k < 200; ++k) force = needle.step(k == 0 ? 1e-5 : 0, depth, 0, 0, hold);
  EXPECT_LT(force, 0);
  EXPECT_GT(needle.tip_displacement(), 0);
  EXPECT_LT(needle.tip_displacement(), 1e-5) << "beside the needle it moves less than on it";
}

TEST(NeedleCoupling, CubesAreLoadedSoThatTheyGiveWayAsTheHandFeels) {
  NeedleCoupling needle(kCouplingTick);
  const NeedleCompliance soft = tissue(5);  // softer than K_t leaves it
  needle.take(soft);
  const auto limits = limits_to(needle, 0.02, 0.05);
  for (int k = 0; k < 500; ++k) test::use(needle.step(1e-5, 0.02, 0.8, 500, limits));
  const NeedleLoad load = needle.cube_load();
  EXPECT_LT(load.tip, 0.8);
  EXPECT_EQ(load.shaft, needle.load().shaft);
  EXPECT_NEAR(cube_displacement(soft, load), needle.tip_displacement(),
              1e-3 * needle.tip_displacement());
  needle.take({});
  EXPECT_EQ(needle.cube_load().tip, 0) << "rigid tissue bears no load that moves it";
  EXPECT_EQ(needle.tip_displacement(), 0);
}

TEST(NeedleCoupling, ShaftDragsUntilEachPointSlipsAndThenHoldsTheSumOfTheLimits) {
  NeedleCoupling needle(kCouplingTick);
  needle.take(tissue());
  const auto limits = limits_to(needle, 0.02, 0.1);
  const double n = static_cast<double>(std::count(limits.begin(), limits.end(), 0.1));
  // A first small way sticks: the force is the way over the compliance of a rigid shaft.
  double force = 0;
  for (int k = 0; k < 200; ++k) force = needle.step(k == 0 ? 1e-5 : 0, 0.02, 0, 0, limits);
  Eigen::MatrixXd C(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  for (Eigen::Index i = 0; i < C.rows(); ++i) {
    for (Eigen::Index j = 0; j < C.cols(); ++j)
      C(i, j) = tissue().by_load[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  }
  const double stiffness = C.ldlt().solve(Eigen::VectorXd::Ones(C.rows())).sum();
  EXPECT_NEAR(-force, stiffness * 1e-5, 0.02 * stiffness * 1e-5);
  for (int k = 0; k < 1000; ++k) force = needle.step(1e-5, 0.02, 0, 0, limits);
  EXPECT_NEAR(-force, 0.1 * n, 1e-9);
  // It stops: the tissue stays dragged. It leaves: nothing is held.
  for (int k = 0; k < 1000; ++k) force = needle.step(0, 0.02, 0, 0, limits);
  EXPECT_NEAR(-force, 0.1 * n, 1e-9);
  EXPECT_GT(needle.tip_displacement(), 1e-4);
  const std::vector<double> none(16, 0.0);
  for (int k = 0; k < 1000; ++k) force = needle.step(0, 0, 0, 0, none);
  EXPECT_EQ(force, 0);
  EXPECT_LT(needle.tip_displacement(), 1e-9);
}

/// A border that lies on a point would else hold it or not by a rounding.
TEST(NeedleCoupling, PointsShareTheShaftWithoutAGapWhereverABorderLies) {
  NeedleCoupling needle(kCouplingTick);
  NeedleCompliance c = tissue();
  c.spacing = 2e-3;
  needle.take(c);
  for (const double border : {0.0, 0.4e-3, 1e-3, 5e-3, 21e-3, 31.9e-3}) {
    double before = 0;
    double behind = 0;
    for (std::size_t i = 0; i < needle.points(); ++i) {
      before += needle.held_by(i, 0, border);
      behind += needle.held_by(i, border, 32e-3);
      const double less = needle.held_by(i, 0, border - 1e-9);
      EXPECT_NEAR(needle.held_by(i, 0, border), less, 1.001e-9) << border;
    }
    EXPECT_NEAR(before, border, 1e-12);
    EXPECT_NEAR(behind, 32e-3 - border, 1e-12);
  }
}

TEST(NeedleCoupling, FrictionTakesEnergyInEveryTickOfATremblingHand) {
  NeedleCouplingParams exact;
  exact.sweeps = 200;
  for (const int sweeps : {200, NeedleCouplingParams{}.sweeps}) {
    NeedleCouplingParams params;
    params.sweeps = sweeps;
    NeedleCoupling needle(kCouplingTick, params);
    needle.take(tissue());
    double work = 0;
    double lost = 0;
    double least = 1;
    double before = 0;
    for (int k = 1; k <= 20000; ++k) {
      const double t = k * kCouplingTick;
      const double depth = 0.03 * std::sin(std::numbers::pi * t / 20) +
                           3e-4 * std::sin(2 * std::numbers::pi * 9 * t);
      const double moved = depth - before;
      before = depth;
      const double force = needle.step(moved, depth, 0, 0, limits_to(needle, depth, 0.08));
      work -= force * moved;
      least = std::min(least, needle.dissipated() - lost);
      lost = needle.dissipated();
    }
    EXPECT_GT(least, sweeps == exact.sweeps ? -1e-12 : -1e-7) << sweeps;
    EXPECT_GT(lost, 5e-3);
    // Each tick's step forward takes a little more: never less.
    EXPECT_GE(work, lost + needle.stored()) << sweeps;
    EXPECT_NEAR(work, lost + needle.stored(), 0.1 * work) << sweeps;
  }
}

/// Hands that tremble, jump and twist, at depths and in layers that change as they like, in tissue
/// that is another one every 333 ticks. The hand's work and what new compliances bring cover what
/// the tissue stores and friction takes, in every tick; let go, the tissue is back.
TEST(NeedleCoupling, WildHandsGetNoEnergyThatIsNotMeteredAndTheTissueIsBackAtRest) {
  constexpr std::uint64_t kSeed = 91;
  NeedleCoupling needle(kCouplingTick);
  needle.take(tissue());
  double work = 0;
  double before = 0;
  double least = 0;
  double largest = 0;
  for (std::uint64_t k = 0; k < 100'000; ++k) {
    const auto random = [k](std::uint64_t i) {
      return uniform_noise(kSeed, 8 * k + i);
    };
    if (k % 333 == 332) needle.take(tissue(0.3 + 2 * random(0)));
    const double jump = random(1) < 0.01 ? 0.03 : 1e-4;
    const double moved = jump * normal_noise(kSeed + 1, k);
    const double depth = 0.05 * random(2) - 0.005;
    const auto limits = limits_to(needle, depth, 0.3 * random(3));
    const double tip_force = 4 * random(4) - 1;
    const double force = needle.step(moved, depth, tip_force, 2000 * random(5), limits);
    const double most = 0.3 * static_cast<double>(needle.points());
    ASSERT_LE(std::abs(force), most) << k;
    work -= force * moved;
    largest = std::max(largest, needle.stored());
    // Each tick's step forward takes a little more than it stores and friction takes: never less.
    const double taken = work + needle.given() - needle.stored() - needle.dissipated();
    least = std::min(least, taken - before);
    before = taken;
    ASSERT_TRUE(std::isfinite(needle.tip_displacement() + taken)) << k;
  }
  EXPECT_GT(work, 1) << "the hands did work";
  EXPECT_GT(largest, 1e-3);
  EXPECT_GT(least, -1e-12 * work) << "rounding of the sums";
  const std::vector<double> none(16, 0.0);
  for (int k = 0; k < 1000; ++k) EXPECT_EQ(needle.step(0, -0.01, 0, 0, none), 0);
  EXPECT_LT(std::abs(needle.tip_displacement()), 1e-7);
  EXPECT_EQ(needle.stored(), 0);
}

TEST(NeedleCoupling, EnergyOfANewComplianceIsMetered) {
  NeedleCoupling needle(kCouplingTick);
  needle.take(tissue());
  const auto limits = limits_to(needle, 0.03, 0.1);
  for (int k = 0; k < 500; ++k) needle.step(1e-5, 0.03, 0, 0, limits);
  const double before = needle.stored();
  needle.take(tissue(1.1));
  EXPECT_NEAR(needle.given(), 0.1 * before, 1e-12);
}

TEST(NeedleCoupling, NeitherAllocatesNorLocks) {
  NeedleCoupling needle(kCouplingTick);
  const NeedleCompliance soft = tissue();
  const std::array<double, 16> limits{0.1, 0.1, 0.1};
  ARTUS_RUNS_REALTIME(NeedleCoupling::take, needle.take(soft));
  ARTUS_RUNS_REALTIME(NeedleCoupling::step, test::use(needle.step(1e-4, 0.01, 0.5, 0, limits)));
  ARTUS_RUNS_REALTIME(NeedleCoupling::tip_compliance, test::use(needle.tip_compliance(0.01)));
  ARTUS_RUNS_REALTIME(NeedleCoupling::held_by, test::use(needle.held_by(1, 0, 4e-3)));
  ARTUS_RUNS_REALTIME(NeedleCoupling::cube_load, test::use(needle.cube_load()));
  ARTUS_RUNS_REALTIME(NeedleCoupling::reset, needle.reset());
}

/// Tissue of one kind below z = 0.
struct SoftHalfSpace {
  QueryCount find_intervals(const Segment& segment, std::span<TissueInterval> out) const noexcept {
    const double length = (segment.end - segment.start).norm();
    const double skin = std::clamp(-segment.start.z(), 0.0, length);
    QueryCount count;
    if (skin > 0) out[count.size++] = {0, skin, kOutside, Vec3::Zero(), kNoInterface};
    if (skin < length) out[count.size++] = {skin, length, kFirstRegion, -Vec3::UnitZ(), 0};
    return count;
  }
};

class CoupledInsertion {
 public:
  explicit CoupledInsertion(double compliance) : tick_(table(), params()) {
    if (compliance > 0) tick_.take({{}, tissue(compliance)});
  }
  /// Moves the tip by `way` at `speed`; the last tick's result.
  const RenderedNeedle& move(double distance, double speed) {
    const int n = static_cast<int>(std::lround(std::abs(distance) / speed / kCouplingTick));
    const RenderedNeedle* out = nullptr;
    for (int k = 0; k < n; ++k) out = &at(z_ + distance / n);
    return *out;
  }
  const RenderedNeedle& at(double z) {
    z_ = z;
    time_ += kCouplingTick;
    return tick_.step({make_pose(Vec3(0, 0, z), Vec3::UnitZ(), Vec3::UnitX()), time_}, body_);
  }
  void carry(double by) { tick_.take({{0, 0, by}, {}}); }
  void soften(double scale) { tick_.take({{}, tissue(scale)}); }
  [[nodiscard]] const NeedleModel& model() const { return tick_.model(); }
  [[nodiscard]] double z() const { return z_; }

 private:
  static LayerTable table() {
    LayerHaptics layer;
    layer.tissue.cutting_force = 0.6;
    layer.tissue.wall_stiffness = 500;
    layer.tissue.puncture_force = 1.5;
    layer.tissue.friction = 1;
    return LayerTable({{}, {}, layer});
  }
  static NeedleRendererParams params() {
    NeedleRendererParams params;
    params.device = find_device("ideal").value();
    return params;
  }
  SoftHalfSpace body_;
  NeedleTickStep tick_;
  double z_ = -2e-3;
  double time_ = 0;
};

TEST(NeedleCoupling, SkinTentsBeforeItGivesWayAndTheTipThenIsDeeperInTheTissue) {
  CoupledInsertion rigid(0);
  CoupledInsertion soft(1);
  const auto punctured_at = [](CoupledInsertion& needle) {
    while (!needle.model().contact().inserted() && needle.z() < 0.02) needle.at(needle.z() + 2e-6);
    return needle.z();
  };
  const double without = punctured_at(rigid);
  const double with = punctured_at(soft);
  EXPECT_NEAR(without, 0.8e-3, 0.02e-3);  // the membrane's own dimple
  EXPECT_NEAR(with - without, 1.5 * 1.6e-3, 0.1e-3);
  // The hand stays: the tissue comes onto the needle.
  const double before = soft.model().contact().tick().depth;
  const double tent = soft.model().coupling().tip_displacement();
  for (int k = 0; k < 300; ++k) soft.at(with);
  const double left = soft.model().coupling().tip_displacement();
  EXPECT_LT(left, 0.5 * tent);
  EXPECT_NEAR(soft.model().contact().tick().depth - before, tent - left, 0.1 * tent);
}

/// Tissue follows the tip later than an encoder's steps come: each is a peak of force, and a tick
/// may meet it or not.
TEST(NeedleCoupling, AnEncodersStepsDoNotDecideWhereSkinGivesWay) {
  constexpr double kStep = 0.055e-3;
  constexpr double kSpeed = 27e-3;
  double nearest = 1;
  double farthest = 0;
  for (int phase = 0; phase < 20; ++phase) {
    CoupledInsertion needle(1);
    double z = -1e-3 - phase * 1.7e-6;
    while (!needle.model().contact().inserted() && z < 0.02) {
      z += kSpeed * kCouplingTick;
      needle.at(kStep * std::round(z / kStep));
    }
    nearest = std::min(nearest, z);
    farthest = std::max(farthest, z);
  }
  EXPECT_GT(nearest, 1e-3);
  EXPECT_LT(farthest - nearest, kStep);
}

/// However fast the hand is, a membrane holds no more than a quarter above its strength.
TEST(NeedleCoupling, AStabIsHeldByNoMoreThanAMembranesStrength) {
  for (const double speed : {0.02, 0.1, 0.3, 1.0}) {
    CoupledInsertion needle(1);
    double most = 0;
    while (needle.z() < 0.015) {
      needle.at(needle.z() + speed * kCouplingTick);
      most = std::max(most, -needle.model().forces().prepuncture);
    }
    EXPECT_LT(most, 1.25 * 1.5) << speed;
  }
}

TEST(NeedleCoupling, PlateauOfTheCutStaysTheSameAtTheHand) {
  CoupledInsertion rigid(0);
  CoupledInsertion soft(1);
  const double without = rigid.move(22e-3, 5e-3).forces.cutting;
  const double with = soft.move(22e-3, 5e-3).forces.cutting;
  EXPECT_NEAR(without, -0.6, 0.01);
  EXPECT_NEAR(with, without, 0.02 * 0.6);
}

/// K_t was measured at a hand, with the tissue in it: a tissue that follows the tip late makes it
/// neither stiffer nor softer, however fast the hand is.
TEST(NeedleCoupling, SlopeOfTheCutIsTheMeasuredOneAtAnySpeedOfTheHand) {
  for (const double speed : {5e-3, 20e-3, 80e-3}) {
    CoupledInsertion needle(1);
    needle.move(15e-3, 10e-3);
    for (int k = 0; k < 1500; ++k) needle.at(needle.z());
    const auto push_until = [&](double force) {
      while (needle.model().forces().cutting > -force && needle.z() < 0.03)
        needle.at(needle.z() + speed * kCouplingTick);
      return Vec3(needle.z(), -needle.model().forces().cutting, 0);
    };
    const Vec3 low = push_until(0.2);
    const Vec3 high = push_until(0.5);
    EXPECT_NEAR((high - low).y() / (high - low).x(), 500, 0.02 * 500) << speed;
  }
}

/// What friction holds of a needle at rest relaxes, and the tissue that it dragged goes back along
/// it: let go, it is not carried out.
TEST(NeedleCoupling, TissueThatTheShaftDraggedGoesBackAlongANeedleAtRest) {
  CoupledInsertion needle(1);
  const double dragging = needle.move(22e-3, 10e-3).forces.friction;
  EXPECT_LT(dragging, -0.05);
  for (int k = 0; k < 1000; ++k) needle.at(needle.z());
  EXPECT_NEAR(needle.model().forces().friction, 0, 0.01 * -dragging);
  EXPECT_LT(needle.model().coupling().stored(), 1e-6);
}

TEST(NeedleCoupling, ClosedWayGivesTheHandNoEnergy) {
  CoupledInsertion needle(1);
  double work = 0;  // by the hand
  for (int k = 0; k < 8000; ++k) {
    const double t = k * kCouplingTick;
    const double z = -2e-3 + 0.025 * std::pow(std::sin(std::numbers::pi * t / 8), 2) +
                     2e-4 * std::sin(2 * std::numbers::pi * 9 * t);
    const double before = needle.z();
    if (k > 0) work += needle.model().forces().total.force.z() * -(z - before);
    needle.at(z);
    EXPECT_TRUE(needle.model().forces().total.force.allFinite());
  }
  EXPECT_GT(work, 0);
}

TEST(NeedleCoupling, TissueThatAProbeCarriesIsMetWhereItIs) {
  CoupledInsertion needle(0);
  needle.carry(1.5e-3);
  for (int k = 0; k < 300; ++k) needle.at(-1e-3);
  while (needle.model().forces().prepuncture == 0 && needle.z() < 5e-3)
    needle.at(needle.z() + 2e-6);
  EXPECT_NEAR(needle.z(), 1.5e-3, 1e-5);
  needle.carry(std::nan(""));
  const double before = needle.model().forces().prepuncture;
  needle.at(needle.z());
  EXPECT_NEAR(needle.model().forces().prepuncture, before, 1e-3) << "what is no number is left out";
}

TEST(NeedleCoupling, TissueThatComesWhileTheNeedleIsInStaysRigidUntilItIsOut) {
  CoupledInsertion rigid(0);
  rigid.move(10e-3, 10e-3);
  rigid.soften(1);
  EXPECT_FALSE(rigid.model().coupling().active());
  rigid.move(-20e-3, 20e-3);
  rigid.soften(1);
  EXPECT_TRUE(rigid.model().coupling().active());
}

}  // namespace
}  // namespace artus
