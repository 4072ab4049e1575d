// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/soft/soft_gates.h"

#include <array>

#include "artus/detail/evidence/validation/soft/soft_gates_list.h"

namespace artus {
namespace {

constexpr std::array<NamedGate, 27> kGates{{{"patch", gate_patch},
                                            {"uniaxial", gate_uniaxial},
                                            {"point-force", gate_point_force},
                                            {"cantilever", gate_cantilever},
                                            {"punch", gate_punch},
                                            {"vessel", gate_vessel},
                                            {"convergence", gate_convergence},
                                            {"layers", gate_layers},
                                            {"volume", gate_volume},
                                            {"balance", gate_balance},
                                            {"turned", gate_turned},
                                            {"reciprocity", gate_reciprocity},
                                            {"bytes", gate_bytes},
                                            {"wild-hand", gate_wild_hand},
                                            {"limb", gate_limb},
                                            {"strain-image", gate_strain_image},
                                            {"inclusion", gate_inclusion},
                                            {"speckle", gate_speckle_pressed},
                                            {"thinning", gate_thinning},
                                            {"carried", gate_carried},
                                            {"border", gate_border},
                                            {"shaft", gate_shaft},
                                            {"needle-rates", gate_needle_rates},
                                            {"tent", gate_tent},
                                            {"drag", gate_drag},
                                            {"packets", gate_packets},
                                            {"still", gate_still}}};

constexpr std::array<NamedJointGate, 2> kJointGates{
    {{"joint-pressed", gate_joint_pressed}, {"joint-still", gate_joint_still}}};

constexpr GateSet kSet{"soft-gates",
                       "Tissue that gives way, on blocks with known answers: mechanics and picture",
                       "closed forms of elasticity; each gate names its own", kGates, kJointGates};

}  // namespace

const GateSet& soft_gates() noexcept {
  return kSet;
}

}  // namespace artus
