// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/soft_model.h"

#include <algorithm>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

using Index = Eigen::Index;

CellVector cell_displacement(const CageCell& cell, std::span<const Vec3> u) noexcept {
  CellVector v;
  for (std::size_t a = 0; a < 8; ++a) v.segment<3>(static_cast<Index>(3 * a)) = u[cell.nodes[a]];
  return v;
}

double target_of(std::span<const double> targets, std::size_t cell) noexcept {
  return targets.empty() ? 1.0 : targets[cell];
}

/// Larger cubes are sampled as densely as the smaller ones, up to 8 along an edge.
int samples_for(double edge, double finest, int samples) noexcept {
  return edge > 1.5 * finest ? std::min(8, 2 * samples) : samples;
}

}  // namespace

SoftModel::SoftModel(const MaterialField& field, const SoftModelParams& params)
    : cage_(params.cage, [&](const Vec3& low, double edge) {
        return tissue_share(sample_cell(field, low, edge, params.samples)) > params.min_share;
      }) {
  for (const SoftMaterial& m : field.materials)
    ARTUS_REQUIRE(m.hard || (m.shear > 0 && m.bulk > 0), "a material without stiffness");
  average_materials(field, params.samples);
  hold_nodes(field, params);
  connect();
}

void SoftModel::average_materials(const MaterialField& field, int samples) {
  materials_.reserve(cage_.cells().size());
  std::vector<CellMixture> mixtures;
  mixtures.reserve(cage_.cells().size());
  for (const CageCell& cell : cage_.cells()) {
    const double edge = cage_.edge(cell);
    const int n = samples_for(edge, cage_.finest(), samples);
    mixtures.push_back(sample_cell(field, cage_.low_corner(cell), edge, n));
    materials_.push_back(average_cell(field, mixtures.back()));
  }
  layers_ = LayerMap(cage_, field, mixtures);
  skin_ = SkinHeight(cage_, field);
  packs_.resize((materials_.size() + kLanes - 1) / kLanes);
  for (std::size_t c = 0; c < materials_.size(); ++c)
    packs_[c / kLanes].set(c % kLanes, materials_[c], cage_.edge(cage_.cells()[c]));
}

void SoftModel::hold_nodes(const MaterialField& field, const SoftModelParams& params) {
  const auto nodes = cage_.nodes();
  held_.resize(nodes.size());
  unknown_of_.assign(nodes.size(), kNotUnknown);
  for (std::uint32_t n = 0; n < nodes.size(); ++n) {
    if (!cage_.masters(n).empty()) continue;
    const int material = field.at(nodes[n]);
    const bool rigid = material == kBeyondMaterial ||
                       (material >= 0 && field.materials[static_cast<std::size_t>(material)].hard);
    if (rigid) {
      held_[n].held = {true, true, true};
    } else if (params.held) {
      held_[n] = params.held(nodes[n]);
    }
    if (held_[n].all()) continue;
    unknown_of_[n] = static_cast<std::uint32_t>(unknown_nodes_.size());
    unknown_nodes_.push_back(n);
  }
}

template <class Visit>
void SoftModel::visit_unknowns(std::uint32_t node, Visit visit) const {
  const auto masters = cage_.masters(node);
  if (masters.empty()) {
    if (unknown_of_[node] != kNotUnknown) visit(unknown_of_[node], 1.0);
    return;
  }
  for (const NodeShare& share : masters) {
    if (unknown_of_[share.node] != kNotUnknown) visit(unknown_of_[share.node], share.weight);
  }
}

void SoftModel::connect() {
  std::vector<std::vector<std::uint32_t>> near(n_unknowns());
  for (const CageCell& cell : cage_.cells()) {
    std::vector<std::uint32_t> all;
    for (const std::uint32_t n : cell.nodes)
      visit_unknowns(n, [&](std::uint32_t i, double) { all.push_back(i); });
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    for (const std::uint32_t i : all) near[i].insert(near[i].end(), all.begin(), all.end());
  }
  graph_.start.assign(1, 0);
  for (std::uint32_t i = 0; i < near.size(); ++i) {
    std::sort(near[i].begin(), near[i].end());
    near[i].erase(std::unique(near[i].begin(), near[i].end()), near[i].end());
    for (const std::uint32_t j : near[i]) {
      if (j != i) graph_.neighbours.push_back(j);
    }
    graph_.start.push_back(static_cast<std::uint32_t>(graph_.neighbours.size()));
  }
}

void SoftModel::expand(const Eigen::VectorXd& unknowns, std::span<const Vec3> prescribed,
                       std::vector<Vec3>& u) const {
  u.resize(cage_.nodes().size());
  for (std::uint32_t n = 0; n < u.size(); ++n) {
    u[n] = prescribed.empty() ? Vec3::Zero() : prescribed[n];
    if (unknown_of_[n] == kNotUnknown) continue;
    for (int k = 0; k < 3; ++k) {
      if (!held_[n].held[static_cast<std::size_t>(k)])
        u[n][k] = unknowns[3 * static_cast<Index>(unknown_of_[n]) + k];
    }
  }
  for (std::uint32_t n = 0; n < u.size(); ++n) {
    const auto masters = cage_.masters(n);
    if (masters.empty()) continue;
    u[n].setZero();
    for (const NodeShare& share : masters) u[n] += share.weight * u[share.node];
  }
}

