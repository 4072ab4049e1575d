// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/viewer/words/translation.h"

namespace artus {

/// All that a person can want of the window by one key.
enum class Action {
  none,
  take_probe,
  take_needle,
  take_plunger,
  let_go,
  push,
  pull,
  choose_entry,
  explore,
  home,
  undo,
  reset,
  pause,
  freeze,
  save,
  clip,
  true_scale,
  measure,
  clear_calipers,
  depth_more,
  depth_less,
  gain_more,
  gain_less,
  zoom_in,
  zoom_out,
  flip,
  dual,
  doppler,
  cine_back,
  cine_forward,
  turn_left,
  turn_right,
  left,
  right,
  up,
  down,
  accept,
  next_panel,
  labels,
  aids,
  expert,
  help,
  layout,
  finish,
  n_actions
};

/// The action's name in a file of keys.
[[nodiscard]] std::string_view name_of(Action action) noexcept;

/// How the keys lie on a person's desk. Keys are known by the character that they type; only what
/// is meant by its place (push above pull) differs.
enum class Keyboard { qwerty, azerty, qwertz };
/// By what the keys do type where QWERTY has its Q and Y.
[[nodiscard]] Keyboard keyboard_of(std::string_view at_q, std::string_view at_y) noexcept;

/// Which key asks for which action. Keys: the character in capitals ("N"), or ESCAPE, SPACE, HOME,
/// TAB, ENTER, BACKSPACE, LEFT, RIGHT, UP, DOWN, PAGE_UP, PAGE_DOWN, F1 to F12; "shift+D" with
/// shift.
class KeyMap {
 public:
  explicit KeyMap(Keyboard keyboard = Keyboard::qwerty);

  /// The default keys with what a TOML text changes: `push = "8"`, or several: `["8", "F9"]`.
  /// Errors: malformed; invalid (no such action or key; one key for two actions).
  [[nodiscard]] static Result<KeyMap> parse(std::string_view toml, const std::string& name,
                                            Keyboard keyboard);

  /// none for a key that means nothing. A key without an own meaning with shift means what it does
  /// without.
  [[nodiscard]] Action find(std::string_view key, bool shift) const;
  /// The first key of an action, as a file of keys has it; empty when it has none.
  [[nodiscard]] std::string key_of(Action action) const;
  /// The same as people say it: "Esc", in French "Échap"; "shift+D", "maj+D".
  [[nodiscard]] std::string said_key(Action action, Language language) const;

 private:
  struct Binding {
    std::string key;  // with "shift+"
    Action action;
  };
  std::vector<Binding> bindings_;
};

}  // namespace artus
