// SPDX-License-Identifier: AGPL-3.0-or-later
// The kernels' code, included once for each kind of register by kernels*.cpp within a namespace of
// its own that says how many bytes a register has (kRegister). Everything here is arithmetic on
// lanes that do not meet, in a fixed order. It calls no function of a library: what a library
// inlines here could be taken by others for other CPUs.

using D = double __attribute__((vector_size(32), may_alias));
using S = float __attribute__((vector_size(32)));  // 8 lanes

constexpr std::size_t kWide = 8;

inline const D& lanes(const Lanes& a) noexcept {
  return *reinterpret_cast<const D*>(&a);
}
inline D& lanes(Lanes& a) noexcept {
  return *reinterpret_cast<D*>(&a);
}
inline D splat(double a) noexcept {
  return D{a, a, a, a};
}
inline D larger(D a, D b) noexcept {
  return a > b ? a : b;
}
inline D smaller(D a, D b) noexcept {
  return a < b ? a : b;
}

constexpr double kInner = 0.21132486540518713;  // (1 - 1/sqrt 3)/2
constexpr double kOuter = 1 - kInner;

// From the four edges of a cube along one axis to the four lines of Gauss points; its own
// transpose.
inline void interpolate(const D* in, D* out) noexcept {
  const D a0 = kOuter * in[0] + kInner * in[1];
  const D a1 = kInner * in[0] + kOuter * in[1];
  const D b0 = kOuter * in[2] + kInner * in[3];
  const D b1 = kInner * in[2] + kOuter * in[3];
  out[0] = kOuter * a0 + kInner * b0;
  out[1] = kOuter * a1 + kInner * b1;
  out[2] = kInner * a0 + kOuter * b0;
  out[3] = kInner * a1 + kOuter * b1;
}

// The nodes at the lower ends of the four edges along axis k, and the line of point g along it.
constexpr std::size_t kEdges[3][4] = {{0, 2, 4, 6}, {0, 1, 4, 5}, {0, 1, 2, 3}};
constexpr std::size_t kLine[3][8] = {
    {0, 0, 1, 1, 2, 2, 3, 3}, {0, 1, 0, 1, 2, 3, 2, 3}, {0, 1, 2, 3, 0, 1, 2, 3}};

struct Gradient {
  D line[3][3][4];  // of component c along axis k on each line of points
  // F = I + grad u, column after column
  inline void at(std::size_t g, D* F) const noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 3; ++c) F[c + 3 * k] = line[c][k][kLine[k][g]];
      F[k + 3 * k] += 1.0;
    }
  }
};

inline void find_gradient(const CellPackState& s, D inverse_edge, Gradient& out) noexcept {
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < 3; ++k) {
      D steps[4];
      for (std::size_t e = 0; e < 4; ++e) {
        const std::size_t low = kEdges[k][e];
        const std::size_t high = low + (std::size_t{1} << k);
        steps[e] = (lanes(s.u[3 * high + c]) - lanes(s.u[3 * low + c])) * inverse_edge;
      }
      interpolate(steps, out.line[c][k]);
    }
  }
}

