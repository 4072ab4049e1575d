// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/evidence/soft/soft_gates.h"

#include <array>

#include "artus/evidence/soft/soft_gates_list.h"

namespace artus {
namespace {

constexpr std::array kGates{NamedGate{"patch", gate_patch},
                            NamedGate{"uniaxial", gate_uniaxial},
                            NamedGate{"point-force", gate_point_force},
                            NamedGate{"cantilever", gate_cantilever},
                            NamedGate{"punch", gate_punch},
                            NamedGate{"vessel", gate_vessel},
                            NamedGate{"convergence", gate_convergence},
                            NamedGate{"layers", gate_layers},
                            NamedGate{"volume", gate_volume},
                            NamedGate{"balance", gate_balance},
                            NamedGate{"turned", gate_turned},
                            NamedGate{"reciprocity", gate_reciprocity},
                            NamedGate{"bytes", gate_bytes},
                            NamedGate{"wild-hand", gate_wild_hand},
                            NamedGate{"limb", gate_limb},
                            NamedGate{"strain-image", gate_strain_image},
                            NamedGate{"inclusion", gate_inclusion},
                            NamedGate{"speckle", gate_speckle_pressed},
                            NamedGate{"thinning", gate_thinning},
                            NamedGate{"tent", gate_tent},
                            NamedGate{"drag", gate_drag},
                            NamedGate{"packets", gate_packets}};

constexpr GateSet kSet{"soft-gates",
                       "Tissue that gives way, on blocks with known answers: mechanics and picture",
                       "closed forms of elasticity; each gate names its own", kGates};

}  // namespace

const GateSet& soft_gates() noexcept {
  return kSet;
}

}  // namespace artus
