// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/labels/part_cache.h"

#include <algorithm>
#include <cstring>
#include <thread>
#include <vector>

#include "artus/detail/core/byte_stream.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_file.h"

namespace artus {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExtension = ".part";

fs::path file_of(const fs::path& folder, const ContentDigest& digest) {
  return folder / (digest.hex() + kExtension);
}

}  // namespace

void ContentDigest::add(std::string_view bytes) noexcept {
  low_ = hash_bytes(bytes, low_);
  high_ = hash_bytes(bytes, high_);
}

std::string ContentDigest::hex() const {
  return in_hexadecimal(low_) + in_hexadecimal(high_);
}

std::optional<std::string> PartCache::find(const ContentDigest& digest) const {
  if (!keeps()) return std::nullopt;
  const fs::path file = file_of(folder_, digest);
  auto bytes = read_bytes(file);
  std::uint64_t checksum = 0;
  if (!bytes || bytes->size() < sizeof checksum) return std::nullopt;
  const std::size_t size = bytes->size() - sizeof checksum;
  std::memcpy(&checksum, bytes->data() + size, sizeof checksum);
  if (hash_bytes(std::string_view(*bytes).substr(0, size)) != checksum) return std::nullopt;
  bytes->resize(size);
  std::error_code ignored;
  fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
  ++*found_;
  return std::move(*bytes);
}

void PartCache::keep(const ContentDigest& digest, std::string_view bytes) const {
  if (!keeps()) return;
  const std::uint64_t checksum = hash_bytes(bytes);
  std::string whole(bytes);
  whole.append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
  // Another thread or program may be keeping the same: each writes a file of its own first.
  const fs::path file = file_of(folder_, digest);
  fs::path written = file;
  written += "." + std::to_string(std::hash<std::thread::id>{}(std::this_thread::get_id()));
  std::error_code error;
  if (write_text(written, whole)) fs::rename(written, file, error);
  if (error) fs::remove(written, error);
}

void PartCache::forget_old(std::uintmax_t max_bytes) const {
  if (!keeps()) return;
  struct Kept {
    fs::file_time_type used;
    std::uintmax_t bytes;
    fs::path file;
  };
  std::vector<Kept> all;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_, ignored)) {
    if (entry.path().extension() != kExtension) continue;
    all.push_back({entry.last_write_time(ignored), entry.file_size(ignored), entry.path()});
  }
  std::sort(all.begin(), all.end(), [](const Kept& a, const Kept& b) { return a.used > b.used; });
  std::uintmax_t bytes = 0;
  for (const Kept& kept : all) {
    bytes += kept.bytes;
    if (bytes > max_bytes) fs::remove(kept.file, ignored);
  }
}

}  // namespace artus
