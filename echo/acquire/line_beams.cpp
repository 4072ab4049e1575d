// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/line_beams.h"

#include <algorithm>
#include <cmath>

namespace artus {
namespace {

// m from a beam, where the tissue is by its displacement and gradient there, and where what it
// meets may be blended of two
constexpr double kGuided = 0.8e-3;

/// Blends the paths of two beams, with the bends of both; false where there is no room.
bool blend_paths(const BeamPath& a, const BeamPath& b, double share, BeamPath& path) noexcept {
  path.size = 0;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size || j < b.size) {
    if (path.size == BeamPath::kMax) return false;
    const bool first = j == b.size || (i < a.size && a.length[i] <= b.length[j]);
    const double length = first ? a.length[i++] : b.length[j++];
    if (path.size > 0 && !(length > path.length[path.size - 1])) continue;
    const Vec3 before = a.at(length);
    path.p_J[path.size] = before + share * (b.at(length) - before);
    path.length[path.size++] = length;
  }
  return path.size >= 2;
}

}  // namespace

void LineBeams::begin_row(int n_planes) {
  n_planes_ = n_planes;
  for (Guide& guide : guides_) {
    guide.line = kNoLine;
    guide.trace.planes.forget();
  }
  for (Line& line : followed_) {
    line.line = kNoLine;
    line.own.planes.forget();
    line.sides.resize(static_cast<std::size_t>(n_planes));
    for (BeamTrace& trace : line.sides) trace.planes.forget();
  }
  between_.own.planes.forget();
  for (BeamTrace& trace : sides_) trace.planes.forget();
}

/// The row's k-th line that is followed.
std::size_t LineBeams::followed(std::size_t k) const noexcept {
  return k * (row_.size() - 1) / std::max<std::size_t>(1, n_parts_);
}

void LineBeams::follow_middle(std::size_t l, Line& line, const BeamTrace* like) {
  const PlacedLine& placed = row_[l];
  line.central = &line.own;
  line.path = &line.own_path;
  const auto alone = [&] {
    tracer_->trace_bent(placed.origin_J, placed.direction_J, line.own, line.own_path, nullptr,
                        like);
  };
  if (!tracer_->gives_way()) return alone();
  const std::size_t group = l / (2 * n_beside_ + 1);
  Guide& guide = guides_[group % guides_.size()];
  const PlacedLine& middle =
      row_[std::min(group * (2 * n_beside_ + 1) + n_beside_, row_.size() - 1)];
  if (guide.line != middle.index) {
    guide.line = middle.index;
    tracer_->trace_bent(middle.origin_J, middle.direction_J, guide.trace, guide.path, nullptr,
                        like);
  }
  if (middle.index == placed.index) {
    line.central = &guide.trace;
    line.path = &guide.path;
    return;
  }
  tracer_->trace_bent(placed.origin_J, placed.direction_J, line.own, line.own_path, &guide.trace,
                      like);
  if (line.own.outran) alone();
}

void LineBeams::follow_side(int p, const Line& line, BeamTrace& trace,
                            const BeamTrace* like) noexcept {
  const Vec3& elevation = row_[static_cast<std::size_t>(line.line)].elevation_J;
  plane_.size = 0;
  for (const double z : shape_->plane_nodes()) {
    plane_.p_J[plane_.size] = line.path->at(z) + shape_->plane_elevation(p, z) * elevation;
    plane_.length[plane_.size++] = z;
  }
  tracer_->trace_along(plane_, elevation, *line.central, trace, like);
}

/// Follows line `l` in all planes, cut as another.
void LineBeams::follow(std::size_t l, Line& line, const Line* like) {
  line.line = static_cast<int>(l);
  follow_middle(l, line, like != nullptr ? like->central : nullptr);
  for (int p = 0; p < n_planes_; ++p) {
    if (shape_->plane_offset(p) == 0 || !shape_->hears_speckle(p)) continue;
    const auto at = static_cast<std::size_t>(p);
    follow_side(p, line, line.sides[at], like != nullptr ? &like->sides[at] : nullptr);
  }
}

void LineBeams::go_to(const BeamTracer& tracer, const BeamShape& shape,
                      std::span<const PlacedLine> row, std::size_t l) {
  tracer_ = &tracer;
  shape_ = &shape;
  row_ = row;
  at_ = l;
  n_beside_ = static_cast<std::size_t>(kGuided / shape.line_spacing(shape.plane_nodes().back()));
  const std::size_t apart = std::max<std::size_t>(1, n_beside_);
  n_parts_ = (row.size() - 1 + apart - 1) / apart;
  std::size_t k = 0;
  while (k + 1 <= n_parts_ && followed(k + 1) <= l) ++k;
  const auto find = [&](std::size_t part) -> Line& {
    Line& line = followed_[part % followed_.size()];
    const Line& other = followed_[(part + 1) % followed_.size()];
    const auto wanted = static_cast<int>(followed(part));
    if (line.line != wanted) {
      const bool is_beside = part > 0 && other.line == static_cast<int>(followed(part - 1));
      follow(followed(part), line, is_beside ? &other : nullptr);
    }
    return line;
  };
  before_ = &find(k);
  now_ = before_;
  if (followed(k) == l) return;
  behind_ = &find(k + 1);
  share_ =
      static_cast<double>(l - followed(k)) / static_cast<double>(followed(k + 1) - followed(k));
  between_.line = static_cast<int>(l);
  between_.central = &between_.own;
  between_.path = &between_.own_path;
  now_ = &between_;
  if (blend_paths(*before_->path, *behind_->path, share_, between_.own_path) &&
      tracer.blend(*before_->central, *behind_->central, share_, between_.own))
    return;
  follow_middle(l, between_, nullptr);
}

const BeamTrace& LineBeams::plane(int p) {
  if (shape_->plane_offset(p) == 0) return central();
  const auto at = static_cast<std::size_t>(p);
  if (now_ != &between_) return now_->sides[at];
  BeamTrace& side = sides_[next_side_++ % sides_.size()];
  if (!tracer_->blend(before_->sides[at], behind_->sides[at], share_, side))
    follow_side(p, between_, side, nullptr);
  return side;
}

}  // namespace artus
