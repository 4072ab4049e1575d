// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/plateau.h"

#include <algorithm>

#include "artus/detail/haptics/needle/needle_contact.h"

namespace artus {
namespace {

constexpr double kAfterRise = 0.1e-3;  // m past the rise before the plateau counts
constexpr double kAfterFall = 0.02;    // s in a weaker layer before it does: some time constants
/// Slower than this on bone the needle is held and its wall settles; faster, it presses on.
constexpr double kPressing = 3e-3;  // m/s

bool cuts(const NeedleRow& row) noexcept {
  return row.state == ContactState::inserting ||
         (row.state == ContactState::bone && row.velocity > kPressing);
}

}  // namespace

void PlateauFinder::add(const NeedleRow& row) {
  if (!cuts(row) || row.region >= by_region_.size()) {
    going_ = false;
    return;
  }
  const Layer& layer = by_region_[row.region];
  if (!going_ || row.region != region_) {
    going_ = true;
    region_ = row.region;
    from_ = row.depth;
    since_ = row.time;
    deepest_ = row.depth;
    const double missing = std::max(0.0, layer.haptic.cutting_force + row.forces.cutting);
    // Setting off again on bone, the tip is pressed in already.
    const double pressed = row.state == ContactState::bone ? row.in_bone : 0;
    rise_ = pressed + missing / std::max(layer.haptic.wall_stiffness, 1e-6);
  }
  LayerPlateau& p = found_[layer.name];
  p.expected = layer.haptic.cutting_force;
  p.rise = std::max(p.rise, rise_);
  const bool deeper = row.depth >= deepest_;
  deepest_ = std::max(deepest_, row.depth);
  // Sliding along bone, the tip goes deeper without being pressed in farther.
  const bool bone = row.state == ContactState::bone;
  const double distance = bone ? row.in_bone : row.depth - from_;
  const double edge = bone ? 0 : ContactParams{}.layer_edge;
  if (distance < edge) since_ = row.time;
  if (!deeper || distance < edge + rise_ + kAfterRise || row.time < since_ + kAfterFall) return;
  const double force = -row.forces.cutting;
  p.least = p.rows == 0 ? force : std::min(p.least, force);
  p.most = p.rows == 0 ? force : std::max(p.most, force);
  p.mean += force;
  ++p.rows;
}

std::vector<LayerPlateau> PlateauFinder::plateaus() const {
  std::vector<LayerPlateau> out;
  for (const Layer& layer : by_region_) {
    const auto found = found_.find(layer.name);
    const auto listed = std::find_if(
        out.begin(), out.end(), [&layer](const LayerPlateau& p) { return p.tissue == layer.name; });
    if (found == found_.end() || listed != out.end()) continue;
    LayerPlateau p = found->second;
    p.tissue = layer.name;
    if (p.rows > 0) p.mean /= static_cast<double>(p.rows);
    out.push_back(p);
  }
  return out;
}

}  // namespace artus
