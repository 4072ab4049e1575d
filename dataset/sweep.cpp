// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/dataset/sweep.h"

#include <array>
#include <fstream>
#include <string>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/dataset/sweep_frame.h"
#include "artus/echo/image_io.h"

namespace artus {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Keeps a second process out of the folder for as long as it lives.
class FolderLock {
 public:
  static Result<FolderLock> take(const fs::path& folder) {
    const fs::path file = folder / "sweep.lock";
    FolderLock lock;
    lock.file_ = open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644);
    if (lock.file_ < 0) return fail(ErrorCode::unreadable, "cannot be written", file.string());
    if (flock(lock.file_, LOCK_EX | LOCK_NB) != 0)
      return fail(ErrorCode::invalid, "another process is drawing into this folder",
                  folder.string());
    return lock;
  }
  FolderLock(FolderLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  FolderLock& operator=(FolderLock&&) = delete;
  ~FolderLock() {
    if (file_ >= 0) close(file_);
  }

 private:
  FolderLock() = default;
  int file_ = -1;
};

json describe_sweep(const CompiledJoint& joint, const std::vector<ListedPose>& poses,
                    const SweepOptions& options) {
  json description = describe_sweep(joint, options);
  description["format"] = 1;
  description["poses"] = {{"count", poses.size()}, {"digest", digest_of(poses)}};
  return description;
}

/// A file under its name or not at all; `write` makes it under another one.
template <class Write>
Result<void> write_whole(const fs::path& file, const Write& write) {
  const fs::path part = file.parent_path() / ("part-" + file.filename().string());
  ARTUS_TRY(write(part));
  std::error_code error;
  fs::rename(part, file, error);
  if (error) return fail(ErrorCode::unreadable, error.message(), file.string());
  return {};
}

/// Whether a line of truth.jsonl is that of frame `index`, with all its pictures.
bool is_finished(std::string_view line, std::size_t index, const fs::path& folder) {
  const json truth = json::parse(line, nullptr, false);
  if (!truth.is_object() || truth.value("index", json()) != json(index)) return false;
  std::vector<std::string_view> keys(kPictureKeys.begin(), kPictureKeys.end());
  keys.push_back(kRfKey);
  for (const std::string_view key : keys) {
    const auto place = truth.find(key);
    if (place == truth.end()) continue;
    std::error_code error;
    if (!place->is_string() || fs::file_size(folder / place->get<std::string>(), error) == 0 ||
        error)
      return false;
  }
  return truth.contains("image");
}

/// The number of finished frames; whatever follows the last of them in `file` is cut off.
Result<std::size_t> find_finished(const fs::path& file, const fs::path& folder) {
  if (!fs::exists(file)) return 0;
  const auto text = read_bytes(file);
  ARTUS_TRY(text);
  std::size_t count = 0;
  std::size_t end = 0;
  while (true) {
    const std::size_t newline = text->find('\n', end);
    if (newline == std::string::npos) break;
    if (!is_finished(std::string_view(*text).substr(end, newline - end), count, folder)) break;
    ++count;
    end = newline + 1;
  }
  std::error_code error;
  if (end != text->size()) fs::resize_file(file, end, error);
  if (error) return fail(ErrorCode::unreadable, error.message(), file.string());
  return count;
}

/// Checks that the folder is this sweep's own, and makes it so when it is new.
Result<void> claim_folder(const fs::path& folder, const json& description, bool restart) {
  const fs::path file = folder / "sweep.json";
  std::error_code error;
  if (restart && fs::exists(file)) {  // never what is not a sweep
    fs::remove(folder / "truth.jsonl", error);
    fs::remove_all(folder / "frames", error);
    fs::remove(file, error);
  }
  fs::create_directories(folder / "frames", error);
  if (error) return fail(ErrorCode::unreadable, error.message(), folder.string());
  if (!fs::exists(file)) {
    if (fs::exists(folder / "truth.jsonl"))
      return fail(ErrorCode::invalid,
                  "the folder holds frames that are not of a sweep; choose another folder",
                  folder.string());
    return write_whole(
        file, [&](const fs::path& part) { return write_text(part, description.dump(2) + "\n"); });
  }
  const auto text = read_bytes(file);
  ARTUS_TRY(text);
  const json earlier = json::parse(*text, nullptr, false);
  for (const auto& [key, value] : description.items()) {
    if (!earlier.is_object() || earlier.value(key, json()) != value)
      return fail(ErrorCode::invalid,
                  "the folder holds another sweep (other " + key +
                      "); choose another folder, or throw it away with --restart",
                  folder.string());
  }
  return {};
}

/// Writes a frame's pictures and returns its line.
Result<json> write_frame(SweepFrame frame, std::size_t index, const fs::path& folder,
                         const std::optional<LineFile>& rf) {
  const std::string stem = printed("frames/%06zu", index);
  for (std::size_t i = 0; i < frame.pictures.size(); ++i) {
    const std::string name = stem + ending_of(frame.pictures[i].first, '-');
    const auto picture = [&](const fs::path& part) {
      return write_image(frame.pictures[i].second, part);
    };
    ARTUS_TRY(write_whole(folder / name, picture));
    frame.truth[frame.pictures[i].first] = name;
  }
  if (frame.rf) {
    const auto bytes = rf->encode(*frame.rf);
    ARTUS_TRY(bytes);
    const std::string name = stem + "-" + std::string(kRfKey) + "." + rf->ending;
    const auto whole = [&](const fs::path& part) {
      return write_text(part, *bytes);
    };
    ARTUS_TRY(write_whole(folder / name, whole));
    frame.truth[kRfKey] = name;
  }
  return std::move(frame.truth);
}

void count_contact(const json& truth, SweepResult& result) {
  const json& contact = truth.at("contact");
  if (!(contact.at("share").get<double>() > 0))
    ++result.off_skin;
  else if (!contact.at("lifted_lines").empty())
    ++result.partly_off;
}

}  // namespace

Result<SweepResult> run_sweep(const std::shared_ptr<const Scene>& scene,
                              const std::vector<ListedPose>& poses, const fs::path& folder,
                              const SweepOptions& options, const Progress& progress) {
  ARTUS_TRY(check_sweep(options, folder.string()));
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return fail(ErrorCode::unreadable, error.message(), folder.string());
  const auto lock = FolderLock::take(folder);
  ARTUS_TRY(lock);
  ARTUS_TRY(claim_folder(folder, describe_sweep(scene->joint(), poses, options), options.restart));
  const fs::path file = folder / "truth.jsonl";
  const auto found = find_finished(file, folder);
  ARTUS_TRY(found);
  SweepResult result;
  result.poses = poses.size();
  result.found = *found;
  if (result.complete()) return result;

  SweepDrawer drawer(scene, options);
  std::ofstream lines(file, std::ios::binary | std::ios::app);
  for (std::size_t i = *found; i < poses.size(); ++i) {
    if (options.stop && options.stop()) break;
    const auto truth = write_frame(drawer.draw(i, FrameOrder(poses[i])), i, folder, options.rf);
    ARTUS_TRY(truth);
    count_contact(*truth, result);
    // A name may hold bytes that are no text.
    lines << truth->dump(-1, ' ', false, json::error_handler_t::replace) + "\n" << std::flush;
    if (!lines) return fail(ErrorCode::unreadable, "cannot be written", file.string());
    ++result.drawn;
    if (progress) progress("sweep", static_cast<double>(i + 1) / static_cast<double>(poses.size()));
  }
  return result;
}

}  // namespace artus
