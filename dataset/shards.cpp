// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/dataset/shards.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include <opencv2/imgcodecs.hpp>

#include <nlohmann/json.hpp>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/dataset/secure_hash.h"
#include "artus/detail/dataset/sweep_frame.h"
#include "artus/detail/dataset/tar_file.h"

namespace artus {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Range {
  std::size_t first;
  std::size_t last;
};

fs::path shard_file(const fs::path& folder, std::size_t shard, const char* extension) {
  const std::string name = printed("shard-%06zu%s", shard, extension);
  return folder / name;
}

std::string png_of(const cv::Mat& picture) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", picture, bytes);
  return {bytes.begin(), bytes.end()};
}

/// The members of one frame, the first of each key being what WebDataset calls a sample.
Result<void> append_frame(std::string& archive, std::size_t index, const SweepFrame& frame,
                          const std::optional<LineFile>& rf) {
  const std::string key = printed("%09zu", index);
  append_member(archive, key + ".json",
                frame.truth.dump(-1, ' ', false, json::error_handler_t::replace));
  for (std::size_t i = 0; i < frame.pictures.size(); ++i) {
    cv::Mat picture = frame.pictures[i].second;
    if (picture.depth() != CV_8U) picture.convertTo(picture, CV_8U);
    append_member(archive, key + ending_of(frame.pictures[i].first, '.'), png_of(picture));
  }
  if (frame.rf) {
    const auto bytes = rf->encode(*frame.rf);
    ARTUS_TRY(bytes);
    append_member(archive, key + "." + std::string(kRfKey) + "." + rf->ending, *bytes);
  }
  return {};
}

json describe(const std::shared_ptr<const Scene>& scene, const FrameSource& frames,
              const ShardOptions& options) {
  json asked = describe_sweep(scene->joint(), options.sweep);
  asked["poses"] = {{"count", frames.count}, {"digest", frames.digest}};
  asked["frames_per_shard"] = options.frames;
  asked["engine"] = options.engine;
  return asked;
}

/// Whether a shard is finished; an error when it is one of another sweep.
Result<bool> is_there(const fs::path& folder, std::size_t shard, const json& asked) {
  const fs::path sidecar = shard_file(folder, shard, ".json");
  std::error_code error;
  if (!fs::exists(sidecar, error)) return false;
  const auto text = read_bytes(sidecar);
  ARTUS_TRY(text);
  const json said = json::parse(*text, nullptr, false);
  if (!said.is_object()) return false;
  if (said.value("sweep", json()) != asked)
    return fail(ErrorCode::invalid,
                "the folder holds a shard of another sweep; choose another folder, or throw its "
                "shards away with --restart",
                sidecar.string());
  const auto size = fs::file_size(shard_file(folder, shard, ".tar"), error);
  return !error && said.value("bytes", json()) == json(size);
}

Result<std::string> draw_shard(SweepDrawer& drawer, const FrameSource& frames, const Range& range,
                               const SweepOptions& options) {
  std::string archive;
  for (std::size_t i = range.first; i < range.last; ++i) {
    if (options.stop && options.stop()) return std::string();
    ARTUS_TRY(append_frame(archive, i, drawer.draw(i, frames.frame(i)), options.rf));
  }
  finish_archive(archive);
  return archive;
}

Result<void> write_shard(const fs::path& folder, std::size_t shard, const Range& range,
                         const std::string& archive, const json& asked) {
  ARTUS_TRY(write_durably(shard_file(folder, shard, ".tar"), archive));
  const json sidecar{
      {"shard", shard},          {"first", range.first},          {"last", range.last},
      {"bytes", archive.size()}, {"sha256", sha256_hex(archive)}, {"sweep", asked}};
  return write_durably(shard_file(folder, shard, ".json"), sidecar.dump(2) + "\n");
}

