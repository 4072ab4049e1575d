// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/simulation/session_params.h"

#include <cmath>
#include <string>
#include <type_traits>

#include "artus/detail/simulation/session_fields.h"

namespace artus {
namespace {

bool is_number(double value) noexcept {
  return !std::isnan(value);  // a limit may be infinite
}

/// The first field that holds no number, or a choice that there is not; empty when all do.
std::string find_nonsense(const SessionParams& params) {
  std::string found;
  visit_fields(params, [&found](const std::string& name, const auto& member) {
    using Member = std::remove_cvref_t<decltype(member)>;
    bool good = true;
    if constexpr (std::is_same_v<Member, double>)
      good = is_number(member);
    else if constexpr (std::is_same_v<Member, Vec3>)
      good = is_number(member.x()) && is_number(member.y()) && is_number(member.z());
    else if constexpr (std::is_enum_v<Member>)
      good = static_cast<long long>(member) == 0 || static_cast<long long>(member) == 1;
    if (!good && found.empty()) found = name;
  });
  return found;
}

constexpr double kFarthest = 10;  // m, as of a device's poses

bool is_near(const Vec3& p) noexcept {
  return p.allFinite() && p.cwiseAbs().maxCoeff() < kFarthest;
}

bool is_rigid(const Pose& pose) noexcept {
  return pose.matrix().allFinite() && is_near(pose.translation()) &&
         pose.linear().isUnitary(1e-6) && pose.linear().determinant() > 0;
}

Result<void> validate(const GestureParams& gesture) {
  if (!is_near(gesture.p_W) || std::abs(gesture.axis_W.norm() - 1) > 1e-6)
    return fail(ErrorCode::invalid, "needs a point within 10 m and a direction of length 1",
                "gesture");
  return {};
}

Result<void> validate(const NeedleShape& shape) {
  const bool tube = shape.bore > 0 && shape.outer_diameter > shape.bore &&
                    shape.outer_diameter < 0.01 && shape.length > 0 && shape.length < 1;
  if (!tube)
    return fail(
        ErrorCode::invalid,
        "needs outer_diameter below 10 mm, a narrower bore above 0 and a length of 0 to 1 m",
        "needle_shape");
  return {};
}

Result<void> validate(const HandAids& aids) {
  constexpr double kStiffest = 1000;  // N/m
  const auto held = [](double stiffness) {
    return stiffness >= 0 && stiffness <= kStiffest;
  };
  if (!held(aids.guide) || !held(aids.wall))
    return fail(ErrorCode::invalid, "must be 0 to 1000 N/m", "aids");
  if (!is_near(aids.entry) || !is_near(aids.target))
    return fail(ErrorCode::invalid, "needs points within 10 m", "aids");
  return {};
}

}  // namespace

static_assert(static_cast<int>(HardLaw::impulse) == 1, "choices are of two");
static_assert(static_cast<int>(ClampingLaw::plasticity) == 1);

double needle_length_of(const SessionParams& params) noexcept {
  return params.feel.needle_length.value_or(params.needle.contact.needle_length);
}

bool gives_way(const CompiledJoint& joint) noexcept {
  return !joint.mesh.tetrahedra.empty();
}

Result<void> validate(const SessionParams& params) {
  if (!(params.haptic_rate >= 100 && params.haptic_rate <= 20000))
    return fail(ErrorCode::invalid, "the haptic rate must be 100 to 20000 Hz", "haptic_rate");
  if (!(params.image_rate >= 1 && params.image_rate <= 120))
    return fail(ErrorCode::invalid, "the image rate must be 1 to 120 Hz", "image_rate");
  if (const std::string name = find_nonsense(params); !name.empty())
    return fail(ErrorCode::invalid, "is not finite or not a known choice", name);
  if (!is_rigid(params.X_WJ))
    return fail(ErrorCode::invalid, "is not a rigid pose within 10 m", "X_WJ");
  if (params.X_JC && !is_rigid(*params.X_JC))
    return fail(ErrorCode::invalid, "is not a rigid pose within 10 m", "X_JC");
  ARTUS_TRY(validate(params.gesture));
  ARTUS_TRY(validate(params.needle_shape));
  ARTUS_TRY(validate(params.aids));
  ARTUS_TRY(validate(params.feel));
  ARTUS_TRY(make_plunger_params(params.syringe, needle_length_of(params)));
  ARTUS_TRY(validate(params.transducer));
  return validate(params.image);
}

}  // namespace artus