void SoftModel::compute_forces(std::span<const Vec3> u, std::span<const double> targets,
                               SoftForces& out) const {
  const auto cells = cage_.cells();
  out.on_nodes.assign(u.size(), Vec3::Zero());
  out.energy = 0;
  out.min_volume = 1;
  const SoftKernels& kernels = soft_kernels();
  CellPackState state;
  for (std::size_t p = 0; p < packs_.size(); ++p) {
    const std::size_t first = kLanes * p;
    const std::size_t count = std::min(kLanes, cells.size() - first);
    for (std::size_t l = 0; l < count; ++l) {
      for (std::size_t a = 0; a < 8; ++a) {
        const Vec3& d = u[cells[first + l].nodes[a]];
        for (std::size_t k = 0; k < 3; ++k) state.u[3 * a + k][l] = d[static_cast<Index>(k)];
      }
      state.target[l] = target_of(targets, first + l);
    }
    kernels.cells(packs_[p], state);
    for (std::size_t l = 0; l < count; ++l) {
      for (std::size_t a = 0; a < 8; ++a) {
        Vec3& f = out.on_nodes[cells[first + l].nodes[a]];
        for (std::size_t k = 0; k < 3; ++k) f[static_cast<Index>(k)] += state.force[3 * a + k][l];
      }
      out.energy += state.energy[l];
      out.min_volume = std::min(out.min_volume, state.min_volume[l]);
    }
  }
  for (std::uint32_t n = 0; n < u.size(); ++n) {
    const auto masters = cage_.masters(n);
    if (masters.empty()) continue;
    for (const NodeShare& share : masters)
      out.on_nodes[share.node] += share.weight * out.on_nodes[n];
    out.on_nodes[n].setZero();
  }
  out.on_unknowns.resize(static_cast<Index>(3 * n_unknowns()));
  for (std::size_t i = 0; i < n_unknowns(); ++i) {
    Vec3 f = out.on_nodes[unknown_nodes_[i]];
    for (int k = 0; k < 3; ++k) {
      if (held_[unknown_nodes_[i]].held[static_cast<std::size_t>(k)]) f[k] = 0;
    }
    out.on_unknowns.segment<3>(static_cast<Index>(3 * i)) = f;
  }
}

void SoftModel::assemble_tangent(std::span<const Vec3> u, std::span<const double> targets,
                                 BlockMatrix& out) const {
  out.set_zero();
  const auto cells = cage_.cells();
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const CellMatrix K = cell_tangent(materials_[c], cage_.edge(cells[c]),
                                      cell_displacement(cells[c], u), target_of(targets, c));
    for (std::size_t a = 0; a < 8; ++a) {
      visit_unknowns(cells[c].nodes[a], [&](std::uint32_t i, double wi) {
        for (std::size_t b = 0; b < 8; ++b) {
          visit_unknowns(cells[c].nodes[b], [&](std::uint32_t j, double wj) {
            if (i > j) return;
            out.add(i, j,
                    wi * wj * K.block<3, 3>(static_cast<Index>(3 * a), static_cast<Index>(3 * b)));
          });
        }
      });
    }
  }
  release_held(out);
}

/// A node that is held in some directions keeps them as equations of their own.
void SoftModel::release_held(BlockMatrix& matrix) const {
  for (std::uint32_t i = 0; i < n_unknowns(); ++i) {
    const HeldNode& hold = held_[unknown_nodes_[i]];
    const double scale = matrix.diagonal[i].trace() / 3;
    for (int k = 0; k < 3; ++k) {
      if (!hold.held[static_cast<std::size_t>(k)]) continue;
      matrix.diagonal[i].row(k).setZero();
      matrix.diagonal[i].col(k).setZero();
      matrix.diagonal[i](k, k) = scale;
    }
    for (std::uint32_t e = graph_.start[i]; e < graph_.start[i + 1]; ++e) {
      const HeldNode& other = held_[unknown_nodes_[graph_.neighbours[e]]];
      for (int k = 0; k < 3; ++k) {
        if (hold.held[static_cast<std::size_t>(k)]) matrix.upper[e].row(k).setZero();
        if (other.held[static_cast<std::size_t>(k)]) matrix.upper[e].col(k).setZero();
      }
    }
  }
}

Vec3 SoftModel::displacement_at(const CagePlace& place, std::span<const Vec3> u) const noexcept {
  Vec3 d = Vec3::Zero();
  if (place.cell < 0) return d;
  const CageCell& cell = cage_.cells()[static_cast<std::size_t>(place.cell)];
  for (std::size_t a = 0; a < 8; ++a) d += place.weights[a] * u[cell.nodes[a]];
  return d;
}

void SoftModel::add_force(const CagePlace& place, const Vec3& force,
                          Eigen::VectorXd& on_unknowns) const {
  for (const UnknownShare& s : shares_of(place)) {
    const HeldNode& hold = held_[unknown_nodes_[s.unknown]];
    for (int k = 0; k < 3; ++k) {
      if (!hold.held[static_cast<std::size_t>(k)])
        on_unknowns[3 * static_cast<Index>(s.unknown) + k] += s.weight * force[k];
    }
  }
}

std::vector<UnknownShare> SoftModel::shares_of(const CagePlace& place) const {
  std::vector<UnknownShare> shares;
  if (place.cell < 0) return shares;
  const CageCell& cell = cage_.cells()[static_cast<std::size_t>(place.cell)];
  for (std::size_t a = 0; a < 8; ++a) {
    if (place.weights[a] == 0) continue;
    visit_unknowns(cell.nodes[a], [&](std::uint32_t i, double w) {
      const auto same = std::find_if(shares.begin(), shares.end(),
                                     [&](const UnknownShare& s) { return s.unknown == i; });
      if (same != shares.end()) {
        same->weight += w * place.weights[a];
      } else {
        shares.push_back({i, w * place.weights[a]});
      }
    });
  }
  return shares;
}

std::vector<Vec3> SoftModel::unknown_places() const {
  std::vector<Vec3> places;
  places.reserve(n_unknowns());
  for (const std::uint32_t n : unknown_nodes_) places.push_back(cage_.nodes()[n]);
  return places;
}

}  // namespace artus
