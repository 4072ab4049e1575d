// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace artus {

/// 128 bits over all that was added, in its order: what is made of the same has the same.
class ContentDigest {
 public:
  /// Starts with `version`.
  explicit ContentDigest(std::uint64_t version) : low_(version), high_(~version) {}
  void add(std::string_view bytes) noexcept;
  void add(const ContentDigest& other) noexcept {
    add_value(other.low_);
    add_value(other.high_);
  }
  template <class T>
  void add_value(const T& value) noexcept {
    static_assert(std::is_arithmetic_v<T>);
    add({reinterpret_cast<const char*>(&value), sizeof value});
  }
  /// 32 hex digits.
  [[nodiscard]] std::string hex() const;

 private:
  std::uint64_t low_;
  std::uint64_t high_;
};

/// What earlier compilations made of single structures, a file each, named by the digest of what
/// it was made of. A damaged file counts as none; what cannot be written is not kept. Copies share
/// their count; find and keep may be called by many threads.
class PartCache {
 public:
  PartCache() = default;  ///< keeps nothing
  explicit PartCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

  [[nodiscard]] std::optional<std::string> find(const ContentDigest& digest) const;
  void keep(const ContentDigest& digest, std::string_view bytes) const;
  /// Removes what was used longest ago beyond `max_bytes` in all.
  void forget_old(std::uintmax_t max_bytes) const;

  [[nodiscard]] bool keeps() const noexcept { return !folder_.empty(); }
  /// How many were found.
  [[nodiscard]] std::size_t found() const noexcept { return *found_; }

 private:
  std::filesystem::path folder_;
  std::shared_ptr<std::atomic<std::size_t>> found_ = std::make_shared<std::atomic<std::size_t>>(0);
};

}  // namespace artus
