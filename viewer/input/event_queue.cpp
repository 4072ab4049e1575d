// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/input/event_queue.h"

#include <utility>

namespace artus {

void EventQueue::add(UserEvent event, double time) {
  events_.push_back({std::move(event), time});
}

std::vector<std::vector<TimedEvent>> EventQueue::take_groups() {
  std::vector<std::vector<TimedEvent>> groups;
  bool moving = false;
  for (TimedEvent& event : std::exchange(events_, {})) {
    const bool move = std::holds_alternative<MoveEvent>(event.event);
    if (!move || !moving) groups.emplace_back();
    groups.back().push_back(std::move(event));
    moving = move;
  }
  return groups;
}

}  // namespace artus
