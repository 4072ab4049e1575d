// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/pages/page.h"

namespace artus {

PageMove move_on_page(Action action, std::size_t at, std::size_t n) noexcept {
  PageMove move{at, false, false};
  switch (action) {
    case Action::up:
      if (at > 0) --move.at;
      break;
    case Action::down:
      if (at + 1 < n) ++move.at;
      break;
    case Action::accept:
    case Action::choose_entry:
      move.chosen = n > 0;
      break;
    case Action::let_go:
    case Action::explore:
      move.back = true;
      break;
    default:
      break;
  }
  return move;
}

}  // namespace artus
