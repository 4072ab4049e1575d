// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <span>

#include "artus/detail/soft/cage/element.h"

namespace artus {

inline constexpr std::size_t kEliminationDepth =
    128;                                  ///< columns whose products are summed at a time
inline constexpr std::size_t kLanes = 4;  ///< cubes that are computed side by side
using Lanes = std::array<double, kLanes>;

/// Four cubes side by side: element.h's materials with a lane for each.
struct alignas(32) CellPack {
  std::array<Lanes, 8> weight{};
  std::array<Lanes, 8> shear{};
  std::array<Lanes, 8> sheet{};
  std::array<Lanes, 8> hardening{};
  Lanes bulk{};
  Lanes drain{};       ///< share of fluid that can leave
  Lanes drain_soft{};  ///< Pa, slope of the pressure while it does
  Lanes firm_from{};   ///< share lost from which the bulk hardens, with what drains
  Lanes firm{};        ///< Pa, of the square of what is lost beyond it
  Lanes crush_rise{};  ///< kCrushRise where the bulk hardens
  Lanes fibre_modulus{};
  std::array<Lanes, 3> fibre{};
  std::array<Lanes, 6> plane{};  ///< two unit vectors along the sheet, one after the other
  Lanes edge{1, 1, 1, 1};        ///< m
  bool has_sheet = false;
  bool has_fibre = false;
  bool has_hardening = false;
  bool has_drain = false;
  bool has_firm = false;
  /// Puts a cube into a lane; lanes that get none do not count.
  void set(std::size_t lane, const CellMaterial& material, double edge_length) noexcept;
};

/// State and answer of a pack: displacements (24, 4) and target volumes in, forces (24, 4), energy
/// and smallest J out.
struct alignas(32) CellPackState {
  std::array<Lanes, 24> u{};
  Lanes target{1, 1, 1, 1};
  std::array<Lanes, 24> force{};
  Lanes energy{};
  Lanes min_volume{1, 1, 1, 1};
};

/// The inner loops of a step, compiled for the plain CPU and for wider registers. All sums stand in
/// the same order in both, without fused multiply-adds: the bytes are the same.
struct SoftKernels {
  /// cell_response of four cubes.
  void (*cells)(const CellPack& pack, CellPackState& state);
  /// x (rows): solves L y = x for the first `columns`, and takes L21 y from the rest. `L` (rows,
  /// columns), row fastest; only its lower trapezium is read.
  void (*forward)(const float* L, std::size_t rows, std::size_t columns, float* x);
  /// x (rows): takes L21^T x_rest from the first `columns` and solves L^T y = x for them.
  void (*backward)(const float* L, std::size_t rows, std::size_t columns, float* x);
  /// y (rows) += A x, A (rows, columns), row fastest.
  void (*multiply)(const float* A, std::size_t rows, std::size_t columns, const float* x, float* y);
  /// Cholesky's elimination of the first `columns` of a symmetric front (n, n), row fastest, of
  /// which the lower triangle counts: they become columns of L, the rest what is left of the front
  /// (Schur complement). False where a pivot is not positive; the front is then useless. `scratch`:
  /// elimination_scratch(n) numbers.
  bool (*eliminate)(double* front, std::size_t n, std::size_t columns, double* scratch);
};

/// Numbers that `eliminate` needs beside a front of n rows.
[[nodiscard]] constexpr std::size_t elimination_scratch(std::size_t n) noexcept {
  return kEliminationDepth * (n + 16);
}

/// Those this CPU can run, from the plain ones to those of the widest registers (AVX2, AVX-512).
[[nodiscard]] std::span<const SoftKernels* const> all_soft_kernels() noexcept;

/// The last of them.
[[nodiscard]] const SoftKernels& soft_kernels() noexcept;

}  // namespace artus
