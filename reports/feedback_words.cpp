// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/reports/feedback_words.h"

#include <array>

#include "artus/detail/viewer/words/retell.h"

namespace artus {
namespace {

constexpr std::array kSentences{
    // what, before its value
    msgid("into what must be spared"),
    msgid("advanced without seeing the tip"),
    msgid("touches of bone"),
    msgid("away from the target"),
    msgid("given beside the target"),
    msgid("pressure in the barrel"),
    msgid("fastest flow"),
    msgid("needle at rest inside"),
    msgid("the probe moved while needling"),
    msgid("passes"),
    msgid("the needle's angle to the probe's face"),
    msgid("degrees"),
    msgid("{}: {} {}; asked for: below {}, and onto bone"),
    msgid("{}: {} {}; asked for: below {}"),
    msgid("{} ml given without an aspiration before"),
    msgid("shown: {} of {}; not shown: {}"),
    // why
    msgid("it was in the picture for {} s, and not in its middle for {} s on end"),
    msgid("it was never in the picture while it was asked for"),
    msgid("the tip was not seen"),
    msgid("the tip was {} mm in front of the plane"),
    msgid("the tip was {} mm behind the plane"),
    msgid("the needle stood at {} degrees to the probe's face: {} dB lost to the angle"),
    msgid("the tip was in the shadow of {}"),
    msgid("the probe did not touch the skin above the tip"),
    msgid("the tip was beside or below the picture"),
    msgid("the tip came onto bone at {} mm/s"),
    msgid("the tip went {} mm into the zone around {}"),
    msgid("nothing moved for {} s"),
    msgid("the needle was placed {} mm from the target"),
    msgid("both hands moved at once, the probe with {} mm/s at the fastest"),
    msgid("the way was not chosen before the skin"),
    msgid("a steep needle sends its echo away"),
    msgid("{} ml with the tip in {}, and no pause to look after the first of it"),
    msgid("{} ml with the tip in {}"),
    msgid("the barrel was not drawn back for 2 s; the tip was in {}"),
    msgid("the tip was in {}"),
    msgid("the thumb pushed with {} N at most"),
    // what to do
    msgid("Enter further from the probe, so that the needle lies flatter."),
    msgid("Choose a way that bone does not cover."),
    msgid("Keep the whole face on the skin."),
    msgid(
        "Stop when you lose the tip. Find the needle with the beam: move the probe, then advance."),
    msgid("Stop when you lose the tip. Tilt the probe until it is back, then advance."),
    msgid("Slow below 5 mm/s in the last centimetre."),
    msgid("Before you stop, look where the tip is, not where it should be."),
    msgid("Give half a ml and look: the line must split."),
    msgid("Pull back for 3 s before you give."),
    msgid("Do not push on: pull back a millimetre until it flows."),
    msgid("Below 0.3 ml/s you feel the tissue."),
    msgid("Look and decide before the skin, then go."),
    msgid("Rest the probe hand on the patient."),
    msgid("Choose the line before the skin."),
    msgid("Flatter: enter further from the probe."),
    msgid("Sweep all of it slowly. Stop when it shows, bring it to the middle, and rest."),
    // done well
    msgid("You found all that was asked for."),
    msgid("You kept the tip in sight nearly all the time."),
    msgid("You kept the needle in the plane while you advanced."),
    msgid("You came there in a single pass."),
    msgid("Your probe hand was quiet."),
    // what is next
    msgid("The same once more with the aids off: only that counts."),
    msgid("Once more to make sure, then the next level."),
    msgid("The same task once more."),
    msgid("Find the structures in the gel block with the probe ({})."),
    msgid("Follow the tip to a shallow point on the gel block ({})."),
    msgid("Hold the needle in the plane on the gel block ({})."),
    msgid("Touch the point at 20 mm on the gel block ({})."),
    msgid("The same task once more: draw back, give half a ml, look, then the rest."),
};

}  // namespace

std::string feedback_words(Language language, const std::string& english) {
  return retell(language, kSentences, english);
}

}  // namespace artus
