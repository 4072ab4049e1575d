// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <string>
#include <type_traits>

#include "artus/detail/core/known_names.h"
#include "artus/detail/core/toml_table.h"

namespace artus {

/// One number of a TOML table that becomes a member of a struct: its key, its range in the file's
/// unit (inclusive), the factor to SI, and whether a new struct must be given it.
template <class Group>
struct TomlField {
  const char* key;
  double Group::*member;
  double low;
  double high;
  double to_si = 1;
  bool required = false;
};

/// Reads the numbers of `fields` that the table has into `group`; one that does not fit its range
/// is a problem told in the file's unit, one that is required and missing, when `is_new`, too.
template <class Fields, class Group>
void read_fields(TomlTable& toml, const Fields& fields, Group& group, bool is_new = true) {
  for (const TomlField<Group>& field : fields) {
    if (is_new && field.required && !toml.has(field.key))
      toml.problem("'" + std::string(field.key) + "' is missing");
    if (const auto value = toml.number(field.key, field.low, field.high))
      group.*field.member = *value * field.to_si;
  }
}

/// Reads one of a row of names, as the value of that place in the row, when the table has it.
template <class Value>
void read_name(TomlTable& toml, const char* key, KnownNames names, Value& value) {
  const auto name = toml.text(key);
  if (!name) return;
  const auto at = std::find(names.begin(), names.end(), *name);
  if (at == names.end()) {
    toml.problem_at(key, std::string(key) + " is '" + *name + "', must be one of " + listed(names) +
                             did_you_mean(*name, names));
    return;
  }
  value = static_cast<Value>(at - names.begin());
}

}  // namespace artus
