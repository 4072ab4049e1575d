// SPDX-License-Identifier: AGPL-3.0-or-later
// The import of a joint as its author meets it: refusals that are followed, the tutorial of
// docs/import.md, the pages of reports.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/anatomy/import/label_samples.h"
#include "tests/apps/run_tool.h"
#include "tests/support/open_counter.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

using test::artus;

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

class ImportTool : public test::TemporaryFolder {
 protected:
  /// The blocks of docs/import.md that a line "<!-- tutorial NAME -->" stands before, in order.
  static std::string tutorial(const std::string& name) {
    const std::string text = content(test::source_dir() / "docs/import.md");
    std::string all;
    const std::string mark = "<!-- tutorial " + name + " -->";
    for (auto at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
      const auto begin = text.find('\n', text.find("```", at)) + 1;
      all += text.substr(begin, text.find("```", begin) - begin);
    }
    return all;
  }
  /// The folder of the tutorial: bare surfaces and the joint file as the document has it.
  std::filesystem::path write_joint(const std::string& toml) const {
    const auto folder = folder_ / "my-joint";
    std::filesystem::create_directories(folder);
    for (const auto& entry : std::filesystem::directory_iterator(test::source_dir() /
                                                                 "meshes/simple-shoulder/surfaces"))
      std::filesystem::copy(entry.path(), folder / entry.path().filename(),
                            std::filesystem::copy_options::overwrite_existing);
    std::ofstream(folder / "joint.toml") << toml;
    return folder;
  }
  /// Each of the files at a joint's folder was opened once.
  static void expect_each_read_once(test::OpenCounter& counter) {
    const auto opened = counter.take();
    EXPECT_GT(opened.size(), 5U);
    for (const auto& [file, times] : opened) EXPECT_EQ(times, 1) << file;
  }
  /// No script, no address, every picture inside.
  static void expect_self_contained(const std::string& page) {
    EXPECT_EQ(page.find("<script"), std::string::npos);
    EXPECT_EQ(page.find("http"), std::string::npos);
    for (auto at = page.find("src="); at != std::string::npos; at = page.find("src=", at + 1))
      EXPECT_EQ(page.compare(at, 10, "src=\"data:"), 0);
  }
  /// What a browser makes of a page; empty where there is no Chromium.
  static std::string seen_by_browser(const std::filesystem::path& page) {
    if (test::run_process({"/usr/bin/which", "chromium"}).exit_code != 0) return {};
    return test::run_process({"chromium", "--headless", "--no-sandbox", "--disable-gpu",
                              "--dump-dom", "file://" + page.string()})
        .out;
  }
};

