// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/nested_ball.h"

#include <utility>
#include <vector>

#include "artus/detail/anatomy/body/layered_body.h"

namespace artus {

Result<std::shared_ptr<const CompiledJoint>> make_nested_ball() {
  auto tissues = read_bundled_tissues();
  ARTUS_TRY(tissues);
  const std::vector<SphereLayer> layers{{"skin", 0.060},   {"muscle", 0.057},    {"bursa", 0.042},
                                        {"tendon", 0.039}, {"cartilage", 0.033}, {"bone", 0.030}};
  CompiledJoint joint = make_nested_spheres(*tissues, layers, Vec3(0, 0, 0.060), 5);
  joint.injections.push_back({"to the centre", Vec3::Zero(), Vec3(0, 0, 0.020)});
  return std::make_shared<const CompiledJoint>(std::move(joint));
}

}  // namespace artus
