// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/cage/averaging.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Eigenvalues>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

struct Sums {
  double n = 0;
  double shear = 0;       // sum of mu
  double compliance = 0;  // sum of 1/mu
  double hardening = 0;   // sum of b, by the share of strain each layer takes
};

/// mu and lambda a sample counts with.
struct Moduli {
  double shear = 0;
  double bulk = 0;
  double hardening = 0;
};

Moduli moduli_of(const SoftMaterial& m, double hard_shear) noexcept {
  if (!m.hard) return {m.shear, m.bulk, m.hardening};
  return {hard_shear, hard_shear * 16, 0};
}

/// Sum over neighbouring samples of d d^T, d the difference of log mu: its largest direction is the
/// normal of the layers.
Eigen::Matrix3d difference_tensor(const CellMixture& mix, const std::vector<double>& log_shear) {
  Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
  const int n = mix.n;
  const auto value = [&](int x, int y, int z) {
    return log_shear[static_cast<std::size_t>(x + n * (y + n * z))];
  };
  for (int z = 0; z + 1 < n; ++z) {
    for (int y = 0; y + 1 < n; ++y) {
      for (int x = 0; x + 1 < n; ++x) {
        Vec3 d = Vec3::Zero();
        for (int a = 0; a < 8; ++a) {
          const double v = value(x + (a & 1), y + (a >> 1 & 1), z + (a >> 2));
          d += v * Vec3((a & 1) != 0 ? 1 : -1, (a & 2) != 0 ? 1 : -1, (a & 4) != 0 ? 1 : -1);
        }
        if (d.allFinite()) tensor += d * d.transpose();
      }
    }
  }
  return tensor;
}

/// How far the layers' share of Reuss goes: 1 for flat layers, 0 when all directions differ alike.
struct Layering {
  Vec3 normal = Vec3::UnitZ();
  double share = 1;
};

Layering layering_of(const CellMixture& mix, const std::vector<double>& log_shear) {
  Layering layering;
  const Eigen::Matrix3d tensor = difference_tensor(mix, log_shear);
  if (!(tensor.trace() > 1e-12)) return layering;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(tensor);
  layering.normal = solver.eigenvectors().col(2);
  layering.share = 1 - solver.eigenvalues()[1] / solver.eigenvalues()[2];
  return layering;
}

std::size_t eighth_of(int index, int n) noexcept {
  const int half = n / 2;
  const int x = index % n;
  const int y = index / n % n;
  const int z = index / (n * n);
  return static_cast<std::size_t>((x >= half ? 1 : 0) + (y >= half ? 2 : 0) + (z >= half ? 4 : 0));
}

void set_fibres(const MaterialField& field, const CellMixture& mix, CellMaterial& out) {
  std::map<int, int> count;
  int tissue = 0;
  for (const int m : mix.samples) {
    if (m < 0) continue;
    ++tissue;
    if (field.materials[static_cast<std::size_t>(m)].fibre_modulus > 0) ++count[m];
  }
  if (count.empty()) return;
  const auto most = std::max_element(
      count.begin(), count.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  const SoftMaterial& material = field.materials[static_cast<std::size_t>(most->first)];
  out.fibre = material.fibre;
  out.fibre_modulus = material.fibre_modulus * most->second / tissue;
}

}  // namespace

CellMixture sample_cell(const MaterialField& field, const Vec3& low_C, double edge, int n) {
  ARTUS_REQUIRE(n >= 2 && n % 2 == 0, "an even number of samples");
  CellMixture mix;
  mix.n = n;
  mix.samples.reserve(static_cast<std::size_t>(n * n * n));
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x)
        mix.samples.push_back(field.at(low_C + edge / n * Vec3(x + 0.5, y + 0.5, z + 0.5)));
    }
  }
  return mix;
}

double tissue_share(const CellMixture& mixture) noexcept {
  const auto n =
      std::count_if(mixture.samples.begin(), mixture.samples.end(), [](int m) { return m >= 0; });
  return static_cast<double>(n) / static_cast<double>(mixture.samples.size());
}

CellMaterial average_cell(const MaterialField& field, const CellMixture& mix, double hard_shear) {
  std::array<Sums, 8> sums{};
  Sums all;
  double bulk_compliance = 0;
  double drain = 0;
  double drain_pressure = 0;
  double firm_pressure = 0;  // at which the first of them hardens
  std::vector<double> log_shear(mix.samples.size(), std::nan(""));
  for (std::size_t i = 0; i < mix.samples.size(); ++i) {
    if (mix.samples[i] < 0) continue;
    const SoftMaterial& material = field.materials[static_cast<std::size_t>(mix.samples[i])];
    const Moduli m = moduli_of(material, hard_shear);
    drain += material.drain_pressure > 0 ? 1 : 0;
    drain_pressure += material.drain_pressure;
    log_shear[i] = std::log(m.shear);
    bulk_compliance += 1 / m.bulk;
    const double firm = material.firm_from * m.bulk;
    if (firm > 0 && (firm_pressure == 0 || firm < firm_pressure)) firm_pressure = firm;
    for (Sums* s : {&sums[eighth_of(static_cast<int>(i), mix.n)], &all}) {
      s->n += 1;
      s->shear += m.shear;
      s->compliance += 1 / m.shear;
      s->hardening += m.hardening / m.shear;
    }
  }
  CellMaterial out;
  if (all.n == 0) return out;
  out.bulk = all.n / bulk_compliance;
  out.firm_from = firm_pressure / out.bulk;
  out.drain = drain / all.n;
  if (drain > 0) out.drain_pressure = drain_pressure / drain;
  const Layering layering = layering_of(mix, log_shear);
  out.sheet_normal = layering.normal;
  const double in_eighth = static_cast<double>(mix.samples.size()) / 8;
  for (std::size_t g = 0; g < 8; ++g) {
    const Sums& s = sums[g].n > 0 ? sums[g] : all;
    const double voigt = s.shear / s.n;
    const double reuss = s.n / s.compliance;
    out.shear[g] = reuss * std::pow(voigt / reuss, 0.5 * (1 - layering.share));
    out.sheet[g] = layering.share * (voigt - out.shear[g]);
    if (out.sheet[g] < 1e-6 * voigt) out.sheet[g] = 0;
    out.hardening[g] = s.hardening / s.compliance;
    out.weight[g] = std::max(kMinWeight, sums[g].n / in_eighth);
  }
  set_fibres(field, mix, out);
  return out;
}

}  // namespace artus
