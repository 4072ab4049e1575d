// SPDX-License-Identifier: AGPL-3.0-or-later
// What an edit of joint.toml costs: nothing but reading when it does not shape the body.
#include <algorithm>
#include <chrono>
#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "artus/anatomy/compile.h"
#include "artus/detail/anatomy/compile/attach_metadata.h"
#include "artus/detail/anatomy/compile/labels/part_cache.h"
#include "tests/anatomy/compile/joint_folder.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::JointFolder;

constexpr const char* kHead = R"([[structure]]
name = "head"
tissue = "muscle"
file = "head.ply"
)";

class KeptBodies : public testing::Test {
 protected:
  KeptBodies() : folder_("kept") {
    folder_.add_sphere("body", Vec3(0, 0, 0), 20);
    folder_.add_sphere("head", Vec3(0, 0, 5), 8);
    folder_.write_toml(kHead);
    // Coarse, since the same body is made many times here.
    replace("facet_size = 3.0", "facet_size = 6.0");
    replace("facet_distance = 0.2", "facet_distance = 0.6");
    replace("cell_size = 8.0", "cell_size = 18.0");
    options_.cache = folder_.path() / "cache";
  }
  CompileOutcome compile(bool with_cache = true) {
    const auto file = read_joint(folder_.path());
    EXPECT_TRUE(file) << file.error().to_string();
    auto outcome = with_cache ? compile_or_reuse(*file, options_) : compile_joint(*file);
    EXPECT_TRUE(outcome) << outcome.error().to_string();
    return std::move(*outcome);
  }
  std::string written(const CompileOutcome& outcome) {
    const fs::path file = folder_.path() / "out.artus";
    EXPECT_TRUE(write_compiled_joint(outcome.joint, file));
    return bytes_of(file);
  }
  void replace(const std::string& from, const std::string& to) {
    std::string text = bytes_of(folder_.path() / "joint.toml");
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    std::ofstream(folder_.path() / "joint.toml") << text.replace(at, from.size(), to);
  }
  [[nodiscard]] std::size_t count(const char* extension) const {
    std::size_t n = 0;
    for (const auto& entry : fs::directory_iterator(options_.cache))
      n += entry.path().extension() == extension ? 1U : 0U;
    return n;
  }

  JointFolder folder_;
  LoadOptions options_;
};

TEST_F(KeptBodies, ServesEveryEditThatShapesNothingWithTheBytesOfACompilationFromNothing) {
  EXPECT_FALSE(compile().report.body_kept);
  replace("position = [0.0, 0.0, 30.0]", "position = [1.0, 0.0, 20.0]");
  replace("entry = [0.0, 0.0, 30.0]", "entry = [2.0, 0.0, 30.0]  # a comment");
  replace("side = \"none\"", "side = \"left\"");
  std::ofstream(folder_.path() / "joint.toml", std::ios::app) << R"(fibre_axis = [0.0, 1.0, 0.0]
[tissue.muscle.haptic]
cutting_force_n = 3.25
[[landmark]]
name = "middle"
position = [0.0, 0.0, 0.0]
[[injection]]
name = "one"
entry = [0.0, 0.0, 20.0]
target = [0.0, 0.0, 5.0]
)";
  const CompileOutcome edited = compile();
  EXPECT_TRUE(edited.report.body_kept);
  EXPECT_EQ(edited.joint.injections.size(), 1U);
  EXPECT_EQ(written(edited), written(compile(false)));
}

TEST_F(KeptBodies, IsMadeAnewWhenAnythingThatShapesItChanges) {
  compile();
  replace("facet_size = 6.0", "facet_size = 6.5");
  EXPECT_FALSE(compile().report.body_kept) << "the mesh's sizes";
  folder_.add_sphere("head", Vec3(0, 0, 5), 8.5);
  EXPECT_FALSE(compile().report.body_kept) << "a surface";
  replace("file = \"head.ply\"", "file = \"head.ply\"\nfacet_distance = 0.3");
  EXPECT_FALSE(compile().report.body_kept) << "a structure's own sizes";
  EXPECT_TRUE(compile().report.body_kept);
}

TEST_F(KeptBodies, UnchangedStructuresAreNotRepairedAndMeasuredAgainAndTheBytesAreTheSame) {
  EXPECT_EQ(compile().report.parts_cached, 0U);
  folder_.add_sphere("other", Vec3(0, 0, -8), 5);
  std::ofstream(folder_.path() / "joint.toml", std::ios::app)
      << "[[structure]]\nname = \"other\"\ntissue = \"muscle\"\nfile = \"other.ply\"\n";
  const CompileOutcome added = compile();
  EXPECT_FALSE(added.report.body_kept);
  EXPECT_EQ(added.report.parts_cached, 4U) << "surface and distances of body and head";
  EXPECT_EQ(written(added), written(compile(false)));
  folder_.add_sphere("head", Vec3(0, 0, 5), 7);
  const CompileOutcome edited = compile();
  EXPECT_EQ(edited.report.parts_cached, 4U) << "surface and distances of body and other";
  EXPECT_EQ(written(edited), written(compile(false)));
}