inline void cross(const D* a, const D* b, D* out) noexcept {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

// exp(x) for x in [0, 3]: the eighth's series, raised to the eighth power.
inline D exponential(D x) noexcept {
  const D y = x * 0.125;
  D sum = splat(1.0);
  for (int n = 12; n > 0; --n) sum = 1.0 + sum * y * (1.0 / n);
  const D two = sum * sum;
  const D four = two * two;
  return four * four;
}

// Hardening: exp(b psi) and its energy per mu; see element.cpp's harden.
inline void harden(D b, D psi, D& factor, D& energy) noexcept {
  constexpr double kMax = 3;
  const D x = b * psi;
  const D inside = larger(smaller(x, splat(kMax)), splat(0.0));
  const D e = exponential(inside);
  const auto tiny = x < 1e-8;
  factor = tiny ? 1.0 + x : e;
  energy = tiny ? psi : (e - 1.0 + e * larger(x - kMax, splat(0.0))) / (tiny ? splat(1.0) : b);
}

inline void add_sheet(const CellPack& pack, D modulus, const D* F, D* P, D& energy) noexcept {
  const D* t = &lanes(pack.plane[0]);
  D A[6];
  for (std::size_t i = 0; i < 3; ++i) {
    A[i] = F[i] * t[0] + F[i + 3] * t[1] + F[i + 6] * t[2];
    A[i + 3] = F[i] * t[3] + F[i + 3] * t[4] + F[i + 6] * t[5];
  }
  const D c00 = A[0] * A[0] + A[1] * A[1] + A[2] * A[2];
  const D c11 = A[3] * A[3] + A[4] * A[4] + A[5] * A[5];
  const D c01 = A[0] * A[3] + A[1] * A[4] + A[2] * A[5];
  const D inverse = 1.0 / larger(c00 * c11 - c01 * c01, splat(1e-2));
  const D twice = inverse * inverse;
  const D s00 = 1.0 - c11 * twice;
  const D s11 = 1.0 - c00 * twice;
  const D s01 = c01 * twice;
  for (std::size_t i = 0; i < 3; ++i) {
    const D along = modulus * (A[i] * s00 + A[i + 3] * s01);
    const D across = modulus * (A[i] * s01 + A[i + 3] * s11);
    for (std::size_t k = 0; k < 3; ++k) P[i + 3 * k] += along * t[k] + across * t[k + 3];
  }
  energy += 0.5 * modulus * (c00 + c11 + inverse - 3.0);
}

inline void add_fibre(const CellPack& pack, const D* F, D* P, D& energy) noexcept {
  const D* a = &lanes(pack.fibre[0]);
  D along[3];
  for (std::size_t i = 0; i < 3; ++i) along[i] = F[i] * a[0] + F[i + 3] * a[1] + F[i + 6] * a[2];
  const D stretch = along[0] * along[0] + along[1] * along[1] + along[2] * along[2];
  const D e = larger(0.5 * (stretch - 1.0), splat(0.0));
  const D tension = lanes(pack.fibre_modulus) * e;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) P[i + 3 * k] += tension * along[i] * a[k];
  }
  energy += 0.5 * tension * e;
}

struct Points {
  D cof[8][9];
  D J[8];
  D mean_J;
  D weight;
  D evenness;  // element.cpp's evenness_of
};

inline void find_volumes(const CellPack& pack, const Gradient& gradient, Points& out) noexcept {
  D sum = splat(0.0);
  out.weight = splat(0.0);
  D shear = splat(0.0);
  for (std::size_t g = 0; g < 8; ++g) {
    D F[9];
    gradient.at(g, F);
    cross(F + 3, F + 6, out.cof[g]);
    cross(F + 6, F, out.cof[g] + 3);
    cross(F, F + 3, out.cof[g] + 6);
    out.J[g] = F[0] * out.cof[g][0] + F[1] * out.cof[g][1] + F[2] * out.cof[g][2];
    out.weight += lanes(pack.weight[g]);
    shear += lanes(pack.weight[g]) * lanes(pack.shear[g]);
    sum += lanes(pack.weight[g]) * out.J[g];
  }
  const auto some = out.weight > 0.0;
  const D weight = some ? out.weight : splat(1.0);
  out.mean_J = some ? sum / weight : splat(1.0);
  out.evenness = smaller(lanes(pack.bulk), shear / weight);
}

// First Piola-Kirchhoff stress at point g, and what it stores.
inline D stress_at(const CellPack& pack, std::size_t g, const D* F, const Points& points,
                   D pressure, D* P) noexcept {
  const D J = points.J[g];
  const D uneven = J - points.mean_J;
  const D shear = lanes(pack.shear[g]);
  D square = splat(0.0);
  for (std::size_t i = 0; i < 9; ++i) square += F[i] * F[i];
  const D psi = 0.5 * (square - 3.0) - (J - 1.0) + 0.5 * (J - 1.0) * (J - 1.0);
  D mu = shear;
  D energy = shear * psi;
  if (pack.has_hardening) {
    D factor;
    D stored;
    harden(lanes(pack.hardening[g]), psi, factor, stored);
    mu = shear * factor;
    energy = shear * stored;
  }
  const D crushed = larger(1.0 - J * (1.0 / kMinPart), splat(0.0));
  const D bulk = lanes(pack.bulk);
  const D square_of_it = crushed * crushed;
  energy += 0.5 * points.evenness * uneven * uneven +
            0.5 * bulk * square_of_it * (1.0 + lanes(pack.crush_rise) * square_of_it);
  const D pushed_back =
      bulk * crushed * (1.0 / kMinPart) * (1.0 + 2.0 * lanes(pack.crush_rise) * square_of_it);
  const D by_volume = mu * (J - 2.0) + pressure + points.evenness * uneven - pushed_back;
  for (std::size_t i = 0; i < 9; ++i) P[i] = mu * F[i] + by_volume * points.cof[g][i];
  if (pack.has_sheet) add_sheet(pack, lanes(pack.sheet[g]), F, P, energy);
  if (pack.has_fibre) add_fibre(pack, F, P, energy);
  return energy;
}

