// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/cells/xml_arrays.h"

#include <array>
#include <cstdint>
#include <cstring>

#include "artus/detail/anatomy/import/volumes/image_volume.h"
#include "artus/detail/anatomy/import/volumes/inflate.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_cursor.h"

namespace artus {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 31U;  // of one array

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/// Bytes one after the other, raw or as base64, whose padding may stand between parts.
class ByteSource {
 public:
  ByteSource(std::string_view text, bool is_base64) : text_(text), is_base64_(is_base64) {}

  /// The next `n` bytes; false when there are fewer.
  bool take(std::size_t n, std::string& out) {
    if (n > kMostBytes || n > left()) return false;
    if (!is_base64_) {
      out.assign(text_.substr(0, n));
      text_.remove_prefix(n);
      return true;
    }
    while (decoded_.size() < n)
      if (!decode_four()) return false;
    out = decoded_.substr(0, n);
    decoded_.erase(0, n);
    return true;
  }

 private:
  /// How many bytes can be left at most.
  [[nodiscard]] std::size_t left() const {
    return is_base64_ ? decoded_.size() + text_.size() / 4 * 3 + 3 : text_.size();
  }
  static int value_of(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+') return 62;
    return c == '/' ? 63 : -1;
  }
  /// Decodes many groups of four, since erasing from the front costs.
  bool decode_four() {
    constexpr std::size_t kMany = 1 << 16;
    std::string more;
    while (more.size() < kMany) {
      std::array<int, 4> group{};
      std::size_t n = 0, padding = 0;
      while (n < 4 && !text_.empty()) {
        const char c = text_.front();
        if (!is_space(c) && c != '=' && value_of(c) < 0) break;
        text_.remove_prefix(1);
        if (is_space(c)) continue;
        padding += c == '=' ? 1 : 0;
        group.at(n++) = c == '=' ? 0 : value_of(c);
      }
      if (n < 4 || padding > 2) break;
      const auto all =
          static_cast<std::uint32_t>(group[0] << 18 | group[1] << 12 | group[2] << 6 | group[3]);
      for (std::size_t k = 0; k + padding < 3; ++k)
        more += static_cast<char>(all >> (16 - 8 * k) & 0xffU);
    }
    decoded_ += more;
    return !more.empty();
  }

  std::string_view text_;
  bool is_base64_;
  std::string decoded_;
};

tl::unexpected<Error> cut_off(const std::string& where) {
  return fail(ErrorCode::corrupt, "an array of it is cut off or damaged; export it again", where);
}

/// A size before data. nullopt: there is none.
std::optional<std::size_t> take_size(ByteSource& source, const XmlArrayForm& form) {
  std::string bytes;
  const std::size_t width = form.has_long_header ? 8 : 4;
  if (!source.take(width, bytes)) return std::nullopt;
  if (form.is_big_endian) swap_bytes(bytes, width);
  std::uint64_t value = 0;
  std::memcpy(&value, bytes.data(), width);
  return value;
}

Result<std::string> take_compressed(ByteSource& source, const XmlArrayForm& form,
                                    const std::string& where) {
  const auto n_blocks = take_size(source, form);
  const auto block = take_size(source, form);
  const auto last = take_size(source, form);
  if (!n_blocks || !block || !last || *n_blocks > kMostBytes || *block > kMostBytes ||
      *last > kMostBytes || *n_blocks * *block > kMostBytes)
    return cut_off(where);
  std::vector<std::size_t> sizes;
  for (std::size_t k = 0; k < *n_blocks; ++k) {
    const auto size = take_size(source, form);
    if (!size) return cut_off(where);
    sizes.push_back(*size);
  }
  std::string all, packed;
  for (std::size_t k = 0; k < *n_blocks; ++k) {
    if (!source.take(sizes[k], packed)) return cut_off(where);
    const bool is_last = k + 1 == *n_blocks && *last > 0;
    const auto bytes = inflate_exactly(packed, is_last ? *last : *block, where);
    ARTUS_TRY(bytes);
    all += *bytes;
  }
  return all;
}

template <class T>
std::vector<double> numbers_in(const std::string& bytes) {
  std::vector<double> numbers(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    T value;
    std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
    numbers[i] = static_cast<double>(value);
  }
  return numbers;
}

Result<std::vector<double>> numbers_of_type(std::string bytes, const std::string& type,
                                            bool is_big_endian, const std::string& where) {
  const auto as = [&]<class T>(T) {
    if (is_big_endian) swap_bytes(bytes, sizeof(T));
    return numbers_in<T>(bytes);
  };
  if (type == "Float32") return as(float{});
  if (type == "Float64") return as(double{});
  if (type == "Int8") return as(std::int8_t{});
  if (type == "UInt8") return as(std::uint8_t{});
  if (type == "Int16") return as(std::int16_t{});
  if (type == "UInt16") return as(std::uint16_t{});
  if (type == "Int32") return as(std::int32_t{});
  if (type == "UInt32") return as(std::uint32_t{});
  if (type == "Int64") return as(std::int64_t{});
  if (type == "UInt64") return as(std::uint64_t{});
  return fail(ErrorCode::unsupported, "arrays of this type are not read: " + artus::quoted(type),
              where);
}

Result<std::vector<double>> read_text(std::string_view text, const std::string& where) {
  std::vector<double> numbers;
  TextCursor cursor(text, where);
  for (auto token = cursor.next(); !token.empty(); token = cursor.next()) {
    const auto number = parse_number(token);
    if (!number) return fail(ErrorCode::malformed, quoted(token) + " is not a number", where);
    numbers.push_back(*number);
  }
  return numbers;
}

/// Attributes of the text of a tag: a="b" or a='b'.
void read_attributes(std::string_view text, XmlTag& tag) {
  std::size_t at = 0;
  while (at < text.size()) {
    while (at < text.size() && (is_space(text[at]) || text[at] == '/')) ++at;
    const auto equals = text.find('=', at);
    if (equals == std::string_view::npos) return;
    std::string_view key = text.substr(at, equals - at);
    while (!key.empty() && is_space(key.back())) key.remove_suffix(1);
    const auto open = text.find_first_of("\"'", equals);
    if (open == std::string_view::npos) return;
    const auto close = text.find(text[open], open + 1);
    if (close == std::string_view::npos) return;
    tag.attributes[std::string(key)] = std::string(text.substr(open + 1, close - open - 1));
    at = close + 1;
  }
}

}  // namespace

