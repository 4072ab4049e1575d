// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/soft/kernels.h"

#include <algorithm>
#include <vector>

namespace artus {
namespace {
constexpr std::size_t kRegister = 16;
#include "artus/soft/kernels_body.h"
}  // namespace

#ifdef __x86_64__
[[nodiscard]] const SoftKernels& avx2_soft_kernels() noexcept;
[[nodiscard]] const SoftKernels& avx512_soft_kernels() noexcept;
#endif

std::span<const SoftKernels* const> all_soft_kernels() noexcept {
  static const std::vector<const SoftKernels*> all = [] {
    std::vector<const SoftKernels*> these{&kKernels};
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2") != 0) these.push_back(&avx2_soft_kernels());
    if (__builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
        __builtin_cpu_supports("avx512dq") != 0)
      these.push_back(&avx512_soft_kernels());
#endif
    return these;
  }();
  return all;
}

const SoftKernels& soft_kernels() noexcept {
  static const SoftKernels& widest = *all_soft_kernels().back();
  return widest;
}

void CellPack::set(std::size_t lane, const CellMaterial& m, double edge_length) noexcept {
  for (std::size_t g = 0; g < 8; ++g) {
    weight[g][lane] = m.weight[g];
    shear[g][lane] = m.shear[g];
    sheet[g][lane] = m.sheet[g];
    hardening[g][lane] = m.hardening[g];
    has_sheet = has_sheet || m.sheet[g] > 0;
    has_hardening = has_hardening || m.hardening[g] > 0;
  }
  bulk[lane] = m.bulk;
  drain[lane] = m.drain;
  drain_soft[lane] = m.drain > 0 ? std::min(0.5 * m.bulk, m.drain_pressure / m.drain) : m.bulk;
  has_drain = has_drain || m.drain > 0;
  firm_from[lane] = kDrainEnd * m.drain + m.firm_from;
  firm[lane] = m.firm_from > 0 ? m.bulk / (kFirmRise * m.firm_from) : 0;
  crush_rise[lane] = m.firm_from > 0 ? kCrushRise : 0;
  has_firm = has_firm || m.firm_from > 0;
  fibre_modulus[lane] = m.fibre_modulus;
  has_fibre = has_fibre || m.fibre_modulus > 0;
  const Vec3 along = m.sheet_normal.unitOrthogonal();
  const Vec3 across = m.sheet_normal.cross(along);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    fibre[k][lane] = m.fibre[axis];
    plane[k][lane] = along[axis];
    plane[k + 3][lane] = across[axis];
  }
  edge[lane] = edge_length;
}

}  // namespace artus