inline void add_nodal_forces(const D line[3][3][4], CellPackState& s) noexcept {
  for (Lanes& f : s.force) lanes(f) = splat(0.0);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < 3; ++k) {
      D steps[4];
      interpolate(line[c][k], steps);
      for (std::size_t e = 0; e < 4; ++e) {
        const std::size_t low = kEdges[k][e];
        const std::size_t high = low + (std::size_t{1} << k);
        lanes(s.force[3 * high + c]) -= steps[e];
        lanes(s.force[3 * low + c]) += steps[e];
      }
    }
  }
}

// What draining fluid takes from the pressure and from lambda/2 excess^2, both of a volume that is
// too small; see element.cpp's volume_law.
inline void drain(const CellPack& pack, D excess, D& pressure, D& energy) noexcept {
  const D share = lanes(pack.drain);
  const D some = share > 0.0 ? share : splat(1.0);
  const D soft = lanes(pack.drain_soft);
  const D stiff = lanes(pack.bulk) - soft;
  const D q = larger(splat(0.0) - excess, splat(0.0));
  const D rise = (kDrainEnd - kDrainBegin) * some;
  const D ramp = smaller(larger(q - kDrainBegin * some, splat(0.0)), rise);
  const D beyond = larger(q - kDrainEnd * some, splat(0.0));
  const D held = 0.5 * ramp * ramp / rise + beyond;
  const D stored = ramp * ramp * ramp / (6.0 * rise) + 0.5 * beyond * (rise + beyond);
  pressure += stiff * (q - held);
  energy -= stiff * (0.5 * q * q - stored);
}

void cells(const CellPack& pack, CellPackState& s) {
  const D edge = lanes(pack.edge);
  Gradient gradient;
  find_gradient(s, 1.0 / edge, gradient);
  Points points;
  find_volumes(pack, gradient, points);
  const D volume = edge * edge * edge * 0.125;
  const D area = edge * edge * 0.125;
  const D excess = points.mean_J - lanes(s.target);
  D pressure = lanes(pack.bulk) * excess;
  D energy = volume * points.weight * 0.5 * lanes(pack.bulk) * excess * excess;
  if (pack.has_drain) {
    D stored = splat(0.0);
    drain(pack, excess, pressure, stored);
    energy += volume * points.weight * stored;
  }
  if (pack.has_firm) {  // see element.cpp's volume_law
    const D passed = larger(splat(0.0) - excess - lanes(pack.firm_from), splat(0.0));
    const D by = lanes(pack.firm) * passed * passed;
    pressure -= by;
    energy += volume * points.weight * by * passed * (1.0 / 3.0);
  }
  D least = splat(1.0);
  D line[3][3][4];
  for (auto& component : line) {
    for (auto& axis : component) {
      for (D& value : axis) value = splat(0.0);
    }
  }
  for (std::size_t g = 0; g < 8; ++g) {
    const D weight = lanes(pack.weight[g]);
    D F[9];
    D P[9];
    gradient.at(g, F);
    least = weight > kMinWeight ? smaller(least, points.J[g]) : least;
    energy += volume * weight * stress_at(pack, g, F, points, pressure, P);
    const D share = area * weight;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 3; ++c) line[c][k][kLine[k][g]] += share * P[c + 3 * k];
    }
  }
  add_nodal_forces(line, s);
  lanes(s.energy) = energy;
  lanes(s.min_volume) = least;
}

// Eight floats at any address: not every compiler keeps a weaker alignment of S behind a reference.
inline S load(const float* p) noexcept {
  S a;
  __builtin_memcpy(&a, p, sizeof a);
  return a;
}
inline void store(S a, float* p) noexcept {
  __builtin_memcpy(p, &a, sizeof a);
}

