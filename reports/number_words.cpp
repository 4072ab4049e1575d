// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/reports/number_words.h"

#include "artus/detail/viewer/words/retell.h"

namespace artus {
namespace {

constexpr const char* kDefinitions[] = {
    // NOLINT(*-avoid-c-arrays)
    msgid("sum of the steps of the pose's origin"),
    msgid("poses that were left out: further from the one before than 2 m/s or 20 rad/s reach, and "
          "not there for 0.3 s"),
    msgid("sum of the steps' angles"),
    msgid("runs faster than 50 mm/s for 0.2 s or more, closed after 0.2 s below"),
    msgid("runs faster than 50 deg/s for 0.2 s or more, closed after 0.2 s below"),
    msgid("spectral arc length of the speed, up to 10 Hz, from 0.05 of the largest; nearer to 0 is "
          "smoother"),
    msgid("log dimensionless jerk of the speed; nearer to 0 is smoother"),
    msgid("begin of the first interval that ends with the tip inside the skin, to the last instant "
          "inside"),
    msgid("start to the first instant with the tip inside"),
    msgid("intervals that end with the tip inside"),
    msgid("steps that end with the tip inside"),
    msgid("area between neighbouring shafts from tip to the skin on the line to 300 mm back; both "
          "ends inside"),
    msgid("swept area times the needle's outer diameter"),
    msgid("largest distance from the skin to the tip along the needle"),
    msgid("start to the last instant with the tip inside"),
    msgid("1 when the tip was outside the body at the end"),
    msgid("times inside, longer than 3 s, with the tip slower than 2 mm/s and the probe, too, "
          "which turns slower than 2 deg/s"),
    msgid("sum of those times"),
    msgid("1 and every advance of 5 mm or more after a withdrawal of 5 mm or more"),
    msgid("turns of the shaft by more than 5 degrees inside between two rests, without a pass; a "
          "turn ends when the shaft keeps within 1 degree for 0.5 s"),
    msgid("share of the distance advanced in tissue with the tip within half the slice's thickness "
          "at its depth and the shaft within 5 degrees of the plane"),
    msgid("tip to image plane, inside"),
    msgid("its 90th percentile"),
    msgid("shaft to image plane, inside"),
    msgid(
        "share of the time in tissue with the last 5 mm of the shaft, and the last 2 mm alone, 4 "
        "dB above lines beside it in the pictures of that moment, where its echo is not 12 dB "
        "below muscle's; without pictures, with the tip between the outermost lines, not shadowed, "
        "and its echo 6 dB above muscle after what angle and distance to the plane take"),
    msgid("runs of 1 mm or more advanced in tissue while the tip is not seen, ended by 3 s without "
          "advance; each 5 mm of one beyond the way to the picture's edge is one more"),
    msgid("distance advanced in those runs"),
    msgid("distance advanced in tissue before the tip first came between the picture's edges; 0 "
          "when it never did"),
    msgid("time with colour or power Doppler on before the needle went in"),
    msgid("shaft to the probe's face (the image's x axis), inside"),
    msgid("the probe's mean speed while the tip moves faster than 2 mm/s inside"),
    msgid("correlation of the two hands' speeds"),
    msgid("where the shaft crossed the skin at the first instant with the tip inside, to the entry "
          "asked for"),
    msgid("shaft to the probe's face at the first instant with the tip inside"),
    msgid("tip to {} where the needle was placed: where half of what was given had been, else its "
          "stay of 0.5 s or more that came nearest, those on the way out aside, else its deepest"),
    msgid("deepest intrusion of the tip beyond the zone's edge"),
    msgid("time of the tip inside the zones to avoid"),
    msgid("deepest intrusion of all"),
    msgid("times that the tip came into a zone"),
    msgid("times that the tip came into a zone that must never be entered"),
    msgid("structures that were shown when asked for: each in turn, its middle within 4 mm of the "
          "beam's middle for 1.5 s"),
    msgid("start to the moment at which the last of them was found"),
    msgid("times that the tip came onto bone, 0.3 s or more apart"),
    msgid("largest force on bone"),
    msgid("fastest touch of bone"),
    msgid("path length of the tip while it stood on bone"),
    msgid("largest cutting and friction along the needle with the tip in this layer"),
    msgid("its mean"),
    msgid("its sum over time"),
    msgid("tip to {}, mean over the volume given"),
    msgid("share of the volume that went into the place of {}"),
    msgid("given into the place of this layer"),
    msgid("out of the tip in all, whatever was drawn back"),
    msgid("time that it flowed, the barrel sucked or the thumb pressed or pulled"),
    msgid("volume given over the time that it flowed (more than 1 ul/s)"),
    msgid("largest flow"),
    msgid("largest force on the thumb"),
    msgid("largest pressure in the barrel"),
    msgid("farthest distance of the tip from where a flow began, while it lasted"),
    msgid("given before the first pause of 2 s or more; none when nothing came after one"),
    msgid("pauses of 2 s or more between two flows"),
    msgid("times that the barrel's pressure was below -5 kPa for 2 s or more"),
    msgid("1 when one of them came before anything was given"),
    msgid("share of the pictures in tissue in which the last 5 mm of the shaft, and the last 2 mm "
          "alone, are 4 dB above lines that run beside it; a shaft across the plane: the disc of "
          "1.5 mm where the tip shows above what is typical of the ring of 2 to 4 mm around it"),
    msgid("that contrast's median"),
    msgid("mean over 10 ms at 100 Hz, zero-phase Butterworth of order 2 at 6 Hz"),
    msgid("none, every tick"),
    msgid("none, every picture"),
    msgid("none, once"),
    msgid("share of the task's questions to the patient that were asked before it began"),
    msgid("patient"),
    msgid("needle"),
    msgid("probe"),
    msgid("both"),
    msgid("syringe"),
};

}  // namespace

std::string number_words(Language language, const std::string& english) {
  return retell(language, kDefinitions, english);
}

}  // namespace artus
