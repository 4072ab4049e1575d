// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/bundled.h"

#include <cstdlib>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

namespace fs = std::filesystem;

class Bundled : public test::TemporaryFolder {
 protected:
  void SetUp() override {
    test::TemporaryFolder::SetUp();
    data_ = folder_;
    fs::create_directories(data_ / "meshes" / "jaw");
    unsetenv("ARTUS_DATA");  // NOLINT(concurrency-mt-unsafe): one thread
  }
  void TearDown() override {
    fs::current_path(before_);
    unsetenv("ARTUS_DATA");  // NOLINT(concurrency-mt-unsafe)
    test::TemporaryFolder::TearDown();
  }
  const fs::path before_ = fs::current_path();
  fs::path data_;
};

TEST_F(Bundled, IsFoundInTheTreeThatTheProgramWasBuiltInFromAnyFolder) {
  fs::current_path("/");
  const fs::path found = find_bundled("meshes/simple-shoulder");
  ASSERT_FALSE(found.empty());
  EXPECT_TRUE(fs::equivalent(found, test::source_dir() / "meshes" / "simple-shoulder"));
}

TEST_F(Bundled, IsTakenFromTheFolderThatTheEnvironmentNamesFirst) {
  fs::create_directories(data_ / "meshes" / "simple-shoulder");
  setenv("ARTUS_DATA", data_.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  EXPECT_EQ(find_bundled("meshes/simple-shoulder"), data_ / "meshes/simple-shoulder");
  EXPECT_FALSE(find_bundled("meshes/shoulder").empty()) << "what it lacks is found elsewhere";
}

TEST_F(Bundled, IsTakenFromTheCurrentFolderLast) {
  EXPECT_TRUE(find_bundled("meshes/jaw").empty());
  fs::current_path(data_);
  EXPECT_EQ(find_bundled("meshes/jaw"), fs::path("meshes/jaw"));
  fs::create_directories("meshes/simple-shoulder");
  EXPECT_TRUE(find_bundled("meshes/simple-shoulder").is_absolute());
}

TEST_F(Bundled, WantsAPathWithinWhatIsBundled) {
  EXPECT_THROW(static_cast<void>(find_bundled("/meshes")), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(find_bundled("")), std::invalid_argument);
}

}  // namespace
}  // namespace artus
