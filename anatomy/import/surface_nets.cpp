// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/surface_nets.h"

#include <algorithm>
#include <cstring>

#include <tbb/parallel_for.h>

namespace artus {
namespace {

constexpr double kReach = 0.45;  // voxel, from the middle of the cell; 0.5 lets vertices coincide

constexpr std::uint16_t kOutsideVolume = 0xffff;

/// What a voxel counts for in surfaces: beyond the volume there is nothing.
constexpr std::uint16_t label_of(std::uint16_t raw) noexcept {
  return raw == kOutsideVolume ? std::uint16_t{0} : raw;
}

/// Labels with a rim of kOutsideVolume around them.
class RimmedLabels {
 public:
  RimmedLabels(std::span<const std::uint16_t> labels, const std::array<std::size_t, 3>& size)
      : labels_(labels),
        nx_(static_cast<std::ptrdiff_t>(size[0])),
        ny_(static_cast<std::ptrdiff_t>(size[1])),
        nz_(static_cast<std::ptrdiff_t>(size[2])) {}
  [[nodiscard]] bool is_outside(std::ptrdiff_t x, std::ptrdiff_t y,
                                std::ptrdiff_t z) const noexcept {
    return x < 0 || y < 0 || z < 0 || x >= nx_ || y >= ny_ || z >= nz_;
  }
  /// A row of nx + 2 labels from x = -1 on.
  void row(std::ptrdiff_t y, std::ptrdiff_t z, std::vector<std::uint16_t>& out) const {
    std::fill(out.begin(), out.end(), kOutsideVolume);
    if (y < 0 || z < 0 || y >= ny_ || z >= nz_) return;
    std::memcpy(out.data() + 1, labels_.data() + (z * ny_ + y) * nx_,
                static_cast<std::size_t>(nx_) * sizeof(std::uint16_t));
  }

 private:
  std::span<const std::uint16_t> labels_;
  std::ptrdiff_t nx_, ny_, nz_;
};

std::size_t count_distinct(std::array<std::uint16_t, 8> values, std::size_t n) {
  std::size_t found = 0;
  for (std::size_t i = 0; i < n; ++i) {
    bool is_new = true;
    for (std::size_t k = 0; k < found && is_new; ++k) is_new = values[k] != values[i];
    if (is_new) values[found++] = values[i];
  }
  return found;
}

/// Walks through the cells and makes their vertices, links and faces.
class NetMaker {
 public:
  NetMaker(std::span<const std::uint16_t> labels, const std::array<std::size_t, 3>& size)
      : labels_(labels, size), nx_(size[0]), ny_(size[1]), nz_(size[2]) {
    net_.size = size;
    for (auto& layer : layers_) layer.assign((nx_ + 1) * (ny_ + 1), kNoVertex);
    for (auto& row : rows_) row.assign(nx_ + 2, 0);
  }

  SurfaceNet run() {
    for (std::size_t z = 0; z <= nz_; ++z) {
      std::swap(layers_[0], layers_[1]);
      std::fill(layers_[1].begin(), layers_[1].end(), kNoVertex);
      for (std::size_t y = 0; y <= ny_; ++y) do_row(y, z);
    }
    return std::move(net_);
  }

 private:
  /// Cells whose upper voxel is (x, y, z), counted from 0 to n: the lower one lies at x - 1.
  void do_row(std::size_t y, std::size_t z) {
    const auto sy = static_cast<std::ptrdiff_t>(y);
    const auto sz = static_cast<std::ptrdiff_t>(z);
    for (std::size_t k = 0; k < 4; ++k)
      labels_.row(sy - 1 + static_cast<std::ptrdiff_t>(k & 1U),
                  sz - 1 + static_cast<std::ptrdiff_t>(k >> 1U), rows_[k]);
    for (std::size_t x = 0; x <= nx_; ++x) {
      std::array<std::uint16_t, 8> corners;
      bool same = true;
      for (std::size_t k = 0; k < 4; ++k) {
        corners[2 * k] = rows_[k][x];
        corners[2 * k + 1] = rows_[k][x + 1];
        same = same && corners[2 * k] == corners[0] && corners[2 * k + 1] == corners[0];
      }
      if (same) continue;
      bool is_empty = true;
      for (const std::uint16_t c : corners) is_empty = is_empty && label_of(c) == 0;
      if (!is_empty) add_cell(x, y, z, corners);
    }
  }

  void add_cell(std::size_t x, std::size_t y, std::size_t z,
                const std::array<std::uint16_t, 8>& c) {
    const auto v = static_cast<std::uint32_t>(net_.points.size());
    layers_[1][y * (nx_ + 1) + x] = v;
    net_.cells.push_back({static_cast<std::int32_t>(x) - 1, static_cast<std::int32_t>(y) - 1,
                          static_cast<std::int32_t>(z) - 1});
    net_.points.emplace_back(static_cast<double>(x) - 0.5, static_cast<double>(y) - 0.5,
                             static_cast<double>(z) - 0.5);
    net_.neighbours.push_back({kNoVertex, kNoVertex, kNoVertex, kNoVertex, kNoVertex, kNoVertex});
    is_line_.push_back(count_distinct(c, 8) > 2);
    if (x > 0) link(v, 0, layers_[1][y * (nx_ + 1) + x - 1], {c[0], c[2], c[4], c[6]});
    if (y > 0) link(v, 1, layers_[1][(y - 1) * (nx_ + 1) + x], {c[0], c[1], c[4], c[5]});
    if (z > 0) link(v, 2, layers_[0][y * (nx_ + 1) + x], {c[0], c[1], c[2], c[3]});
    // Faces whose four cells are all there now: pairs of voxels at the cell's lower side.
    if (y > 0 && z > 0) add_face(x, y, z, 0, c[0], c[1]);
    if (x > 0 && z > 0) add_face(x, y, z, 1, c[0], c[2]);
    if (x > 0 && y > 0) add_face(x, y, z, 2, c[0], c[4]);
  }

