// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <map>
#include <string>
#include <vector>

#include "artus/detail/evidence/runs/needle_trace.h"

namespace artus {

/// The cutting component where a layer's force has built up.
struct LayerPlateau {
  std::string tissue;    ///< or layer of a body without tissues
  double expected = 0;   ///< N, the layer's cutting force
  double mean = 0;       ///< N, over the plateau's rows
  double least = 0;      ///< N
  double most = 0;       ///< N
  std::size_t rows = 0;  ///< 0: the layer is thinner than its rise
  double rise = 0;       ///< m, over which the force built up
};

/// Collects the rows in which a layer's force has built up: from where the tip entered the layer
/// (or set off again in it) over the layer's edge (ContactParams::layer_edge) and the distance that
/// its stiffness needs for what is missing, and some milliseconds if it is a weaker one, as long as
/// the tip goes deeper. On bone the distance is that by which the tip is pressed in.
class PlateauFinder {
 public:
  /// What a region is called and feels like, by region. Regions of one name are taken together.
  struct Layer {
    std::string name;
    Haptic haptic;
  };
  explicit PlateauFinder(std::vector<Layer> by_region) : by_region_(std::move(by_region)) {}

  void add(const NeedleRow& row);
  /// In the order of the regions.
  [[nodiscard]] std::vector<LayerPlateau> plateaus() const;

 private:
  std::vector<Layer> by_region_;
  bool going_ = false;
  RegionId region_ = kOutside;
  double from_ = 0;   // m, where the tip entered
  double since_ = 0;  // s, when
  double rise_ = 0;
  double deepest_ = 0;
  std::map<std::string, LayerPlateau> found_;
};

}  // namespace artus
