// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/input/script.h"

#include <cmath>
#include <optional>
#include <sstream>

#include "artus/detail/core/units.h"

namespace artus {
namespace {

template <class... T>
bool read(std::istringstream& in, T&... values) {
  in.imbue(std::locale::classic());
  return static_cast<bool>((in >> ... >> values));
}

std::optional<ScriptStep> parse_input(const std::string& word, std::istringstream& in) {
  if (word == "key") {
    KeyEvent key;
    if (!read(in, key.key)) return std::nullopt;
    const std::string shift = "shift+";
    key.shift = key.key.rfind(shift, 0) == 0;
    if (key.shift) key.key.erase(0, shift.size());
    return UserEvent(key);
  } else if (word == "move") {
    MoveEvent move;
    if (read(in, move.x, move.y)) return UserEvent(move);
  } else if (word == "button") {
    ButtonEvent button;
    std::string state;
    if (read(in, button.button, state) && (state == "down" || state == "up")) {
      button.down = state == "down";
      return UserEvent(button);
    }
  } else if (word == "pad") {
    PadEvent pad;
    if (read(in, pad.left_x, pad.left_y, pad.right_x, pad.right_y, pad.push, pad.seconds))
      return UserEvent(pad);
  } else if (word == "scroll") {
    ScrollEvent scroll;
    if (!read(in, scroll.notches)) return std::nullopt;
    std::string fine;
    if (in >> fine) {
      if (fine != "fine") return std::nullopt;
      scroll.fine = true;
    } else {
      in.clear();
    }
    return UserEvent(scroll);
  }
  return std::nullopt;
}

std::optional<ScriptStep> parse_other(const std::string& word, std::istringstream& in) {
  if (word == "wait") {
    WaitStep wait;
    if (read(in, wait.seconds) && wait.seconds >= 0) return wait;
  } else if (word == "tissue") {
    TissueStep tissue;
    if (read(in, tissue.tissue, tissue.alpha)) return tissue;
  } else if (word == "screenshot") {
    std::string file;
    if (read(in, file)) return ScreenshotStep{file};
  } else if (word == "connect" || word == "disconnect") {
    return ConnectStep{word == "connect"};
  } else if (word == "page") {
    PageStep page;
    if (read(in, page.name)) return page;
  } else if (word == "await") {
    AwaitStep await;
    if (read(in, await.what, await.seconds) && await.seconds > 0 &&
        (await.what == "picture" || await.what == "inside" || await.what == "outside"))
      return await;
  } else if (word == "camera") {
    CameraStep camera;
    if (read(in, camera.yaw, camera.pitch, camera.distance))
      return CameraStep{camera.yaw * kDegree, camera.pitch * kDegree,
                        camera.distance * kMillimetre};
  } else if (word == "measure") {
    MeasureStep measure;
    if (read(in, measure.from_x_mm, measure.from_y_mm, measure.to_x_mm, measure.to_y_mm))
      return measure;
  }
  return std::nullopt;
}

}  // namespace

Result<std::vector<ScriptStep>> parse_script(std::string_view text, const std::string& name) {
  std::vector<ScriptStep> steps;
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    line = line.substr(0, line.find('#'));
    std::istringstream in(line);
    std::string word;
    if (!(in >> word)) continue;
    auto step = parse_input(word, in);
    if (!step) {
      std::istringstream again(line);
      again >> word;
      step = parse_other(word, again);
      std::string rest;
      if (step && again >> rest) step.reset();
    }
    if (!step)
      return fail(ErrorCode::malformed, "this is no step of a script: " + line,
                  name + ":" + std::to_string(number));
    steps.push_back(*step);
  }
  return steps;
}

Result<std::vector<ScriptStep>> PageScript::take(const std::string& page) {
  std::vector<ScriptStep> own;
  if (!given() || over()) return own;
  const auto* head = std::get_if<PageStep>(&steps_[next_]);
  if (head == nullptr || head->name != page)
    return fail(ErrorCode::failed,
                "this is '" + page + "', and the script goes on with " +
                    (head == nullptr ? "no page" : "'" + head->name + "'"),
                "script");
  for (++next_; !over() && !std::holds_alternative<PageStep>(steps_[next_]); ++next_)
    own.push_back(steps_[next_]);
  return own;
}

}  // namespace artus
