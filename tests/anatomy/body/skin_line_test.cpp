// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/skin_line.h"

#include <gtest/gtest.h>

namespace artus {
namespace {

TEST(SkinLine, IsMetWhereTheNearestOuterFaceIs) {
  CompiledJoint joint;
  joint.mesh.vertices = {Vec3(-1, -1, 0), Vec3(3, -1, 0), Vec3(-1, 3, 0),
                         Vec3(-1, -1, 2), Vec3(3, -1, 2), Vec3(-1, 3, 2)};
  Interface skin;
  skin.vertices = {0, 1, 2};
  skin.front = kOutside;
  skin.back = kFirstRegion;
  Interface other = skin;
  other.vertices = {3, 4, 5};
  joint.mesh.interfaces = {skin, other};
  EXPECT_NEAR(*find_skin_along(joint, Vec3(0, 0, 0.5), Vec3(0, 0, 1)), -0.5, 1e-12);
  EXPECT_NEAR(*find_skin_along(joint, Vec3(0, 0, 1.5), Vec3(0, 0, 1)), 0.5, 1e-12);
  EXPECT_FALSE(find_skin_along(joint, Vec3(2, 2, 0.5), Vec3(0, 0, 1)));
  EXPECT_EQ(moved_onto_skin(joint, Vec3(2, 2, 0.5), Vec3(0, 0, 1)), Vec3(2, 2, 0.5));
  joint.mesh.interfaces[1].front = kBeyond;
  EXPECT_NEAR(*find_skin_along(joint, Vec3(0, 0, 1.5), Vec3(0, 0, 1)), -1.5, 1e-12);
}

}  // namespace
}  // namespace artus
