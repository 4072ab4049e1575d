// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/help_rows.h"

#include <array>

namespace artus {
namespace {

struct Row {
  std::array<Action, 4> actions;  // none: no more
  Text what;
};

constexpr Action kNone = Action::none;
constexpr std::array<Row, 33> kHelpRows{{
    {{Action::take_probe, kNone, kNone, kNone}, Text::help_take_probe},
    {{Action::choose_entry, kNone, kNone, kNone}, Text::help_choose},
    {{Action::explore, kNone, kNone, kNone}, Text::help_explore},
    {{Action::take_needle, kNone, kNone, kNone}, Text::help_needle},
    {{Action::push, Action::pull, kNone, kNone}, Text::help_push},
    {{Action::take_plunger, kNone, kNone, kNone}, Text::help_plunger},
    {{Action::let_go, kNone, kNone, kNone}, Text::help_let_go},
    {{Action::home, kNone, kNone, kNone}, Text::help_home},
    {{Action::undo, kNone, kNone, kNone}, Text::help_undo},
    {{Action::turn_left, Action::turn_right, kNone, kNone}, Text::help_turn},
    {{Action::left, Action::right, Action::up, Action::down}, Text::help_arrows},
    {{Action::freeze, kNone, kNone, kNone}, Text::help_freeze},
    {{Action::cine_back, Action::cine_forward, kNone, kNone}, Text::help_cine},
    {{Action::save, kNone, kNone, kNone}, Text::help_save},
    {{Action::clip, kNone, kNone, kNone}, Text::help_clip},
    {{Action::true_scale, kNone, kNone, kNone}, Text::help_scale},
    {{Action::measure, Action::accept, kNone, kNone}, Text::help_measure},
    {{Action::clear_calipers, kNone, kNone, kNone}, Text::help_clear},
    {{Action::depth_more, Action::depth_less, kNone, kNone}, Text::help_depth},
    {{Action::gain_more, Action::gain_less, kNone, kNone}, Text::help_gain},
    {{Action::zoom_in, Action::zoom_out, kNone, kNone}, Text::help_zoom},
    {{Action::flip, kNone, kNone, kNone}, Text::help_flip},
    {{Action::dual, kNone, kNone, kNone}, Text::help_dual},
    {{Action::doppler, kNone, kNone, kNone}, Text::help_colour},
    {{Action::next_panel, kNone, kNone, kNone}, Text::help_tab},
    {{Action::labels, kNone, kNone, kNone}, Text::help_labels},
    {{Action::aids, kNone, kNone, kNone}, Text::help_aids},
    {{Action::pause, kNone, kNone, kNone}, Text::help_pause},
    {{Action::reset, kNone, kNone, kNone}, Text::help_reset},
    {{Action::expert, kNone, kNone, kNone}, Text::help_expert},
    {{Action::layout, kNone, kNone, kNone}, Text::help_layout},
    {{Action::finish, kNone, kNone, kNone}, Text::help_finish},
    {{Action::help, kNone, kNone, kNone}, Text::help_help},
}};

}  // namespace

std::vector<HelpRow> help_rows(const KeyMap& keys, Language language) {
  std::vector<HelpRow> rows;
  for (const Row& row : kHelpRows) {
    HelpRow shown{"", text(language, row.what)};
    for (const Action action : row.actions) {
      if (action == kNone) continue;
      if (!shown.keys.empty()) shown.keys += ", ";
      shown.keys += keys.said_key(action, language);
    }
    rows.push_back(std::move(shown));
  }
  return rows;
}

}  // namespace artus
