// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace artus::igtl {

/// Appends values in network byte order, as every field of the protocol is.
class BigEndianWriter {
 public:
  template <class T>
  void put(T value) {
    static_assert(std::is_arithmetic_v<T>);
    if constexpr (std::is_floating_point_v<T>) {
      using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
      put(std::bit_cast<Bits>(value));
    } else {
      const auto bits = static_cast<std::uint64_t>(value);
      for (std::size_t i = sizeof(T); i-- > 0;)
        bytes_.push_back(static_cast<char>((bits >> (8 * i)) & 0xFFU));
    }
  }
  void put_bytes(std::string_view text) { bytes_.append(text); }
  /// Cut or filled with zeros to `size`.
  void put_padded(std::string_view text, std::size_t size) {
    bytes_.append(text.substr(0, size));
    bytes_.append(size - std::min(size, text.size()), '\0');
  }
  [[nodiscard]] std::string& bytes() noexcept { return bytes_; }

 private:
  std::string bytes_;
};

/// Takes values in network byte order; after the first one that is not there every further one is
/// zero and ok() is false.
class BigEndianReader {
 public:
  explicit BigEndianReader(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  [[nodiscard]] T get() {
    static_assert(std::is_arithmetic_v<T>);
    if constexpr (std::is_floating_point_v<T>) {
      using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
      return std::bit_cast<T>(get<Bits>());
    } else {
      std::uint64_t bits = 0;
      for (const char c : get_bytes(sizeof(T))) bits = bits << 8U | static_cast<unsigned char>(c);
      return static_cast<T>(bits);
    }
  }
  /// The next `size` bytes; empty when there are fewer.
  [[nodiscard]] std::string_view get_bytes(std::size_t size) {
    if (!ok_ || size > rest_.size()) {
      ok_ = false;
      return {};
    }
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }
  /// Text up to its first zero in a field of `size` bytes.
  [[nodiscard]] std::string get_padded(std::size_t size) {
    const std::string_view field = get_bytes(size);
    return std::string(field.substr(0, field.find('\0')));
  }
  [[nodiscard]] std::string_view rest() const noexcept { return rest_; }
  [[nodiscard]] bool ok() const noexcept { return ok_; }
  [[nodiscard]] bool at_end() const noexcept { return rest_.empty(); }

 private:
  std::string_view rest_;
  bool ok_ = true;
};

}  // namespace artus::igtl
