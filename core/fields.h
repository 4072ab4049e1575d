// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <concepts>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace artus {

/// P is Owner, const or not: what an overload of fields_of takes.
template <class P, class Owner>
concept Like = std::same_as<std::remove_const_t<P>, Owner>;

namespace detail {
struct NoVisitor {
  template <class T>
  void operator()(const std::string& /*name*/, T& /*member*/) const noexcept {}
};

/// Calls visit(name, member) with each of `names`, "a, b, c", and its member.
template <class F, class... Members>
void visit_each(F& visit, std::string_view names, Members&... members) {
  const auto next_name = [&names] {
    const auto comma = std::min(names.find(','), names.size());
    const std::string name(names.substr(0, comma));
    names.remove_prefix(std::min(comma + 2, names.size()));
    return name;
  };
  (visit(next_name(), members), ...);
}
}  // namespace detail

/// A struct of parameters whose members are named: there is an overload of
/// `fields_of(params, visit)` that calls visit("name", member) for each member in order.
/// ARTUS_FIELDS makes it.
template <class P>
concept HasFields = requires(P& params) {
  fields_of(params, detail::NoVisitor{});
};

/// Calls `visit(name, member)` for each number, flag, choice and vector in `params`, the members of
/// members, too: their names are joined by dots, as "contact.motion.band". `visit` takes a
/// std::string and a reference, const when `params` is.
template <HasFields P, class F>
void visit_fields(P& params, F&& visit, const std::string& before = {}) {
  fields_of(params, [&visit, &before](const std::string& name, auto& member) {
    if constexpr (HasFields<std::remove_reference_t<decltype(member)>>) {
      visit_fields(member, visit, before + name + ".");
    } else {
      visit(before + name, member);
    }
  });
}

}  // namespace artus

/// Names all members of a struct, in their order, by the names that recordings and messages give
/// them: `ARTUS_FIELDS(Syringe, volume, diameter, glide);` in the struct's namespace makes its
/// overload of fields_of. They are bound all at once, so that a member that it forgets does not
/// compile.
#define ARTUS_FIELDS(Type, ...)             \
  template <::artus::Like<Type> P, class F> \
  void fields_of(P& params, F&& visit) {    \
    auto& [__VA_ARGS__] = params;           \
    ARTUS_VISIT_FIELDS(visit, __VA_ARGS__); \
  }                                         \
  static_assert(::artus::HasFields<Type>)

/// visit("name", name) for each of the variables: for an overload that is to leave members out.
#define ARTUS_VISIT_FIELDS(visit, ...) ::artus::detail::visit_each(visit, #__VA_ARGS__, __VA_ARGS__)
