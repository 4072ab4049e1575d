// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "artus/core/geometry.h"
#include "artus/detail/core/fields.h"

namespace artus {

/// A number, "inf" or "-inf", which JSON's own numbers are not.
[[nodiscard]] inline nlohmann::json number_to_json(double value) {
  if (std::isfinite(value)) return value;
  return value > 0 ? "inf" : "-inf";
}
/// Throws nlohmann::json::exception for anything else.
[[nodiscard]] inline double number_from_json(const nlohmann::json& json) {
  if (json == "inf") return std::numeric_limits<double>::infinity();
  if (json == "-inf") return -std::numeric_limits<double>::infinity();
  return json.get<double>();
}

/// Every field of `params` (visit_fields) by its dotted name: numbers and flags as they are,
/// choices as whole numbers, vectors as three numbers. Reading it gives the same bits.
template <HasFields P>
[[nodiscard]] nlohmann::json fields_to_json(const P& params) {
  auto json = nlohmann::json::object();
  visit_fields(params, [&json](const std::string& name, const auto& member) {
    using Member = std::remove_cvref_t<decltype(member)>;
    if constexpr (std::is_enum_v<Member>)
      json[name] = static_cast<long long>(member);
    else if constexpr (std::is_same_v<Member, Vec3>)
      json[name] = {number_to_json(member.x()), number_to_json(member.y()),
                    number_to_json(member.z())};
    else if constexpr (std::is_same_v<Member, double>)
      json[name] = number_to_json(member);
    else
      json[name] = member;
  });
  return json;
}

/// Back from that. Throws nlohmann::json::exception where a field is missing or of another type;
/// whether the values make sense is for the caller to say.
template <HasFields P>
void read_fields(const nlohmann::json& json, P& params) {
  visit_fields(params, [&json](const std::string& name, auto& member) {
    using Member = std::remove_cvref_t<decltype(member)>;
    const nlohmann::json& value = json.at(name);
    if constexpr (std::is_enum_v<Member>) {
      member = static_cast<Member>(value.get<long long>());
    } else if constexpr (std::is_same_v<Member, Vec3>) {
      for (Eigen::Index i = 0; i < 3; ++i)
        member[i] = number_from_json(value.at(static_cast<std::size_t>(i)));
    } else if constexpr (std::is_same_v<Member, double>) {
      member = number_from_json(value);
    } else {
      value.get_to(member);
    }
  });
}

}  // namespace artus
