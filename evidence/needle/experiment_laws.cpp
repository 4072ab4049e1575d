// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/evidence/needle/experiment_laws.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace artus {
namespace {

constexpr std::array<std::pair<std::uint32_t, std::string_view>, 8> kFlags{
    {{LawKind::kCutting, "--cutting"},
     {LawKind::kPrepuncture, "--prepuncture"},
     {LawKind::kTap, "--bone-tap"},
     {LawKind::kClamping, "--clamping"},
     {LawKind::kFriction, "--friction-set"},
     {LawKind::kPatient, "--patient"},
     {LawKind::kWorkspace, "--workspace-mm"},
     {LawKind::kPassivity, "--passivity-control"}}};

bool is_changed(const PatientProfile& p) noexcept {
  const PatientProfile none;
  return p.cutting != none.cutting || p.friction != none.friction ||
         p.attracted != none.attracted || p.clamping != none.clamping ||
         p.puncture != none.puncture;
}

template <class Law>
Result<void> check_names(const std::map<std::string, Law>& of_layer, std::string_view flag,
                         std::span<const std::string> names) {
  std::string known;
  for (const std::string& name : names) known.append(known.empty() ? "" : ", ").append(name);
  for (const auto& entry : of_layer)
    if (std::find(names.begin(), names.end(), entry.first) == names.end())
      return fail(ErrorCode::not_found,
                  "the experiment has no layer \"" + entry.first + "\"; there are " + known,
                  std::string(flag));
  return {};
}

}  // namespace

std::uint32_t changed_laws(const ExperimentLaws& e) noexcept {
  std::uint32_t changed = 0;
  if (e.laws.cutting || !e.laws.cutting_of_tissue.empty()) changed |= LawKind::kCutting;
  if (e.laws.prepuncture || !e.laws.prepuncture_of_tissue.empty()) changed |= LawKind::kPrepuncture;
  if (e.tap) changed |= LawKind::kTap;
  if (e.clamping) changed |= LawKind::kClamping;
  if (e.friction) changed |= LawKind::kFriction;
  if (is_changed(e.patient)) changed |= LawKind::kPatient;
  if (e.workspace) changed |= LawKind::kWorkspace;
  if (e.passivity_control) changed |= LawKind::kPassivity;
  return changed;
}

Result<void> check_laws(const ExperimentLaws& e, std::string_view experiment, std::uint32_t takes,
                        std::string_view why_not, std::span<const std::string> layer_names) {
  std::string taken;
  for (const auto& [kind, flag] : kFlags)
    if ((takes & kind) != 0) taken.append(taken.empty() ? "" : ", ").append(flag);
  for (const auto& [kind, flag] : kFlags) {
    if ((changed_laws(e) & kind & ~takes) == 0) continue;
    return fail(ErrorCode::invalid,
                std::string(experiment) + " " + std::string(why_not) + "; it takes " +
                    (taken.empty() ? "no law flags" : taken),
                std::string(flag));
  }
  ARTUS_TRY(check_names(e.laws.cutting_of_tissue, "--cutting", layer_names));
  return check_names(e.laws.prepuncture_of_tissue, "--prepuncture", layer_names);
}

void apply_laws(const ExperimentLaws& e, std::span<const std::string> names,
                std::vector<LayerHaptics>& layers) {
  for (std::size_t i = 0; i < layers.size() && i < names.size(); ++i)
    layers[i] = for_run(layers[i], names[i], e.laws, e.patient);
}

void apply_laws(const ExperimentLaws& e, NeedleParams& needle) noexcept {
  if (e.tap) needle.hard.law = *e.tap;
  if (e.clamping) needle.clamping = *e.clamping;
  if (e.friction) needle.friction = *e.friction;
  if (e.workspace) {
    needle.use_workspace = true;
    needle.workspace = *e.workspace;
  }
}

}  // namespace artus
