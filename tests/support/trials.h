// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

namespace artus::test {

/// How often to try something at random: a tenth under the sanitizers, which look at how memory is
/// used and not at how rare a difference is.
[[nodiscard]] constexpr int trials(int n) noexcept {
#if defined(ARTUS_SANITIZED)
  return n / 10;
#else
  return n;
#endif
}

}  // namespace artus::test
