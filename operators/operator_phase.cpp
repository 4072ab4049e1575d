// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/operators/operator_phase.h"

namespace artus {
namespace {

constexpr double kPatience = 60;  // s for a goal

OperatorPhase lasting(OperatorPhase::Kind kind, double duration) {
  OperatorPhase phase;
  phase.kind = kind;
  phase.duration = duration;
  return phase;
}

}  // namespace

OperatorPhase push_to(double depth, double speed) {
  OperatorPhase phase = lasting(OperatorPhase::Kind::advance, kPatience);
  phase.depth = depth;
  phase.speed = speed;
  return phase;
}

OperatorPhase pull_to(double depth, double speed) {
  OperatorPhase phase = push_to(depth, speed);
  phase.kind = OperatorPhase::Kind::withdraw;
  return phase;
}

OperatorPhase stay(double duration) {
  return lasting(OperatorPhase::Kind::hold, duration);
}

OperatorPhase press(double duration) {
  return lasting(OperatorPhase::Kind::wait, duration);
}

OperatorPhase let_go(double duration) {
  return lasting(OperatorPhase::Kind::let_go, duration);
}

OperatorPhase aim(const Vec3& direction, double duration) {
  OperatorPhase phase = lasting(OperatorPhase::Kind::turn, duration);
  phase.direction = direction.normalized();
  return phase;
}

}  // namespace artus
