// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/register_page.h"

#include <chrono>
#include <cstdint>

#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/units.h"
#include "artus/detail/viewer/words/anatomy_names.h"

namespace artus {
namespace {

/// What the page is about, from one look to the next.
struct Registering {
  TouchedLandmarks& landmarks;
  const SeenNeedle& needle;
  TrackerCalibration calibration;
  std::string told;  // of the last choice
  bool bad = false;  // it could not be done
  Language language;
};

std::int64_t now_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

std::string in_millimetres(double metres) {
  return fixed_number(metres / kMillimetre, 1);
}

/// Where the tip is, or why it cannot be taken.
PageLine needle_line(const Registering& at) {
  const RestingTip tip = at.landmarks.tip();
  switch (tip.rest) {
    case TipRest::unseen:
      return {translate(at.language, "The needle is not seen."), Tone::bad};
    case TipRest::brief:
      return {translate(at.language, "The needle is seen: hold it still."), Tone::dim};
    case TipRest::moving:
      return {translate(at.language, "The tip moves: hold it still."), Tone::dim};
    case TipRest::resting:
      break;
  }
  const Vec3 p = tip.X_RN.translation();
  return {fill(translate(at.language, "The tip rests at {}, {}, {} mm of the hands' frame."),
               {in_millimetres(p.x()), in_millimetres(p.y()), in_millimetres(p.z())}),
          Tone::good};
}

/// How well what was touched fits.
PageLine fit_line(const Registering& at) {
  constexpr std::size_t kFewest = 3;
  const std::size_t n = at.landmarks.n_touched();
  if (n < kFewest)
    return {fill(translate(at.language, "{} of at least three landmarks touched."),
                 {std::to_string(n)})};
  const auto fit = at.landmarks.fit();
  if (!fit) return {fit.error().message, Tone::bad};
  return {fill(translate(at.language, "They fit within {} mm (rms)."), {in_millimetres(fit->rms)}),
          Tone::good};
}

void refresh(Page& page, Registering& at) {
  at.landmarks.see(now_ns(), at.needle());
  page.lines = {{translate(at.language,
                           "Put the needle's tip on a landmark, hold it still, and choose the "
                           "landmark.")},
                needle_line(at),
                fit_line(at)};
  if (!at.told.empty()) page.lines.push_back({at.told, at.bad ? Tone::bad : Tone::good});
}

Page make_page(Registering& at) {
  Page page;
  page.name = "register";
  page.title = translate(at.language, "Where the joint is");
  const auto fit = at.landmarks.fit();
  std::size_t of_fit = 0;
  const auto& landmarks = at.landmarks.landmarks();
  for (std::size_t k = 0; k < landmarks.size(); ++k) {
    std::string beside = translate(at.language, "to do");
    if (at.landmarks.is_touched(k)) {
      beside = translate(at.language, "touched");
      if (fit)
        beside = fill(translate(at.language, "off by {} mm"),
                      {in_millimetres(fit->residuals[of_fit++])});
    }
    page.choices.push_back({clinical_name(at.language, landmarks[k].name),
                            beside,
                            at.landmarks.is_touched(k) ? Tone::good : Tone::plain,
                            {},
                            nullptr});
  }
  const auto add = [&](const char* name, const std::string& beside, const char* about) {
    page.choices.push_back({translate(at.language, name),
                            beside,
                            Tone::plain,
                            {{translate(at.language, about)}},
                            nullptr});
  };
  add(msgid("Where the device lets a needle in"),
      translate(at.language, at.calibration.insertion ? msgid("done") : msgid("to do")),
      msgid("Only for a device whose needle goes in at one fixed place: hold it there, along the "
            "direction in which it goes in."));
  add(msgid("Save"), "", msgid("For --calibration of every command."));
  add(msgid("Leave"), "", msgid("Nothing is written."));
  page.refresh = [&at](Page& shown) {
    refresh(shown, at);
  };
  return page;
}

/// The insertion point is where the needle is, if it rests; whether it does.
bool take_insertion(Registering& at) {
  const RestingTip tip = at.landmarks.tip();
  if (tip.rest != TipRest::resting) return false;
  GestureParams gesture = at.calibration.insertion.value_or(GestureParams());
  gesture.p_W = tip.X_RN.translation();
  gesture.axis_W = tip.X_RN.linear().col(2);
  at.calibration.insertion = gesture;
  return true;
}

/// The calibration as it can be saved. Errors: those of the fit; invalid (nothing is known).
Result<void> finish(Registering& at) {
  if (at.landmarks.n_touched() == 0 && at.calibration.insertion) return {};
  const auto fit = at.landmarks.fit();
  ARTUS_TRY(fit);
  at.calibration.X_JR = fit->X_JR;
  at.calibration.registered = true;
  return {};
}

}  // namespace

Result<bool> lead_to_registration(
    PageWindow& pages, TouchedLandmarks& landmarks, const SeenNeedle& needle,
    const TrackerCalibration& calibration,
    const std::function<Result<void>(const TrackerCalibration&)>& saved, Language language) {
  Registering at{landmarks, needle, calibration, {}, false, language};
  const std::size_t n = landmarks.landmarks().size();
  std::size_t mark = 0;
  const auto tell = [&](bool done) {
    at.bad = !done;
    at.told = translate(language,
                        done ? msgid("This is done.") : msgid("This was not done: try it again."));
    return done;
  };
  for (;;) {
    Page page = make_page(at);
    page.at = mark;
    const auto answer = pages.show(std::move(page));
    ARTUS_TRY(answer);
    if (answer->kind != PageAnswer::Kind::chosen || answer->choice > n + 1) return false;
    mark = answer->choice;
    if (mark < n) {
      if (tell(landmarks.touch(mark))) mark += 1;
    } else if (mark == n) {
      (void)tell(take_insertion(at));
    } else if (const auto known = finish(at)) {
      ARTUS_TRY(saved(at.calibration));
      return true;
    } else {
      at.bad = true;
      at.told = known.error().message;
    }
  }
}

}  // namespace artus
