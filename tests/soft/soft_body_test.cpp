// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/soft_body.h"

#include <cstring>
#include <memory>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/body/layered_body.h"
#include "artus/detail/soft/cage/tet_locator.h"
#include "artus/detail/soft/solver/cage_vtu.h"
#include "artus/detail/soft/solver/press.h"
#include "tests/support/layered_body.h"
#include "tests/support/meshed_block.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

std::shared_ptr<const CompiledJoint> simple_shoulder() {
  auto joint = read_compiled_joint(test::test_joints() / "simple-shoulder.artus");
  return joint ? std::make_shared<const CompiledJoint>(std::move(*joint)) : nullptr;
}

/// Coarse, so that the tests are quick.
SoftBodyParams quick() {
  SoftBodyParams params;
  params.fine_cell = 6e-3;
  params.near_cell = 6e-3;
  return params;
}

class SoftBodyTest : public testing::Test {
 protected:
  void SetUp() override {
    joint = simple_shoulder();
    ASSERT_NE(joint, nullptr);
  }
  std::shared_ptr<const CompiledJoint> joint;
};

TEST_F(SoftBodyTest, LocatorFindsEachTetrahedronAtItsMiddle) {
  const TetLocator locator(joint->mesh);
  const auto& mesh = joint->mesh;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); t += 97) {
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t v : mesh.tetrahedra[t]) middle += 0.25 * mesh.vertices[v];
    EXPECT_EQ(locator.find(middle), static_cast<std::int64_t>(t));
  }
  EXPECT_EQ(locator.find(Vec3(10, 0, 0)), -1);
  EXPECT_EQ(locator.find(Vec3(std::nan(""), 0, 0)), -1);
}

TEST_F(SoftBodyTest, AFaceThatBeginsInsideTheSkinIsLiftedUntilItHoldsTheForce) {
  auto on_skin = SoftBody::make(joint, joint->X_JP_default, quick());
  auto inside = SoftBody::make(joint, joint->X_JP_default, quick());
  ASSERT_TRUE(on_skin && inside);
  const auto pressed = press_with(*on_skin, joint->X_JP_default, 1.0);
  ASSERT_TRUE(pressed) << pressed.error().to_string();
  constexpr double kDeeper = 3e-3;  // m than where the hand holds 1 N
  Pose X_JP = joint->X_JP_default;
  X_JP.translation() += (pressed->depth + kDeeper) * X_JP.linear().col(2);
  const auto lifted = press_with(*inside, X_JP, 1.0);
  ASSERT_TRUE(lifted) << lifted.error().to_string();
  EXPECT_NEAR(lifted->normal_force, 1.0, 0.005);
  EXPECT_NEAR(lifted->depth, -kDeeper, 0.1e-3);
}

TEST_F(SoftBodyTest, AFaceWithinBoneIsToldSo) {
  auto body = SoftBody::make(joint, joint->X_JP_default, quick());
  ASSERT_TRUE(body);
  Pose X_JP = joint->X_JP_default;
  for (std::size_t t = 0; t < joint->mesh.tetrahedra.size(); ++t) {
    if (!joint->tissue_of(joint->mesh.regions[t]).haptic.hard) continue;
    X_JP.translation() = joint->mesh.vertices[joint->mesh.tetrahedra[t][0]];
    break;
  }
  const auto press = press_with(*body, X_JP, 1.0, 2e-3);
  ASSERT_FALSE(press);
  EXPECT_NE(press.error().to_string().find("not within bone"), std::string::npos)
      << press.error().to_string();
}

TEST_F(SoftBodyTest, PressedJointHoldsTheHandAndItsBonesStay) {
  auto body = SoftBody::make(joint, joint->X_JP_default, quick());
  ASSERT_TRUE(body);
  const auto press = press_with(*body, joint->X_JP_default, 1.0);
  ASSERT_TRUE(press) << press.error().to_string();
  EXPECT_NEAR(press->normal_force, 1.0, 0.005);
  EXPECT_GT(press->depth, 1e-3);
  const Vec3 reaction = body->cage_pose().linear() * body->solver().reaction();
  EXPECT_LT((reaction - press->contact.force).norm(), 1e-3);
  const auto snapshot = body->snapshot();
  const auto vertices = snapshot->vertices();
  const auto& mesh = joint->mesh;
  double most = 0;
  for (const Interface& i : mesh.interfaces) {
    for (const std::uint32_t v : i.vertices)
      most = std::max(most, (vertices[v] - mesh.vertices[v]).norm());
  }
  EXPECT_GT(most, 0.5 * press->depth);
  // Deep inside a bone, one cube from its surface, nothing moves.
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); t += 53) {
    if (!joint->tissue_of(mesh.regions[t]).haptic.hard) continue;
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t v : mesh.tetrahedra[t]) middle += 0.25 * mesh.vertices[v];
    EXPECT_LT(snapshot->displacement(middle).norm(), 0.25 * press->depth);
  }
}

