// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/space_bytes.h"

namespace artus {
namespace {

// Every number of a space in file order, for writing and reading alike.
template <class S, class Value = std::conditional_t<std::is_const_v<S>, const double, double>>
std::array<Value*, 20> numbers_of_space(S& s) {
  auto& law = s.law;
  return {&law.opening,     &law.resistance, &law.rest,     &law.stiffness,     &law.slack,
          &law.toe,         &law.yield,      &law.rupture,  &law.suction,       &law.suction_volume,
          &law.relaxing,    &law.relaxation, &law.film_gap, &law.film_area,     &law.peak,
          &law.peak_volume, &law.stop,       &law.contents, &s.leak_resistance, &s.leak_opening};
}

}  // namespace

void put_spaces(ByteWriter& out, const std::vector<Space>& spaces) {
  out.put(static_cast<std::uint32_t>(spaces.size()));
  for (const Space& s : spaces) {
    for (const std::string* text : {&s.name, &s.like, &s.liquid, &s.leaks_to})
      out.put(std::string_view(*text));
    out.put(static_cast<std::uint32_t>(s.regions.size()));
    for (const std::string& region : s.regions) out.put(std::string_view(region));
    out.put(static_cast<std::uint8_t>(s.law.kind));
    for (const double* value : numbers_of_space(s)) out.put(*value);
  }
}

std::vector<Space> get_spaces(ByteReader& in) {
  std::vector<Space> spaces(in.get_count(4));
  for (Space& s : spaces) {
    for (std::string* text : {&s.name, &s.like, &s.liquid, &s.leaks_to}) *text = in.get_text();
    s.regions.resize(in.get_count(4));
    for (std::string& region : s.regions) region = in.get_text();
    const auto kind = in.get<std::uint8_t>();
    if (kind >= kSpaceKindNames.size()) in.refuse();
    s.law.kind = static_cast<SpaceKind>(kind);
    for (double* value : numbers_of_space(s)) *value = in.get<double>();
  }
  return spaces;
}

}  // namespace artus