std::string XmlTag::attribute(std::string_view key) const {
  const auto at = attributes.find(key);
  return at == attributes.end() ? std::string() : at->second;
}

std::optional<XmlTag> next_tag(std::string_view bytes, std::size_t& at) {
  while (true) {
    const auto open = bytes.find('<', at);
    if (open == std::string_view::npos) return std::nullopt;
    const bool is_comment = bytes.substr(open, 4) == "<!--";
    const auto close = is_comment ? bytes.find("-->", open) : bytes.find('>', open);
    if (close == std::string_view::npos) return std::nullopt;
    at = close + 1;
    std::string_view inside = bytes.substr(open + 1, close - open - 1);
    if (is_comment || inside.empty() || inside.front() == '?' || inside.front() == '!') continue;
    XmlTag tag;
    tag.end = at;
    tag.is_end = inside.front() == '/';
    tag.is_empty = inside.back() == '/';
    if (tag.is_end) inside.remove_prefix(1);
    const auto blank = inside.find_first_of(" \t\r\n/");
    tag.name = std::string(inside.substr(0, blank));
    if (blank != std::string_view::npos) read_attributes(inside.substr(blank), tag);
    return tag;
  }
}

Result<std::vector<double>> read_xml_array(const XmlTag& tag, std::string_view text,
                                           const XmlArrayForm& form, const std::string& where) {
  const std::string how = tag.attribute("format");
  if (how == "ascii" || how.empty()) return read_text(text, where);
  std::optional<ByteSource> source;
  if (how == "binary") {
    source.emplace(text, true);
  } else if (how == "appended") {
    const auto offset = parse_integer(tag.attribute("offset"));
    if (!offset || *offset < 0 || static_cast<std::size_t>(*offset) > form.appended.size())
      return cut_off(where);
    source.emplace(form.appended.substr(static_cast<std::size_t>(*offset)), !form.appended_is_raw);
  } else {
    return fail(ErrorCode::unsupported, "arrays of this format are not read: " + artus::quoted(how),
                where);
  }
  std::string bytes;
  if (form.is_compressed) {
    auto all = take_compressed(*source, form, where);
    ARTUS_TRY(all);
    bytes = std::move(*all);
  } else {
    const auto size = take_size(*source, form);
    if (!size || !source->take(*size, bytes)) return cut_off(where);
  }
  return numbers_of_type(std::move(bytes), tag.attribute("type"), form.is_big_endian, where);
}

}  // namespace artus
