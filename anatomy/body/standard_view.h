// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/core/result.h"

namespace artus {

struct CompiledJoint;

/// Where in the picture of a standard view a structure lies.
enum class ViewSide { anywhere, left, right };

/// What a standard view must show: a structure whose upper border is met, in the middle of the
/// columns that hold it, so deep below the skin.
struct ViewSight {
  std::string structure;               ///< region name
  double least = 0;                    ///< m below the skin
  double most = 0;                     ///< m
  ViewSide side = ViewSide::anywhere;  ///< on which half of the picture most of it lies
  bool operator==(const ViewSight&) const = default;
};

/// A picture that a published protocol asks for: where the probe stands and what is seen.
struct StandardView {
  std::string name;               ///< [a-z0-9_]+, unique
  std::string title;              ///< one line for people
  std::string source;             ///< of the protocol
  std::string shows;              ///< what it describes, in words
  std::string pose;               ///< how the joint is held; empty: as compiled
  Pose X_JP = Pose::Identity();   ///< the probe, in that pose
  double depth = 0;               ///< m, of the picture; 0: as usual
  std::vector<ViewSight> sights;  ///< by depth, the nearest to the skin first; what has a side
                                  ///< stands beside the others and in no order
};

/// The view of that name. Errors: not_found, with the names there are.
[[nodiscard]] Result<StandardView> find_view(const CompiledJoint& joint, const std::string& name);

/// The view that the joint's default probe stands at; null: none.
[[nodiscard]] const StandardView* view_at_default_probe(const CompiledJoint& joint);

}  // namespace artus
