// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/text_file.h"
#include "artus/detail/dataset/pose_draw.h"
#include "artus/detail/dataset/shard_merge.h"
#include "artus/detail/dataset/shards.h"
#include "artus/detail/evidence/runs/echo_phantom.h"
#include "tests/support/temporary_folder.h"

namespace artus::test {

namespace fs = std::filesystem;

/// Four small shards of ten drawn frames, the last of one frame, of a flat block.
class Shards : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    const std::array<FlatLayer, 3> layers{{{"fat", 5e-3}, {"muscle", 12e-3}, {"bone", 20e-3}}};
    scene_ = make_block_scene(layers);
    options_.sweep.transducer.n_lines = 32;
    options_.sweep.settings.n_samples = 256;
    options_.sweep.settings.n_planes = 1;
    options_.sweep.settings.pixel = 0.5e-3;
    options_.frames = 3;
    options_.engine = "1.0";
    DrawRanges ranges;
    ranges.lateral = {-5e-3, 5e-3};
    source_ = drawn_frames({{scene_}, {}}, ranges, 7, 10);
  }
  [[nodiscard]] Result<ShardResult> write(const std::string& name, const ShardJob& job = {}) const {
    return write_shards(scene_, source_, job, folder_ / name, options_);
  }
  [[nodiscard]] std::map<std::string, std::string> content(const std::string& name) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder_ / name))
      files[entry.path().filename().string()] = *read_bytes(entry.path());
    return files;
  }
  [[nodiscard]] MergedSet merge(const std::vector<std::string>& names) const {
    std::vector<fs::path> folders;
    for (const std::string& name : names) folders.push_back(folder_ / name);
    const auto set = merge_shards(folders, folder_ / "set.json");
    EXPECT_TRUE(set) << set.error().to_string();
    return set.value_or(MergedSet{});
  }

  std::shared_ptr<const Scene> scene_;
  FrameSource source_;
  ShardOptions options_;
};

}  // namespace artus::test
