// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/raycast/moving_scene.h"

#include <array>
#include <cmath>
#include <cstring>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/raycast/plane_cache.h"
#include "artus/detail/raycast/pressed_scene.h"
#include "tests/raycast/brute_force.h"
#include "tests/support/moved_block.h"

namespace artus {
namespace {

constexpr std::array<double, 4> kBorders{0, 3e-3, 9e-3, 39e-3};  // m

test::MovedBlock make_block() {
  const std::array<test::FlatLayer, 3> layers{{{"skin", 3e-3}, {"fat", 6e-3}, {"muscle", 30e-3}}};
  return test::make_moved_block(layers);
}

/// A dent under a face, along z alone.
Vec3 dent(const Vec3& p) {
  const double aside = p.head<2>().squaredNorm() / (2 * 0.01 * 0.01);
  return {0, 0, 5e-3 * std::exp(-aside) * (1 - p.z() / kBorders[3])};
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

/// Everything that intervals tell.
std::vector<double> numbers_of(const std::vector<TissueInterval>& intervals) {
  std::vector<double> out;
  for (const TissueInterval& k : intervals) {
    for (const double value :
         {k.entry, k.exit, static_cast<double>(k.region), k.entry_normal.x(), k.entry_normal.y(),
          k.entry_normal.z(), static_cast<double>(k.entry_interface)})
      out.push_back(value);
  }
  return out;
}

/// Every answer of a scene to lines and points from a fixed sequence.
std::vector<double> answers(const Scene& scene) {
  std::vector<double> out;
  for (std::uint64_t i = 0; i < 400; ++i) {
    const Vec3 a = test::random_point(1, i, Vec3(0, 0, 0.015), 0.06);
    const Vec3 b = test::random_point(2, i, Vec3(0, 0, 0.015), 0.06);
    const std::vector<double> met = numbers_of(tissue_intervals(scene, {a, b}));
    out.insert(out.end(), met.begin(), met.end());
    out.push_back(scene.region_at(a));
    out.push_back(scene.signed_distance_to_skin(a, 0.02));
    const NearestInterface nearest = scene.find_nearest(a, 0.02);
    out.push_back(nearest.distance);
    out.push_back(nearest.interface);
  }
  return out;
}

TEST(MovingScene, KnowsHowItsInterfacesFacedAtRest) {
  const test::MovedBlock block = make_block();
  const auto scene = make_scene(block.moved(dent));
  const std::vector<TissueInterval> found =
      tissue_intervals(*scene, {Vec3(7e-3, 1e-3, -0.02), Vec3(7e-3, 1e-3, 0.03)});
  ASSERT_GE(found.size(), 3U);
  for (std::size_t k = 1; k < 3; ++k) {
    const Vec3 at_rest = scene->normal_at_rest(found[k].entry_interface);
    EXPECT_NEAR(std::abs(at_rest.z()), 1, 1e-12) << k;
    EXPECT_LT(std::abs(found[k].entry_normal.z()), 0.99) << k;
  }
}

TEST(MovingScene, HitsAnInterfaceAtTheDisplacedVertex) {
  const test::MovedBlock block = make_block();
  const auto scene = make_scene(block.moved(dent));
  std::size_t n = 0;
  for (double x = -21e-3; x < 22e-3; x += 3e-3) {
    for (double y = -6e-3; y < 7e-3; y += 3e-3) {
      // a micrometre beside the vertex, so that the line is through one of its triangles
      const Vec3 start(x + 1e-9, y + 2e-9, -0.02);
      const auto found = tissue_intervals(*scene, {start, start + Vec3(0, 0, 0.08)});
      ASSERT_EQ(found.size(), 5U);
      for (std::size_t k = 0; k < 4; ++k) {
        const Vec3 at_rest(x, y, kBorders[k]);
        EXPECT_NEAR(start.z() + found[k + 1].entry, (at_rest + dent(at_rest)).z(), 1e-6);
        ++n;
      }
    }
  }
  EXPECT_EQ(n, 15U * 5U * 4U);
}

TEST(MovingScene, AnswersAtRestWithTheBytesOfTheRigidScene) {
  const test::MovedBlock block = make_block();
  const auto rigid = answers(Scene(block.joint));
  MovingScene scenes;
  EXPECT_TRUE(same_bytes(answers(*scenes.at(block.at_rest())), rigid));
  EXPECT_FALSE(same_bytes(answers(*scenes.at(block.moved(dent))), rigid));
  EXPECT_TRUE(same_bytes(answers(*scenes.at(block.at_rest())), rigid)) << "and back again";
}

TEST(MovingScene, AnswersAsASceneBuiltOfTheMovedSurfaces) {
  const test::MovedBlock block = make_block();
  const auto body = block.moved(dent);
  const auto moved = answers(*make_scene(body));
  const auto built = answers(Scene(std::make_shared<const CompiledJoint>(body->moved_joint())));
  ASSERT_EQ(moved.size(), built.size());
  for (std::size_t i = 0; i < moved.size(); ++i)
    EXPECT_TRUE(moved[i] == built[i] || std::abs(moved[i] - built[i]) < 1e-9)  // infinite, or near
        << i << ": " << moved[i] << ", " << built[i];
}

TEST(MovingScene, AnswersWithTheSameBytesWithAndWithoutACacheOfPlanes) {
  const test::MovedBlock block = make_block();
  MovingScene scenes;
  PlaneCache planes;
  std::size_t found = 0;
  // One cache for states of which each moves what was in it, and for one at rest.
  for (const double much : {1.0, 0.4, 0.0, 1.0}) {
    planes.forget();
    const auto scene = scenes.at(block.moved([&](const Vec3& p) { return Vec3(much * dent(p)); }));
    for (std::uint64_t i = 0; i < 200; ++i) {
      const Vec3 a = test::random_point(1, i / 4, Vec3(0, 0, 0.015), 0.06);
      const Vec3 b = test::random_point(2, i, Vec3(0, 0, 0.015), 0.06);
      const std::vector<TissueInterval> plain = tissue_intervals(*scene, {a, b});
      std::vector<TissueInterval> kept(plain.size() + 1);
      kept.resize(scene->find_intervals({a, b}, kept, &planes).size);
      ASSERT_TRUE(same_bytes(numbers_of(plain), numbers_of(kept))) << much << ", line " << i;
      found += kept.size();
    }
  }
  EXPECT_GT(found, 2000U);
}

TEST(MovingScene, FollowsWhatMovesInOnePlaceAfterAnother) {
  const test::MovedBlock block = make_block();
  MovingScene scenes;
  const Scene* same = nullptr;
  for (const double place : {-30e-3, 33e-3, 12e-3}) {  // each lets the one before come back to rest
    const auto body = block.moved([&](const Vec3& p) {
      const double aside = (p - Vec3(place, -place, p.z())).norm();
      return aside < 12e-3 ? Vec3(0.4 * dent({aside, 0, p.z()})) : Vec3(Vec3::Zero());
    });
    const auto scene = scenes.at(body);
    EXPECT_TRUE(same == nullptr || same == scene.get());
    same = scene.get();
    const auto moved = answers(*scene);
    const auto built = answers(Scene(std::make_shared<const CompiledJoint>(body->moved_joint())));
    ASSERT_EQ(moved.size(), built.size());
    for (std::size_t i = 0; i < moved.size(); ++i)
      EXPECT_TRUE(moved[i] == built[i] || std::abs(moved[i] - built[i]) < 1e-9)
          << place << ", " << i << ": " << moved[i] << ", " << built[i];
  }
}

/// The block with its fat swollen in the middle: the same surfaces between other vertices.
std::shared_ptr<const CompiledJoint> swollen(const CompiledJoint& block) {
  auto joint = std::make_shared<CompiledJoint>(block);
  for (Vec3& p : joint->mesh.vertices)
    if (std::abs(p.z() - kBorders[1]) < 1e-6) p.z() -= 0.3 * dent(p).z();
  return joint;
}

TEST(MovingScene, HasOneIndexForShapesOfTheSameSurfaces) {
  const test::MovedBlock block = make_block();
  const auto joint = swollen(*block.joint);
  const auto body = block.moved(dent);
  const auto map = make_body_map(*joint, std::array{body->mapped()});
  ASSERT_EQ(map->first.map, block.map);
  const auto shape =
      std::make_shared<const DeformedBody>(joint, map, body->node_displacements(), body->contact());
  const auto alone = make_scene(std::make_shared<const DeformedBody>(
      joint, make_body_map(*joint, Pose::Identity(), block.map->model), body->node_displacements(),
      body->contact()));
  MovingScene scenes;
  const Scene* first = scenes.at(body).get();
  const auto scene = scenes.at(shape);
  EXPECT_EQ(scene.get(), first);
  EXPECT_EQ(scene->shared_joint(), joint);
  const auto wanted = answers(*alone);
  const auto found = answers(*scene);
  EXPECT_GT(wanted.size(), 4000U);
  EXPECT_TRUE(same_bytes(found, wanted));
  EXPECT_FALSE(same_bytes(found, answers(*make_scene(body))));
  for (std::uint32_t i = 0; i < joint->mesh.interfaces.size(); ++i)
    ASSERT_LT((scene->normal_at_rest(i) - alone->normal_at_rest(i)).norm(), 1e-12) << i;
  // A shape of a shape is one of what that was a shape of.
  EXPECT_EQ(make_body_map(*block.joint, std::array{shape->mapped()})->first.map, block.map);
}

/// What an index keeps of surfaces at rest is that of the first, moved or not, and stays when its
/// owner is gone.
TEST(MovingScene, AnswersTheSameWhereItSharesAnothersSurfaces) {
  const test::MovedBlock block = make_block();
  const auto dented = block.moved(dent);
  const std::vector<double> alone = answers(*make_scene(dented));
  MovingScene sharing;
  {
    const auto other = make_scene(dented);
    sharing.share(*other);
  }
  const auto first = sharing.at(dented);
  const auto second = sharing.at(block.moved([](const Vec3&) { return Vec3(0, 0, 0); }));
  EXPECT_TRUE(same_bytes(answers(*first), alone));
  EXPECT_TRUE(same_bytes(answers(*second), answers(Scene(dented->shared_joint()))));
  EXPECT_EQ(first->normal_at_rest(0), second->normal_at_rest(0));
}

/// When it is done changes no byte: it takes what is shared, and leaves another body's scenes
/// alone.
TEST(MovingScene, MadeAheadItGivesWhatItWouldHaveMade) {
  const test::MovedBlock block = make_block();
  const std::array<test::FlatLayer, 2> layers{{{"skin", 4e-3}, {"fat", 20e-3}}};
  const test::MovedBlock other = test::make_moved_block(layers);
  const auto shared = make_scene(block.moved(dent));
  MovingScene scenes;
  scenes.make_ahead(block.at_rest(), 2);  // nothing is shared yet
  scenes.share(*shared);
  scenes.make_ahead(block.at_rest(), 2);
  const auto first = scenes.at(block.moved(dent));
  scenes.make_ahead(other.at_rest(), 2);
  const auto second = scenes.at(block.at_rest());
  MovingScene plain;
  plain.share(*shared);
  EXPECT_TRUE(same_bytes(answers(*first), answers(*plain.at(block.moved(dent)))));
  EXPECT_TRUE(same_bytes(answers(*second), answers(*plain.at(block.at_rest()))));
}

/// Of another body nothing is shared, though it was offered.
TEST(MovingScene, SharesNothingWithAnotherBody) {
  const test::MovedBlock block = make_block();
  const std::array<test::FlatLayer, 2> layers{{{"skin", 4e-3}, {"fat", 20e-3}}};
  const test::MovedBlock other = test::make_moved_block(layers);
  MovingScene scenes;
  scenes.share(*make_scene(other.moved(dent)));
  const auto moved = block.moved(dent);
  EXPECT_TRUE(same_bytes(answers(*scenes.at(moved)), answers(*make_scene(moved))));
}

TEST(MovingScene, HasAnotherIndexForOtherSurfaces) {
  const test::MovedBlock block = make_block();
  CompiledJoint other = *block.joint;
  other.mesh.interfaces.pop_back();
  const MappedJoint whole = block.at_rest()->mapped();
  const auto own = make_body_map(other, std::array{whole});
  EXPECT_EQ(own->first.map, nullptr);
  const auto shared_other = std::make_shared<const CompiledJoint>(other);
  EXPECT_EQ(make_body_map(other, std::array{whole, MappedJoint{shared_other, own}})->first.map, own)
      << "one of several has them";
  // A vertex that no group has moved, as one outside the cage would.
  BodyMap cut = *block.map;
  const std::uint32_t lost = cut.groups.back().vertices.back();
  cut.group_of[lost] = static_cast<std::uint32_t>(cut.groups.size());
  const DeformedBody without(block.joint, std::make_shared<const BodyMap>(cut),
                             block.at_rest()->node_displacements(), ContactForce{});
  CompiledJoint shape = *block.joint;
  EXPECT_NE(make_body_map(shape, std::array{without.mapped()})->first.map, nullptr);
  shape.mesh.vertices[lost].x() += 1e-3;
  EXPECT_EQ(make_body_map(shape, std::array{without.mapped()})->first.map, nullptr);
}

TEST(MovingScene, LeavesASceneAloneWhileItIsHeldAndUsesItAgainAfterwards) {
  const test::MovedBlock block = make_block();
  MovingScene scenes;
  const auto held = scenes.at(block.moved(dent));
  const auto before = answers(*held);
  const Scene* another = nullptr;
  {
    const auto second = scenes.at(block.at_rest());
    EXPECT_NE(second, held);
    another = second.get();
  }
  EXPECT_EQ(scenes.at(block.moved([](const Vec3& p) { return Vec3(0.5 * dent(p)); })).get(),
            another);
  EXPECT_TRUE(same_bytes(answers(*held), before));
  EXPECT_EQ(held->tissue()->shared_joint(), block.joint);
}

TEST(MovingScene, MadeReadyItHasAllThreeThatGoRound) {
  const test::MovedBlock block = make_block();
  MovingScene scenes;
  std::set<const Scene*> ready;
  std::shared_ptr<const Scene> drawn;
  for (auto& scene : scenes.make_ready(block.at_rest())) {
    ready.insert(scene.get());
    drawn = std::move(scene);
  }
  EXPECT_EQ(ready.size(), 3U);
  std::shared_ptr<const Scene> before;
  for (int i = 0; i < 6; ++i) {  // one is made while one is drawn and one was
    auto made = scenes.at(i % 2 == 0 ? block.moved(dent) : block.at_rest());
    EXPECT_TRUE(ready.contains(made.get())) << i;
    EXPECT_NE(made, drawn);
    EXPECT_NE(made, before);
    before = std::move(drawn);
    drawn = std::move(made);
  }
  const auto third = scenes.at(block.at_rest());
  EXPECT_FALSE(ready.contains(scenes.at(block.at_rest()).get())) << "a fourth is another";
}

TEST(MovingScene, WhoKeepsOneWaitsForNoneWhenThatWasSaid) {
  const test::MovedBlock block = make_block();
  MovingScene scenes;
  std::set<const Scene*> ready;
  for (const auto& scene : scenes.make_ready(block.at_rest(), MovingScene::kGoingRound + 1))
    ready.insert(scene.get());
  EXPECT_EQ(ready.size(), 4U);
  const auto kept = scenes.at(block.at_rest());
  std::vector<std::shared_ptr<const Scene>> round;
  for (int i = 0; i < 6; ++i) {
    round.push_back(scenes.at(block.moved(dent)));
    EXPECT_TRUE(ready.contains(round.back().get())) << i;
    if (round.size() == 3) round.erase(round.begin());
  }
}

TEST(MovingScene, OutlivesItsMaker) {
  const test::MovedBlock block = make_block();
  std::shared_ptr<const Scene> scene;
  {
    MovingScene scenes;
    scene = scenes.at(block.moved(dent));
  }
  EXPECT_EQ(scene->region_at({0, 0, 4e-3}), kOutside) << "in the dent";
}

TEST(PressedScene, RefusesABodyWithoutTetrahedraAndAPressOfBothKinds) {
  const auto empty = std::make_shared<const CompiledJoint>();
  const auto pressed = press_scene(empty, Pose::Identity(), {1e-3, {}});
  ASSERT_FALSE(pressed);
  EXPECT_EQ(pressed.error().code, ErrorCode::invalid);
  EXPECT_THROW(static_cast<void>(press_scene(empty, Pose::Identity(), {1e-3, 1.0})),
               std::invalid_argument);
}

}  // namespace
}  // namespace artus
