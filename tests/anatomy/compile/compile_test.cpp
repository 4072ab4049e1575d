// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/anatomy/compile.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include <oneapi/tbb/global_control.h>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "artus/detail/core/noise.h"
#include "tests/anatomy/compile/joint_folder.h"
#include "tests/anatomy/surfaces/surface_samples.h"

namespace artus {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::JointFolder;
using test::kMm;

double ball(double radius) {
  return 4.0 / 3 * std::numbers::pi * radius * radius * radius;
}

CompileOutcome compile(const JointFolder& folder) {
  const auto file = read_joint(folder.path());
  EXPECT_TRUE(file) << file.error().to_string();
  auto outcome = compile_joint(*file);
  EXPECT_TRUE(outcome) << outcome.error().to_string();
  return std::move(*outcome);
}

const StructureReport& report_of(const CompileOutcome& outcome, const std::string& name) {
  for (const StructureReport& s : outcome.report.structures) {
    if (s.name == name) return s;
  }
  throw std::runtime_error("no structure " + name);
}

std::string compiled_bytes(const JointFolder& folder, std::size_t threads) {
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                          threads);
  const fs::path file = folder.path() / "out.artus";
  const auto written = write_compiled_joint(compile(folder).joint, file);
  EXPECT_TRUE(written) << written.error().to_string();
  return bytes_of(file);
}

constexpr const char* kTwoBalls = R"(
[[structure]]
name = "head"
tissue = "bone"
file = "head.ply"
[[structure]]
name = "belly"
tissue = "muscle"
file = "belly.ply"
)";

// Two balls of 8 mm, 10 mm apart, in one of 20 mm.
const JointFolder& two_balls() {
  static const JointFolder folder("two-balls");
  static const bool made = [] {
    folder.add_sphere("body", Vec3(0, 0, 0), 20);
    folder.add_sphere("head", Vec3(-5, 0, 0), 8);
    folder.add_sphere("belly", Vec3(5, 0, 0), 8);
    folder.write_toml(kTwoBalls);
    return true;
  }();
  EXPECT_TRUE(made);
  return folder;
}

const CompileOutcome& two_balls_compiled() {
  static const CompileOutcome outcome = compile(two_balls());
  return outcome;
}

TEST(CompileJoint, OverlappingBallsKeepTheVolumesPriorityLeavesThem) {
  const CompileOutcome& outcome = two_balls_compiled();
  // lens of two balls of radius r at distance d: pi (4 r + d) (2 r - d)^2 / 12
  const double lens = std::numbers::pi * (32 + 10) * 36 / 12 * 1e-9;
  EXPECT_NEAR(report_of(outcome, "head").resolved_volume, ball(8 * kMm), 0.015 * ball(8 * kMm));
  EXPECT_NEAR(report_of(outcome, "belly").resolved_volume, ball(8 * kMm) - lens,
              0.015 * ball(8 * kMm));
  EXPECT_NEAR(report_of(outcome, "belly").lost_volume, lens, 0.05 * lens);
  const double all = ball(20 * kMm);
  EXPECT_NEAR(report_of(outcome, "filler").resolved_volume, all - 2 * ball(8 * kMm) + lens,
              0.01 * all);
}

TEST(CompileJoint, TetrahedraAreWellShapedAndNoneIsInverted) {
  const TetQuality& quality = two_balls_compiled().report.quality;
  EXPECT_EQ(quality.inverted, 0U);
  EXPECT_GT(quality.above_8_deg_percent(), 99.9);
}

