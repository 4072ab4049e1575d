// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <string>

#include "echo/image_settings.h"
#include "echo/needle_view.h"
#include "echo/transducer.h"

#include "apps/command.h"

namespace artus {

/// The flags of every command that looks through a probe; lengths in millimetres, frequency in MHz.
struct ViewOptions {
  std::string probe;
  std::string needle;
  int gauge = 22;
  bool echogenic = false;
  double depth_mm = 40;
  double gain_db = 0;
  double dynamic_range_db = 60;
  double frequency_mhz = 12;
  double focus_mm = 20;
  double pixel_mm = 0.1;
  int lines = 256;
  int planes = 5;
  int threads = 0;
  std::uint64_t seed = 1;
};
void add_view_options(CLI::App* command, ViewOptions& options);

/// What the flags mean, before any joint is loaded. Poses that are not given are the joint's.
struct View {
  std::optional<Pose> X_JP;  ///< empty: the joint's default probe pose
  std::optional<Pose> X_JN;  ///< empty: no needle, or the joint's when default_needle
  bool default_needle = false;
  NeedleShape needle_shape;
  Transducer transducer;
  ImageSettings settings;

  [[nodiscard]] Pose probe(const CompiledJoint& joint) const;
  [[nodiscard]] std::optional<NeedleView> needle(const CompiledJoint& joint) const;
};

/// Errors: malformed or invalid, with the flag as place.
[[nodiscard]] Result<View> make_view(const ViewOptions& options);

}  // namespace artus
