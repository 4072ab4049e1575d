// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/cage/element.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include "artus/detail/soft/cage/kernels.h"

namespace artus {
namespace {

using Matrix3 = Eigen::Matrix3d;
using Matrix9 = Eigen::Matrix<double, 9, 9>;
using Plane = Eigen::Matrix<double, 3, 2>;
using Gradients = Eigen::Matrix<double, 8, 3>;  // of the shape functions, per edge length

/// No law hardens more than exp(3) = 20 times: beyond, the energy goes on as a straight line in
/// psi.
constexpr double kMaxHardening = 3;

Gradients gradients_at(const Vec3& s) noexcept {
  Gradients d;
  for (int a = 0; a < 8; ++a) {
    const double x = (a & 1) != 0 ? s.x() : 1 - s.x();
    const double y = (a & 2) != 0 ? s.y() : 1 - s.y();
    const double z = (a & 4) != 0 ? s.z() : 1 - s.z();
    d.row(a) << ((a & 1) != 0 ? 1 : -1) * y * z, ((a & 2) != 0 ? 1 : -1) * x * z,
        ((a & 4) != 0 ? 1 : -1) * x * y;
  }
  return d;
}

/// Gradients of the 8 shape functions at the 8 Gauss points, as Gradients stores them.
constexpr std::array<std::array<double, 24>, 8> make_gauss_gradients() {
  constexpr double kInner = 0.21132486540518713;  // (1 - 1/sqrt 3)/2
  std::array<std::array<double, 24>, 8> all{};
  for (std::size_t g = 0; g < 8; ++g) {
    std::array<double, 3> s{};
    for (std::size_t k = 0; k < 3; ++k) s[k] = ((g >> k) & 1U) != 0 ? 1 - kInner : kInner;
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t k = 0; k < 3; ++k) {
        double d = ((a >> k) & 1U) != 0 ? 1 : -1;
        for (std::size_t m = 0; m < 3; ++m) {
          if (m != k) d *= ((a >> m) & 1U) != 0 ? s[m] : 1 - s[m];
        }
        all[g][a + 8 * k] = d;
      }
    }
  }
  return all;
}

constexpr std::array<std::array<double, 24>, 8> kGaussGradients = make_gauss_gradients();

Eigen::Map<const Gradients> gauss_gradients(std::size_t g) noexcept {
  return Eigen::Map<const Gradients>(kGaussGradients[g].data());
}

Matrix3 gradient_of(const Gradients& d, double edge, const CellVector& u) noexcept {
  const Eigen::Map<const Eigen::Matrix<double, 3, 8>> displacement(u.data());
  return Matrix3::Identity() + displacement * d / edge;
}

Matrix3 cofactor(const Matrix3& F) noexcept {
  Matrix3 cof;
  cof.col(0) = F.col(1).cross(F.col(2));
  cof.col(1) = F.col(2).cross(F.col(0));
  cof.col(2) = F.col(0).cross(F.col(1));
  return cof;
}

Plane plane_across(const Vec3& normal) noexcept {
  Plane plane;
  plane.col(0) = normal.unitOrthogonal();
  plane.col(1) = normal.cross(plane.col(0));
  return plane;
}

/// The stress of a hardening psi: first derivative and the factor of its second.
struct Hardened {
  double factor = 1;  // exp(b psi), cut
  double slope = 0;   // d factor / d psi
  double energy = 0;  // per mu
};

Hardened harden(double b, double psi) noexcept {
  const double x = b * psi;
  if (x < 1e-8) return {1 + x, b, psi};
  if (x > kMaxHardening) {
    const double top = std::exp(kMaxHardening);
    return {top, 0, (top - 1 + top * (x - kMaxHardening)) / b};
  }
  const double factor = std::exp(x);
  return {factor, b * factor, (factor - 1) / b};
}

double psi_of(const Matrix3& F, double J) noexcept {
  return 0.5 * (F.squaredNorm() - 3) - (J - 1) + 0.5 * (J - 1) * (J - 1);
}

/// Membrane: energy per mu and its gradient by A = F T.
struct Sheet {
  Plane A;
  Eigen::Matrix2d inverse;  // of c
  double det = 1;
  Eigen::Matrix2d stress;  // I - c^-1 / det c
};