TEST(CompileJoint, EveryFaceIsSharedByTwoTetrahedraOrLiesOnTheHull) {
  const TetMesh& mesh = two_balls_compiled().joint.mesh;
  struct Owners {
    int count = 0;
    RegionId first = kOutside;
    RegionId second = kOutside;
  };
  std::map<std::array<std::uint32_t, 3>, Owners> faces;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& tet = mesh.tetrahedra[t];
      std::array<std::uint32_t, 3> key{tet[(k + 1) % 4], tet[(k + 2) % 4], tet[(k + 3) % 4]};
      std::sort(key.begin(), key.end());
      Owners& owners = faces[key];
      (owners.count++ == 0 ? owners.first : owners.second) = mesh.regions[t];
    }
  }
  std::size_t expected = 0;
  for (const auto& [key, owners] : faces) {
    ASSERT_LE(owners.count, 2);
    if (owners.count == 1 || owners.first != owners.second) ++expected;
  }
  EXPECT_EQ(mesh.interfaces.size(), expected);
  for (const Interface& f : mesh.interfaces) {
    auto key = f.vertices;
    std::sort(key.begin(), key.end());
    const Owners& owners = faces.at(key);
    EXPECT_TRUE((owners.first == f.back && owners.second == f.front) ||
                (owners.first == f.front && owners.second == f.back));
  }
}

TEST(CompileJoint, PointsInsideTheBodyLieInOneTetrahedronOfTheRightRegion) {
  const CompiledJoint& joint = two_balls_compiled().joint;
  const TetMesh& mesh = joint.mesh;
  for (std::uint64_t i = 0; i < 40; ++i) {
    Vec3 p;
    for (std::uint64_t a = 0; a < 3; ++a) {
      p[static_cast<Eigen::Index>(a)] = (uniform_noise(7, 3 * i + a) - 0.5) * 36 * kMm;
    }
    if (p.norm() > 18 * kMm) continue;
    int owners = 0;
    RegionId region = kOutside;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
      const auto& tet = mesh.tetrahedra[t];
      Eigen::Matrix3d edges;
      for (std::size_t k = 0; k < 3; ++k) {
        edges.col(static_cast<Eigen::Index>(k)) = mesh.vertices[tet[k + 1]] - mesh.vertices[tet[0]];
      }
      const Vec3 b = edges.inverse() * (p - mesh.vertices[tet[0]]);
      if (b.minCoeff() < 0 || b.sum() > 1) continue;
      ++owners;
      region = mesh.regions[t];
    }
    EXPECT_EQ(owners, 1) << p.transpose();
    const double to_head = (p - Vec3(-5 * kMm, 0, 0)).norm() - 8 * kMm;
    const double to_belly = (p - Vec3(5 * kMm, 0, 0)).norm() - 8 * kMm;
    if (std::min(std::abs(to_head), std::abs(to_belly)) < 0.5 * kMm) continue;
    const std::string expected = to_head < 0 ? "head" : to_belly < 0 ? "belly" : "filler";
    EXPECT_EQ(joint.regions[region].name, expected) << p.transpose();
  }
}

TEST(CompileJoint, GivesTheSameBytesAtAnyNumberOfThreads) {
  const std::string once = compiled_bytes(two_balls(), 1);
  EXPECT_EQ(once, compiled_bytes(two_balls(), 2));
  EXPECT_EQ(once, compiled_bytes(two_balls(), 7));
}

TEST(CompileJoint, ShellHasTheVolumeOfItsThickness) {
  const JointFolder folder("shell");
  folder.add_sphere("body", Vec3(0, 0, 0), 20);
  folder.write_toml(
      "[[structure]]\nname = \"skin\"\ntissue = \"skin\"\nshell = { thickness = 2.0 }\n");
  const double expected = ball(20 * kMm) - ball(18 * kMm);
  const CompileOutcome outcome = compile(folder);
  EXPECT_NEAR(report_of(outcome, "skin").resolved_volume, expected, 0.03 * expected);
  EXPECT_NEAR(report_of(outcome, "skin").region_volume, expected, 0.01 * expected)
      << "the shell's outside is the body's: its edge must be smoothed once";
}

TEST(CompileJoint, AFineStructureTakesItsOwnVolumeFromACoarseOneAndNoMore) {
  const JointFolder folder("fine-in-coarse");
  folder.add_sphere("body", Vec3(0, 0, 0), 20);
  folder.add_sphere("head", Vec3(2, 0, 0), 1.5);
  folder.add_sphere("belly", Vec3(0, 0, 0), 8);
  folder.write_toml(kTwoBalls);
  const CompileOutcome outcome = compile(folder);
  EXPECT_NEAR(report_of(outcome, "belly").lost_volume, ball(1.5 * kMm), 0.1 * ball(1.5 * kMm));
  EXPECT_NEAR(report_of(outcome, "belly").region_volume, ball(8 * kMm), 0.01 * ball(8 * kMm));
}

