// SPDX-License-Identifier: AGPL-3.0-or-later
#include "haptics/layer_haptics.h"

namespace artus {

const char* to_string(CuttingLaw law) noexcept {
  switch (law) {
    case CuttingLaw::tracking_wall:
      return "tracking_wall";
    case CuttingLaw::direct:
      return "direct";
    case CuttingLaw::spring:
      return "spring";
    case CuttingLaw::voigt:
      return "voigt";
  }
  return "";
}

const char* to_string(PrepunctureLaw law) noexcept {
  switch (law) {
    case PrepunctureLaw::membrane:
      return "membrane";
    case PrepunctureLaw::simone_okamura:
      return "simone_okamura";
    case PrepunctureLaw::barbe:
      return "barbe";
    case PrepunctureLaw::god_object:
      return "god_object";
  }
  return "";
}

Result<CuttingLaw> find_cutting_law(std::string_view name) {
  for (const CuttingLaw law :
       {CuttingLaw::tracking_wall, CuttingLaw::direct, CuttingLaw::spring, CuttingLaw::voigt}) {
    if (name == to_string(law)) return law;
  }
  return fail(ErrorCode::not_found, "no cutting law \"" + std::string(name) +
                                        "\"; there are tracking_wall, direct, spring, voigt");
}

Result<PrepunctureLaw> find_prepuncture_law(std::string_view name) {
  for (const PrepunctureLaw law : {PrepunctureLaw::membrane, PrepunctureLaw::simone_okamura,
                                   PrepunctureLaw::barbe, PrepunctureLaw::god_object}) {
    if (name == to_string(law)) return law;
  }
  return fail(ErrorCode::not_found,
              "no pre-puncture law \"" + std::string(name) +
                  "\"; there are membrane, simone_okamura, barbe, god_object");
}

namespace {

// The run's word on this tissue, else the run's on all, else the tissue library's.
template <class Law, class Find>
Law choose(const Tissue& tissue, const char* key, Law otherwise, const std::optional<Law>& run,
           const std::map<std::string, Law>& of_tissue, Find find) {
  const auto exception = of_tissue.find(tissue.name);
  if (exception != of_tissue.end()) return exception->second;
  if (run) return *run;
  const auto named = tissue.source.find(key);
  if (named == tissue.source.end()) return otherwise;
  const Result<Law> law = find(named->second);
  ARTUS_REQUIRE(law.has_value(), "a tissue names a law that does not exist");
  return *law;
}

}  // namespace

LayerTable::LayerTable(const CompiledJoint& joint, const LawSelection& laws,
                       const PatientProfile& patient) {
  by_region_.reserve(joint.regions.size());
  for (const Region& region : joint.regions) {
    ARTUS_REQUIRE(region.tissue < joint.tissues.size(),
                  "a region names a tissue that is not there");
    const Tissue& tissue = joint.tissues[region.tissue];
    LayerHaptics layer{tissue.haptic};
    layer.cutting = choose(tissue, "cutting_law", layer.cutting, laws.cutting,
                           laws.cutting_of_tissue, find_cutting_law);
    layer.prepuncture = choose(tissue, "prepuncture_law", layer.prepuncture, laws.prepuncture,
                               laws.prepuncture_of_tissue, find_prepuncture_law);
    layer.tissue.cutting_force *= patient.cutting;
    layer.tissue.friction *= patient.friction;
    layer.tissue.attracted_force *= patient.attracted;
    layer.tissue.clamping_stiffness *= patient.clamping;
    layer.tissue.puncture_force *= patient.puncture;
    by_region_.push_back(layer);
  }
}

}  // namespace artus
