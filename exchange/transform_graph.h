// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/core/result.h"
#include "artus/detail/exchange/igtl/contents.h"

namespace artus {

/// "ProbeToTracker" as Probe and Tracker: at the last "To" before a capital letter. nullopt when
/// there is none, or nothing on one side of it.
[[nodiscard]] std::optional<std::pair<std::string, std::string>> frames_of_transform(
    std::string_view name);

/// The transforms that one instant of a tracker's recording has, each from one frame to another,
/// and what follows of them: ProbeToReference of ProbeToTracker and ReferenceToTracker.
class TransformGraph {
 public:
  /// A matrix in millimetres; a second one of the name replaces it. Names without "To" are passed
  /// over. Whether it is rigid is asked only of those on the way.
  void set(std::string_view name, const igtl::Matrix& matrix);
  [[nodiscard]] bool knows(std::string_view frame) const;
  /// `from` in `to` by the fewest transforms, against their direction where need be; nullopt when
  /// no way leads there. Errors: invalid, a matrix on the way is not rigid, naming it.
  /// `given`: gets the orientation by the matrices as they are, each a little off a rotation as its
  /// digits leave it.
  [[nodiscard]] Result<std::optional<Pose>> find(std::string_view from, std::string_view to,
                                                 Eigen::Matrix3d* given = nullptr) const;

 private:
  struct Edge {
    std::string to;
    std::string name;
    igtl::Matrix matrix;
    bool forward = true;
  };
  std::map<std::string, std::vector<Edge>, std::less<>> edges_;
};

/// Probe and needle of one instant by the names that are asked for.
struct FoundHands {
  std::optional<Pose> probe;
  std::optional<Pose> needle;
  std::string probe_name;   ///< what was taken, "Probe in Tracker"; empty: what was asked for
  std::string needle_name;  ///< the same
  Eigen::Matrix3d probe_given = Eigen::Matrix3d::Identity();   ///< orientation, as find gives it
  Eigen::Matrix3d needle_given = Eigen::Matrix3d::Identity();  ///< the same
};

/// Looks for the two transforms that `probe` and `needle` name; where the file has no such frame,
/// for the needle also NeedleTip, StylusTip and Stylus, and Tracker where Reference does not occur.
/// Errors: as TransformGraph::find.
[[nodiscard]] Result<FoundHands> find_hands(const TransformGraph& graph, const std::string& probe,
                                            const std::string& needle);

}  // namespace artus
