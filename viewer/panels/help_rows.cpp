// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/help_rows.h"

#include <array>

namespace artus {
namespace {

struct Row {
  std::array<Action, 4> actions;  // none: no more
  const char* what;
};

constexpr Action kNone = Action::none;
constexpr std::array<Row, 33> kHelpRows{{
    {{Action::take_probe, kNone, kNone, kNone},
     msgid("take the probe: mouse slides it on the skin, wheel turns it")},
    {{Action::choose_entry, kNone, kNone, kNone},
     msgid("choose the entry beside the probe: the joint is moved under the needle")},
    {{Action::explore, kNone, kNone, kNone}, msgid("back to exploring")},
    {{Action::take_needle, kNone, kNone, kNone},
     msgid("take the needle: mouse turns it about the entry, wheel pushes")},
    {{Action::push, Action::pull, kNone, kNone},
     msgid("push and pull the needle; press and lift the probe in hand")},
    {{Action::take_plunger, kNone, kNone, kNone},
     msgid("put the thumb on the plunger, or off: the wheel presses and draws back")},
    {{Action::let_go, kNone, kNone, kNone}, msgid("let go; close this help")},
    {{Action::home, kNone, kNone, kNone}, msgid("needle and probe back to the start")},
    {{Action::undo, kNone, kNone, kNone}, msgid("undo the last withdrawal")},
    {{Action::turn_left, Action::turn_right, kNone, kNone}, msgid("turn the probe in hand")},
    {{Action::left, Action::right, Action::up, Action::down},
     msgid("move what is in hand; nothing in hand: turn the joint")},
    {{Action::freeze, kNone, kNone, kNone}, msgid("freeze the picture")},
    {{Action::cine_back, Action::cine_forward, kNone, kNone},
     msgid("frozen: step back and forth through the last 20 s")},
    {{Action::save, kNone, kNone, kNone}, msgid("save the picture as PNG")},
    {{Action::clip, kNone, kNone, kNone}, msgid("start and end a clip")},
    {{Action::true_scale, kNone, kNone, kNone}, msgid("picture at true scale")},
    {{Action::measure, Action::accept, kNone, kNone},
     msgid("caliper by keys: cross, point; or two clicks in the picture")},
    {{Action::clear_calipers, kNone, kNone, kNone}, msgid("remove the calipers")},
    {{Action::depth_more, Action::depth_less, kNone, kNone}, msgid("deeper, shallower")},
    {{Action::gain_more, Action::gain_less, kNone, kNone}, msgid("more gain, less gain")},
    {{Action::zoom_in, Action::zoom_out, kNone, kNone},
     msgid("zoom in, zoom out; a drag or the arrows move what is seen")},
    {{Action::flip, kNone, kNone, kNone}, msgid("left-right flip")},
    {{Action::dual, kNone, kNone, kNone}, msgid("keep this picture beside the live one")},
    {{Action::doppler, kNone, kNone, kNone}, msgid("colour Doppler: motion, red toward the probe")},
    {{Action::next_panel, kNone, kNone, kNone}, msgid("next panel")},
    {{Action::labels, kNone, kNone, kNone}, msgid("names of the structures on the picture")},
    {{Action::aids, kNone, kNone, kNone}, msgid("aids on and off")},
    {{Action::pause, kNone, kNone, kNone}, msgid("pause")},
    {{Action::reset, kNone, kNone, kNone}, msgid("start the insertion over")},
    {{Action::expert, kNone, kNone, kNone}, msgid("expert mode: no 3D view, no aids")},
    {{Action::layout, kNone, kNone, kNone}, msgid("panels back in their places")},
    {{Action::finish, kNone, kNone, kNone}, msgid("finish the task")},
    {{Action::help, kNone, kNone, kNone}, msgid("this help")},
}};

}  // namespace

std::vector<HelpRow> help_rows(const KeyMap& keys, Language language) {
  std::vector<HelpRow> rows;
  for (const Row& row : kHelpRows) {
    HelpRow shown{"", translate(language, row.what)};
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