Result<std::vector<std::size_t>> shards_of(const ShardJob& job, const FrameSource& frames,
                                           std::size_t per_shard) {
  const std::size_t last = job.last == 0 ? frames.count : job.last;
  if (job.first % per_shard != 0 || (last % per_shard != 0 && last != frames.count) ||
      job.first >= last || last > frames.count)
    return fail(ErrorCode::invalid,
                "frames are drawn in whole shards: first and last must be multiples of " +
                    std::to_string(per_shard) + ", the last at most " +
                    std::to_string(frames.count),
                "--frames");
  std::vector<std::size_t> shards;
  for (std::size_t s = job.first / per_shard; s * per_shard < last; ++s)
    if (s % job.of == job.turn) shards.push_back(s);
  return shards;
}

Result<std::pair<std::size_t, std::size_t>> parse_two(const std::string& text, char separator,
                                                      const std::string& flag) {
  const char* end = text.data() + text.size();
  std::size_t a = 0;
  std::size_t b = 0;
  const auto first = std::from_chars(text.data(), end, a);
  if (first.ec == std::errc{} && first.ptr != end && *first.ptr == separator) {
    const auto second = std::from_chars(first.ptr + 1, end, b);
    if (second.ec == std::errc{} && second.ptr == end) return std::pair{a, b};
  }
  return fail(ErrorCode::malformed,
              "'" + text + "' must be two whole numbers with '" + separator + "' between", flag);
}

}  // namespace

Result<ShardJob> parse_turn(const std::string& text, const std::string& flag) {
  const auto two = parse_two(text, '/', flag);
  ARTUS_TRY(two);
  if (two->first >= two->second)
    return fail(ErrorCode::malformed, "in k/N, k counts from 0 and must be below N", flag);
  ShardJob job;
  job.turn = two->first;
  job.of = two->second;
  return job;
}

Result<ShardJob> parse_frames(const std::string& text, const std::string& flag) {
  const auto two = parse_two(text, ':', flag);
  ARTUS_TRY(two);
  if (two->first >= two->second)
    return fail(ErrorCode::malformed, "a:b means frames a to b - 1; a must be below b", flag);
  ShardJob job;
  job.first = two->first;
  job.last = two->second;
  return job;
}

Result<ShardResult> write_shards(const std::shared_ptr<const Scene>& scene,
                                 const FrameSource& frames, const ShardJob& job,
                                 const fs::path& folder, const ShardOptions& options,
                                 const Progress& progress) {
  constexpr std::size_t kMaxRegions = 256;  // of an 8-bit picture
  ARTUS_TRY(check_sweep(options.sweep, folder.string()));
  const auto many = [](const auto& body) {
    return body->joint().regions.size() > kMaxRegions;
  };
  if (many(scene) ||
      std::any_of(options.sweep.patients.begin(), options.sweep.patients.end(), many))
    return fail(ErrorCode::invalid,
                "the joint has more than the 256 regions that 8-bit labels can hold");
  const auto shards = shards_of(job, frames, options.frames);
  ARTUS_TRY(shards);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return fail(ErrorCode::unreadable, error.message(), folder.string());
  const json asked = describe(scene, frames, options);
  ShardResult result;
  result.shards = shards->size();
  std::unique_ptr<SweepDrawer> drawer;
  for (std::size_t k = 0; k < shards->size(); ++k) {
    const std::size_t shard = (*shards)[k];
    const auto there = options.sweep.restart ? Result<bool>(false) : is_there(folder, shard, asked);
    ARTUS_TRY(there);
    result.found += *there ? 1 : 0;
    if (*there) continue;
    if (!drawer) drawer = std::make_unique<SweepDrawer>(scene, options.sweep);
    const Range range{shard * options.frames, std::min(frames.count, (shard + 1) * options.frames)};
    const auto archive = draw_shard(*drawer, frames, range, options.sweep);
    ARTUS_TRY(archive);
    if (archive->empty()) break;
    ARTUS_TRY(write_shard(folder, shard, range, *archive, asked));
    ++result.drawn;
    result.frames += range.last - range.first;
    result.bytes += archive->size();
    if (progress)
      progress("shards", static_cast<double>(k + 1) / static_cast<double>(shards->size()));
  }
  return result;
}

}  // namespace artus
