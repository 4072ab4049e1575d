// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/hands_pages.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>

#include "artus/detail/core/text_cursor.h"

namespace artus {
namespace {

std::string state_words(bool done, Language language) {
  return translate(language, done ? msgid("done") : msgid("to do"));
}

/// The first thing that is to do.
HandsChoice next_step(const HandsState& state) {
  if (!state.camera) return HandsChoice::print;
  if (!state.tip) return HandsChoice::tip;
  return state.face ? HandsChoice::go : HandsChoice::face;
}

/// Runs artus-hands while a page shows its lines; whether the window is still open.
Result<bool> show_run(PageWindow& pages, HandsChoice choice, const HandsSetup& setup,
                      Language language) {
  const HandsProgram run(setup.program, hands_arguments(choice, setup));
  Page page;
  page.name = "hands-step";
  page.title = translate(language, "Follow these lines");
  page.may_back = true;
  page.choices = {{translate(language, "Back"), "", Tone::plain, {}, nullptr}};
  page.refresh = [&run, language](Page& shown) {
    shown.lines.clear();
    for (const std::string& line : run.lines()) shown.lines.push_back({line});
    if (!run.ended()) return;
    const bool good = run.exit_code() == 0;
    shown.lines.push_back({translate(language, good ? msgid("This is done.")
                                                    : msgid("This was not done: try it again.")),
                           good ? Tone::good : Tone::bad});
  };
  const auto answer = pages.show(std::move(page));
  ARTUS_TRY(answer);
  return answer->kind != PageAnswer::Kind::closed;
}

Result<HandsState> state_of(const HandsSetup& setup) {
  const HandsProgram asked(setup.program, {"state", "-k", setup.kit.string()});
  while (!asked.ended()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const auto lines = asked.lines();
  return parse_hands_state(lines.empty() ? "" : lines.back());
}

}  // namespace

Page make_hands_page(const HandsState& state, const HandsSetup& setup, Language language) {
  Page page;
  page.name = "hands";
  page.title = translate(language, "Hands by a camera and paper");
  page.lines = {
      {fill(translate(language, "Camera: {}"), {setup.source}), Tone::dim},
      {translate(language,
                 "You will feel no force of the simulation: foam resists alike everywhere. Force, "
                 "pressure and how hard bone is met are not judged."),
       Tone::bad},
      {state.camera && state.tip && state.face
           ? fill(translate(language,
                            "The tip is known to +- {} mm in the probe's frame, and a "
                            "little worse far from the camera."),
                  {fixed_number(state.error_mm, 1)})
           : translate(language,
                       "The tip is not calibrated yet: it may be off by several millimetres.")},
      {translate(language,
                 "What it teaches: to align needle and probe, to sweep, the order of the steps, "
                 "two hands at once.")}};
  const auto add = [&](const char* name, const std::string& beside, const char* about,
                       Tone tone = Tone::plain) {
    page.choices.push_back(
        {translate(language, name), beside, tone, {{translate(language, about)}}, nullptr});
  };
  add(msgid("Go"), state_words(state.camera, language),
      msgid("The block stands on the sheet, the camera sees both hands from the sheet's lower "
            "edge, 40 to 70 cm away."),
      Tone::good);
  add(msgid("Print sheets and parts"), setup.prints.string(),
      msgid("PDF at 100 %, STL in millimetres. Measure the ruler of each sheet, glue the labels "
            "on probe and syringe."));
  add(msgid("Calibrate the camera"), state_words(state.camera, language),
      msgid("With the board under glass, tilted to all sides. Lock the focus if you can."));
  add(msgid("Measure the glued markers"), state_words(state.markers, language),
      msgid("Turn the probe, then the syringe, before the camera for half a minute each."));
  add(msgid("Find the needle's tip"), state_words(state.tip, language),
      msgid("The tip rests in a pit of the printed plate while you lean the syringe."));
  add(msgid("Find the probe's face"), state_words(state.face, language),
      msgid("Touch the three crosses on the probe's face with the tip."));
  add(msgid("Leave"), "", msgid("What was measured is kept."));
  page.at = static_cast<std::size_t>(next_step(state));
  return page;
}

std::vector<std::string> hands_arguments(HandsChoice choice, const HandsSetup& setup) {
  const std::vector<std::string> seen{setup.source, "-k", setup.kit.string()};
  std::vector<std::string> line;
  switch (choice) {
    case HandsChoice::print:
      return {"print", "-o", setup.prints.string()};
    case HandsChoice::camera:
      line = {"calibrate"};
      break;
    case HandsChoice::markers:
      line = {"markers"};
      break;
    case HandsChoice::tip:
      line = {"pivot"};
      break;
    default:
      line = {"face"};
      break;
  }
  line.insert(line.end(), seen.begin(), seen.end());
  return line;
}

Result<bool> lead_to_hands(PageWindow& pages, const HandsSetup& setup, Language language) {
  for (;;) {
    const auto state = state_of(setup);
    ARTUS_TRY(state);
    const auto answer = pages.show(make_hands_page(*state, setup, language));
    ARTUS_TRY(answer);
    if (answer->kind != PageAnswer::Kind::chosen) return false;
    const auto choice = static_cast<HandsChoice>(answer->choice);
    if (choice == HandsChoice::leave) return false;
    if (choice == HandsChoice::go) {
      if (state->camera) return true;
      continue;
    }
    const auto open = show_run(pages, choice, setup, language);
    ARTUS_TRY(open);
    if (!*open) return false;
  }
}

}  // namespace artus
