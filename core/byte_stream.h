// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace artus {

static_assert(std::endian::native == std::endian::little,
              "compiled joints are little endian and read without swapping");

/// 64-bit hash of bytes, eight at a time; for checksums and digests, not for security.
[[nodiscard]] std::uint64_t hash_bytes(std::string_view bytes, std::uint64_t seed = 0) noexcept;

/// Appends values to a string of bytes.
class ByteWriter {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void put(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size()));
    bytes_.append(text);
  }
  /// The elements without padding: T must have none.
  template <class T>
  void put_array(const std::vector<T>& values) {
    put(static_cast<std::uint64_t>(values.size()));
    if (!values.empty()) {
      bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    }
  }
  [[nodiscard]] const std::string& bytes() const noexcept { return bytes_; }

 private:
  std::string bytes_;
};

/// Takes values from bytes; after the first one that is not there, every further one is zero and
/// ok() is false.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  [[nodiscard]] T get() {
    static_assert(std::is_arithmetic_v<T>);
    T value{};
    if (take(sizeof value)) std::memcpy(&value, taken_, sizeof value);
    return value;
  }
  [[nodiscard]] std::string get_text() {
    const auto n = get<std::uint32_t>();
    return take(n) ? std::string(taken_, n) : std::string();
  }
  template <class T>
  [[nodiscard]] std::vector<T> get_array() {
    const auto n = get<std::uint64_t>();
    std::vector<T> values;
    if (n > rest_.size() / sizeof(T)) {
      ok_ = false;
      return values;
    }
    values.resize(n);
    if (take(n * sizeof(T)) && n > 0) {
      std::memcpy(static_cast<void*>(values.data()), taken_, n * sizeof(T));
    }
    return values;
  }
  /// For a value that was read but cannot be: ok() is false from now on.
  void refuse() noexcept { ok_ = false; }
  /// How many elements of at least `size` bytes follow; refuses more than can be there.
  [[nodiscard]] std::uint32_t get_count(std::size_t size) {
    const auto n = get<std::uint32_t>();
    if (n > rest_.size() / size) ok_ = false;
    return ok_ ? n : 0;
  }
  [[nodiscard]] bool ok() const noexcept { return ok_; }
  [[nodiscard]] bool at_end() const noexcept { return rest_.empty(); }

 private:
  bool take(std::size_t n) {
    if (!ok_ || n > rest_.size()) {
      ok_ = false;
      return false;
    }
    taken_ = rest_.data();
    rest_.remove_prefix(n);
    return true;
  }

  std::string_view rest_;
  const char* taken_ = nullptr;
  bool ok_ = true;
};

}  // namespace artus
