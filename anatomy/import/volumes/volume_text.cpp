// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/volumes/volume_text.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "artus/detail/anatomy/import/volumes/inflate.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_lines.h"

namespace artus {

std::optional<std::string_view> take_line(std::string_view& bytes) {
  if (bytes.empty()) return std::nullopt;
  const auto end = bytes.find('\n');
  const std::string_view line = trimmed(bytes.substr(0, end));
  bytes.remove_prefix(end == std::string_view::npos ? bytes.size() : end + 1);
  return line;
}

Result<std::pair<std::string_view, std::string_view>> key_and_value(std::string_view line,
                                                                    char separator,
                                                                    const char* form,
                                                                    const std::string& where) {
  const auto at = line.find(separator);
  if (at == std::string_view::npos)
    return fail(ErrorCode::malformed,
                std::string("a line of ") + form + ", this one has no '" + separator + "'", where);
  return std::pair{trimmed(line.substr(0, at)), trimmed(line.substr(at + 1))};
}

Result<SampleType> sample_type_of(std::string_view word, SampleTypeNames known,
                                  const std::string& where) {
  for (const auto& [name, type] : known)
    if (name == word) return type;
  return fail(ErrorCode::unsupported,
              "samples of type " + quoted(word) + " are no labels; save it with whole numbers",
              where);
}

std::string text_of(const HeaderText& header, std::string_view key) {
  const auto found = header.find(key);
  return found == header.end() ? std::string() : found->second;
}

std::string to_lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

std::optional<std::vector<double>> numbers_of(std::string_view text) {
  std::string plain(text);
  for (char& c : plain)
    if (c == '(' || c == ')' || c == ',') c = ' ';
  std::vector<double> numbers;
  for (const std::string& word : words_of_line(plain)) {
    const auto number = parse_number(word);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

std::vector<std::string> words_of_line(std::string_view text) {
  TextCursor cursor(text, {});
  std::vector<std::string> words;
  for (auto word = cursor.next(); !word.empty(); word = cursor.next()) words.emplace_back(word);
  return words;
}

std::size_t whole_of(double value) noexcept {
  return value >= 1 && value < 2147483648.0 && value == std::floor(value)
             ? static_cast<std::size_t>(value)
             : 0;
}

Result<void> take_samples(std::string_view data, bool compressed, bool big_endian,
                          ImageVolume& volume, const std::string& name) {
  constexpr std::size_t kMost = std::size_t{1} << 36;  // bytes
  const std::size_t width = bytes_of(volume.type);
  const std::size_t voxels = volume.n_voxels();
  if (volume.layers > kMost / (voxels * width))
    return fail(ErrorCode::invalid, "it holds more than any segmentation has; crop it", name);
  const std::size_t wanted = voxels * volume.layers * width;
  if (compressed) {
    auto all = inflate_exactly(data, wanted, name);
    ARTUS_TRY(all);
    volume.samples = std::move(*all);
  } else {
    if (data.size() < wanted)
      return fail(ErrorCode::corrupt,
                  printed("its header promises %zu bytes of voxels and there are %zu; it is not "
                          "complete: copy or download it again",
                          wanted, data.size()),
                  name);
    volume.samples = data.substr(0, wanted);
  }
  if (big_endian) swap_bytes(volume.samples, width);
  return {};
}

std::optional<Vec3> signs_of_space(std::string_view space) {
  const std::string lower = to_lower(space);
  constexpr std::array<std::string_view, 3> kWords{"left", "posterior", "superior"};
  constexpr std::array<std::string_view, 3> kOpposite{"right", "anterior", "inferior"};
  constexpr std::array<char, 3> kLetters{'l', 'p', 's'};
  constexpr std::array<char, 3> kOppositeLetters{'r', 'a', 'i'};
  std::vector<std::string> parts;
  if (lower.size() == 3) {
    for (const char c : lower) parts.emplace_back(1, c);
  } else {
    std::string part;
    for (const char c : lower + "-") {
      if (c != '-') {
        part += c;
        continue;
      }
      parts.push_back(std::exchange(part, {}));
    }
  }
  if (parts.size() < 3) return std::nullopt;
  Vec3 signs = Vec3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string& p = parts[i];
    const bool same = p == kWords.at(i) || p == std::string(1, kLetters.at(i));
    const bool opposite = p == kOpposite.at(i) || p == std::string(1, kOppositeLetters.at(i));
    if (!same && !opposite) return std::nullopt;
    signs[static_cast<Eigen::Index>(i)] = same ? 1 : -1;
  }
  return signs;
}

}  // namespace artus