TEST_F(SoftBodyTest, AnotherCageGoesOnFromWhereTheTissueIs) {
  auto one = SoftBody::make(joint, joint->X_JP_default, quick());
  ASSERT_TRUE(one);
  Pose X_JP = joint->X_JP_default;
  X_JP.translation() += 4e-3 * X_JP.linear().col(2);
  ASSERT_TRUE(one->settle(X_JP));
  const double held = one->force_J().force.norm();
  ASSERT_GT(held, 0.5);
  Pose X_JC = joint->X_JP_default;  // cubes elsewhere, by no whole number of them
  X_JC.translation() += 8.3e-3 * X_JC.linear().col(0);
  auto other = SoftBody::make(joint, X_JC, quick());
  auto from_rest = SoftBody::make(joint, X_JC, quick());
  ASSERT_TRUE(other && from_rest);
  const auto before = one->snapshot();
  other->follow(*before);
  const Vec3 below = X_JP * Vec3(0, 0, 6e-3);
  EXPECT_LT((other->snapshot()->displacement(below) - before->displacement(below)).norm(), 0.2e-3);
  double least = held;
  for (int k = 0; k < 6; ++k) {
    other->step(X_JP, 1 / 60.0);
    least = std::min(least, other->force_J().force.norm());
  }
  EXPECT_GT(least, 0.8 * held);
  EXPECT_NEAR(other->force_J().force.norm(), held, 0.2 * held);
  from_rest->step(X_JP, 1 / 60.0);
  EXPECT_GT(std::abs(from_rest->force_J().force.norm() - held), 0.5 * held) << "what it was";
}

TEST_F(SoftBodyTest, InverseMapUndoesTheForwardMap) {
  auto body = SoftBody::make(joint, joint->X_JP_default, quick());
  ASSERT_TRUE(body);
  static_cast<void>(press_by(*body, joint->X_JP_default, 4e-3));
  const auto snapshot = body->snapshot();
  const auto vertices = snapshot->vertices();
  const auto& mesh = joint->mesh;
  for (std::size_t v = 0; v < vertices.size(); v += 41) {
    const auto rest = snapshot->to_rest(vertices[v]);
    if (!rest.found) continue;
    EXPECT_LT((rest.p_rest - mesh.vertices[v]).norm(), 5e-6);
    EXPECT_NEAR(snapshot->rotation(rest.p_rest).determinant(), 1, 1e-9);
  }
  const CompiledJoint moved = snapshot->moved_joint();
  EXPECT_EQ(moved.mesh.vertices[3], vertices[3]);
}

TEST_F(SoftBodyTest, BoneThatTurnsTakesTheTissueWithItAndOthersStay) {
  auto body = SoftBody::make(joint, joint->X_JP_default, quick());
  ASSERT_TRUE(body);
  EXPECT_EQ(body->move_bones(std::vector<BoneMotion>{{"no such bone", {}}}).error().code,
            ErrorCode::not_found);
  // The bone deepest under the probe, about the beam through its middle tetrahedron.
  const auto& mesh = joint->mesh;
  const auto middle_of = [&](std::size_t t) {
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t v : mesh.tetrahedra[t]) middle += 0.25 * mesh.vertices[v];
    return middle;
  };
  const Pose X_PJ = joint->X_JP_default.inverse();
  std::string bone;
  Vec3 centre = Vec3::Zero();
  double nearest = 1;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (!joint->tissue_of(mesh.regions[t]).haptic.hard) continue;
    const double distance = (X_PJ * middle_of(t)).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    bone = joint->regions[mesh.regions[t]].name;
    centre = middle_of(t);
  }
  BoneMotion motion{bone, Pose::Identity()};
  motion.X_J.linear() = Eigen::AngleAxisd(0.1, joint->X_JP_default.linear().col(2)).matrix();
  motion.X_J.translation() = centre - motion.X_J.linear() * centre + Vec3(3e-4, 0, 0);
  const auto moved = body->move_bones(std::vector<BoneMotion>{motion}, 4);
  ASSERT_TRUE(moved) << moved.error().to_string();
  const auto snapshot = body->snapshot();
  // A node of the cage within the bone is where the bone is.
  const auto& map = snapshot->map();
  const TetLocator locator(mesh);
  int inside = 0;
  for (std::uint32_t n = 0; n < map.model->cage().nodes().size(); ++n) {
    const Vec3 p = map.X_JC * map.model->cage().nodes()[n];
    const std::int64_t tet = locator.find(p);
    if (inside >= 5) break;
    if (tet < 0 || !map.model->held(n).all()) continue;
    if (joint->regions[mesh.regions[static_cast<std::size_t>(tet)]].name != bone) continue;
    ++inside;
    const Vec3 u = map.X_JC.linear() * snapshot->node_displacements()[n];
    EXPECT_LT((p + u - motion.X_J * p).norm(), 1e-9);
  }
  EXPECT_EQ(inside, 5);
  double most = 0;
  const auto vertices = snapshot->vertices();
  for (std::size_t v = 0; v < vertices.size(); ++v)
    most = std::max(most, (vertices[v] - mesh.vertices[v]).norm());
  EXPECT_GT(most, 2e-4);
  EXPECT_LT(most, 0.1 * 0.08);
}

