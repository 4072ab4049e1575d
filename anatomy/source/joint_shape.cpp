// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/source/joint_shape.h"

#include <array>
#include <sstream>
#include <string_view>

namespace artus {
namespace {

constexpr std::array<std::string_view, 13> kShapeNothing{
    "title",     "side",   "axes",           "surfaces", "landmark", "probe", "needle",
    "injection", "tissue", "tissue_library", "space",    "pose",     "view"};

}  // namespace

std::string to_joint_shape(toml::table joint) {
  for (const std::string_view key : kShapeNothing) joint.erase(key);
  if (auto* structures = joint.get_as<toml::array>("structure"))
    for (toml::node& node : *structures)
      if (auto* structure = node.as_table()) {
        structure->erase("fibre_axis");
        structure->erase("fibre_course");
      }
  std::ostringstream out;
  out << toml::toml_formatter(joint);
  return out.str();
}

}  // namespace artus