// x (n) -= four columns of A (n, stride) times y (4).
inline void subtract_columns(const float* A, std::size_t stride, std::size_t n, const float* y,
                             float* x) noexcept {
  const float* B = A + stride;
  const float* C = B + stride;
  const float* E = C + stride;
  std::size_t i = 0;
  for (; i + kWide <= n; i += kWide)
    store(load(x + i) - load(A + i) * y[0] - load(B + i) * y[1] - load(C + i) * y[2] -
              load(E + i) * y[3],
          x + i);
  for (; i < n; ++i) x[i] = x[i] - A[i] * y[0] - B[i] * y[1] - C[i] * y[2] - E[i] * y[3];
}

inline float sum_of(const S& a) noexcept {
  return ((a[0] + a[4]) + (a[1] + a[5])) + ((a[2] + a[6]) + (a[3] + a[7]));
}

// out (4) = four columns of A (n, stride) times x (n).
inline void multiply_columns(const float* A, std::size_t stride, std::size_t n, const float* x,
                             float* out) noexcept {
  const float* B = A + stride;
  const float* C = B + stride;
  const float* E = C + stride;
  S a = S{};
  S b = S{};
  S c = S{};
  S e = S{};
  std::size_t i = 0;
  for (; i + kWide <= n; i += kWide) {
    const S v = load(x + i);
    a += load(A + i) * v;
    b += load(B + i) * v;
    c += load(C + i) * v;
    e += load(E + i) * v;
  }
  out[0] = sum_of(a);
  out[1] = sum_of(b);
  out[2] = sum_of(c);
  out[3] = sum_of(e);
  for (; i < n; ++i) {
    out[0] += A[i] * x[i];
    out[1] += B[i] * x[i];
    out[2] += C[i] * x[i];
    out[3] += E[i] * x[i];
  }
}

void forward(const float* L, std::size_t rows, std::size_t columns, float* x) {
  std::size_t j = 0;
  for (; j + 4 <= columns; j += 4) {
    const float* A = L + j * rows;
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t m = 0; m < k; ++m) x[j + k] -= A[m * rows + j + k] * x[j + m];
      x[j + k] /= A[k * rows + j + k];
    }
    subtract_columns(A + j + 4, rows, rows - j - 4, x + j, x + j + 4);
  }
  for (; j < columns; ++j) {
    const float* A = L + j * rows;
    x[j] /= A[j];
    for (std::size_t i = j + 1; i < rows; ++i) x[i] -= A[i] * x[j];
  }
}

void backward(const float* L, std::size_t rows, std::size_t columns, float* x) {
  std::size_t j = columns;
  for (; j % 4 != 0; --j) {
    const float* A = L + (j - 1) * rows;
    float sum = 0;
    for (std::size_t i = j; i < rows; ++i) sum += A[i] * x[i];
    x[j - 1] = (x[j - 1] - sum) / A[j - 1];
  }
  for (; j > 0; j -= 4) {
    const float* A = L + (j - 4) * rows;
    float sum[4];
    multiply_columns(A + j, rows, rows - j, x + j, sum);
    float* y = x + j - 4;
    for (std::size_t k = 4; k-- > 0;) {
      const float* column = A + k * rows + j - 4;
      for (std::size_t m = k + 1; m < 4; ++m) sum[k] += column[m] * y[m];
      y[k] = (y[k] - sum[k]) / column[k];
    }
  }
}

void multiply(const float* A, std::size_t rows, std::size_t columns, const float* x, float* y) {
  std::size_t j = 0;
  for (; j + 4 <= columns; j += 4) {
    const float minus[4] = {-x[j], -x[j + 1], -x[j + 2], -x[j + 3]};
    subtract_columns(A + j * rows, rows, rows, minus, y);
  }
  for (; j < columns; ++j) {
    const float* column = A + j * rows;
    std::size_t i = 0;
    for (; i + kWide <= rows; i += kWide) store(load(y + i) + load(column + i) * x[j], y + i);
    for (; i < rows; ++i) y[i] += column[i] * x[j];
  }
}

#include "artus/detail/soft/cage/elimination_body.h"

constexpr SoftKernels kKernels{cells, forward, backward, multiply, eliminate};