Sheet make_sheet(const Matrix3& F, const Plane& plane) noexcept {
  Sheet sheet;
  sheet.A = F * plane;
  const Eigen::Matrix2d c = sheet.A.transpose() * sheet.A;
  // A sheet that is crushed to nothing keeps a finite stress.
  sheet.det = std::max(c.determinant(), 1e-2);
  sheet.inverse << c(1, 1), -c(0, 1), -c(1, 0), c(0, 0);
  sheet.inverse /= sheet.det;
  sheet.stress = Eigen::Matrix2d::Identity() - sheet.inverse / sheet.det;
  return sheet;
}

struct Kinematics {
  std::array<Matrix3, 8> F;
  std::array<Matrix3, 8> cof;
  std::array<double, 8> J{};
  double mean_J = 1;
  double weight = 0;  // sum over the eighths
};

Kinematics kinematics_of(const CellMaterial& m, double edge, const CellVector& u) noexcept {
  Kinematics k;
  double sum = 0;
  for (std::size_t g = 0; g < 8; ++g) {
    k.F[g] = gradient_of(gauss_gradients(g), edge, u);
    k.cof[g] = cofactor(k.F[g]);
    k.J[g] = k.F[g].col(0).dot(k.cof[g].col(0));
    k.weight += m.weight[g];
    sum += m.weight[g] * k.J[g];
  }
  if (k.weight > 0) k.mean_J = sum / k.weight;
  return k;
}

