// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/window.h"

#include <utility>

#include "artus/detail/viewer/input/gui_context.h"
#include "artus/detail/viewer/input/screen.h"
#include "artus/detail/viewer/window_loop.h"

namespace artus {

Result<void> run_window(Session& session, HandDevice* hand, const HandTarget& start,
                        const WindowOptions& options, WindowReport& report) {
  const auto screen = Screen::open(options.width, options.height);
  ARTUS_TRY(screen);
  return run_window(**screen, session, hand, start, options, report);
}

Result<void> run_window(Screen& screen, Session& session, HandDevice* hand, const HandTarget& start,
                        const WindowOptions& options, WindowReport& report) {
  const GuiContext gui;
  auto joint = JointView::make(session.scene().shared_joint(), session.params().transducer.width,
                               needle_length_of(session.params()), options.outside);
  ARTUS_TRY(joint);
  WindowLoop loop(screen.window(), std::move(*joint), session, hand, start, options);
  ARTUS_TRY(loop.prepare());
  return loop.run(report);
}

}  // namespace artus
