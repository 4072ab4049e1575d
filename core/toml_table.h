// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "artus/core/geometry.h"
#include "artus/core/result.h"

namespace artus {

/// Collects what is wrong with a TOML file, so that all of it can be told at once.
class Problems {
 public:
  /// Adds a problem at the place of `node`; without a place when there is none.
  void add(const toml::source_region& where, const std::string& message);
  void add(const toml::node& node, const std::string& message) { add(node.source(), message); }
  [[nodiscard]] bool empty() const noexcept { return lines_.empty(); }
  /// All of them as one refusal of `file`: the only one as it is, several as a list.
  [[nodiscard]] tl::unexpected<Error> refusal(ErrorCode code, const std::string& file) const;

 private:
  std::vector<std::string> lines_;
};

/// A TOML table that is being taken apart: typed access that reports what does not fit, and at
/// finish() every key nobody asked for (with the nearest known one). A missing key is told where
/// the table stands. `what` names the table in messages ("structure 'humerus'").
class TomlTable {
 public:
  TomlTable(const toml::table& table, std::string what, Problems& problems)
      : table_(table), what_(std::move(what)), problems_(problems) {}

  [[nodiscard]] bool has(std::string_view key) const { return table_.contains(key); }
  std::optional<std::string> text(std::string_view key);
  std::string required_text(std::string_view key);
  /// A number in [low, high], multiplied by `scale`.
  std::optional<double> number(std::string_view key, double low, double high, double scale = 1);
  double required_number(std::string_view key, double low, double high, double scale = 1);
  std::optional<bool> boolean(std::string_view key);
  /// Three finite numbers, multiplied by `scale`.
  std::optional<Vec3> vector(std::string_view key, double scale = 1);
  Vec3 required_vector(std::string_view key, double scale = 1);
  std::vector<std::string> required_texts(std::string_view key);
  const toml::array* array(std::string_view key);
  const toml::table* table(std::string_view key);
  /// The tables of an array of tables; empty when the key is absent.
  std::vector<const toml::table*> tables(std::string_view key);
  /// Reports the keys nobody asked for.
  void finish();

  void problem(const std::string& message) { problems_.add(table_, what_ + ": " + message); }
  /// A key that is told of is known.
  void problem_at(std::string_view key, const std::string& message);
  [[nodiscard]] const toml::table& raw() const noexcept { return table_; }
  [[nodiscard]] const std::string& what() const noexcept { return what_; }
  [[nodiscard]] Problems& problems() noexcept { return problems_; }

 private:
  const toml::node* find(std::string_view key);
  void missing(std::string_view key);

  const toml::table& table_;
  std::string what_;
  Problems& problems_;
  std::set<std::string, std::less<>> known_;
};

/// Parses TOML text. Errors: malformed, with line and column.
[[nodiscard]] Result<toml::table> parse_toml(std::string_view text, const std::string& name);

/// Is `name` made of [a-z0-9] and `also` only, and not empty?
[[nodiscard]] bool is_plain_name(std::string_view name, char also) noexcept;

}  // namespace artus
