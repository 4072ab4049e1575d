// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "artus/anatomy/body/compiled_joint.h"
#include "artus/anatomy/body/tissue.h"
#include "artus/core/check.h"

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

/// The laws of a run: for all tissues when set, and exceptions by tissue name. What a run leaves
/// open is the tissue's own choice (Haptic::cutting_law, prepuncture_law).
struct LawSelection {
  std::optional<CuttingLaw> cutting;
  std::optional<PrepunctureLaw> prepuncture;
  std::map<std::string, CuttingLaw> cutting_of_tissue;
  std::map<std::string, PrepunctureLaw> prepuncture_of_tissue;
};

/// A patient's deviation from the tissue library; each factor multiplies the tissue's value.
struct PatientProfile {
  double cutting = 1;
  double friction = 1;
  double attracted = 1;
  double clamping = 1;
  double puncture = 1;
};

/// A layer of the tissue `name` as a run wants it: its laws chosen, its values times the patient's
/// factors.
[[nodiscard]] LayerHaptics for_run(LayerHaptics layer, const std::string& name,
                                   const LawSelection& laws, const PatientProfile& patient);

/// Haptic values by region, so that the tick looks them up by index. Regions out of range feel like
/// outside (nothing).
class LayerTable {
 public:
  LayerTable() = default;
  explicit LayerTable(std::vector<LayerHaptics> by_region) : by_region_(std::move(by_region)) {}
  /// Requires: a joint whose regions index its tissues.
  LayerTable(const CompiledJoint& joint, const LawSelection& laws, const PatientProfile& patient);

  [[nodiscard]] ARTUS_REALTIME const LayerHaptics& operator[](RegionId region) const noexcept {
    return region != kOutside && region < by_region_.size() ? by_region_[region] : outside_;
  }

 private:
  std::vector<LayerHaptics> by_region_;
  LayerHaptics outside_;
};

}  // namespace artus
