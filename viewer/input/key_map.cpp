// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/input/key_map.h"

#include <algorithm>
#include <array>
#include <utility>

#include "artus/detail/core/toml_table.h"

namespace artus {
namespace {

constexpr auto kCount = static_cast<std::size_t>(Action::n_actions);

struct KeyRow {
  std::string_view name;
  std::string_view key;  // on QWERTY; two are separated by a blank
};

constexpr std::array<KeyRow, kCount> kRows{{{"none", ""},
                                            {"take_probe", "P"},
                                            {"take_needle", "N"},
                                            {"take_plunger", "J"},
                                            {"let_go", "ESCAPE"},
                                            {"push", "W"},
                                            {"pull", "S"},
                                            {"choose_entry", "C"},
                                            {"explore", "X"},
                                            {"home", "HOME"},
                                            {"undo", "BACKSPACE"},
                                            {"reset", "R"},
                                            {"pause", "SPACE"},
                                            {"freeze", "F"},
                                            {"save", "V"},
                                            {"clip", "K"},
                                            {"true_scale", "T"},
                                            {"measure", "L"},
                                            {"clear_calipers", "M"},
                                            {"depth_more", "D"},
                                            {"depth_less", "shift+D"},
                                            {"gain_more", "G"},
                                            {"gain_less", "shift+G"},
                                            {"zoom_in", "PAGE_UP"},
                                            {"zoom_out", "PAGE_DOWN"},
                                            {"flip", "I"},
                                            {"dual", "U"},
                                            {"doppler", "O"},
                                            {"cine_back", "F5"},
                                            {"cine_forward", "F6"},
                                            {"turn_left", "B"},
                                            {"turn_right", "shift+B"},
                                            {"left", "LEFT"},
                                            {"right", "RIGHT"},
                                            {"up", "UP"},
                                            {"down", "DOWN"},
                                            {"accept", "ENTER"},
                                            {"next_panel", "TAB"},
                                            {"labels", "F3"},
                                            {"aids", "F4"},
                                            {"expert", "E"},
                                            {"help", "F1"},
                                            {"layout", "F2"},
                                            {"finish", "F10"}}};

struct NamedKey {
  std::string_view key;
  const char* said;
};

constexpr std::array<NamedKey, 12> kNamedKeys{{{"ESCAPE", msgid("Esc")},
                                               {"SPACE", msgid("Space")},
                                               {"HOME", msgid("Home")},
                                               {"TAB", msgid("Tab")},
                                               {"ENTER", msgid("Enter")},
                                               {"BACKSPACE", msgid("Backspace")},
                                               {"LEFT", msgid("Left")},
                                               {"RIGHT", msgid("Right")},
                                               {"UP", msgid("Up")},
                                               {"DOWN", msgid("Down")},
                                               {"PAGE_UP", msgid("Page up")},
                                               {"PAGE_DOWN", msgid("Page down")}}};
constexpr std::string_view kShift = "shift+";

bool is_function_key(std::string_view key) {
  if (key.size() < 2 || key.size() > 3 || key[0] != 'F') return false;
  const std::string number(key.substr(1));
  return number.find_first_not_of("0123456789") == std::string::npos && number[0] != '0' &&
         std::stoi(number) <= 12;
}

bool is_key(std::string_view key) {
  if (key.substr(0, kShift.size()) == kShift) key.remove_prefix(kShift.size());
  for (const NamedKey& named : kNamedKeys) {
    if (named.key == key) return true;
  }
  if (key.size() == 1) return key[0] > ' ' && (key[0] < 'a' || key[0] > 'z');
  const bool one_letter = key.size() == 2 && (static_cast<unsigned char>(key[0]) & 0xe0U) == 0xc0U;
  return one_letter || is_function_key(key);  // a letter beyond ASCII is two bytes of UTF-8
}

Action action_named(std::string_view name) {
  for (std::size_t i = 1; i < kCount; ++i) {
    if (kRows[i].name == name) return static_cast<Action>(i);
  }
  return Action::none;
}

Result<std::vector<std::string>> keys_of(const toml::node& node, const std::string& where) {
  std::vector<std::string> keys;
  if (const auto one = node.value<std::string>()) keys.push_back(*one);
  if (const toml::array* several = node.as_array()) {
    for (const toml::node& each : *several) keys.push_back(each.value_or(std::string()));
  }
  if (keys.empty()) return fail(ErrorCode::malformed, "a key is a text: \"N\"", where);
  for (const std::string& key : keys) {
    if (!is_key(key))
      return fail(ErrorCode::invalid,
                  "'" + key + "' is no key: a capital letter or sign, or a name as PAGE_UP or F5",
                  where);
  }
  return keys;
}

}  // namespace

std::string_view name_of(Action action) noexcept {
  return kRows[static_cast<std::size_t>(action)].name;
}

Keyboard keyboard_of(std::string_view at_q, std::string_view at_y) noexcept {
  if (at_q == "A") return Keyboard::azerty;
  return at_y == "Z" ? Keyboard::qwertz : Keyboard::qwerty;
}

KeyMap::KeyMap(Keyboard keyboard) {
  for (std::size_t i = 1; i < kCount; ++i)
    bindings_.push_back({std::string(kRows[i].key), static_cast<Action>(i)});
  if (keyboard != Keyboard::azerty) return;
  for (Binding& binding : bindings_) {  // above S lies Z there
    if (binding.action == Action::push) binding.key = "Z";
  }
}

Result<KeyMap> KeyMap::parse(std::string_view text, const std::string& name, Keyboard keyboard) {
  const auto table = parse_toml(text, name);
  ARTUS_TRY(table);
  KeyMap map(keyboard);
  for (const auto& [word, node] : *table) {
    const std::string where = name + ":" + std::to_string(node.source().begin.line);
    const Action action = action_named(word.str());
    if (action == Action::none)
      return fail(ErrorCode::invalid, "'" + std::string(word.str()) + "' is no action", where);
    const auto keys = keys_of(node, where);
    ARTUS_TRY(keys);
    auto& all = map.bindings_;
    all.erase(std::remove_if(all.begin(), all.end(),
                             [&](const Binding& b) { return b.action == action; }),
              all.end());
    for (const std::string& key : *keys) all.push_back({key, action});
  }
  for (std::size_t i = 0; i < map.bindings_.size(); ++i) {
    for (std::size_t j = i + 1; j < map.bindings_.size(); ++j) {
      const Binding& a = map.bindings_[i];
      const Binding& b = map.bindings_[j];
      if (a.key != b.key) continue;
      return fail(ErrorCode::invalid,
                  "the key " + a.key + " would mean both " + std::string(name_of(a.action)) +
                      " and " + std::string(name_of(b.action)),
                  name);
    }
  }
  return map;
}

Action KeyMap::find(std::string_view key, bool shift) const {
  const auto named = [this](const std::string& wanted) {
    for (const Binding& b : bindings_) {
      if (b.key == wanted) return b.action;
    }
    return Action::none;
  };
  if (shift) {
    const Action own = named(std::string(kShift) + std::string(key));
    if (own != Action::none) return own;
  }
  return named(std::string(key));
}

std::string KeyMap::key_of(Action action) const {
  for (const Binding& b : bindings_) {
    if (b.action == action) return b.key;
  }
  return {};
}

std::string KeyMap::said_key(Action action, Language language) const {
  std::string key = key_of(action);
  std::string said;
  if (key.compare(0, kShift.size(), kShift) == 0) {
    key.erase(0, kShift.size());
    said = std::string(translate(language, "shift")) + "+";
  }
  for (const NamedKey& named : kNamedKeys) {
    if (named.key == key) return said + translate(language, named.said);
  }
  return said + key;
}

}  // namespace artus
