// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/viewer/input/user_event.h"

namespace artus {

/// What was done, and when: s on the monotonic clock, as it was fetched from the window system.
struct TimedEvent {
  UserEvent event;
  double time = 0;
};

/// Events in the order in which they were done, until the window has time for them. Whoever looks
/// at a mouse's state once a picture does not see a click that is shorter than a picture, or two in
/// one; so they are handed out in groups, each for one look: a group holds motions, or one event of
/// another kind.
class EventQueue {
 public:
  void add(UserEvent event, double time);
  /// All events so far; the queue is empty then.
  [[nodiscard]] std::vector<std::vector<TimedEvent>> take_groups();

 private:
  std::vector<TimedEvent> events_;
};

}  // namespace artus
