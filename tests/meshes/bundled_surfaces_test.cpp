// SPDX-License-Identifier: AGPL-3.0-or-later
// The committed surface files of the generated joints: sound, small, and the generator's own.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "artus/detail/core/units.h"
#include "artus/detail/meshes/generate/ankle.h"
#include "artus/detail/meshes/generate/elbow.h"
#include "artus/detail/meshes/generate/hip.h"
#include "artus/detail/meshes/generate/knee.h"
#include "artus/detail/meshes/generate/person.h"
#include "artus/detail/meshes/generate/shoulder.h"
#include "artus/detail/meshes/generate/simple_shoulder.h"
#include "artus/detail/meshes/generate/wrist.h"
#include "tests/meshes/topology.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

const std::filesystem::path kMeshes = artus::test::source_dir() / "meshes";

struct Bundled {
  std::filesystem::path file;
  Solid solid;
  SurfaceMesh mesh;
};

std::vector<Bundled> read_bundled() {
  std::vector<Bundled> all;
  const auto add = [&](const char* joint, const std::vector<Solid>& solids) {
    for (const Solid& solid : solids) {
      const auto file = kMeshes / joint / "surfaces" / (solid.name + ".ply");
      auto mesh = read_surface(file, kMillimetre);
      EXPECT_TRUE(mesh) << mesh.error().to_string();
      if (mesh) all.push_back({file, solid, std::move(*mesh)});
    }
  };
  add("simple-shoulder", make_simple_shoulder({}));
  add("shoulder", make_shoulder({}));
  add("knee", make_knee({}));
  add("hip", make_hip({}));
  add("elbow", make_elbow({}));
  add("wrist", make_wrist({}));
  add("ankle", make_ankle({}));
  add("person", make_person());
  return all;
}

TEST(BundledSurfaces, EachIsClosedManifoldOutwardAndFreeOfSelfIntersections) {
  for (const Bundled& b : read_bundled()) {
    const Topology topology = compute_topology(b.mesh);
    EXPECT_TRUE(topology.manifold) << b.file;
    EXPECT_TRUE(topology.closed) << b.file;
    EXPECT_TRUE(topology.outward) << b.file;
    EXPECT_FALSE(topology.self_intersecting) << b.file;
  }
}

TEST(BundledSurfaces, EachLiesOnTheGeneratorsSolid) {
  for (const Bundled& b : read_bundled()) {
    double worst_corner = 0;
    for (const Vec3& v : b.mesh.vertices) {
      worst_corner = std::max(worst_corner, std::abs(b.solid.field(v)));
    }
    double worst_middle = 0;
    for (const Triangle& t : b.mesh.triangles) {
      const Vec3 middle =
          (b.mesh.vertices[t[0]] + b.mesh.vertices[t[1]] + b.mesh.vertices[t[2]]) / 3;
      worst_middle = std::max(worst_middle, std::abs(b.solid.field(middle)));
    }
    // The field of a ribbon jumps by as much where the nearest of its spans changes.
    constexpr double kJump = 0.14e-3;
    EXPECT_LT(worst_corner, std::max(0.3 * b.solid.facet_distance, kJump)) << b.file;
    EXPECT_LT(worst_middle, 5 * b.solid.facet_distance) << b.file;  // creases of unions
  }
}

TEST(BundledSurfaces, GeneratorGivesTheCommittedTriangles) {
  for (const Bundled& b : read_bundled()) {
    const auto& name = b.solid.name;
    const std::set<std::string> some{"joint_fluid",         "bone",     "patella",
                                     "anterior_recess",     "pisiform", "annular_ligament",
                                     "retrocalcaneal_bursa"};
    if (some.count(name) == 0) continue;
    const auto again = compute_surface(b.solid);
    ASSERT_TRUE(again) << again.error().to_string();
    ASSERT_TRUE(again->triangles == b.mesh.triangles) << b.file;
    for (std::size_t i = 0; i < again->vertices.size(); ++i) {
      EXPECT_LT((again->vertices[i] - b.mesh.vertices[i]).norm(), 1e-9) << b.file;
    }
  }
}

TEST(BundledSurfaces, AllTogetherStayUnder25MegabytesAndEachUnderOne) {
  std::uintmax_t total = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kMeshes)) {
    if (!entry.is_regular_file()) continue;
    const bool compiled = entry.path().extension() == ".artus";  // the one that hello reads
    EXPECT_LT(entry.file_size(), compiled ? 4000000U : 1000000U) << entry.path();
    total += entry.file_size();
  }
  EXPECT_LT(total, 25000000U);
}

TEST(BundledSurfaces, ShoulderHasTheSizeOfAnAdults) {
  const auto volume_cm3 = [](const char* name) {
    const auto mesh = read_surface(kMeshes / "shoulder/surfaces" / name, kMillimetre);
    return mesh ? 1e6 * signed_volume(*mesh) : 0.0;
  };
  // The real shoulder of the atlas has 29, 110, 35 and 331 cm3; the bellies here end medially.
  EXPECT_NEAR(volume_cm3("supraspinatus.ply"), 27, 6);
  EXPECT_NEAR(volume_cm3("subscapularis.ply"), 50, 20);
  EXPECT_NEAR(volume_cm3("deltoid.ply"), 280, 80);
  EXPECT_NEAR(volume_cm3("supraspinatus_tendon.ply"), 8, 2);  // with what bone takes of it
  EXPECT_NEAR(volume_cm3("subacromial_bursa.ply"), 2.3, 0.5);
}

TEST(BundledSurfaces, SimpleShouldersLayersHaveTheirThicknessEverywhere) {
  const SimpleShoulderSize size;
  const std::vector<Solid> solids = make_simple_shoulder(size);
  const std::vector<double> inward{size.skin, size.muscle, size.bursa, size.tendon, size.cartilage};
  for (std::size_t i = 0; i < inward.size(); ++i) {
    const auto outer =
        read_surface(kMeshes / "simple-shoulder/surfaces" / (solids[i].name + ".ply"), kMillimetre);
    ASSERT_TRUE(outer);
    for (const Vec3& v : outer->vertices) {
      ASSERT_NEAR(solids[i + 1].field(v), inward[i], 1e-6) << solids[i].name;
    }
  }
}

}  // namespace
}  // namespace artus