TEST_F(SoftBodyTest, UntouchedBodyIsTheJointItself) {
  auto body = SoftBody::make(joint, joint->X_JP_default, quick());
  ASSERT_TRUE(body);
  body->step(std::nullopt, 1.0 / 60);
  const auto vertices = body->snapshot()->vertices();
  EXPECT_EQ(
      std::memcmp(vertices.data(), joint->mesh.vertices.data(), vertices.size() * sizeof(Vec3)), 0);
}

TEST_F(SoftBodyTest, CageIsWrittenForParaview) {
  auto body = SoftBody::make(joint, joint->X_JP_default, quick());
  ASSERT_TRUE(body);
  const auto file = std::filesystem::temp_directory_path() / "artus_cage_test.vtu";
  ASSERT_TRUE(write_vtu(*body->snapshot(), file));
  EXPECT_GT(std::filesystem::file_size(file), 10000U);
  std::filesystem::remove(file);
  EXPECT_FALSE(write_vtu(*body->snapshot(), "/dev/null/cage.vtu"));
}

TEST_F(SoftBodyTest, PoseBesideTheBodyIsRefused) {
  Pose away = joint->X_JP_default;
  away.translation() -= 0.3 * away.linear().col(2);
  EXPECT_FALSE(SoftBody::make(joint, away, quick()));
}

// A finger is as thick as the face is wide: with the skin of its palm among what may be pressed,
// two thirds of all nodes were solved as one dense matrix.
TEST(SoftBody, TheOtherSideOfAThinLimbIsNotPressed) {
  const std::array<FlatLayer, 5> layers{
      {{"skin", 2e-3}, {"muscle", 3.5e-3}, {"bone", 7e-3}, {"muscle", 3.5e-3}, {"skin", 2e-3}}};
  const auto limb =
      std::make_shared<const CompiledJoint>(test::make_meshed_block(layers, 60e-3, 24e-3, 2e-3));
  const auto body = SoftBody::make(limb, Pose::Identity(), quick());
  ASSERT_TRUE(body) << body.error().to_string();
  const auto places = body->solver().model().unknown_places();
  const auto root = body->solver().factor().root_nodes();
  ASSERT_FALSE(root.empty());
  for (const std::uint32_t n : root) EXPECT_LE(places[n].z(), 6e-3 + 1e-9);
}

TEST(SoftBody, BodyWithoutTetrahedraIsRefused) {
  const std::array<FlatLayer, 1> layers{{{"fat", 30e-3}}};
  const auto block =
      std::make_shared<const CompiledJoint>(test::make_layered_block(layers, 60e-3, 60e-3));
  const auto body = SoftBody::make(block, Pose::Identity());
  ASSERT_FALSE(body);
  EXPECT_EQ(body.error().code, ErrorCode::invalid);
}

TEST(SoftBody, ABodyThatNothingHoldsIsRefusedAndOneOnATableIsNot) {
  const std::array<FlatLayer, 2> layers{{{"skin", 2e-3}, {"muscle", 30e-3}}};
  CompiledJoint loose = test::make_meshed_block(layers, 0.06, 0.06, 4e-3);
  const auto refused =
      SoftBody::make(std::make_shared<const CompiledJoint>(loose), loose.X_JP_default);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("nothing holds the tissue"), std::string::npos);
  stand_on_table(loose);
  auto body = SoftBody::make(std::make_shared<const CompiledJoint>(loose), loose.X_JP_default);
  ASSERT_TRUE(body) << body.error().to_string();
  const auto pressed = press_by(*body, loose.X_JP_default, 1e-3);
  EXPECT_TRUE(pressed.settled);
  EXPECT_GT(pressed.normal_force, 0.05);
}

}  // namespace
}  // namespace artus
