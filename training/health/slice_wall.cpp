// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/health/slice_wall.h"

#include <algorithm>

#include "artus/detail/training/health/beam_walls.h"

namespace artus {
namespace {

/// The share of a segment from `a` to `b` that is left of the line through `p` along `d`, kept in
/// `from` and `to`; frame P, y = 0.
void keep_beside(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& d, double& from,
                 double& to) {
  const auto side = [&](const Vec3& q) {
    return d.x() * (q.z() - p.z()) - d.z() * (q.x() - p.x());
  };
  const double at_a = side(a);
  const double at_b = side(b);
  if (at_a < 0 && at_b < 0) {
    to = from;
  } else if (at_a < 0) {
    from = std::max(from, at_a / (at_a - at_b));
  } else if (at_b < 0) {
    to = std::min(to, at_a / (at_a - at_b));
  }
}

}  // namespace

SliceWall::SliceWall(const TetMesh& before, const TetMesh& after, const std::vector<bool>& regions,
                     const Pose& X_JP, const Transducer& transducer)
    : beams_(spaced_evenly(transducer)) {
  const auto same = [](const Interface& f, const Interface& g) {
    return f.vertices == g.vertices && f.front == g.front && f.back == g.back;
  };
  if (!std::equal(before.interfaces.begin(), before.interfaces.end(), after.interfaces.begin(),
                  after.interfaces.end(), same))
    return;
  const auto in = [&](RegionId r) {
    return r < regions.size() && regions[r];
  };
  const Pose X_PJ = X_JP.inverse();
  for (const Interface& f : after.interfaces)
    if (in(f.front) != in(f.back)) cut(before, after, f.vertices, X_PJ);
}

void SliceWall::cut(const TetMesh& before, const TetMesh& after,
                    const std::array<std::uint32_t, 3>& facet, const Pose& X_PJ) {
  std::array<Vec3, 3> p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = X_PJ * after.vertices[facet[k]];
  std::array<Vec3, 2> ends;
  std::array<Vec3, 2> were;
  std::size_t n = 0;
  for (std::size_t k = 0; k < 3 && n < 2; ++k) {
    const std::size_t next = (k + 1) % 3;
    if ((p[k].y() < 0) == (p[next].y() < 0)) continue;
    const double share = p[k].y() / (p[k].y() - p[next].y());
    ends[n] = p[k] + share * (p[next] - p[k]);
    const Vec3& was = before.vertices[facet[k]];
    were[n++] = was + share * (before.vertices[facet[next]] - was);
  }
  if (n == 2) pieces_.push_back({ends[0], ends[1], (were[0] - were[1]).norm()});
}

double SliceWall::length_before(std::size_t beam, double from, double to) const {
  const auto place = [&](std::size_t i, double depth) {
    const Scanline line = scanline(beams_, static_cast<int>(i));
    return Vec3(line.origin + depth * line.direction);
  };
  // Not what leads on at either end.
  const double first_depth = from + kBeamSpacing / 2;
  const double last_depth = to - kBeamSpacing / 2;
  if (last_depth <= first_depth) return 0;
  const std::array<Vec3, 4> corners{place(beam, first_depth), place(beam + 1, first_depth),
                                    place(beam + 1, last_depth), place(beam, last_depth)};
  double length = 0;
  for (const Piece& piece : pieces_) {
    double first = 0;
    double last = 1;
    for (std::size_t k = 0; k < 4 && first < last; ++k)
      keep_beside(piece.a, piece.b, corners[k], corners[(k + 1) % 4] - corners[k], first, last);
    length += std::max(0.0, last - first) * piece.before;
  }
  return length;
}

}  // namespace artus
