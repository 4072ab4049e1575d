// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <concepts>
#include <string>
#include <type_traits>
#include <utility>

namespace artus {

/// P is Owner, const or not: what an overload of fields_of takes.
template <class P, class Owner>
concept Like = std::same_as<std::remove_const_t<P>, Owner>;

namespace detail {
struct NoVisitor {
  template <class T>
  void operator()(const char* /*name*/, T& /*member*/) const noexcept {}
};
}  // namespace detail

/// A struct of parameters whose members are named: there is an overload of
/// `fields_of(params, visit)` that calls visit("name", member) for each member in order. Each
/// overload binds all members at once (auto& [a, b] = params), so that a member that it forgets
/// does not compile.
template <class P>
concept HasFields = requires(P& params) {
  fields_of(params, detail::NoVisitor{});
};

/// Calls `visit(name, member)` for each number, flag, choice and vector in `params`, the members of
/// members, too: their names are joined by dots, as "contact.motion.band". `visit` takes a
/// std::string and a reference, const when `params` is.
template <HasFields P, class F>
void visit_fields(P& params, F&& visit, const std::string& before = {}) {
  fields_of(params, [&visit, &before](const char* name, auto& member) {
    if constexpr (HasFields<std::remove_reference_t<decltype(member)>>) {
      visit_fields(member, visit, before + name + ".");
    } else {
      visit(before + name, member);
    }
  });
}

}  // namespace artus