// What an author should look at: a ball half outside the skin, one mostly covered, one far away.
TEST(CompileJoint, WarnsOfWhatIsLostOutsideOrDoubtful) {
  const JointFolder folder("warnings");
  folder.add_sphere("body", Vec3(0, 0, 0), 20);
  folder.add_sphere("head", Vec3(18, 0, 0), 6);
  folder.add_sphere("cover", Vec3(-6, 0, 0), 6);
  folder.add_sphere("belly", Vec3(-7, 0, 0), 6);
  folder.add_sphere("away", Vec3(500, 0, 0), 6);
  std::string toml;
  for (const char* name : {"head", "cover", "belly", "away"})
    toml += std::string("[[structure]]\nname = \"") + name + "\"\ntissue = \"bone\"\nfile = \"" +
            name + ".ply\"\n";
  folder.write_toml(toml);
  const CompileOutcome outcome = compile(folder);
  const auto warnings = [&](const char* name) {
    std::string all;
    for (const std::string& w : report_of(outcome, name).warnings) all += w + "\n";
    return all;
  };
  EXPECT_NE(warnings("head").find("of its surface lies outside the body"), std::string::npos);
  EXPECT_EQ(warnings("cover"), "");
  EXPECT_NE(warnings("belly").find("goes to structures before it"), std::string::npos);
  EXPECT_NE(warnings("away").find("none of it is in the joint"), std::string::npos);
  EXPECT_NE(warnings("away").find("from the middle of the others"), std::string::npos);
}

TEST(CompileJoint, SetsTheProbeOnTheSkinWhenTheFileHasNone) {
  auto file = read_joint(two_balls().path());
  ASSERT_TRUE(file) << file.error().to_string();
  file->X_JP_default.reset();
  file->X_JN_default.reset();
  file->region_of_interest = RegionOfInterest{Vec3(0, 0, 12 * kMm), 12 * kMm, {}};
  const auto outcome = compile_joint(*file);
  ASSERT_TRUE(outcome) << outcome.error().to_string();
  const Pose& X_JP = outcome->joint.X_JP_default;
  EXPECT_NEAR(X_JP.translation().norm(), 20 * kMm, 0.3 * kMm);
  EXPECT_GT(X_JP.linear().col(2).dot(-Vec3::UnitZ()), 0.98);
  const Pose& X_JN = outcome->joint.X_JN_default;
  EXPECT_NEAR((X_JP.inverse() * X_JN.translation()).z(), 4 * kMm, 0.2 * kMm);
  EXPECT_NEAR((X_JP.inverse() * X_JN.translation()).y(), 0, 1e-9);
  EXPECT_EQ(outcome->report.notes.size(), 2U);
}

TEST(CompileJoint, SetsTheProbeOverThePlannedNeedleWhenTheFileHasNone) {
  auto file = read_joint(two_balls().path());
  ASSERT_TRUE(file) << file.error().to_string();
  file->X_JP_default.reset();
  file->X_JN_default.reset();
  const Vec3 target = Vec3(-8, 2, 3) * kMm;
  const Vec3 entry = Vec3(-20, 0, 0) * kMm;  // the skin nearest to the target is along the needle
  file->injections = {{"one", entry, target}};
  const auto outcome = compile_joint(*file);
  ASSERT_TRUE(outcome) << outcome.error().to_string();
  const Pose& X_JP = outcome->joint.X_JP_default;
  EXPECT_NEAR(X_JP.translation().norm(), 20 * kMm, 0.3 * kMm);
  const Vec3 seen_target = X_JP.inverse() * target;
  EXPECT_NEAR(seen_target.head<2>().norm(), 0, 1e-9);
  EXPECT_NEAR((X_JP.inverse() * entry).y(), 0, 1e-9);
  const Vec3 along = (target - entry).normalized();
  EXPECT_LE(std::abs(along.dot(X_JP.linear().col(2))), 0.77 + 1e-9);
  EXPECT_TRUE(outcome->joint.X_JN_default.translation().isApprox(target));
  EXPECT_TRUE(outcome->joint.X_JN_default.linear().col(2).isApprox(along));
}

