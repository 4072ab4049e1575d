// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string_view>
#include <utility>
#include <vector>

#include "artus/detail/anatomy/body/tet_mesh.h"
#include "artus/detail/anatomy/body/tissue.h"
#include "artus/detail/core/check.h"

namespace artus {

/// The names that files and flags use. Errors of the find_ forms:
/// not_found, with the names there are.
[[nodiscard]] const char* to_string(CuttingLaw law) noexcept;
[[nodiscard]] const char* to_string(PrepunctureLaw law) noexcept;
[[nodiscard]] Result<CuttingLaw> find_cutting_law(std::string_view name);
[[nodiscard]] Result<PrepunctureLaw> find_prepuncture_law(std::string_view name);

/// What the needle feels in one region: the tissue's values and the laws that use them.
struct LayerHaptics {
  Haptic tissue;
  CuttingLaw cutting = CuttingLaw::tracking_wall;
  PrepunctureLaw prepuncture = PrepunctureLaw::membrane;
};

/// Haptic values by region, so that the tick looks them up by index. Regions out of range feel like
/// outside (nothing).
class LayerTable {
 public:
  LayerTable() = default;
  explicit LayerTable(std::vector<LayerHaptics> by_region) : by_region_(std::move(by_region)) {}

  [[nodiscard]] ARTUS_REALTIME const LayerHaptics& operator[](RegionId region) const noexcept {
    return region != kOutside && region < by_region_.size() ? by_region_[region] : outside_;
  }

 private:
  std::vector<LayerHaptics> by_region_;
  LayerHaptics outside_;
};

}  // namespace artus
