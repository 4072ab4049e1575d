// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/detail/anatomy/body/tissue.h"
#include "artus/detail/core/fields.h"
#include "artus/detail/haptics/needle/needle_params.h"
#include "tests/golden/force_scenarios.h"

namespace artus::test {

/// What happens to a setup of parameters, as lines of text that a golden could hold.
template <class Setup>
struct Subject {
  std::string name;
  Setup setup;
  std::function<std::vector<std::string>(const Setup&)> trace;
};

/// A parameter that was changed, and the subjects whose trace changed with it.
struct Mutation {
  std::string parameter;
  std::vector<std::string> noticed_by;
  std::string first_difference;  ///< "tracking-wall: row 12, cutting_n: 1 -> 1.05"
};

/// How many laws there are to choose from.
template <class Choice>
constexpr int choices_of() {
  if constexpr (std::is_same_v<Choice, CuttingLaw>) return kCuttingLawNames.size();
  if constexpr (std::is_same_v<Choice, PrepunctureLaw>) return kPrepunctureLawNames.size();
  return 2;
}

/// A number or a vector gets 5 % more, a count one more, a flag the other value, a choice the next.
template <class T>
void change(T& value) {
  if constexpr (std::is_same_v<T, bool>) {
    value = !value;
  } else if constexpr (std::is_enum_v<T>) {
    value = static_cast<T>((static_cast<int>(value) + 1) % choices_of<T>());
  } else if constexpr (std::is_integral_v<T>) {
    ++value;
  } else {
    value *= 1.05;
  }
}

/// Whether somebody wants to know of all subjects that notice a parameter, not of the first alone.
[[nodiscard]] bool wants_table();

/// Changes each parameter alone in one subject after the other, until one notices. Cost: parameters
/// times subjects for the whole table.
template <class Setup>
std::vector<Mutation> try_mutations(const std::vector<Subject<Setup>>& subjects) {
  const bool all = wants_table();
  std::vector<Mutation> mutations;
  visit_fields(subjects.front().setup, [&](const std::string& name, const auto& /*member*/) {
    mutations.push_back({name, {}, {}});
  });
  for (const Subject<Setup>& subject : subjects) {
    const auto expected = subject.trace(subject.setup);
    for (Mutation& mutation : mutations) {
      if (!all && !mutation.noticed_by.empty()) continue;
      Setup setup = subject.setup;
      visit_fields(setup, [&](const std::string& name, auto& member) {
        if (name == mutation.parameter) change(member);
      });
      const std::string difference = find_difference(expected, subject.trace(setup));
      if (difference.empty()) continue;
      if (mutation.noticed_by.empty()) mutation.first_difference = subject.name + ": " + difference;
      mutation.noticed_by.push_back(subject.name);
    }
  }
  return mutations;
}

/// Parameters that nothing may notice, each with the reason.
using Exempt = std::map<std::string, std::string>;

/// Prints the table, adds it to the file that ARTUS_MUTATION_TABLE names, and fails on each
/// parameter that nothing notices, but for those that are exempt with a reason: of these, on each
/// that something does notice.
void expect_noticed(const std::string& what, const std::vector<Mutation>& mutations,
                    const Exempt& exempt);

}  // namespace artus::test
