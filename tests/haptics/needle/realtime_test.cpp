// SPDX-License-Identifier: AGPL-3.0-or-later
// Every function of the needle's tick under the allocation and lock counters. What a whole tick
// does from skin to bone is in needle_renderer_test.cpp.
#include <algorithm>
#include <array>
#include <memory>

#include <gtest/gtest.h>

#include "artus/detail/haptics/needle/insertion_cone.h"
#include "artus/detail/haptics/needle/insertion_line.h"
#include "artus/detail/haptics/needle/laws/clamping.h"
#include "artus/detail/haptics/needle/laws/classic_cutting.h"
#include "artus/detail/haptics/needle/laws/skin_puncture.h"
#include "artus/detail/haptics/needle/laws/velocity_estimator.h"
#include "artus/detail/haptics/needle/needle_model.h"
#include "artus/detail/haptics/needle/needle_tick_step.h"
#include "tests/haptics/needle/tick_builder.h"
#include "tests/support/real_time.h"

namespace artus {
namespace {

using test::AxialTick;
using test::use;

TEST(RealTimeNeedle, TrackingWallNeitherAllocatesNorLocks) {
  AxialTick line(test::soft(2));
  TrackingWall law;
  ARTUS_RUNS_REALTIME(TrackingWall::reset, law.reset(0));
  ARTUS_RUNS_REALTIME(TrackingWall::start, law.start(0, 0));
  ARTUS_RUNS_REALTIME(TrackingWall::step, use(law.step(line.at(5e-3))),
                      use(law.step(line.at(5e-3, Motion::still))), use(law.step(line.at(1e-3))));
  line.tick().bone_depth = 3e-3;
  line.tick().bone = line.tick().layer;
  ARTUS_RUNS_REALTIME(TrackingWall::step, use(law.step(line.at(4e-3))));
  ARTUS_RUNS_REALTIME(TrackingWall::take_line, law.take_line(1e-4, 0.5));
}

TEST(RealTimeNeedle, InsertionLineNeitherAllocatesNorLocks) {
  InsertionLine line({}, 0.035);
  const Vec3 z = Vec3::UnitZ();
  ARTUS_RUNS_REALTIME(InsertionLine::start, line.start(Vec3::Zero(), z, 0, -z));
  ARTUS_RUNS_REALTIME(InsertionLine::follow, use(line.follow(Vec3(0, 0, 0.02), z)),
                      use(line.follow(Vec3(2e-3, 0, 0.01), z)),
                      use(line.follow(Vec3(2e-3, 0, 0.001), z)));
}

TEST(RealTimeNeedle, SkinPunctureNeitherAllocatesNorLocks) {
  SkinPuncture skin(0.5e-3);
  NeedlePlace now;
  ARTUS_RUNS_REALTIME(SkinPuncture::forget, skin.forget());
  ARTUS_RUNS_REALTIME(SkinPuncture::leave, skin.leave(Vec3::Zero(), now));
  now.depth = -1e-3;
  ARTUS_RUNS_REALTIME(SkinPuncture::wait, skin.wait(now));
  now.depth = 1e-3;
  ARTUS_RUNS_REALTIME(SkinPuncture::touch, skin.touch(now));
  ARTUS_RUNS_REALTIME(SkinPuncture::between, use(skin.between(now, 0)));
  ARTUS_RUNS_REALTIME(SkinPuncture::last_dimple, use(skin.last_dimple(1e-3)));
  ARTUS_RUNS_REALTIME(SkinPuncture::wholeness, use(skin.wholeness()));
  ARTUS_RUNS_REALTIME(SkinPuncture::remember, skin.remember(now));
}

TEST(RealTimeNeedle, ClassicCuttingLawsNeitherAllocateNorLock) {
  AxialTick line(test::soft(2));
  DirectCutting direct;
  ARTUS_RUNS_REALTIME(DirectCutting::reset, direct.reset(0));
  ARTUS_RUNS_REALTIME(DirectCutting::step, use(direct.step(line.at(5e-3))));
  SpringCutting spring;
  ARTUS_RUNS_REALTIME(SpringCutting::reset, spring.reset(0));
  ARTUS_RUNS_REALTIME(SpringCutting::step, use(spring.step(line.at(5e-3))));
  VoigtCutting voigt;
  ARTUS_RUNS_REALTIME(VoigtCutting::reset, voigt.reset(0));
  ARTUS_RUNS_REALTIME(VoigtCutting::step, use(voigt.step(line.at(5e-3, Motion::inward, 0.01))));
}

TEST(RealTimeNeedle, MembranesNeitherAllocateNorLock) {
  AxialTick line(test::soft(2));
  const PrepunctureParams params;
  for (const PrepunctureLaw kind : {PrepunctureLaw::membrane, PrepunctureLaw::simone_okamura,
                                    PrepunctureLaw::barbe, PrepunctureLaw::god_object}) {
    line.tick().membrane = {test::soft(1), CuttingLaw::tracking_wall, kind};
    line.tick().membrane.tissue.puncture_force = 1;
    line.tick().dimple = 0.5e-3;
    ARTUS_RUNS_REALTIME(prepuncture_force,
                        use(prepuncture_force(params, line.tick().membrane, 0.5e-3, 0.01)));
    Prepuncture law(params);
    ARTUS_RUNS_REALTIME(Prepuncture::reset, law.reset(0));
    ARTUS_RUNS_REALTIME(Prepuncture::step, use(law.step(line.at(0.5e-3))));
    ARTUS_RUNS_REALTIME(Prepuncture::tear, law.tear(1, 0.5e-3, 0.5e-3));
    ARTUS_RUNS_REALTIME(Prepuncture::step, use(law.step(line.at(0.6e-3))));
  }
  GodObject proxy;
  ARTUS_RUNS_REALTIME(GodObject::reset, proxy.reset(0));
  ARTUS_RUNS_REALTIME(GodObject::step, use(proxy.step(line.at(0.5e-3))));
}

TEST(RealTimeNeedle, FrictionNeitherAllocatesNorLocks) {
  const LugreParams params;
  ARTUS_RUNS_REALTIME(lugre_level, use(lugre_level(params, 0.01)));
  LugreBristle bristle;
  ARTUS_RUNS_REALTIME(LugreBristle::reset, bristle.reset());
  ARTUS_RUNS_REALTIME(LugreBristle::step, use(bristle.step(params, 1e-4, 0.1, 1e-3, 1)));
  ARTUS_RUNS_REALTIME(LugreBristle::advance, use(bristle.advance(params, 1e-4, 1)));
  ARTUS_RUNS_REALTIME(LugreBristle::relax, bristle.relax(params, 1e-3, 1e-3));
  AxialTick line(test::soft(2));
  LugreFriction law(1e-3);
  ARTUS_RUNS_REALTIME(LugreFriction::reset, law.reset(0));
  ARTUS_RUNS_REALTIME(LugreFriction::step, use(law.step(line.at(5e-3, Motion::inward, 0.01))));
  ARTUS_RUNS_REALTIME(LugreFriction::take_line, law.take_line(1e-4));
}

TEST(RealTimeNeedle, TapOnBoneNeitherAllocatesNorLocks) {
  ARTUS_RUNS_REALTIME(decaying_sinusoid, use(decaying_sinusoid({}, 0.01)));
  AxialTick line(test::soft(2));
  line.tick().bone_depth = 3e-3;
  for (const HardLaw kind : {HardLaw::decaying_sinusoid, HardLaw::impulse}) {
    HardContactParams params;
    params.law = kind;
    HardContact law(params);
    ARTUS_RUNS_REALTIME(HardContact::reset, law.reset(0));
    ARTUS_RUNS_REALTIME(HardContact::step, use(law.step(line.at(2e-3, Motion::inward, 0.1))),
                        use(law.step(line.at(3.5e-3, Motion::inward, 0.1))));
    EXPECT_TRUE(law.touching());
    ARTUS_RUNS_REALTIME(HardContact::take_line, law.take_line(1e-4));
  }
}

TEST(RealTimeNeedle, WhatHoldsTheNeedleOnItsLineNeitherAllocatesNorLocks) {
  AxialTick line(test::soft(2));
  line.at(10e-3).tip += Vec3(1e-3, 0, 0);
  line.tick().orientation = Eigen::AngleAxisd(0.1, Vec3::UnitX());
  Clamping clamping;
  ARTUS_RUNS_REALTIME(Clamping::reset, clamping.reset(0));
  ARTUS_RUNS_REALTIME(Clamping::step, use(clamping.step(line.tick())));
  ARTUS_RUNS_REALTIME(clamping_stiffness, use(clamping_stiffness(line.tick())));
  PlasticityFixture plasticity;
  ARTUS_RUNS_REALTIME(PlasticityFixture::reset, plasticity.reset(0));
  ARTUS_RUNS_REALTIME(PlasticityFixture::take_line, plasticity.take_line(0.5));
  ARTUS_RUNS_REALTIME(PlasticityFixture::step, use(plasticity.step(line.tick())));
  OrientationTorque torque;
  ARTUS_RUNS_REALTIME(OrientationTorque::reset, torque.reset(0));
  ARTUS_RUNS_REALTIME(OrientationTorque::step, use(torque.step(line.tick())));
  ARTUS_RUNS_REALTIME(orientation_error,
                      use(orientation_error(line.tick().orientation, line.tick().orientation_0)));
  HemisphereWorkspace workspace;
  ARTUS_RUNS_REALTIME(HemisphereWorkspace::reset, workspace.reset(0));
  ARTUS_RUNS_REALTIME(HemisphereWorkspace::step, use(workspace.step(line.tick())));
  ARTUS_RUNS_REALTIME(insertion_cone, use(insertion_cone(0.01, 0.035)));
}

TEST(RealTimeNeedle, MotionAndVelocityNeitherAllocateNorLock) {
  MotionDetector motion;
  ARTUS_RUNS_REALTIME(MotionDetector::reset, motion.reset(0, Motion::inward));
  ARTUS_RUNS_REALTIME(MotionDetector::step, motion.step(1e-3, 1e-3));
  ARTUS_RUNS_REALTIME(MotionDetector::shift, motion.shift(1e-3));
  SampleWindow<double> window(0.01, 1e-3);
  ARTUS_RUNS_REALTIME(SampleWindow::reset, window.reset(0));
  ARTUS_RUNS_REALTIME(SampleWindow::push, use(window.push(1)));
  ARTUS_RUNS_REALTIME(SampleWindow::shift, window.shift(1));
  WindowedDifference difference(0.01, 1e-3);
  ARTUS_RUNS_REALTIME(WindowedDifference::reset, difference.reset(0));
  ARTUS_RUNS_REALTIME(WindowedDifference::step, use(difference.step(1)));
  TaylorEstimator taylor(3, 0.01, 1e-3);
  ARTUS_RUNS_REALTIME(TaylorEstimator::reset, taylor.reset(0));
  ARTUS_RUNS_REALTIME(TaylorEstimator::step, use(taylor.step(1)));
  LevantDifferentiator levant(10, 1e-3);
  ARTUS_RUNS_REALTIME(LevantDifferentiator::reset, levant.reset(0));
  ARTUS_RUNS_REALTIME(LevantDifferentiator::step, use(levant.step(1)));
}

/// A needle going in along z through skin and muscle onto bone, and out.
class LayeredInsertion {
 public:
  LayeredInsertion() {
    Haptic skin = test::soft(1);
    skin.puncture_force = 1;
    Haptic bone = test::soft(4, 4000);
    bone.hard = true;
    table_ = test::table_of({skin, test::soft(2), bone});
  }
  [[nodiscard]] const LayerTable& table() const { return table_; }
  [[nodiscard]] static Pose pose(int tick) {
    const double z = -3e-3 + 20e-3 * std::sin(1e-3 * tick * 3);
    return make_pose(Vec3(1e-3 * std::sin(0.01 * tick), 0, z), Vec3(0.05, 0, 1).normalized(),
                     Vec3::UnitX());
  }
  /// The layers begin at 0, 2 and 14 mm on the z axis.
  std::span<const TissueInterval> intervals(const Segment& segment) {
    const Vec3 path = segment.end - segment.start;
    const double slope = path.z() / path.norm();
    const std::array<double, 5> z{segment.start.z(), 0, 2e-3, 14e-3, segment.end.z()};
    std::size_t n = 0;
    for (std::size_t i = 0; i + 1 < z.size(); ++i) {
      const double from = std::max(0.0, (z[i] - z[0]) / slope);
      const double to = std::min(path.norm(), (z[i + 1] - z[0]) / slope);
      if (to <= from) continue;
      buffer_[n++] = {from, to, static_cast<RegionId>(i == 0 ? kOutside : kFirstRegion + i - 1),
                      from > 0 ? Vec3(-Vec3::UnitZ()) : Vec3(Vec3::Zero()), 0};
    }
    return std::span<const TissueInterval>(buffer_.data(), n);
  }

