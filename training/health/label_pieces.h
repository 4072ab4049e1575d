// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/echo/labels.h"

namespace artus {

/// What regions that hold liquid are named in a label picture when they are looked at as one:
/// spaces, and liquid that parts tissue.
inline constexpr RegionId kLiquidRegion = 0xffff;
inline constexpr RegionId kPartedRegion = 0xfffe;

/// Gives the regions that hold liquid (by RegionId) one name: kPartedRegion where it parts tissue
/// (`is_parted` of all regions), else kLiquidRegion.
void join_liquid(LabelImage& labels, const std::vector<bool>& liquid,
                 const std::vector<bool>& is_parted);

/// The pixels of a label picture that count, columns and rows; the rest is a margin, in which what
/// looks like pieces may hang together.
struct LabelWindow {
  int left = 0;
  int right = 0;  ///< one past the last
  int top = 0;
  int bottom = 0;  ///< one past the last
};

/// How the regions of a label picture lie.
struct RegionLayout {
  std::map<RegionId, int> pieces;  ///< that hang together, by edges of pixels; liquid that parts
                                   ///< tissue between them counts as theirs
  std::map<std::pair<RegionId, RegionId>, double> contacts;  ///< m along which two touch; smaller
                                                             ///< id first

  /// Takes up what there is more of in another: a picture's neighbour, from which tissue may come.
  void add(const RegionLayout& other);
  /// The same of who touches whom alone.
  void add_contacts(const RegionLayout& other);
};

/// Pieces that have at least `min_area` m^2 in the window, and who touches whom in it. Cost:
/// linear in pixels.
[[nodiscard]] RegionLayout find_layout(const LabelImage& labels, const LabelWindow& window,
                                       double min_area);

/// What is otherwise than before, in words: "deltoid 1 -> 3".
struct LayoutChange {
  int fragments = 0;   ///< pieces of tissue more than before, of all regions
  int neighbours = 0;  ///< pairs that touch along 3 mm or more and did not before (0.3 mm)
  std::string which_fragments;
  std::string which_neighbours;
};

/// `names`: of the regions after. `parted`: regions that liquid parts, which may touch it; such
/// liquid may touch what lies beside them, too, but bone and skin. kOutside, kBeyond and what is
/// liquid has no fragments.
[[nodiscard]] LayoutChange compare_layouts(const RegionLayout& before, const RegionLayout& after,
                                           const CompiledJoint& names,
                                           const std::vector<bool>& parted);

}  // namespace artus
