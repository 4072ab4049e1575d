// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/toml_table.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/known_names.h"
#include "artus/detail/core/text_cursor.h"

namespace artus {
namespace {

std::string in_range(double low, double high, double scale) {
  std::string out = "must be a number ";
  if (std::isinf(high)) {
    out += low == 0 ? "not below " : "of at least ";
    append_number(out, low);
  } else {
    out += "from ";
    append_number(out, low);
    out += " to ";
    append_number(out, high);
  }
  if (scale != 1) out += " (in the units of the file)";
  return out;
}

}  // namespace

void Problems::add(const toml::source_region& where, const std::string& message) {
  std::string line;
  if (where.begin.line > 0)
    line = std::to_string(where.begin.line) + ":" + std::to_string(where.begin.column) + ": ";
  line += message;
  if (std::find(lines_.begin(), lines_.end(), line) == lines_.end())
    lines_.push_back(std::move(line));
}

tl::unexpected<Error> Problems::refusal(ErrorCode code, const std::string& file) const {
  if (lines_.size() == 1) return fail(code, lines_.front(), file);
  std::string message = std::to_string(lines_.size()) + " problems";
  for (const auto& line : lines_) message += "\n  " + line;
  return fail(code, message, file);
}

const toml::node* TomlTable::find(std::string_view key) {
  known_.emplace(key);
  return table_.get(key);
}

void TomlTable::missing(std::string_view key) {
  problem("'" + std::string(key) + "' is missing");
}

void TomlTable::problem_at(std::string_view key, const std::string& message) {
  known_.emplace(key);
  const toml::node* node = table_.get(key);
  problems_.add(node != nullptr ? node->source() : table_.source(),
                what_ + ": '" + std::string(key) + "' " + message);
}

std::optional<std::string> TomlTable::text(std::string_view key) {
  const auto* node = find(key);
  if (node == nullptr) return std::nullopt;
  auto value = node->value_exact<std::string>();
  if (!value) problem_at(key, "must be a text in quotes");
  return value;
}

std::string TomlTable::required_text(std::string_view key) {
  if (find(key) == nullptr) missing(key);
  auto value = text(key);
  if (value && value->empty()) problem_at(key, "must not be empty");
  return value.value_or("");
}

std::optional<double> TomlTable::number(std::string_view key, double low, double high,
                                        double scale) {
  const auto* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto value = node->is_number() ? node->value<double>() : std::nullopt;
  if (!value || !(*value >= low && *value <= high) || std::isinf(*value)) {
    problem_at(key, in_range(low, high, scale));
    return std::nullopt;
  }
  return *value * scale;
}

double TomlTable::required_number(std::string_view key, double low, double high, double scale) {
  if (find(key) == nullptr) missing(key);
  return number(key, low, high, scale).value_or(0);
}

std::optional<bool> TomlTable::boolean(std::string_view key) {
  const auto* node = find(key);
  if (node == nullptr) return std::nullopt;
  auto value = node->value_exact<bool>();
  if (!value) problem_at(key, "must be true or false");
  return value;
}

std::optional<Vec3> TomlTable::vector(std::string_view key, double scale) {
  const auto* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto* array = node->as_array();
  if (array != nullptr && array->size() == 3) {
    Vec3 v = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      const auto* item = array->get(static_cast<std::size_t>(k));
      v[k] = item->is_number() ? item->value_or(std::nan("")) : std::nan("");
    }
    if (v.allFinite()) return v * scale;
  }
  problem_at(key, "must be three numbers, [x, y, z]");
  return std::nullopt;
}

Vec3 TomlTable::required_vector(std::string_view key, double scale) {
  if (find(key) == nullptr) missing(key);
  return vector(key, scale).value_or(Vec3::Zero());
}

std::vector<std::string> TomlTable::required_texts(std::string_view key) {
  const auto* node = find(key);
  if (node == nullptr) missing(key);
  std::vector<std::string> out;
  if (node == nullptr) return out;
  const auto* array = node->as_array();
  if (array != nullptr)
    for (const auto& item : *array)
      if (const auto value = item.value_exact<std::string>()) out.push_back(*value);
  if (array == nullptr || out.empty() || out.size() != array->size())
    problem_at(key, "must be a list of texts, [\"name\", ...]");
  return out;
}

const toml::array* TomlTable::array(std::string_view key) {
  const auto* node = find(key);
  if (node == nullptr) return nullptr;
  if (!node->is_array()) problem_at(key, "must be a list, [...]");
  return node->as_array();
}

const toml::table* TomlTable::table(std::string_view key) {
  const auto* node = find(key);
  if (node == nullptr) return nullptr;
  if (!node->is_table()) problem_at(key, "must be a table");
  return node->as_table();
}

std::vector<const toml::table*> TomlTable::tables(std::string_view key) {
  const auto* node = find(key);
  std::vector<const toml::table*> out;
  if (node == nullptr) return out;
  const auto* array = node->as_array();
  if (array != nullptr)
    for (const auto& item : *array)
      if (const auto* t = item.as_table()) out.push_back(t);
  if (array == nullptr || out.size() != array->size())
    problem_at(key, "must be tables, each under [[" + std::string(key) + "]]");
  return out;
}

void TomlTable::finish() {
  for (const auto& [key, node] : table_) {
    if (known_.contains(key.str())) continue;
    problems_.add(key.source(),
                  what_ + ": unknown key " + quoted(key.str()) + did_you_mean(key.str(), known_));
  }
}

Result<toml::table> parse_toml(std::string_view text, const std::string& name) {
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    const auto& at = error.source().begin;
    constexpr std::string_view kJoint = "joint.toml";  // that has a guide
    const bool is_joint = name.size() >= kJoint.size() &&
                          name.compare(name.size() - kJoint.size(), kJoint.size(), kJoint) == 0;
    return fail(ErrorCode::malformed,
                std::string(error.description()) + (is_joint ? "; see docs/joint-format.md" : ""),
                name + ":" + std::to_string(at.line) + ":" + std::to_string(at.column));
  }
}

bool is_plain_name(std::string_view name, char also) noexcept {
  return !name.empty() && std::all_of(name.begin(), name.end(), [also](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == also;
  });
}

}  // namespace artus
