// SPDX-License-Identifier: AGPL-3.0-or-later
// The bars every compiled joint must meet, on the bundled joints as the tool compiled them.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/core/noise.h"
#include "artus/echo/renderer.h"
#include "artus/raycast/scene.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

class BundledJoint : public testing::TestWithParam<std::string> {
 protected:
  static std::filesystem::path file(const std::string& extension) {
    return artus::test::test_joints() / (GetParam() + extension);
  }
  static nlohmann::json report() { return nlohmann::json::parse(std::ifstream(file(".json"))); }
  static std::shared_ptr<const CompiledJoint> joint() {
    auto read = read_compiled_joint(file(".artus"));
    if (!read) throw std::runtime_error(read.error().to_string());
    return std::make_shared<const CompiledJoint>(std::move(*read));
  }
};

TEST_P(BundledJoint, HasNoInvertedAndHardlyAnyFlatTetrahedra) {
  const auto quality = report().at("quality");
  EXPECT_EQ(quality.at("inverted").get<int>(), 0);
  EXPECT_GE(quality.at("above_8_deg_percent").get<double>(), 99.9);
}

TEST_P(BundledJoint, KeepsTheVolumeOfEveryStructure) {
  for (const auto& structure : report().at("structures"))
    EXPECT_LT(std::abs(structure.at("volume_error_percent").get<double>()), 3)
        << structure.at("name");
}

TEST_P(BundledJoint, KeepsItsInterfacesOnTheInputSurfaces) {
  const auto distance = report().at("distance");
  EXPECT_LT(distance.at("mean_mm").get<double>(), 0.2);
  EXPECT_LT(distance.at("percentile95_mm").get<double>(), 0.5);
}

TEST_P(BundledJoint, FillsTheBodyWithTetrahedraOfOneRegionEach) {
  const auto body = joint();
  const Scene scene(body);
  const auto& mesh = body->mesh;
  ASSERT_EQ(mesh.regions.size(), mesh.tetrahedra.size());
  // The centre of every tenth tetrahedron lies, for the ray index, in the tetrahedron's region.
  std::size_t wrong = 0;
  std::size_t asked = 0;
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); i += 10) {
    Vec3 centre = Vec3::Zero();
    for (const auto v : mesh.tetrahedra[i]) centre += mesh.vertices[v] / 4;
    ++asked;
    if (scene.region_at(centre) != mesh.regions[i]) ++wrong;
  }
  EXPECT_GT(asked, 1000U);
  EXPECT_EQ(wrong, 0U) << "of " << asked;
}

TEST_P(BundledJoint, InjectionsStartOutsideAndEndInside) {
  const auto body = joint();
  const Scene scene(body);
  ASSERT_GE(body->injections.size(), 3U);
  for (const auto& injection : body->injections) {
    EXPECT_EQ(scene.region_at(injection.entry - (injection.target - injection.entry) * 0.1),
              kOutside)
        << injection.name;
    EXPECT_GE(scene.region_at(injection.target), kFirstRegion) << injection.name;
  }
}

// meshes/README.md says how it is made again.
TEST(CommittedJoint, IsReadableByThisVersionAndWhatIsCompiledToday) {
  const auto committed = read_compiled_joint(test::source_dir() / "meshes/simple-shoulder.artus");
  ASSERT_TRUE(committed) << committed.error().to_string();
  const auto fresh = read_compiled_joint(test::test_joints() / "simple-shoulder.artus");
  ASSERT_TRUE(fresh) << fresh.error().to_string();
  ASSERT_EQ(committed->regions.size(), fresh->regions.size());
  for (std::size_t i = 0; i < fresh->regions.size(); ++i) {
    EXPECT_EQ(committed->regions[i].name, fresh->regions[i].name);
    EXPECT_EQ(committed->tissue_of(static_cast<RegionId>(i)).name,
              fresh->tissue_of(static_cast<RegionId>(i)).name);
  }
  ASSERT_EQ(committed->injections.size(), fresh->injections.size());
  for (std::size_t i = 0; i < fresh->injections.size(); ++i)
    EXPECT_LT((committed->injections[i].target - fresh->injections[i].target).norm(), 1e-4);
  EXPECT_TRUE(committed->X_JP_default.isApprox(fresh->X_JP_default, 1e-3));
  const auto n = static_cast<double>(fresh->mesh.tetrahedra.size());
  EXPECT_NEAR(static_cast<double>(committed->mesh.tetrahedra.size()), n, 0.02 * n);
}

TEST(CommittedJoint, IsSmall) {
  EXPECT_LT(std::filesystem::file_size(test::source_dir() / "meshes/simple-shoulder.artus"),
            3'500'000U);
}

INSTANTIATE_TEST_SUITE_P(Joints, BundledJoint,
                         testing::Values("simple-shoulder", "shoulder", "elbow", "wrist", "hip",
                                         "knee", "ankle"),
                         [](const auto& parameter) {
                           std::string name = parameter.param;
                           name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
                           return name;
                         });

TEST(BundledVessels, TheFemoralArteryBeatsAllOverItsSection) {
  auto joint = read_compiled_joint(test::test_joints() / "hip.artus");
  ASSERT_TRUE(joint) << joint.error().message;
  const auto scene =
      std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(std::move(*joint)));
  ImageSettings settings;
  settings.depth = 60e-3;
  settings.doppler = true;
  settings.doppler_limit = 0.6;
  Renderer renderer(scene, Transducer{}, settings);
  const Pose X_JP = make_pose(Vec3(22e-3, -64e-3, 15e-3), Vec3(0, 0.9, -0.43), Vec3::UnitX());
  struct Seen {
    int away = 0;
    int toward = 0;
    float fastest = 0;  // m/s
  };
  // Between 1.1 and 2.1 cm and within 5 mm of the middle lies the artery alone.
  const auto look_at = [&](double time) {
    renderer.set_flow_time(time);
    const Frame& frame = renderer.render(X_JP);
    Seen seen;
    for (int l = 96; l < 160; ++l)
      for (int s = 190; s < 360; ++s) {
        const float v = frame.velocity[static_cast<std::size_t>(l * frame.n_samples + s)];
        if (std::isnan(v)) continue;
        ++(v < 0 ? seen.away : seen.toward);
        seen.fastest = std::max(seen.fastest, std::abs(v));
      }
    return seen;
  };
  const Seen systole = look_at(0.125);  // blood runs down, and so does the beam
  EXPECT_GT(systole.away, 3000);
  EXPECT_EQ(systole.toward, 0);
  // 136 diameters of 8.2 mm a second, 64 degrees from the beam
  EXPECT_NEAR(systole.fastest, 136 * 8.2e-3 * 0.43, 0.06);
  const Seen back = look_at(0.33);
  EXPECT_EQ(back.away, 0);
  EXPECT_GT(back.toward, 2000);
  EXPECT_NEAR(back.fastest, 0.25 * systole.fastest, 0.02);
}

}  // namespace
}  // namespace artus