TEST(CompileJoint, RefusesSizesThatWouldNeverEnd) {
  const JointFolder folder("sizes");
  folder.add_sphere("body", Vec3(0, 0, 0), 20);
  folder.write_toml(
      "[[structure]]\nname = \"skin\"\ntissue = \"skin\"\nshell = { thickness = 2.0 }\n");
  for (const auto& [key, member] : {std::pair{"cell_size", &JointFile::cell_size},
                                    std::pair{"facet_size", &JointFile::facet_size},
                                    std::pair{"facet_distance", &JointFile::facet_distance}}) {
    auto file = read_joint(folder.path());
    ASSERT_TRUE(file) << file.error().to_string();
    (*file).*member = 1e-6;
    const auto refused = compile_joint(*file);
    ASSERT_FALSE(refused) << key;
    EXPECT_EQ(refused.error().code, ErrorCode::invalid);
    EXPECT_NE(refused.error().message.find(std::string("enlarge ") + key), std::string::npos)
        << refused.error().message;
  }
}

TEST(CompiledFile, ReadsBackWhatWasWrittenAndRefusesEveryDamage) {
  const fs::path file = two_balls().path() / "damage.artus";
  ASSERT_TRUE(write_compiled_joint(two_balls_compiled().joint, file));
  const auto joint = read_compiled_joint(file);
  ASSERT_TRUE(joint) << joint.error().to_string();
  EXPECT_EQ(joint->mesh.tetrahedra, two_balls_compiled().joint.mesh.tetrahedra);
  const std::string good = bytes_of(file);
  const auto refused = [&](const std::string& bytes) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
    return !read_compiled_joint(file);
  };
  for (std::size_t at = 0; at < good.size(); at = at < 64 ? at + 1 : at + good.size() / 50) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 0x10);
    EXPECT_TRUE(refused(bad)) << "flipped byte " << at;
    EXPECT_TRUE(refused(good.substr(0, at))) << "cut at " << at;
  }
  EXPECT_TRUE(refused(good + "x"));
}

TEST(CompiledFile, KeepsEachTissuesLawsAndRefusesTheVersionThatHadNone) {
  const fs::path file = two_balls().path() / "laws.artus";
  CompiledJoint joint = two_balls_compiled().joint;
  joint.tissues.back().haptic.cutting_law = CuttingLaw::voigt;
  joint.tissues.back().haptic.prepuncture_law = PrepunctureLaw::god_object;
  ASSERT_TRUE(write_compiled_joint(joint, file));
  const auto read = read_compiled_joint(file);
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->tissues.front().haptic.cutting_law, CuttingLaw::tracking_wall);
  EXPECT_EQ(read->tissues.back().haptic.cutting_law, CuttingLaw::voigt);
  EXPECT_EQ(read->tissues.back().haptic.prepuncture_law, PrepunctureLaw::god_object);
  std::string old = bytes_of(file);
  old[8] = 2;  // the version, behind the magic
  std::ofstream(file, std::ios::binary | std::ios::trunc) << old;
  const auto refused = read_compiled_joint(file);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::unsupported);
}

TEST(CompileJoint, RefusesAndNamesWhatCannotBeRepaired) {
  const JointFolder folder("refused");
  folder.add_sphere("body", Vec3(0, 0, 0), 20);
  folder.write_toml(kTwoBalls);
  folder.add_sphere("head", Vec3(0, 0, 0), 8);
  std::ofstream(folder.path() / "belly.ply")
      << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const auto file = read_joint(folder.path());
  ASSERT_TRUE(file) << file.error().to_string();
  const auto strict = compile_joint(*file);
  ASSERT_FALSE(strict);
  EXPECT_EQ(strict.error().code, ErrorCode::defective);
  EXPECT_NE(strict.error().message.find("belly"), std::string::npos);
  CompileOptions lenient;
  lenient.skip_refused = true;
  EXPECT_TRUE(compile_joint(*file, lenient));
}

}  // namespace
}  // namespace artus
