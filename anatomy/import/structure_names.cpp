// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/structure_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>

#include "artus/detail/anatomy/body/tissue.h"
#include "artus/detail/anatomy/import/bundled_names.h"
#include "artus/detail/core/known_names.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/text_lines.h"
#include "artus/detail/core/toml_table.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kLargestLabel = 65535;

/// A file of names that is being read.
class NamesReader {
 public:
  explicit NamesReader(std::vector<Tissue> tissues) : tissues_(std::move(tissues)) {}

  void read_label(const toml::table& table) {
    TomlTable toml(table, "label", problems);
    NamedLabel label;
    label.value = toml.required_number("value", 1, kLargestLabel);
    label.name = toml.required_text("name");
    if (const auto tissue = toml.text("tissue")) label.tissue = known(*tissue, table);
    toml.finish();
    names.labels.push_back(std::move(label));
  }
  void read_map(const toml::table& table) {
    TomlTable toml(table, "map", problems);
    StructureNames::Map map;
    if (const auto* pattern = table.get_as<std::string>("match"))
      map.patterns.push_back(toml.text("match").value_or(pattern->get()));
    else
      map.patterns = toml.required_texts("match");
    map.tissue = known(toml.required_text("tissue"), table);
    toml.finish();
    names.maps.push_back(std::move(map));
  }
  void read_code(const toml::table& table) {
    TomlTable toml(table, "code", problems);
    const std::string scheme = toml.required_text("scheme");
    const auto values = toml.required_texts("values");
    const std::string tissue = known(toml.required_text("tissue"), table);
    toml.finish();
    for (const std::string& value : values) names.codes.push_back({scheme + " " + value, tissue});
  }

  void read_tube(const toml::table& table) {
    TomlTable toml(table, "tube", problems);
    NamedTube tube;
    tube.name = toml.required_text("name");
    tube.tissue = known(toml.required_text("tissue"), table);
    tube.radius = kMillimetre * toml.required_number("radius", 0.2, 30);
    const auto* list = table.get_as<toml::array>("points");
    for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
      const auto* place = list->get_as<toml::array>(i);
      Vec3 p = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
      for (std::size_t k = 0; place != nullptr && place->size() == 3 && k < 3; ++k)
        p[static_cast<Eigen::Index>(k)] =
            kMillimetre *
            place->get(k)->value<double>().value_or(std::numeric_limits<double>::quiet_NaN());
      tube.points.push_back(p);
    }
    const bool is_sound =
        tube.points.size() >= 2 && std::all_of(tube.points.begin(), tube.points.end(),
                                               [](const Vec3& p) { return p.allFinite(); });
    if (!is_sound)
      problems.add(table,
                   "tube '" + tube.name + "' needs points = [[x, y, z], ...], two or more, in mm");
    names.tubes.push_back(std::move(tube));
  }

  Problems problems;
  StructureNames names;

 private:
  std::string known(const std::string& tissue, const toml::table& table) {
    const auto all = item_names(tissues_);
    if (tissue != kBodyOutline && !tissue.empty() &&
        std::find(all.begin(), all.end(), tissue) == all.end())
      problems.add(table, "unknown tissue '" + tissue + "'" + did_you_mean(tissue, all));
    return tissue;
  }
  std::vector<Tissue> tissues_;
};

std::vector<std::string> words_of_name(std::string_view name) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : std::string(name) + " ") {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u) != 0 && u < 128) {
      word += static_cast<char>(std::tolower(u));
      continue;
    }
    if (!word.empty()) words.push_back(std::exchange(word, {}));
  }
  return words;
}

/// 'l' and 'r' stand for sides at the end ("Deltoid.l") only.
std::string side_of_word(const std::vector<std::string>& words, std::size_t i) {
  const std::string& w = words[i];
  const bool is_last = i + 1 == words.size() && words.size() > 1;
  if (w == "left" || w == "lt" || (is_last && w == "l")) return "left";
  if (w == "right" || w == "rt" || (is_last && w == "r")) return "right";
  return "none";
}

bool glob(std::string_view pattern, std::string_view text) {
  std::size_t p = 0, t = 0;
  std::size_t star = std::string_view::npos, from = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      from = t;
    } else if (p < pattern.size() && pattern[p] == text[t]) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++from;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

