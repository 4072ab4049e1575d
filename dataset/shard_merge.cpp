// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/dataset/shard_merge.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "artus/detail/core/text_file.h"
#include "artus/detail/dataset/secure_hash.h"
#include "artus/detail/dataset/tar_file.h"

namespace artus {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Shard {
  fs::path tar;
  json sidecar;
  std::size_t first = 0;
  std::size_t last = 0;
};

Result<std::vector<fs::path>> find_sidecars(const std::vector<fs::path>& folders) {
  std::vector<fs::path> found;
  for (const fs::path& folder : folders) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      const std::string name = entry.path().filename().string();
      if (name.rfind("shard-", 0) == 0 && entry.path().extension() == ".json")
        found.push_back(entry.path());
    }
    if (error) return fail(ErrorCode::not_found, error.message(), folder.string());
  }
  if (found.empty())
    return fail(ErrorCode::not_found, "the folder has no finished shard", folders.front().string());
  std::sort(found.begin(), found.end());
  return found;
}

std::optional<Shard> read_shard(const fs::path& file, std::vector<std::string>& problems) {
  const auto text = read_bytes(file);
  const json sidecar = text ? json::parse(*text, nullptr, false) : json();
  const auto whole = [&](const char* key) {
    return sidecar.contains(key) && sidecar[key].is_number_unsigned();
  };
  if (!sidecar.is_object() || !whole("first") || !whole("last") || !whole("bytes") ||
      !sidecar.contains("sha256") || !sidecar.contains("sweep")) {
    problems.push_back(file.string() + ": not the JSON of a shard");
    return std::nullopt;
  }
  fs::path tar = file;
  tar.replace_extension(".tar");
  return Shard{tar, sidecar, sidecar["first"].get<std::size_t>(),
               sidecar["last"].get<std::size_t>()};
}

/// What is wrong with a shard's bytes; empty when nothing is.
std::string damage_of(const Shard& shard) {
  const auto archive = read_bytes(shard.tar);
  if (!archive) return "damaged: " + archive.error().message;
  if (json(archive->size()) != shard.sidecar["bytes"])
    return "damaged: its size differs from its JSON";
  if (json(sha256_hex(*archive)) != shard.sidecar["sha256"])
    return "damaged: its sha256 differs from its JSON";
  const auto members = list_members(*archive);
  if (!members) return "damaged: " + members.error().message;
  const auto samples = static_cast<std::size_t>(
      std::count_if(members->begin(), members->end(), [](const TarMember& member) {
        return member.name.size() > 5 && member.name.substr(member.name.size() - 5) == ".json";
      }));
  return samples == shard.last - shard.first
             ? ""
             : "damaged: its number of frames differs from its JSON";
}

std::string frames_text(std::size_t first, std::size_t last) {
  return "frames " + std::to_string(first) + ":" + std::to_string(last);
}

void check_ranges(const std::vector<Shard>& shards, std::size_t count,
                  std::vector<std::string>& problems) {
  std::size_t next = 0;
  for (const Shard& shard : shards) {
    if (shard.first > next) problems.push_back("missing: " + frames_text(next, shard.first));
    if (shard.first < next)
      problems.push_back(shard.tar.string() + ": doubled, " +
                         frames_text(shard.first, std::min(next, shard.last)));
    next = std::max(next, shard.last);
  }
  if (next < count) problems.push_back("missing: " + frames_text(next, count));
  if (next > count) problems.push_back("more frames than the sweep has");
}

json listing(const std::vector<Shard>& shards, const MergedSet& set) {
  json list = json::array();
  for (const Shard& shard : shards)
    list.push_back({{"file", shard.tar.filename().string()},
                    {"folder", shard.tar.parent_path().string()},
                    {"first", shard.first},
                    {"last", shard.last},
                    {"bytes", shard.sidecar["bytes"]},
                    {"sha256", shard.sidecar["sha256"]}});
  return {{"frames", set.frames},
          {"bytes", set.bytes},
          {"sweep", shards.front().sidecar["sweep"]},
          {"shards", list}};
}

}  // namespace

Result<MergedSet> merge_shards(const std::vector<fs::path>& folders, const fs::path& out,
                               const Progress& progress) {
  const auto files = find_sidecars(folders);
  ARTUS_TRY(files);
  MergedSet set;
  std::vector<Shard> shards;
  for (const fs::path& file : *files)
    if (auto shard = read_shard(file, set.problems)) shards.push_back(std::move(*shard));
  if (shards.empty()) return set;
  const json sweep = shards.front().sidecar["sweep"];
  std::vector<Shard> own;
  for (std::size_t i = 0; i < shards.size(); ++i) {
    if (shards[i].sidecar["sweep"] != sweep) {
      set.problems.push_back(shards[i].tar.string() + ": foreign, of another sweep than " +
                             shards.front().tar.string());
      continue;
    }
    if (const std::string damage = damage_of(shards[i]); !damage.empty())
      set.problems.push_back(shards[i].tar.string() + ": " + damage);
    set.frames += shards[i].last - shards[i].first;
    set.bytes += shards[i].sidecar["bytes"].get<std::uint64_t>();
    own.push_back(shards[i]);
    if (progress)
      progress("merge", static_cast<double>(i + 1) / static_cast<double>(shards.size()));
  }
  set.shards = own.size();
  std::sort(own.begin(), own.end(),
            [](const Shard& a, const Shard& b) { return a.first < b.first; });
  const json poses = sweep.value("poses", json::object());
  const json count = poses.value("count", json());
  if (!count.is_number_unsigned())
    set.problems.push_back(own.front().tar.string() + ": does not say how many frames there are");
  else
    check_ranges(own, count.get<std::size_t>(), set.problems);
  if (set.problems.empty()) ARTUS_TRY(write_durably(out, listing(own, set).dump(2) + "\n"));
  return set;
}

}  // namespace artus
