// SPDX-License-Identifier: AGPL-3.0-or-later
#include "anatomy/region_labels.h"

#include <algorithm>

namespace artus {

double signed_distance(const RegionOfInterest& roi, const Vec3& p) {
  if (!roi.half_extent) return (p - roi.centre).norm() - roi.radius;
  const Vec3 q = (p - roi.centre).cwiseAbs() - *roi.half_extent;
  return q.cwiseMax(Vec3::Zero()).norm() + std::min(q.maxCoeff(), 0.0);
}

RegionId RegionLabels::at(const Vec3& p) const {
  if (body.value(p) >= 0) return kOutside;
  if (region_of_interest && signed_distance(*region_of_interest, p) >= 0) return kBeyond;
  for (const Layer& layer : layers) {
    if (layer.field.value(p) < 0) return layer.region;
  }
  return filler;
}

const RegionLabels::Layer* RegionLabels::layer_of(RegionId region) const {
  const auto found = std::find_if(layers.begin(), layers.end(),
                                  [region](const Layer& l) { return l.region == region; });
  return found == layers.end() ? nullptr : &*found;
}

double RegionLabels::separation(RegionId a, RegionId b, const Vec3& p) const {
  if (a == kOutside || b == kOutside) return body.value(p);
  if (a == kBeyond || b == kBeyond) return signed_distance(*region_of_interest, p);
  for (const Layer& layer : layers) {
    if (layer.region == a || layer.region == b) return layer.field.value(p);
  }
  return 0;
}

}  // namespace artus
