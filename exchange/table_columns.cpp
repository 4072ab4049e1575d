// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/table_columns.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <utility>

namespace artus {
namespace {

using Words = std::vector<std::string>;

/// "Needle_Tx [mm]" as needle, tx, mm.
Words words_of(std::string_view cell) {
  Words words(1);
  for (const char c : cell) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0)
      words.back() += static_cast<char>(std::tolower(byte));
    else if (!words.back().empty())
      words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

bool is_one_of(const std::string& word, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(), [&](const char* w) { return word == w; });
}

/// Takes a unit off the end; 0 when there is none.
double take_unit(Words& words, std::initializer_list<std::pair<const char*, double>> units) {
  if (words.size() < 2) return 0;
  for (const auto& [name, size] : units)
    if (words.back() == name) {
      words.pop_back();
      return size;
    }
  return 0;
}

struct Component {
  std::size_t place = 0;  // of ToolColumns::at
  std::string tool;
  double unit = 0;
  bool of_ndi = false;
};

std::optional<std::size_t> place_of(const std::string& word) {
  if (is_one_of(word, {"x", "tx", "px", "posx", "positionx"})) return 0;
  if (is_one_of(word, {"y", "ty", "py", "posy", "positiony"})) return 1;
  if (is_one_of(word, {"z", "tz", "pz", "posz", "positionz"})) return 2;
  if (is_one_of(word, {"qw", "q0", "qo", "w", "quatw", "rotw"})) return 3;
  if (is_one_of(word, {"qx", "quatx", "rotx"})) return 4;
  if (is_one_of(word, {"qy", "quaty", "roty"})) return 5;
  if (is_one_of(word, {"qz", "quatz", "rotz"})) return 6;
  return std::nullopt;
}

std::string joined(const Words& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::optional<Component> component_of(Words words) {
  Component found;
  found.unit = take_unit(words, {{"mm", 1e-3}, {"m", 1}, {"cm", 1e-2}});
  if (words.empty()) return std::nullopt;
  std::string last = words.back();
  words.pop_back();
  auto place = place_of(last);
  if (!place && last.size() >= 2 && last.size() <= 3) {  // NDI's tools have a letter: Xa, qoa
    const char letter = last.back();
    place =
        letter >= 'a' && letter <= 'l' ? place_of(last.substr(0, last.size() - 1)) : std::nullopt;
    if (place) words.emplace_back(1, letter);
    found.of_ndi = place.has_value();
  }
  if (!place) return std::nullopt;
  found.place = *place;
  if (last.size() == 1 && !words.empty() &&
      is_one_of(words.back(), {"orientation", "rotation", "quaternion", "quat", "q", "rot"})) {
    if (*place < 3) found.place = *place + 4;
    words.pop_back();
  } else if (last.size() == 1 && !words.empty() &&
             is_one_of(words.back(), {"position", "pos", "translation", "t", "p"})) {
    words.pop_back();
  }
  while (!words.empty() && words.back() == "pose") words.pop_back();
  found.of_ndi = found.of_ndi || last == "q0";
  found.tool = joined(words);
  return found;
}

/// Puts components together into tools; a name that comes again begins the next tool.
class ToolCollector {
 public:
  void take(const Component& c, std::size_t column) {
    Part& part = parts_[c.tool];
    if (part.filled[c.place]) part = Part();
    part.columns.at[c.place] = column;
    part.filled[c.place] = true;
    part.of_ndi = part.of_ndi || c.of_ndi;
    if (c.unit > 0) part.columns.unit = c.unit;
    if (!std::all_of(part.filled.begin(), part.filled.end(), [](bool f) { return f; })) return;
    part.columns.tool = c.tool;
    tools.push_back(part.columns);
    of_ndi = of_ndi || part.of_ndi;
  }
  std::vector<ToolColumns> tools;
  bool of_ndi = false;

 private:
  struct Part {
    ToolColumns columns;
    std::array<bool, 7> filled{};
    bool of_ndi = false;
  };
  std::map<std::string, Part> parts_;
};

/// A column of times or counts; whether it is one.
bool take_time(TableColumns& table, Words words, std::size_t i) {
  const double unit =
      take_unit(words, {{"s", 1}, {"sec", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}});
  const std::string word = joined(words);
  const auto put = [i](std::optional<std::size_t>& place) {
    if (!place) place = i;
    return true;
  };
  if (is_one_of(word, {"hour", "hours"})) return put(table.hour);
  if (is_one_of(word, {"minute", "minutes", "min"})) return put(table.minute);
  if (is_one_of(word, {"second", "seconds", "sec"})) return put(table.second);
  if (is_one_of(word, {"ms", "millisecond", "milliseconds"})) return put(table.millisecond);
  if (is_one_of(word, {"frame", "frame number", "sample", "framenumber"})) return put(table.frame);
  if (!is_one_of(word, {"time", "times", "timestamp", "t", "stamp", "time stamp", "header stamp",
                        "elapsed time"}) ||
      table.time)
    return false;
  table.time_unit = unit;
  return put(table.time);
}

}  // namespace

TableColumns find_columns(const std::vector<std::string>& cells) {
  TableColumns table;
  ToolCollector tools;
  std::vector<std::size_t> status;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Words words = words_of(cells[i]);
    if (words.empty() || take_time(table, words, i)) continue;
    if (const auto component = component_of(words))
      tools.take(*component, i);
    else if (is_one_of(words.back(), {"state", "status"}))
      status.push_back(i);
  }
  table.tools = std::move(tools.tools);
  table.of_ndi = tools.of_ndi;
  for (const std::size_t i : status) {
    const auto behind = std::find_if(table.tools.begin(), table.tools.end(), [i](const auto& tool) {
      return *std::max_element(tool.at.begin(), tool.at.end()) > i;
    });
    if (!table.tools.empty())
      (behind == table.tools.end() ? table.tools.back() : *behind).status.push_back(i);
  }
  if (table.tools.empty()) return {};
  return table;
}

}  // namespace artus
