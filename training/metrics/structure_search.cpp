// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/structure_search.h"

#include <array>
#include <cmath>

namespace artus {
namespace {

constexpr double kCoupled = 5e-3;  // m of gel between face and skin
constexpr int kLines = 21;

/// Whether a scanline from the face meets the region before anything hard.
bool meets(const Scene& scene, const Segment& line, RegionId region) {
  std::array<TissueInterval, 64> layers;
  const QueryCount count = scene.find_intervals(line, layers);
  for (std::size_t i = 0; i < count.size; ++i) {
    const TissueInterval& layer = layers[i];
    if (layer.region < kFirstRegion) {
      if (layer.exit - layer.entry > kCoupled) return false;
      continue;
    }
    if (layer.region == region) return true;
    if (scene.joint().tissue_of(layer.region).haptic.hard) return false;
  }
  return false;
}

}  // namespace

StructureSight see_structure(const Scene& scene, const Transducer& transducer, double depth,
                             const Pose& X_JP, RegionId region) {
  StructureSight sight;
  double first = 0;
  double last = 0;
  for (int k = 0; k < kLines; ++k) {
    const int line = static_cast<int>(std::lround((transducer.n_lines - 1.0) * k / (kLines - 1)));
    const Scanline beam = scanline(transducer, line);
    const Vec3 from = X_JP * beam.origin;
    const Vec3 to = X_JP * Vec3(beam.origin + depth * beam.direction);
    if (!meets(scene, {from, to}, region)) continue;
    const double x = beam.origin.x();
    if (!sight.in_picture) first = x;
    last = x;
    sight.in_picture = true;
  }
  sight.x = 0.5 * (first + last);
  return sight;
}

StructureSearch::StructureSearch(const CompiledJoint& joint, std::span<const std::string> names,
                                 const Transducer& transducer, double depth, double hold)
    : transducer_(transducer), depth_(depth), hold_(hold) {
  for (const std::string& name : names) {
    Sought one;
    one.name = name;
    for (std::size_t i = kFirstRegion; i < joint.regions.size(); ++i)
      if (joint.regions[i].name == name) one.region = static_cast<RegionId>(i);
    sought_.push_back(one);
  }
}

void StructureSearch::look(const Scene& scene, double time, const Pose& X_JP) {
  const double passed = last_ < 0 ? 0 : time - last_;
  last_ = time;
  if (done()) return;
  Sought& one = sought_[asked_];
  StructureSight sight;
  if (one.region != kOutside) sight = see_structure(scene, transducer_, depth_, X_JP, one.region);
  if (sight.in_picture) one.seen += passed;
  if (!sight.in_picture || std::abs(sight.x) > kMiddle) {
    since_ = -1;
    return;
  }
  if (since_ < 0) since_ = time;
  if (time - since_ < hold_) return;
  one.found = time;
  ++asked_;
  since_ = -1;
}

}  // namespace artus