/// d cof(F) / dF as a matrix over (i + 3 J, k + 3 L).
void add_cofactor_derivative(const Matrix3& F, double factor, Matrix9& H) noexcept {
  constexpr std::array<std::array<int, 3>, 6> kPermutations{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  for (int a = 0; a < 6; ++a) {
    for (int b = 0; b < 6; ++b) {
      const auto& [i, k, m] = kPermutations[static_cast<std::size_t>(a)];
      const auto& [j, l, n] = kPermutations[static_cast<std::size_t>(b)];
      const double sign = (a < 3) == (b < 3) ? 1 : -1;
      H(i + 3 * j, k + 3 * l) += factor * sign * F(m, n);
    }
  }
}

/// mu I + volume cof cof^T + squeeze d cof/dF, without its negative values, mode by mode: by the
/// singular values of F, twists have mu + squeeze times the third value, flips mu less it, and the
/// three stretches a matrix of their own. Source [Smith2018], 4.3.
void add_positive_part(const Matrix3& F, double mu, double volume, double squeeze,
                       Matrix9& H) noexcept {
  const Eigen::JacobiSVD<Matrix3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 U = svd.matrixU();
  const Matrix3 V = svd.matrixV();
  Vec3 s = svd.singularValues();
  if (U.determinant() * V.determinant() < 0) {
    U.col(2) *= -1;
    s[2] *= -1;
  }
  const auto add = [&](double value, const Matrix3& mode) {
    if (!(value > 0)) return;
    const Matrix3 turned = U * mode * V.transpose();
    const Eigen::Map<const Eigen::Matrix<double, 9, 1>> m(turned.data());
    H += value * m * m.transpose();
  };
  for (int k = 0; k < 3; ++k) {
    Matrix3 mode = Matrix3::Zero();
    const int i = (k + 1) % 3;
    const int j = (k + 2) % 3;
    mode(i, j) = mode(j, i) = std::sqrt(0.5);
    add(mu - squeeze * s[k], mode);
    mode(j, i) *= -1;
    add(mu + squeeze * s[k], mode);
  }
  const Vec3 areas(s[1] * s[2], s[2] * s[0], s[0] * s[1]);
  Matrix3 stretches;
  stretches << 0, s[2], s[1], s[2], 0, s[0], s[1], s[0], 0;
  stretches = squeeze * stretches + mu * Matrix3::Identity() + volume * areas * areas.transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(stretches);
  for (int k = 0; k < 3; ++k)
    add(solver.eigenvalues()[k], solver.eigenvectors().col(k).asDiagonal());
}

void add_sheet_tangent(const Sheet& sheet, const Plane& plane, double factor, Matrix9& H) noexcept {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(sheet.stress);
  const Eigen::Vector2d held = solver.eigenvalues().cwiseMax(0);
  const Eigen::Matrix2d tension =
      solver.eigenvectors() * held.asDiagonal() * solver.eigenvectors().transpose();
  for (int kl = 0; kl < 9; ++kl) {
    Matrix3 dF = Matrix3::Zero();
    dF(kl % 3, kl / 3) = 1;
    const Plane dA = dF * plane;
    const Eigen::Matrix2d half = sheet.A.transpose() * dA;
    const Eigen::Matrix2d dc = half + half.transpose();
    const Eigen::Matrix2d inv = sheet.inverse;
    const Eigen::Matrix2d dS = (inv * dc * inv + (inv * dc).trace() * inv) / sheet.det;
    const Matrix3 dP = (dA * tension + sheet.A * dS) * plane.transpose();
    H.col(kl) += factor * Eigen::Map<const Eigen::Matrix<double, 9, 1>>(dP.data());
  }
}

void add_fibre_tangent(const CellMaterial& m, const Matrix3& F, Matrix9& H) noexcept {
  const Vec3 along = F * m.fibre;
  const double e = 0.5 * (along.squaredNorm() - 1);
  if (e <= 0) return;
  for (int kl = 0; kl < 9; ++kl) {
    const double a_l = m.fibre[kl / 3];
    Vec3 d = m.fibre_modulus * along[kl % 3] * a_l * along;
    d[kl % 3] += m.fibre_modulus * e * a_l;
    const Matrix3 dP = d * m.fibre.transpose();
    H.col(kl) += Eigen::Map<const Eigen::Matrix<double, 9, 1>>(dP.data());
  }
}

/// Pa by which a cube resists that its parts change their volumes unlike: its mean shear modulus,
/// lambda at most (then the volume is integrated in full), so that sum_g V_g e/2 (J_g - mean J)^2
/// holds the patterns that alternate from node to node, which a mean alone does not see. Chosen
/// between gates of docs/deformation.md: less leaves a point force's neighbours to alternate, more
/// stiffens a wall.
double evenness_of(const CellMaterial& m) noexcept {
  double sum = 0;
  double weight = 0;
  for (std::size_t g = 0; g < 8; ++g) {
    sum += m.weight[g] * m.shear[g];
    weight += m.weight[g];
  }
  return weight > 0 ? std::min(m.bulk, sum / weight) : 0;
}

/// Pa by which a part of a cube that is squeezed below kMinPart of its volume pushes back.
double crush_of(const CellMaterial& m, double J) noexcept {
  const double x = std::max(0.0, 1 - J / kMinPart);
  const double rise = m.firm_from > 0 ? kCrushRise : 0;
  return m.bulk / kMinPart * x * (1 + 2 * rise * x * x);
}

/// By how much more for each further share of its volume.
double crush_slope_of(const CellMaterial& m, double J) noexcept {
  const double x = 1 - J / kMinPart;
  const double rise = m.firm_from > 0 ? kCrushRise : 0;
  return x > 0 ? m.bulk / (kMinPart * kMinPart) * (1 + 6 * rise * x * x) : 0;
}

/// Pressure (negative) of the mean dilatation and its slope, by `excess` = mean J - J0; as
/// kernels_body.h has it.
struct VolumeLaw {
  double pressure = 0;
  double slope = 0;
};

VolumeLaw drained_law(const CellMaterial& m, double excess) noexcept {
  if (!(m.drain > 0) || excess >= 0) return {m.bulk * excess, m.bulk};
  const double soft = std::min(0.5 * m.bulk, m.drain_pressure / m.drain);
  const double rise = (kDrainEnd - kDrainBegin) * m.drain;
  const double ramp = std::clamp(-excess - kDrainBegin * m.drain, 0.0, rise);
  const double beyond = std::max(-excess - kDrainEnd * m.drain, 0.0);
  return {soft * excess - (m.bulk - soft) * (0.5 * ramp * ramp / rise + beyond),
          soft + (m.bulk - soft) * ramp / rise};
}

VolumeLaw volume_law(const CellMaterial& m, double excess) noexcept {
  VolumeLaw law = drained_law(m, excess);
  const double passed = -excess - kDrainEnd * m.drain - m.firm_from;
  if (!(m.firm_from > 0) || !(passed > 0)) return law;
  const double hardening = m.bulk / (kFirmRise * m.firm_from);
  law.pressure -= hardening * passed * passed;
  law.slope += 2 * hardening * passed;
  return law;
}

/// Second derivative of the energy density at one point without the mean dilatation's own part.
Matrix9 point_tangent(const CellMaterial& m, std::size_t g, const Kinematics& k, double pressure,
                      const Plane& plane) noexcept {
  const Matrix3& F = k.F[g];
  const Hardened hard = harden(m.hardening[g], psi_of(F, k.J[g]));
  const double mu = m.shear[g] * hard.factor;
  const double even = evenness_of(m);
  const double volume = mu + even + crush_slope_of(m, k.J[g]);
  const double squeeze =
      mu * (k.J[g] - 2) + pressure + even * (k.J[g] - k.mean_J) - crush_of(m, k.J[g]);
  const Eigen::Map<const Eigen::Matrix<double, 9, 1>> cof(k.cof[g].data());
  Matrix9 H = Matrix9::Zero();
  if (std::abs(squeeze) <= mu) {
    H = mu * Matrix9::Identity() + volume * cof * cof.transpose();
    add_cofactor_derivative(F, squeeze, H);
  } else {
    add_positive_part(F, mu, volume, squeeze, H);
  }
  const Matrix3 slope = F + (k.J[g] - 2) * k.cof[g];
  const Eigen::Map<const Eigen::Matrix<double, 9, 1>> s(slope.data());
  H += m.shear[g] * hard.slope * s * s.transpose();
  if (m.sheet[g] > 0) add_sheet_tangent(make_sheet(F, plane), plane, m.sheet[g], H);
  if (m.fibre_modulus > 0) add_fibre_tangent(m, F, H);
  return H;
}

}  // namespace

