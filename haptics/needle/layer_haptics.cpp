// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/haptics/needle/layer_haptics.h"

#include <algorithm>
#include <array>

namespace artus {

namespace {

/// The law of a name; `what` stands in the refusal.
template <class Law, std::size_t n>
Result<Law> find_law(const std::array<std::string_view, n>& names, std::string_view name,
                     const std::string& what) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) return static_cast<Law>(at - names.begin());
  std::string known;
  for (const std::string_view other : names)
    known += (known.empty() ? "" : ", ") + std::string(other);
  return fail(ErrorCode::not_found,
              "no " + what + " \"" + std::string(name) + "\"; there are " + known);
}

/// The run's word on this tissue, else the run's on all, else the tissue's own.
template <class Law>
Law choose(const std::string& tissue, Law own, const std::optional<Law>& run,
           const std::map<std::string, Law>& of_tissue) {
  const auto exception = of_tissue.find(tissue);
  return exception != of_tissue.end() ? exception->second : run.value_or(own);
}

}  // namespace

const char* to_string(CuttingLaw law) noexcept {
  return kCuttingLawNames[static_cast<std::size_t>(law)].data();
}

const char* to_string(PrepunctureLaw law) noexcept {
  return kPrepunctureLawNames[static_cast<std::size_t>(law)].data();
}

Result<CuttingLaw> find_cutting_law(std::string_view name) {
  return find_law<CuttingLaw>(kCuttingLawNames, name, "cutting law");
}

Result<PrepunctureLaw> find_prepuncture_law(std::string_view name) {
  return find_law<PrepunctureLaw>(kPrepunctureLawNames, name, "pre-puncture law");
}

LayerHaptics for_run(LayerHaptics layer, const std::string& name, const LawSelection& laws,
                     const PatientProfile& patient) {
  layer.cutting = choose(name, layer.cutting, laws.cutting, laws.cutting_of_tissue);
  layer.prepuncture = choose(name, layer.prepuncture, laws.prepuncture, laws.prepuncture_of_tissue);
  layer.tissue.cutting_force *= patient.cutting;
  layer.tissue.friction *= patient.friction;
  layer.tissue.attracted_force *= patient.attracted;
  layer.tissue.clamping_stiffness *= patient.clamping;
  layer.tissue.puncture_force *= patient.puncture;
  return layer;
}

LayerTable::LayerTable(const CompiledJoint& joint, const LawSelection& laws,
                       const PatientProfile& patient) {
  by_region_.reserve(joint.regions.size());
  for (const Region& region : joint.regions) {
    ARTUS_REQUIRE(region.tissue < joint.tissues.size(),
                  "a region names a tissue that is not there");
    const Tissue& tissue = joint.tissues[region.tissue];
    by_region_.push_back(
        for_run({tissue.haptic, tissue.haptic.cutting_law, tissue.haptic.prepuncture_law},
                tissue.name, laws, patient));
  }
}

}  // namespace artus
