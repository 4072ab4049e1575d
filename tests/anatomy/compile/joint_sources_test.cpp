// SPDX-License-Identifier: AGPL-3.0-or-later
// How often the files of a joint are read, counted where they are opened.
#include "artus/detail/anatomy/compile/labels/joint_sources.h"

#include <fstream>
#include <map>

#include <gmock/gmock.h>

#include "artus/anatomy/compile.h"
#include "artus/detail/anatomy/compile/check/joint_check.h"
#include "tests/anatomy/compile/joint_folder.h"
#include "tests/support/open_counter.h"

namespace artus {
namespace {

using test::JointFolder;
using test::OpenCounter;

using Counts = std::map<std::string, int>;
const Counts kOnceEach{{"joint.toml", 1}, {"body.ply", 1}, {"head.ply", 1}};

class ReadOnce : public testing::Test {
 protected:
  ReadOnce() : folder_("sources"), cache_("sources-cache") {
    folder_.add_sphere("body", Vec3(0, 0, 0), 20);
    folder_.add_sphere("head", Vec3(0, 0, 5), 8);
    folder_.write_toml(
        "[[structure]]\nname = \"head\"\ntissue = \"muscle\"\nfile = \"head.ply\"\n");
    options_.cache = cache_.path();
  }

  JointFolder folder_;
  JointFolder cache_;
  LoadOptions options_;
};

TEST_F(ReadOnce, ByALoadThatCompilesAndByOneThatFindsTheBodyKept) {
  OpenCounter counter(folder_.path());
  ASSERT_TRUE(load_joint(folder_.path(), options_));
  EXPECT_EQ(counter.take(), kOnceEach);
  ASSERT_TRUE(load_joint(folder_.path(), options_));
  EXPECT_EQ(counter.take(), kOnceEach);
}

TEST_F(ReadOnce, ByACheckAndACompilationOfTheSameSources) {
  OpenCounter counter(folder_.path());
  const JointSources sources(read_joint(folder_.path()).value());
  EXPECT_EQ(check_joint(sources).surfaces.size(), 2U);
  EXPECT_EQ(counter.take(), kOnceEach);
  ASSERT_TRUE(compile_or_reuse(sources, options_));
  EXPECT_EQ(counter.take(), Counts{});
}

TEST_F(ReadOnce, TheDigestIsThatOfTheBytesWhetherTheyAreParsedBeforeOrAfter) {
  const JointFile file = read_joint(folder_.path()).value();
  const auto& surface = std::get<SurfaceFile>(file.body.shape);
  const JointSources first(file);
  const JointSources second(file);
  ASSERT_TRUE(second.mesh(surface));
  EXPECT_EQ(first.digest(surface).value().hex(), second.digest(surface).value().hex());
  EXPECT_EQ(compute_source_digest(first).value(), compute_source_digest(second).value());
  EXPECT_GT((*first.mesh(surface))->triangles.size(), 100U);
  EXPECT_EQ(first.mesh(surface)->get(), first.mesh(surface)->get());
  EXPECT_NE(first.digest(surface).value().hex(),
            first.digest(std::get<SurfaceFile>(file.structures[0].shape)).value().hex());
}

TEST_F(ReadOnce, AFileThatIsGoneOrNoSurfaceIsToldToEveryoneWhoAsks) {
  const JointFile file = read_joint(folder_.path()).value();
  const auto& head = std::get<SurfaceFile>(file.structures[0].shape);
  std::ofstream(folder_.path() / "head.ply") << "no surface";
  const JointSources broken(file);
  EXPECT_EQ(broken.mesh(head).error().code, ErrorCode::malformed);
  EXPECT_EQ(broken.mesh(head).error().code, ErrorCode::malformed);
  EXPECT_TRUE(broken.digest(head));
  std::filesystem::remove(folder_.path() / "head.ply");
  const JointSources gone(file);
  EXPECT_EQ(gone.digest(head).error().code, ErrorCode::not_found);
  EXPECT_EQ(gone.mesh(head).error().code, ErrorCode::not_found);
  EXPECT_EQ(compute_source_digest(gone).error().code, ErrorCode::not_found);
}

TEST_F(ReadOnce, TheJointKnowsWhatItIsMadeOfByAnyPath) {
  const auto library = folder_.path() / "tissues.toml";
  std::filesystem::create_symlink(folder_.path() / "head.ply", folder_.path() / "link.ply");
  const JointSources sources(read_joint(folder_.path()).value());
  EXPECT_TRUE(sources.contains(folder_.path() / "joint.toml"));
  EXPECT_TRUE(sources.contains(folder_.path() / "." / "body.ply"));
  EXPECT_TRUE(sources.contains(folder_.path() / "link.ply"));
  EXPECT_FALSE(sources.contains(folder_.path() / "new.artus"));
  EXPECT_FALSE(sources.contains({}));
  std::ofstream(library) << "";
  EXPECT_FALSE(sources.contains(library));
  JointFile file = sources.joint();
  file.tissue_library = library;
  EXPECT_TRUE(JointSources(file).contains(library));
}

}  // namespace
}  // namespace artus