CellResponse cell_response(const CellMaterial& m, double edge, const CellVector& u,
                           double target) noexcept {
  CellPack pack;
  pack.set(0, m, edge);
  CellPackState state;
  for (std::size_t i = 0; i < 24; ++i) state.u[i][0] = u[static_cast<Eigen::Index>(i)];
  state.target[0] = target;
  soft_kernels().cells(pack, state);
  CellResponse out;
  for (std::size_t i = 0; i < 24; ++i) out.force[static_cast<Eigen::Index>(i)] = state.force[i][0];
  out.energy = state.energy[0];
  out.min_volume = state.min_volume[0];
  return out;
}

CellMatrix cell_tangent(const CellMaterial& m, double edge, const CellVector& u,
                        double target) noexcept {
  const Kinematics k = kinematics_of(m, edge, u);
  const double volume = edge * edge * edge / 8;
  const VolumeLaw law = volume_law(m, k.mean_J - target);
  const Plane plane = plane_across(m.sheet_normal);
  CellMatrix K = CellMatrix::Zero();
  CellVector dilatation = CellVector::Zero();
  for (std::size_t g = 0; g < 8; ++g) {
    if (m.weight[g] <= 0) continue;
    const Gradients d = gauss_gradients(g) / edge;
    const double w = volume * m.weight[g];
    const Matrix9 H = w * point_tangent(m, g, k, law.pressure, plane);
    // B, which takes the nodes' displacements to grad u, is d in each of the three directions by
    // itself.
    Eigen::Matrix<double, 24, 9> BH = Eigen::Matrix<double, 24, 9>::Zero();
    for (int r = 0; r < 9; ++r) {
      for (int a = 0; a < 8; ++a) {
        for (int J = 0; J < 3; ++J)
          BH.col(r).segment<3>(3 * a) += d(a, J) * H.col(r).segment<3>(3 * J);
      }
    }
    for (int a = 0; a < 8; ++a) {
      for (int J = 0; J < 3; ++J) {
        for (int i = 0; i < 3; ++i) K.col(3 * a + i) += d(a, J) * BH.col(i + 3 * J);
        dilatation.segment<3>(3 * a) += w * d(a, J) * k.cof[g].col(J);
      }
    }
  }
  if (k.weight > 0)
    K += (law.slope - evenness_of(m)) / (volume * k.weight) * dilatation * dilatation.transpose();
  return K;
}

Eigen::Matrix3d cell_gradient(double edge, const CellVector& u) noexcept {
  return gradient_of(gradients_at(Vec3::Constant(0.5)), edge, u);
}

double cell_pressure(const CellMaterial& m, double J, double target) noexcept {
  return -volume_law(m, J - target).pressure;
}

double cell_dilatation(const CellMaterial& m, double edge, const CellVector& u) noexcept {
  return kinematics_of(m, edge, u).mean_J;
}

}  // namespace artus
