// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/guide.h"

#include <cmath>

#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kBeside =
    5e-3;  // m; assumed: beyond it the probe goes to the needle, not the needle to it

std::string say(const GuideInput& in, const char* which,
                std::initializer_list<std::string_view> values) {
  return fill(translate(in.language, which), values);
}

bool at_target(const GuideInput& in) {
  return in.needle.inside && !in.target.empty() && in.needle.region == in.target_region;
}

}  // namespace

std::string Guide::goal(const GuideInput& in) const {
  if (in.target.empty()) return translate(in.language, "Explore the joint with the probe");
  if (in.target_is_bone)
    return say(in,
               reached_ ? msgid("Done: the tip touched the {}")
                        : msgid("Touch this bone with the tip: {}"),
               {in.target});
  return say(
      in, reached_ ? msgid("Done: the tip came into the {}") : msgid("Bring the tip into the {}"),
      {in.target});
}

// The needle is in the body.
std::string Guide::with_needle(const GuideInput& in) const {
  const auto key = [&in](Action action) {
    return in.keys->said_key(action, in.language);
  };
  const std::string pull = key(Action::pull);
  if (in.needle.hub_on_skin)
    return say(in, msgid("The hub is on the skin: this needle is {} mm long. Pull back with {}"),
               {number(in.language, in.needle_length / kMillimetre, 0), pull});
  if (at_target(in) && in.frozen)
    return say(in, msgid("Next: two clicks measure, {} saves the picture; {} goes on"),
               {key(Action::save), key(Action::freeze)});
  if (at_target(in))
    return say(in, msgid("Next: {} freezes, {} saves the picture; then {} pulls the needle out"),
               {key(Action::freeze), key(Action::save), pull});
  if (in.needle.on_bone) return say(in, msgid("Bone: pull back with {} and aim beside it"), {pull});
  if (reached_) return say(in, msgid("Next: {} pulls the needle out"), {pull});
  if (std::abs(in.needle.plane_offset) > kBeside)
    return say(
        in,
        msgid(
            "The needle is {} mm beside the picture: {} takes the probe, slide it over the needle"),
        {number(in.language, std::abs(in.needle.plane_offset) / kMillimetre, 0),
         key(Action::take_probe)});
  if (!in.needle.in_plane)
    return say(
        in, msgid("The needle is not in the picture's plane: turn it with the mouse until it is"),
        {});
  if (in.target.empty())
    return say(in, msgid("Next: wheel or {} pushes the needle in; {} pulls"),
               {key(Action::push), pull});
  return say(in, msgid("Next: go on, the tip in sight: {} mm to go"),
             {number(in.language, in.needle.to_target / kMillimetre, 0)});
}

std::string Guide::next(const GuideInput& in) {
  reached_ = reached_ || at_target(in);
  const auto key = [&in](Action action) {
    return in.keys->said_key(action, in.language);
  };
  if (in.peer == PeerState::absent) return say(in, msgid("Next: {}"), {in.connect});
  if (in.peer != PeerState::alive)
    return say(
        in,
        msgid("The device does not answer: no force. Reconnect its cable; the last state is kept"),
        {});
  if (in.paused) return say(in, msgid("Paused: {} goes on"), {key(Action::pause)});
  if (!in.has_hand)
    return say(in, msgid("A simulated hand or another device is at work: watch"), {});
  if (in.needle.inside) return with_needle(in);
  if (reached_) return say(in, msgid("Done. {} starts again"), {key(Action::reset)});
  if (in.grab == Grab::needle)
    return say(in, msgid("Next: wheel or {} pushes the needle in; {} pulls"),
               {key(Action::push), key(Action::pull)});
  if (in.probe_lifted)
    return say(in, msgid("The probe is off the skin: press it on with {}, or {} puts it back"),
               {key(Action::push), key(Action::home)});
  if (in.phase == GesturePhase::inserting)
    return say(in, msgid("Next: {} takes the needle, which stands at the entry"),
               {key(Action::take_needle)});
  if (in.grab == Grab::probe)
    return say(
        in,
        msgid("Next: move the mouse until the picture shows the {}; then {} chooses the entry, or "
              "{} lets go"),
        {in.target.empty() ? translate(in.language, "Explore the joint with the probe") : in.target,
         key(Action::choose_entry), key(Action::let_go)});
  return say(in, msgid("Next: {} takes the probe to explore, {} the needle at the planned entry"),
             {key(Action::take_probe), key(Action::take_needle)});
}

}  // namespace artus
