// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/haptics/needle_feel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "artus/detail/core/known_names.h"

namespace artus {
namespace {

constexpr std::array<std::string_view, 9> kKindNames{
    "cutting", "prepuncture", "tap",           "clamping",         "friction",
    "patient", "workspace",   "needle_length", "passivity_control"};

bool is_changed(const PatientProfile& patient) {
  bool is = false;
  visit_fields(patient, [&is](const std::string&, double factor) { is = is || factor != 1; });
  return is;
}

template <class Law>
bool is_changed(const LawChoice<Law>& choice) noexcept {
  return choice.all || !choice.of_tissue.empty();
}

template <class Law>
Result<void> check_names(const LawChoice<Law>& choice, std::uint32_t kind, const FeelScope& scope) {
  for (const auto& [name, law] : choice.of_tissue) {
    if (std::find(scope.tissues.begin(), scope.tissues.end(), name) != scope.tissues.end())
      continue;
    const std::vector<std::string_view> known(scope.tissues.begin(), scope.tissues.end());
    return fail(ErrorCode::not_found,
                scope.what + " has no tissue \"" + name + "\"; there are " + listed(known) +
                    did_you_mean(name, known),
                std::string(feel_kind_name(kind)));
  }
  return {};
}

/// The run's word on this tissue, else the run's on all, else the tissue's own.
template <class Law>
Law choose(const LawChoice<Law>& choice, const std::string& tissue, Law own) {
  const auto exception = choice.of_tissue.find(tissue);
  return exception != choice.of_tissue.end() ? exception->second : choice.all.value_or(own);
}

bool in(double value, double low, double high) noexcept {
  return value >= low && value <= high;  // not for a NaN
}

Result<void> refuse(std::uint32_t kind, const std::string& what) {
  return fail(ErrorCode::invalid, what, std::string(feel_kind_name(kind)));
}

bool is_valid(const LugreParams& p) noexcept {
  constexpr double kMax = 1e9;
  return p.sigma0 > 0 && p.sigma0 <= kMax && in(p.sigma1, 0, kMax) && in(p.sigma2, 0, kMax) &&
         p.mu_c > 0 && p.mu_c <= kMax && p.mu_s > 0 && p.mu_s <= kMax && in(p.alpha, 0, kMax) &&
         p.length > 0 && p.length <= kMax && p.stiffness_limit > 0 && p.stiffness_limit <= kMax &&
         in(p.damping_limit, 0, kMax) && p.relaxation_time > 0 && p.relaxation_time <= kMax;
}

}  // namespace

std::string_view feel_kind_name(std::uint32_t kind) noexcept {
  for (std::size_t i = 0; i < kKindNames.size(); ++i)
    if (kind == 1U << i) return kKindNames[i];
  return {};
}

std::uint32_t changed(const NeedleFeel& feel) {
  const auto bit = [](bool is, std::uint32_t kind) {
    return is ? kind : 0U;
  };
  return bit(is_changed(feel.cutting), FeelKind::kCutting) |
         bit(is_changed(feel.prepuncture), FeelKind::kPrepuncture) |
         bit(feel.tap.has_value(), FeelKind::kTap) |
         bit(feel.clamping.has_value(), FeelKind::kClamping) |
         bit(feel.friction.has_value(), FeelKind::kFriction) |
         bit(is_changed(feel.patient), FeelKind::kPatient) |
         bit(feel.workspace.has_value(), FeelKind::kWorkspace) |
         bit(feel.needle_length.has_value(), FeelKind::kNeedleLength) |
         bit(feel.passivity_control, FeelKind::kPassivity);
}

FeelScope scope_of(const CompiledJoint& joint) {
  FeelScope scope;
  scope.what = "the joint";
  for (const Tissue& tissue : joint.tissues) scope.tissues.push_back(tissue.name);
  return scope;
}

Result<void> validate(const NeedleFeel& feel) {
  std::string wrong;
  visit_fields(feel.patient, [&wrong](const std::string& name, double factor) {
    if (!in(factor, 0, 10)) wrong = name;
  });
  if (!wrong.empty())
    return refuse(FeelKind::kPatient, "the patient's factor " + wrong + " must be 0 to 10");
  if (feel.friction && !is_valid(*feel.friction))
    return refuse(FeelKind::kFriction, "the friction's parameters must be above 0");
  if (feel.workspace) {
    const HemisphereParams& sphere = *feel.workspace;
    if (!sphere.centre.allFinite() || !in(sphere.radius, 1e-6, 1e3))
      return refuse(FeelKind::kWorkspace, "needs a centre and a radius above 0");
    if (!in(sphere.push, 0, 50))
      return refuse(FeelKind::kWorkspace, "the workspace's push must be 0 to 50 N");
  }
  if (feel.needle_length && !in(*feel.needle_length, 0.01, 0.3))
    return refuse(FeelKind::kNeedleLength, "a needle must be 10 to 300 mm long");
  return {};
}

Result<void> check(const NeedleFeel& feel, const FeelScope& scope) {
  ARTUS_TRY(validate(feel));
  const std::uint32_t refused = changed(feel) & ~scope.takes;
  std::string taken;
  for (std::size_t i = 0; i < kKindNames.size(); ++i)
    if ((scope.takes & 1U << i) != 0) taken.append(taken.empty() ? "" : ", ").append(kKindNames[i]);
  for (std::size_t i = 0; i < kKindNames.size(); ++i)
    if ((refused & 1U << i) != 0)
      return refuse(1U << i, scope.what + " " + scope.why_not +
                                 "; what can be changed: " + (taken.empty() ? "nothing" : taken));
  ARTUS_TRY(check_names(feel.cutting, FeelKind::kCutting, scope));
  return check_names(feel.prepuncture, FeelKind::kPrepuncture, scope);
}

void apply(const NeedleFeel& feel, NeedleParams& needle) noexcept {
  if (feel.tap) needle.hard.law = *feel.tap;
  if (feel.clamping) needle.clamping = *feel.clamping;
  if (feel.friction) needle.friction = *feel.friction;
  if (feel.needle_length) needle.contact.needle_length = *feel.needle_length;
  if (feel.workspace) {
    needle.use_workspace = true;
    needle.workspace = *feel.workspace;
  }
}

void apply(const NeedleFeel& feel, PassivityParams& passivity) noexcept {
  if (feel.passivity_control) passivity.control = true;
}

void apply(const NeedleFeel& feel, const std::string& name, LayerHaptics& layer) {
  layer.cutting = choose(feel.cutting, name, layer.cutting);
  layer.prepuncture = choose(feel.prepuncture, name, layer.prepuncture);
  layer.tissue.cutting_force *= feel.patient.cutting;
  layer.tissue.friction *= feel.patient.friction;
  layer.tissue.attracted_force *= feel.patient.attracted;
  layer.tissue.clamping_stiffness *= feel.patient.clamping;
  layer.tissue.puncture_force *= feel.patient.puncture;
}

LayerTable make_layer_table(const CompiledJoint& joint, const NeedleFeel& feel) {
  std::vector<LayerHaptics> by_region;
  by_region.reserve(joint.regions.size());
  for (const Region& region : joint.regions) {
    ARTUS_REQUIRE(region.tissue < joint.tissues.size(),
                  "a region names a tissue that is not there");
    const Tissue& tissue = joint.tissues[region.tissue];
    LayerHaptics layer{tissue.haptic, tissue.haptic.cutting_law, tissue.haptic.prepuncture_law};
    apply(feel, tissue.name, layer);
    by_region.push_back(layer);
  }
  return LayerTable(std::move(by_region));
}

}  // namespace artus
