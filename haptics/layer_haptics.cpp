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

LayerTable::LayerTable(const CompiledJoint& joint, const LawSelection& laws,
                       const PatientProfile& patient) {
  by_region_.reserve(joint.regions.size());
  for (const Region& region : joint.regions) {
    ARTUS_REQUIRE(region.tissue < joint.tissues.size(),
                  "a region names a tissue that is not there");
    const Tissue& tissue = joint.tissues[region.tissue];
    LayerHaptics layer{tissue.haptic, laws.cutting, laws.prepuncture};
    layer.tissue.cutting_force *= patient.cutting;
    layer.tissue.friction *= patient.friction;
    layer.tissue.attracted_force *= patient.attracted;
    layer.tissue.clamping_stiffness *= patient.clamping;
    layer.tissue.puncture_force *= patient.puncture;
    const auto cutting = laws.cutting_of_tissue.find(tissue.name);
    if (cutting != laws.cutting_of_tissue.end()) layer.cutting = cutting->second;
    const auto prepuncture = laws.prepuncture_of_tissue.find(tissue.name);
    if (prepuncture != laws.prepuncture_of_tissue.end()) layer.prepuncture = prepuncture->second;
    by_region_.push_back(layer);
  }
}

}  // namespace artus