TEST_F(KeptBodies, DamagedPartsAreMadeAnew) {
  const std::string first = written(compile());
  for (const auto& entry : fs::directory_iterator(options_.cache / "parts")) {
    std::string bytes = bytes_of(entry.path());
    ASSERT_GT(bytes.size(), 1000U);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    std::ofstream(entry.path(), std::ios::binary | std::ios::trunc) << bytes;
  }
  for (const auto& entry : fs::directory_iterator(options_.cache))
    if (entry.is_regular_file()) fs::remove(entry.path());
  const CompileOutcome again = compile();
  EXPECT_EQ(again.report.parts_cached, 0U);
  EXPECT_EQ(written(again), first);
}

using PartCacheFolder = test::TemporaryFolder;

TEST_F(PartCacheFolder, ForgetsWhatWasUsedLongestAgo) {
  const PartCache parts(folder_);
  const auto digest_of = [](int i) {
    ContentDigest digest(1);
    digest.add_value(i);
    return digest;
  };
  const std::string bytes(1000, 'x');
  const auto now = fs::file_time_type::clock::now();
  for (int i = 0; i < 4; ++i) {
    parts.keep(digest_of(i), bytes);
    fs::last_write_time(folder_ / (digest_of(i).hex() + ".part"), now - std::chrono::hours(10 - i));
  }
  EXPECT_EQ(parts.find(digest_of(0)), bytes) << "it is the one used last now";
  parts.forget_old(2500);
  EXPECT_TRUE(parts.find(digest_of(0)));
  EXPECT_FALSE(parts.find(digest_of(1)));
  EXPECT_FALSE(parts.find(digest_of(2)));
  EXPECT_TRUE(parts.find(digest_of(3)));
  EXPECT_FALSE(PartCache().find(digest_of(0))) << "one without a folder keeps nothing";
}

TEST_F(KeptBodies, BringsTheReportOfItsMaking) {
  const CompileReport made = compile().report;
  const CompileReport kept = compile().report;
  ASSERT_EQ(kept.structures.size(), made.structures.size());
  EXPECT_EQ(kept.tetrahedra, made.tetrahedra);
  EXPECT_EQ(kept.quality.histogram, made.quality.histogram);
  EXPECT_NEAR(kept.structures[1].resolved_volume, made.structures[1].resolved_volume, 1e-15);
  // Every number that the report prints comes back from its text.
  const auto before = nlohmann::json::parse(to_json(made)).flatten();
  const auto again = parse_compile_report(to_json(made), "report");
  ASSERT_TRUE(again) << again.error().to_string();
  const auto after = nlohmann::json::parse(to_json(*again)).flatten();
  ASSERT_EQ(before.size(), after.size());
  for (const auto& [key, value] : before.items()) {
    if (value.is_number())
      EXPECT_NEAR(after.at(key).get<double>(), value.get<double>(),
                  1e-12 * std::abs(value.get<double>()))
          << key;
    else
      EXPECT_EQ(after.at(key), value) << key;
  }
  EXPECT_FALSE(parse_compile_report("{\"structures\": 1}", "report"));
}

TEST_F(KeptBodies, IsRebuiltWhenDamaged) {
  const std::string first = written(compile());
  for (const auto& entry : fs::directory_iterator(options_.cache))
    std::ofstream(entry.path(), std::ios::binary | std::ios::trunc) << "rubbish";
  const CompileOutcome again = compile();
  EXPECT_FALSE(again.report.body_kept);
  EXPECT_EQ(written(again), first);
  EXPECT_TRUE(compile().report.body_kept);
}

TEST_F(KeptBodies, IsForgottenAfterAFewOthersOfTheSameJoint) {
  std::ofstream(folder_.path() / "balls-of-another.artus") << "stays";
  fs::create_directories(options_.cache);
  fs::copy_file(folder_.path() / "balls-of-another.artus",
                options_.cache / "balls-of-another.artus");
  for (int i = 0; i < 6; ++i) {
    compile();
    replace("cell_size = " + std::to_string(18 + i), "cell_size = " + std::to_string(19 + i));
  }
  EXPECT_EQ(count(".artus"), 4U + 1U);
  EXPECT_EQ(count(".json"), 4U);
  EXPECT_TRUE(fs::exists(options_.cache / "balls-of-another.artus"));
}

TEST_F(KeptBodies, AreDressedInWhatTheFileSays) {
  const CompileOutcome made = compile();
  auto file = read_joint(folder_.path());
  ASSERT_TRUE(file);
  file->side = "left";
  file->structures[0].fibre_axis = Vec3(0, 2, 0);
  file->structures[0].fibre_course = FibreCourse::layer;
  std::vector<std::string> notes;
  const CompiledJoint dressed = attach_metadata(*file, made.joint.mesh, "digest", notes);
  EXPECT_EQ(dressed.side, "left");
  EXPECT_EQ(dressed.source_digest, "digest");
  EXPECT_EQ(dressed.regions.back().fibre_axis, Vec3(0, 1, 0));
  EXPECT_EQ(dressed.regions.back().fibre_course, FibreCourse::layer);
  EXPECT_TRUE(dressed.X_JP_default.isApprox(*file->X_JP_default));
  EXPECT_TRUE(notes.empty()) << "the file gives both poses";
}

}  // namespace
}  // namespace artus
