// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/reports/feedback_words.h"

#include <algorithm>

#include "artus/detail/viewer/words/retell.h"

namespace artus {
namespace {

constexpr const char* kSentences[] = {
    // NOLINT(*-avoid-c-arrays)
    // what, before its value
    msgid("entered a structure that must never be entered"),
    msgid("entered a structure to avoid"),
    msgid("time until the needle was out"),
    msgid("the needle was left in the patient"),
    msgid("the patient was not asked all that matters"),
    msgid("the needle was never in the patient"),
    msgid("Put the tip on the skin beside the probe and advance it in the picture's plane."),
    msgid("advanced without seeing the tip"),
    msgid("bone contacts"),
    msgid("distance from the target"),
    msgid("distance from the planned entry"),
    msgid("injected outside the target"),
    msgid("pressure in the syringe"),
    msgid("fastest flow"),
    msgid("needle at rest in the tissue"),
    msgid("the probe moved while needling"),
    msgid("passes"),
    msgid("the needle's angle to the probe's face"),
    msgid("degrees"),
    msgid("{}: {} {}; should be below {}, and onto bone"),
    msgid("{}: {} {}; should be below {}"),
    msgid("{} ml injected without aspirating first"),
    msgid("shown: {} of {}; not shown: {}"),
    // why
    msgid("it was in the picture for {} s, and not in its middle for {} s on end"),
    msgid("it was never in the picture while it was asked for"),
    msgid("the tip was not seen"),
    msgid("the tip was {} mm deep at the end"),
    msgid("the time limit was over"),
    msgid("{} of 100 of the task's questions were asked"),
    msgid("the tip was {} mm in front of the plane"),
    msgid("the tip was {} mm behind the plane"),
    msgid("the needle stood at {} degrees to the probe's face: {} dB lost to the angle"),
    msgid("the tip was in the shadow of {}"),
    msgid("the probe did not touch the skin above the tip"),
    msgid("the tip was beside or below the picture"),
    msgid("what lay around the tip was as bright as it"),
    msgid("the tip came onto bone at {} mm/s"),
    msgid("the tip went {} mm into the zone around {}"),
    msgid("nothing moved for {} s"),
    msgid("the needle was placed {} mm from the target"),
    msgid("both hands moved at once, the probe with {} mm/s at the fastest"),
    msgid("the path was not chosen before the skin"),
    msgid("a steep needle sends its echo away"),
    msgid("{} ml with the tip in {}, without a pause to check where the first drops went"),
    msgid("{} ml with the tip in {}"),
    msgid("the plunger was not drawn back for 2 s; the tip was in {}"),
    msgid("the tip was in {}"),
    msgid("the thumb pushed with {} N at most"),
    // what to do
    msgid("Ask before you begin: side, allergies, blood thinners, infections, consent."),
    msgid("Enter further from the probe, so that the needle lies flatter."),
    msgid("Choose a path that bone does not shadow."),
    msgid("Keep the whole face on the skin."),
    msgid(
        "Stop when you lose the tip. Find the needle with the beam: move the probe, then advance."),
    msgid("Stop when you lose the tip. Tilt the probe until it is back, then advance."),
    msgid("Find this structure in the picture first. Choose a path that passes it."),
    msgid("Withdraw the needle before you end the attempt."),
    msgid("Slow down to less than 5 mm/s in the last centimetre."),
    msgid("Before you stop, look where the tip is, not where it should be."),
    msgid("Inject half a ml and look: the line must open."),
    msgid("Aspirate for 3 s before you inject."),
    msgid("Do not force it: withdraw the needle by a millimetre until it flows."),
    msgid("Inject more slowly than 0.3 ml/s, so that you feel the tissue."),
    msgid("Look and decide before you enter the skin, then go."),
    msgid("Rest the probe hand on the patient."),
    msgid("Choose the path before you enter the skin."),
    msgid("Hold the needle flatter: enter further from the probe."),
    msgid("Sweep the whole area slowly. Stop when you see it, bring it to the middle and hold "
          "still."),
    // done well
    msgid("You found all that was asked for."),
    msgid("You kept the tip in sight nearly all the time."),
    msgid("You kept the needle in the plane while you advanced."),
    msgid("You reached the target in a single pass."),
    msgid("Your probe hand was steady."),
    // what is next
    msgid("Repeat this task with the aids until all marks hold."),
    msgid("Do the same task again without aids: only that counts."),
    msgid("Repeat it once to make sure, then go to the next level."),
    msgid("Repeat this task."),
    msgid("Find the structures in the gel block with the probe."),
    msgid("Follow the tip to a shallow point on the gel block."),
    msgid("Hold the needle in the plane on the gel block."),
    msgid("Touch the point at 20 mm on the gel block."),
    msgid("Repeat this task: aspirate, inject half a ml, look, then inject the rest."),
};

}  // namespace

std::string feedback_words(Language language, const std::string& english) {
  std::string told = retell(language, kSentences, english);
  if (language == Language::english) std::replace(told.begin(), told.end(), '_', ' ');  // names
  return told;
}

}  // namespace artus
