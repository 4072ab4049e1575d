// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/cage/kernels.h"

#include <algorithm>

namespace artus {
namespace {
constexpr std::size_t kRegister = 16;
#include "artus/detail/soft/cage/kernels_body.h"
}  // namespace

#ifdef __x86_64__
extern const SoftKernels kAvx2SoftKernels;
extern const SoftKernels kAvx512SoftKernels;

namespace {

constexpr std::array<const SoftKernels*, 3> kAll{&kKernels, &kAvx2SoftKernels, &kAvx512SoftKernels};

std::size_t runnable() noexcept {
  if (__builtin_cpu_supports("avx2") == 0) return 1;
  const bool avx512 = __builtin_cpu_supports("avx512f") != 0 &&
                      __builtin_cpu_supports("avx512vl") != 0 &&
                      __builtin_cpu_supports("avx512dq") != 0;
  return avx512 ? 3 : 2;
}

}  // namespace
#else
namespace {

constexpr std::array<const SoftKernels*, 1> kAll{&kKernels};

std::size_t runnable() noexcept {
  return 1;
}

}  // namespace
#endif

std::span<const SoftKernels* const> all_soft_kernels() noexcept {
  return std::span(kAll).first(runnable());
}

const SoftKernels& soft_kernels() noexcept {
  return *all_soft_kernels().back();
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
