// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/guide.h"

#include <cmath>

#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kBeside =
    5e-3;  // m; assumed: beyond it the probe goes to the needle, not the needle to it

std::string say(const GuideInput& in, Text which, std::initializer_list<std::string_view> values) {
  return fill(text(in.language, which), values);
}

bool at_target(const GuideInput& in) {
  return in.needle.inside && !in.target.empty() && in.needle.region == in.target_region;
}

}  // namespace

std::string Guide::goal(const GuideInput& in) const {
  if (in.target.empty()) return text(in.language, Text::goal_none);
  if (in.target_is_bone)
    return say(in, reached_ ? Text::goal_on_bone : Text::goal_bone, {in.target});
  return say(in, reached_ ? Text::goal_reached : Text::goal_region, {in.target});
}

// The needle is in the body.
std::string Guide::with_needle(const GuideInput& in) const {
  const auto key = [&in](Action action) {
    return in.keys->said_key(action, in.language);
  };
  const std::string pull = key(Action::pull);
  if (in.needle.hub_on_skin)
    return say(in, Text::step_hub, {number(in.language, in.needle_length / kMillimetre, 0), pull});
  if (at_target(in) && in.frozen)
    return say(in, Text::step_frozen, {key(Action::save), key(Action::freeze)});
  if (at_target(in))
    return say(in, Text::step_reached, {key(Action::freeze), key(Action::save), pull});
  if (in.needle.on_bone) return say(in, Text::step_bone, {pull});
  if (reached_) return say(in, Text::step_withdraw, {pull});
  if (std::abs(in.needle.plane_offset) > kBeside)
    return say(in, Text::step_follow,
               {number(in.language, std::abs(in.needle.plane_offset) / kMillimetre, 0),
                key(Action::take_probe)});
  if (!in.needle.in_plane) return say(in, Text::step_steer, {});
  if (in.target.empty()) return say(in, Text::step_push, {key(Action::push), pull});
  return say(in, Text::step_advance, {number(in.language, in.needle.to_target / kMillimetre, 0)});
}

std::string Guide::next(const GuideInput& in) {
  reached_ = reached_ || at_target(in);
  const auto key = [&in](Action action) {
    return in.keys->said_key(action, in.language);
  };
  if (in.peer == PeerState::absent) return say(in, Text::step_connect, {in.connect});
  if (in.peer != PeerState::alive) return say(in, Text::step_lost, {});
  if (in.paused) return say(in, Text::step_paused, {key(Action::pause)});
  if (!in.has_hand) return say(in, Text::step_watch, {});
  if (in.needle.inside) return with_needle(in);
  if (reached_) return say(in, Text::step_done, {key(Action::reset)});
  if (in.grab == Grab::needle)
    return say(in, Text::step_push, {key(Action::push), key(Action::pull)});
  if (in.probe_lifted)
    return say(in, Text::step_probe_lifted, {key(Action::push), key(Action::home)});
  if (in.phase == GesturePhase::inserting)
    return say(in, Text::step_needle, {key(Action::take_needle)});
  if (in.grab == Grab::probe)
    return say(in, Text::step_probe,
               {in.target.empty() ? text(in.language, Text::goal_none) : in.target,
                key(Action::choose_entry), key(Action::let_go)});
  return say(in, Text::step_choose, {key(Action::take_probe), key(Action::take_needle)});
}

}  // namespace artus
