// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>

#include "artus/detail/apps/options/device_options.h"
#include "artus/detail/apps/options/feel_options.h"
#include "artus/detail/apps/options/view_options.h"

namespace artus {

/// The flags of every command that lets a simulated hand push a needle into a joint and shows what
/// came of it. Gauge and length of the needle are the view's, for forces and pictures alike.
struct HandOptions {
  JointOptions joint;
  ViewOptions view;
  FeelOptions feel;
  double rate_hz = 1000;
  std::string device = "virtuose_6d_desktop";
  std::string liquid = "lidocaine";
  std::filesystem::path out;
  bool no_images = false;
  bool no_video = false;
  bool json = false;
};

/// Adds them all but the ticks' rate, which commands name differently.
void add_hand_options(Command* command, HandOptions& options);

/// A joint that is loaded, how it is looked at, and how its needle feels.
struct LoadedHand {
  LoadedView at;
  NeedleFeel feel;
};

/// What the flags mean: a wrong one of the picture is told before anything is loaded. Errors: those
/// of load_view and make_feel.
[[nodiscard]] Result<LoadedHand> load_hand(const HandOptions& options);

}  // namespace artus
