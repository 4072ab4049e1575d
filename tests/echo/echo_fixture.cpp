// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/echo/echo_fixture.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/check.h"

namespace artus::test {

std::shared_ptr<const Scene> make_block_scene(std::span<const FlatLayer> layers,
                                              const std::function<void(CompiledJoint&)>& change) {
  auto joint = std::make_shared<CompiledJoint>(make_layered_block(layers, 80e-3, 60e-3));
  if (change) change(*joint);
  return std::make_shared<Scene>(joint);
}

Acoustic& acoustic_of(CompiledJoint& joint, const std::string& tissue) {
  const auto found = std::find_if(joint.tissues.begin(), joint.tissues.end(),
                                  [&](const Tissue& t) { return t.name == tissue; });
  ARTUS_REQUIRE(found != joint.tissues.end(), "no such tissue");
  return found->acoustic;
}

Pose probe_at(double x, double y, double z) {
  return make_pose(Vec3(x, y, z), Vec3::UnitZ(), Vec3::UnitX());
}

NeedleView needle_at(const Pose& X_JP, const Vec3& tip_P, double angle) {
  NeedleView needle;
  const Vec3 along(std::cos(angle), 0, std::sin(angle));
  needle.X_JN = X_JP * make_pose(tip_P, along, Vec3::UnitY());
  return needle;
}

}  // namespace artus::test