TEST_F(ImportTool, TheTutorialLeadsFromBareSurfacesToAnInjection) {
  const auto folder = write_joint(tutorial("joint.toml"));
  const auto check = artus({"check", folder.string()});
  ASSERT_EQ(check.exit_code, 0) << check.out << check.err;
  const auto compile = [&] {
    return artus({"compile", folder.string(), "-o", in("my.artus"), "--cache", in("cache"),
                  "--report", in("report.html")});
  };
  test::OpenCounter counter(folder);
  const auto compiled = compile();
  ASSERT_EQ(compiled.exit_code, 0) << compiled.out << compiled.err;
  expect_each_read_once(counter);
  std::ofstream(folder / "joint.toml", std::ios::app) << tutorial("injections");
  const auto planned = compile();
  ASSERT_EQ(planned.exit_code, 0) << planned.out << planned.err;
  EXPECT_NE(planned.out.find("the body is the one compiled before"), std::string::npos);
  EXPECT_EQ(artus({"image", "-j", in("my.artus"), "-o", in("image.png")}).exit_code, 0);
  const auto run = artus({"run", "three-injections", "-j", in("my.artus"), "--out", in("run"),
                          "--no-images", "--rigid", "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
  const std::string text = content(in("report.html"));
  expect_self_contained(text);
  for (const char* expected : {"What to do next", "in the probe's plane", "distance to bone.ply",
                               "p95 mm", "95 % of its area inside the region is nearer than this"})
    EXPECT_NE(text.find(expected), std::string::npos) << expected;
  const std::string seen = seen_by_browser(in("report.html"));
  if (seen.empty()) GTEST_SKIP() << "there is no Chromium to open the page in";
  EXPECT_GE(std::count(seen.begin(), seen.end(), '<'), 200) << "the browser shows the page";
}

TEST_F(ImportTool, WhatTheJointIsMadeFromIsNoPlaceToWriteTo) {
  const std::string toml = tutorial("joint.toml");
  const auto folder = write_joint(toml);
  const std::vector<std::pair<std::string, std::string>> targets{
      {"-o", "joint.toml"}, {"--out", "bone.ply"}, {"--report", "joint.toml"}};
  for (const auto& [flag, file] : targets) {
    const std::string target = (folder / file).string();
    const std::string before = content(target);
    const auto refused = artus({"compile", folder.string(), flag, target, "--cache", in("cache")});
    EXPECT_NE(refused.exit_code, 0) << flag;
    EXPECT_NE(refused.err.find(target), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("name another"), std::string::npos) << refused.err;
    EXPECT_EQ(content(target), before) << flag;
  }
  EXPECT_FALSE(std::filesystem::exists(in("cache"))) << "refused before anything is made";
}

TEST_F(ImportTool, RefusalsComeFirstWithOneExitCodeAndTheirMendWorks) {
  std::string toml = tutorial("joint.toml") +
                     "[[injection]]\nname = \"astray\"\nentry = [-60.0, 0.0, -13.9]\n"
                     "target = [-34.1, 0.0, 3.0]\n";
  auto folder = write_joint(toml);
  test::OpenCounter counter(folder);
  const auto check = artus({"check", folder.string(), "--report", in("check.html")});
  expect_each_read_once(counter);
  EXPECT_EQ(check.exit_code, 3);
  EXPECT_EQ(check.out.rfind("refused injection 'astray' (line ", 0), 0U) << check.out;
  const auto compile = artus({"compile", folder.string(), "-o", in("a.artus"), "--cache", in("c")});
  EXPECT_EQ(compile.exit_code, 3) << compile.err;
  EXPECT_NE(compile.err.find("injection 'astray'"), std::string::npos) << compile.err;
  const std::string text = content(in("check.html"));
  expect_self_contained(text);
  EXPECT_NE(text.find("refused"), std::string::npos);
  const std::string offer = "the skin is at (";
  const auto at = check.out.find(offer);
  ASSERT_NE(at, std::string::npos) << check.out;
  const auto begin = at + offer.size();
  const std::string entry = check.out.substr(begin, check.out.find(')', begin) - begin);
  toml.replace(toml.find("-60.0, 0.0, -13.9"), 17, entry);
  folder = write_joint(toml);
  EXPECT_EQ(artus({"check", folder.string()}).exit_code, 0);
}

TEST_F(ImportTool, ASegmentationBecomesAJointWithoutAnEdit) {
  // Two bones with cartilage between them, in a limb that leaves the volume at both ends.
  const LabelVolume limb = test::painted(
      {50, 50, 40}, test::oblique_frame({1, 1, 1}),
      {"femur_left", "tibia_left", "cartilage", "body"}, [](const Vec3& p) -> std::uint16_t {
        const double r = p.head<2>().norm();
        if (r < 8e-3) return std::abs(p.z()) < 1.6e-3 ? 3 : p.z() > 0 ? 1 : 2;
        return r < 22e-3 ? 4 : 0;
      });
  std::ofstream(in("limb.nii"), std::ios::binary) << test::nifti_of(limb);
  std::ofstream(in("limb.seg.nrrd"), std::ios::binary) << test::nrrd_of(limb);
  const auto imported = artus({"import", in("limb.nii"), "-o", in("limb"), "--json"});
  ASSERT_EQ(imported.exit_code, 0) << imported.err;
  const auto json = nlohmann::json::parse(imported.out);
  EXPECT_EQ(json.at("side"), "left");
  EXPECT_EQ(json.at("structures").size(), 3U);
  EXPECT_NE(content(folder_ / "limb/import.html").find("before and after"), std::string::npos);
  EXPECT_EQ(artus({"check", in("limb")}).exit_code, 0) << artus({"check", in("limb")}).out;
  const auto compiled = artus({"compile", in("limb"), "-o", in("limb.artus"), "--fresh", "--json"});
  ASSERT_EQ(compiled.exit_code, 0) << compiled.err;
  const auto report = nlohmann::json::parse(compiled.out);
  for (const auto& s : report.at("structures")) {
    if (s.at("kind") != "surface") continue;
    const double volume = s.at("surface_volume_cm3").get<double>();
    EXPECT_NEAR(s.at("resolved_volume_cm3").get<double>(), volume, 0.02 * volume) << s.at("name");
  }
  EXPECT_EQ(artus({"import", in("limb.nii"), "-o", in("limb")}).exit_code, 1) << "not over a joint";
  // The frame of a NIfTI has single precision, so that its bytes are its own.
  ASSERT_EQ(artus({"import", in("limb.seg.nrrd"), "-o", in("again")}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "again/surfaces/femur.ply"));
}

/// A cube as OFF, mm.
std::string cube(double x, double half) {
  std::ostringstream out;
  out << "OFF\n8 12 0\n";
  for (int i = 0; i < 8; ++i)
    out << x + ((i & 1) != 0 ? half : -half) << ' ' << ((i & 2) != 0 ? half : -half) << ' '
        << ((i & 4) != 0 ? half : -half) << '\n';
  out << "3 0 2 1\n3 1 2 3\n3 4 5 6\n3 5 7 6\n3 0 1 4\n3 1 5 4\n3 2 6 3\n3 3 6 7\n3 0 4 2\n3 2 4 "
         "6\n"
         "3 1 3 5\n3 3 7 5\n";
  return out.str();
}

TEST_F(ImportTool, WhatNobodyMeantEndsWithExitCodeThreeInCheckAndInCompile) {
  const std::string head =
      "format = 1\nname = \"limb\"\nunits = \"mm\"\naxes = \"LPS\"\nside = \"none\"\n[body]\nfile "
      "= "
      "\"body.off\"\ntissue = \"fat\"\n[[structure]]\nname = \"femur\"\ntissue = \"bone\"\nfile = "
      "\"femur.off\"\n[[structure]]\nname = \"tibia\"\ntissue = \"bone\"\nfile = \"tibia.off\"\n";
  const std::string pose =
      "[pose.forced]\ntitle = \"forced\"\n[[pose.forced.move]]\nstructures = [\"tibia\"]\naxis = "
      "[0.0, 0.0, "
      "1.0]\nthrough = [20.0, 0.0, 0.0]\ndegrees = 0.0\nshift = [-15.0, 0.0, 0.0]\n";
  struct Case {
    std::string tibia, more, words;
  };
  const std::vector<Case> cases{{cube(20, 8), pose, "is pressed"},
                                {cube(400, 8), "", "outside"},
                                {cube(200, 80), "", "10 times too large"},
                                {cube(-10, 4), "", "femur"}};
  std::filesystem::create_directories(folder_ / "limb");
  std::ofstream(in("limb/body.off")) << cube(0, 40);
  std::ofstream(in("limb/femur.off")) << cube(-10, 10);
  for (const Case& c : cases) {
    std::ofstream(in("limb/tibia.off")) << c.tibia;
    std::ofstream(in("limb/joint.toml")) << head + c.more;
    const auto check = artus({"check", in("limb")});
    EXPECT_EQ(check.exit_code, 3) << c.words << check.out;
    EXPECT_NE(check.out.find(c.words), std::string::npos) << check.out;
    const auto compiled = artus({"compile", in("limb"), "-o", in("limb.artus"), "--fresh"});
    EXPECT_EQ(compiled.exit_code, 3) << c.words << compiled.out;
    EXPECT_NE(compiled.err.find(c.words), std::string::npos) << compiled.err;
  }
}

}  // namespace
}  // namespace artus
