// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/source/joint_view_toml.h"

#include <algorithm>
#include <set>

#include "artus/detail/anatomy/source/joint_pose_toml.h"
#include "artus/detail/core/known_names.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kDeepestPicture = 0.3;  // m

using Names = std::set<std::string, std::less<>>;

/// Two numbers, the least first, m below the skin.
void read_depths(TomlTable& see, double unit, ViewSight& sight) {
  const toml::array* depths = see.array("depth");
  if (depths == nullptr || depths->size() != 2) {
    see.problem_at("depth", "must be two numbers: least and most below the skin");
    return;
  }
  sight.least = unit * depths->get(0)->value_or(-1.0);
  sight.most = unit * depths->get(1)->value_or(-1.0);
  if (!(sight.least >= 0 && sight.most > sight.least && sight.most <= kDeepestPicture))
    see.problem_at("depth", "must be two numbers, 0 at least, the greater one second");
}

ViewSight read_sight(TomlTable& see, double unit, const Names& structures) {
  ViewSight sight;
  sight.structure = see.required_text("structure");
  if (!sight.structure.empty() && structures.count(sight.structure) == 0)
    see.problem_at("structure", "there is no structure '" + sight.structure + "'" +
                                    did_you_mean(sight.structure, structures));
  read_depths(see, unit, sight);
  const std::string side = see.text("side").value_or("anywhere");
  if (side == "left")
    sight.side = ViewSide::left;
  else if (side == "right")
    sight.side = ViewSide::right;
  else if (side != "anywhere")
    see.problem_at("side", "must be \"left\", \"right\" or \"anywhere\"");
  see.finish();
  return sight;
}

StandardView read_view(TomlTable& toml, const std::string& name, double unit,
                       const Names& structures, const JointFile& joint) {
  StandardView view;
  view.name = name;
  if (!is_plain_name(name, '_')) toml.problem("its name may contain only a-z, 0-9 and _");
  view.title = toml.required_text("title");
  view.source = toml.required_text("source");
  view.shows = toml.required_text("shows");
  view.pose = toml.text("pose").value_or("");
  const bool is_pose =
      view.pose.empty() || std::any_of(joint.poses.begin(), joint.poses.end(),
                                       [&](const JointPose& p) { return p.name == view.pose; });
  if (!is_pose) toml.problem_at("pose", "there is no [pose." + view.pose + "]");
  view.depth = toml.number("depth", 0, kDeepestPicture / unit, unit).value_or(0);
  if (const auto* t = toml.table("probe")) {
    TomlTable probe(*t, toml.what() + " probe", toml.problems());
    view.X_JP = read_probe_pose(probe, unit).value_or(Pose::Identity());
  } else {
    toml.problem("needs its [view." + name + ".probe]");
  }
  for (const auto* t : toml.tables("see")) {
    TomlTable see(*t, toml.what() + " see", toml.problems());
    view.sights.push_back(read_sight(see, unit, structures));
  }
  toml.finish();
  return view;
}

}  // namespace

std::vector<StandardView> read_views(TomlTable& toml, double unit, const JointFile& joint) {
  std::vector<StandardView> views;
  const auto* all = toml.table("view");
  if (all == nullptr) return views;
  Names structures{joint.filler_name};
  for (const Structure& s : joint.structures) structures.insert(s.name);
  TomlTable named(*all, "view", toml.problems());
  for (const auto& [key, node] : *all) {
    const std::string name(key.str());
    if (const auto* table = named.table(name)) {
      TomlTable view(*table, "view '" + name + "'", toml.problems());
      views.push_back(read_view(view, name, unit, structures, joint));
    }
  }
  named.finish();
  return views;
}

}  // namespace artus
