// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <unistd.h>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "tests/anatomy/surfaces/surface_samples.h"

namespace artus::test {

inline constexpr double kMm = 1e-3;

/// A fresh folder of a joint, removed at the end.
class JointFolder {
 public:
  explicit JointFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("artus-" + name + "-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  JointFolder(const JointFolder&) = delete;
  JointFolder& operator=(const JointFolder&) = delete;
  JointFolder(JointFolder&&) = delete;
  JointFolder& operator=(JointFolder&&) = delete;
  ~JointFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  void add_sphere(const std::string& name, const Vec3& centre_mm, double radius_mm) const {
    const auto written =
        write_surface(make_sphere(centre_mm * kMm, radius_mm * kMm), path_ / (name + ".ply"), kMm);
    ASSERT_TRUE(written) << written.error().to_string();
  }
  void write_toml(const std::string& structures) const {
    std::ofstream(path_ / "joint.toml") << R"(format = 1
name = "balls"
title = "Balls"
side = "none"
units = "mm"
axes = "LPS"
[mesh]
facet_size = 3.0
facet_distance = 0.2
cell_size = 8.0
[body]
file = "body.ply"
filler = "filler"
tissue = "fat"
[probe]
position = [0.0, 0.0, 30.0]
direction = [0.0, 0.0, -1.0]
lateral = [1.0, 0.0, 0.0]
[needle]
entry = [0.0, 0.0, 30.0]
target = [0.0, 0.0, 0.0]
)" << structures << bone_;
  }
  /// A small bone that holds the tissue, behind the structures of every write_toml from now on.
  void add_bone() {
    add_sphere("femur", Vec3(0, 0, -20), 5);
    bone_ = "[[structure]]\nname = \"femur\"\ntissue = \"bone\"\nfile = \"femur.ply\"\n";
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::string bone_;
};

/// The content of a file.
[[nodiscard]] inline std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

}  // namespace artus::test