 private:
  LayerTable table_;
  std::array<TissueInterval, 8> buffer_{};
};

TEST(RealTimeNeedle, ContactNeitherAllocatesNorLocks) {
  LayeredInsertion insertion;
  NeedleContact contact({}, {}, insertion.table(), 1e-3);
  Segment segment;
  bool bone = false;
  for (int i = 0; i < 1100; ++i) {
    const Pose X_JN = LayeredInsertion::pose(i);
    ARTUS_RUNS_REALTIME(NeedleContact::query_segment, segment = contact.query_segment(X_JN));
    const auto intervals = insertion.intervals(segment);
    ARTUS_RUNS_REALTIME(NeedleContact::update, contact.update(X_JN, intervals));
    bone = bone || contact.state() == ContactState::bone;
  }
  EXPECT_TRUE(bone);
  ARTUS_RUNS_REALTIME(NeedleContact::hold, contact.hold());
  ARTUS_RUNS_REALTIME(NeedleContact::reset, contact.reset());
  ARTUS_RUNS_REALTIME(LayerTable::operator[], use(insertion.table()[99]));
}

TEST(RealTimeNeedle, ModelNeitherAllocatesNorLocks) {
  LayeredInsertion insertion;
  NeedleParams params;
  params.use_workspace = true;
  NeedleModel model(params, insertion.table(), 1e-3);
  Segment segment;
  double hardest = 0;
  for (int i = 0; i < 1100; ++i) {
    const Pose X_JN = LayeredInsertion::pose(i);
    ARTUS_RUNS_REALTIME(NeedleModel::query_segment, segment = model.query_segment(X_JN));
    const auto intervals = insertion.intervals(segment);
    ARTUS_RUNS_REALTIME(NeedleModel::step, use(model.step(X_JN, intervals)));
    hardest = std::max(hardest, model.forces().total.force.norm());
  }
  EXPECT_GT(hardest, 3);
  NeedleCompliance soft;
  soft.points = 4;
  soft.spacing = 10e-3;
  for (std::size_t i = 0; i < soft.points; ++i) soft.by_load[i][i] = 1e-3;
  model.reset();
  ARTUS_RUNS_REALTIME(NeedleModel::take, model.take({{}, soft}));
  for (int i = 0; i < 1100; ++i) {
    const Pose X_JN = LayeredInsertion::pose(i);
    ARTUS_RUNS_REALTIME(NeedleModel::query_segment, segment = model.query_segment(X_JN));
    const auto intervals = insertion.intervals(segment);
    ARTUS_RUNS_REALTIME(NeedleModel::step, use(model.step(X_JN, intervals)));
    EXPECT_TRUE(model.forces().total.force.allFinite());
  }
  EXPECT_GT(model.coupling().dissipated(), 0);
  ARTUS_RUNS_REALTIME(NeedleModel::hold, model.hold());
  ARTUS_RUNS_REALTIME(NeedleModel::reset, model.reset());
}

/// The same layers as a tick asks for them; when `truncated` it says that it kept some back.
struct Layers {
  LayeredInsertion& insertion;
  bool truncated = false;
  QueryCount find_intervals(const Segment& segment, std::span<TissueInterval> out) const noexcept {
    const auto found = insertion.intervals(segment);
    std::copy(found.begin(), found.end(), out.begin());
    return {found.size(), truncated};
  }
};

TEST(RealTimeNeedle, TheWholeTickNeitherAllocatesNorLocksAlsoWhenAQueryIsTruncated) {
  LayeredInsertion insertion;
  NeedleRendererParams params;
  params.device = *find_device("virtuose_6d_desktop");
  NeedleTickStep tick(insertion.table(), params);
  ARTUS_RUNS_REALTIME(NeedleTickStep::take, tick.take({}));
  double hardest = 0;
  for (int i = 0; i < 1100; ++i) {
    const TimedPose pose{LayeredInsertion::pose(i), 1e-3 * i};
    const Layers layers{insertion, i > 900};
    if (i % 2 == 0) {
      ARTUS_RUNS_REALTIME(NeedleTickStep::step, use(tick.step(pose, layers)));
    } else {
      ARTUS_RUNS_REALTIME(NeedleTickStep::feel, use(tick.feel(pose, layers)));
      ARTUS_RUNS_REALTIME(NeedleTickStep::command, use(tick.command(Vec3(0, 0, 1))));
    }
    hardest = std::max(hardest, tick.model().forces().total.force.norm());
  }
  EXPECT_GT(hardest, 3);
}

}  // namespace
}  // namespace artus