  /// `face` are the four voxels between the two cells.
  void link(std::uint32_t v, std::size_t axis, std::uint32_t other,
            const std::array<std::uint16_t, 4>& face) {
    // The border of the volume counts as a label: what it cuts keeps its outline there.
    const std::size_t n = count_distinct({face[0], face[1], face[2], face[3], 0, 0, 0, 0}, 4);
    bool is_surface = false;
    for (const std::uint16_t c : face) is_surface = is_surface || label_of(c) != label_of(face[0]);
    if (!is_surface || other == kNoVertex) return;
    if (!is_line_[v] || n > 2) net_.neighbours[v][2 * axis] = other;
    if (!is_line_[other] || n > 2) net_.neighbours[other][2 * axis + 1] = v;
  }

  /// The face between the lower voxel of cell (x, y, z) and the next along `axis`.
  void add_face(std::size_t x, std::size_t y, std::size_t z, std::uint8_t axis, std::uint16_t below,
                std::uint16_t above) {
    below = label_of(below);
    above = label_of(above);
    if (below == above) return;
    const std::size_t w = nx_ + 1;
    const auto vertex = [&](std::size_t dx, std::size_t dy, std::size_t dz) {
      return layers_[1 - dz][(y - dy) * w + x - dx];
    };
    NetFace face;
    if (axis == 0)
      face.vertices = {vertex(0, 1, 1), vertex(0, 0, 1), vertex(0, 0, 0), vertex(0, 1, 0)};
    else if (axis == 1)
      face.vertices = {vertex(1, 0, 1), vertex(1, 0, 0), vertex(0, 0, 0), vertex(0, 0, 1)};
    else
      face.vertices = {vertex(1, 1, 0), vertex(0, 1, 0), vertex(0, 0, 0), vertex(1, 0, 0)};
    face.below = below;
    face.above = above;
    face.axis = axis;
    face.voxel = static_cast<std::uint32_t>((z * (ny_ + 2) + y) * (nx_ + 2) + x);
    const auto sx = static_cast<std::ptrdiff_t>(x) - 1;
    const auto sy = static_cast<std::ptrdiff_t>(y) - 1;
    const auto sz = static_cast<std::ptrdiff_t>(z) - 1;
    face.cut = labels_.is_outside(sx, sy, sz) ||
               labels_.is_outside(sx + (axis == 0 ? 1 : 0), sy + (axis == 1 ? 1 : 0),
                                  sz + (axis == 2 ? 1 : 0));
    net_.faces.push_back(face);
  }

  RimmedLabels labels_;
  std::size_t nx_, ny_, nz_;
  std::array<std::vector<std::uint32_t>, 2> layers_;  // vertices of the cells below and of this z
  std::array<std::vector<std::uint16_t>, 4> rows_;
  std::vector<bool> is_line_;  // three labels or more
  SurfaceNet net_;
};

/// Whether a vertex may move along an axis: not out of the border of the volume.
bool is_free(const SurfaceNet& net, std::size_t v, std::size_t axis) {
  const std::int32_t c = net.cells[v].at(axis);
  return c >= 0 && c + 1 < static_cast<std::int32_t>(net.size.at(axis));
}

}  // namespace

SurfaceNet make_surface_net(std::span<const std::uint16_t> labels,
                            const std::array<std::size_t, 3>& size) {
  return NetMaker(labels, size).run();
}

void smooth(SurfaceNet& net, int steps) {
  std::vector<Vec3> next(net.points.size());
  for (int step = 0; step < steps; ++step) {
    tbb::parallel_for(std::size_t{0}, next.size(), [&](std::size_t v) {
      Vec3 sum = Vec3::Zero();
      int n = 0;
      for (const std::uint32_t other : net.neighbours[v]) {
        if (other == kNoVertex) continue;
        sum += net.points[other];
        ++n;
      }
      next[v] = net.points[v];
      if (n < 2) return;  // the end of a line stays
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!is_free(net, v, axis)) continue;
        const auto k = static_cast<Eigen::Index>(axis);
        const double middle = net.cells[v].at(axis) + 0.5;
        const double moved = net.points[v][k] + 0.5 * (sum[k] / n - net.points[v][k]);
        next[v][k] = std::clamp(moved, middle - kReach, middle + kReach);
      }
    });
    std::swap(net.points, next);
  }
}

std::vector<Vec3> places_of(const SurfaceNet& net, const IndexFrame& X_LI) {
  std::vector<Vec3> places(net.points.size());
  tbb::parallel_for(std::size_t{0}, places.size(),
                    [&](std::size_t i) { places[i] = X_LI * net.points[i]; });
  return places;
}

std::array<std::array<std::uint8_t, 3>, 2> triangles_of(const NetFace& face,
                                                        std::span<const Vec3> places) {
  const auto& v = face.vertices;
  const double across = (places[v[0]] - places[v[2]]).squaredNorm();
  const double other = (places[v[1]] - places[v[3]]).squaredNorm();
  if (across <= other) return {{{0, 1, 2}, {0, 2, 3}}};
  return {{{0, 1, 3}, {1, 2, 3}}};
}

}  // namespace artus