std::optional<KnownTissue> find_by_maps(const StructureNames& names, const std::string& plain,
                                        const char* by) {
  for (const auto& map : names.maps)
    for (const std::string& pattern : map.patterns)
      if (fits(pattern, plain)) return KnownTissue{map.tissue, by + ("'" + pattern + "'")};
  return std::nullopt;
}

}  // namespace

Result<StructureNames> parse_structure_names(std::string_view text, const std::string& name) {
  const auto document = parse_toml(text, name);
  ARTUS_TRY(document);
  auto tissues = read_bundled_tissues();
  ARTUS_TRY(tissues);
  NamesReader reader(std::move(*tissues));
  TomlTable toml(*document, "file", reader.problems);
  static_cast<void>(toml.number("format", 1, 1));
  for (const auto* table : toml.tables("label")) reader.read_label(*table);
  for (const auto* table : toml.tables("map")) reader.read_map(*table);
  for (const auto* table : toml.tables("code")) reader.read_code(*table);
  for (const auto* table : toml.tables("tube")) reader.read_tube(*table);
  toml.finish();
  if (!reader.problems.empty()) return reader.problems.refusal(ErrorCode::invalid, name);
  return std::move(reader.names);
}

/// "index name r g b a" of 3D Slicer, or "index r g b a visible mesh "name"" of ITK-SNAP.
Result<StructureNames> parse_colour_table(std::string_view text, const std::string& name) {
  StructureNames names;
  const auto each = [&](std::string_view line, const std::string& where) -> Result<void> {
    line = trimmed(line);
    if (line.empty() || line.front() == '#') return {};
    TextCursor cursor(line, where);
    const auto value = parse_number(cursor.next());
    std::string label(cursor.next());
    const auto open = line.find('"');
    if (open != std::string_view::npos)
      label = line.substr(open + 1, line.find('"', open + 1) - open - 1);
    if (!value || *value < 0 || *value > kLargestLabel || label.empty())
      return fail(ErrorCode::malformed,
                  "a line of a colour table is: number, name, red, green, blue, alpha", where);
    if (*value > 0) names.labels.push_back({*value, label, {}});
    return {};
  };
  ARTUS_TRY(for_lines(text, name, each));
  return names;
}

Result<StructureNames> read_structure_names(const std::filesystem::path& file) {
  const auto bytes = read_bytes(file);
  ARTUS_TRY(bytes);
  if (file.extension() == ".toml") return parse_structure_names(*bytes, file.string());
  return parse_colour_table(*bytes, file.string());
}

Result<StructureNames> read_bundled_structure_names() {
  return parse_structure_names(kBundledStructureNames, "structure_names.toml");
}

std::string plain_structure_name(std::string_view name) {
  const auto words = words_of_name(name);
  std::string plain;
  for (std::size_t i = 0; i < words.size(); ++i)
    if (side_of_word(words, i) == "none") plain += (plain.empty() ? "" : "_") + words[i];
  return plain;
}

std::string side_of_name(std::string_view name) {
  const auto words = words_of_name(name);
  for (std::size_t i = 0; i < words.size(); ++i)
    if (std::string side = side_of_word(words, i); side != "none") return side;
  return "none";
}

bool fits(std::string_view pattern, std::string_view plain) {
  return glob("*_" + std::string(pattern) + "_*", "_" + std::string(plain) + "_");
}

std::optional<KnownTissue> find_tissue(const StructureNames& of_user, const StructureNames& bundled,
                                       const std::string& name, const std::string& code) {
  const std::string plain = plain_structure_name(name);
  for (const NamedLabel& label : of_user.labels)
    if (label.name == name && !label.tissue.empty()) return KnownTissue{label.tissue, "your file"};
  if (auto found = find_by_maps(of_user, plain, "your file's ")) return found;
  for (const auto* names : {&of_user, &bundled})
    for (const auto& known : names->codes)
      if (!code.empty() && known.code == code) return KnownTissue{known.tissue, "code " + code};
  return find_by_maps(bundled, plain, "name ");
}

}  // namespace artus
