// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/apps/options/device_options.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/needle_view.h"
#include "artus/echo/transducer.h"
#include "artus/raycast/scene.h"

namespace artus {

/// The flags of every command that looks through a probe; lengths in millimetres, frequency in MHz.
struct ViewOptions {
  std::string probe;
  std::string needle;
  int gauge = 22;
  bool echogenic = false;
  std::optional<double> needle_length_mm;  ///< else 35, or more where the way needs it
  std::string transducer = "linear-6-18";
  std::optional<double> frequency_mhz;  ///< empty: the transducer's, as the next four
  std::optional<double> focus_mm;
  std::optional<double> transmit_focus_mm;
  std::optional<double> steering_deg;
  std::optional<int> lines;
  std::optional<double> depth_mm;  ///< else 40, or more where the joint's needle goes deeper
  double gain_db = ImageSettings{}.gain_db;
  double dynamic_range_db = ImageSettings{}.dynamic_range_db;
  double pixel_mm = 0.1;
  double smoothing = 0;
  std::string look = look_name(ImageSettings{}.look);
  std::string grey_curve = "clinical";
  int compound = 1;
  int planes = ImageSettings{}.n_planes;
  int threads = 0;
  std::uint64_t seed = 1;
};

/// --gauge, checked by needle_of_flag; --threads.
void add_gauge_option(Command* command, int& gauge);
void add_threads_option(Command* command, int& threads);

/// The flags of transducer, image and needle type, without poses.
void add_imaging_options(Command* command, ViewOptions& options);

/// All of them.
void add_view_options(Command* command, ViewOptions& options);

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

/// The needle that --gauge names. Errors: invalid (no such gauge).
[[nodiscard]] Result<NeedleShape> needle_of_flag(int gauge);

/// Errors: malformed or invalid, with the flag as place; those of the transducer's file.
[[nodiscard]] Result<View> make_view(const ViewOptions& options);

/// As the view says that the joint's default probe stands at; else deep enough to show the joint's
/// needle as planned, in steps of 10 mm; 40 mm or more, m.
[[nodiscard]] double depth_for(const CompiledJoint& joint);

/// The shortest needle of those that are sold (35 to 200 mm) whose hub stays 8 mm out of the skin
/// with its tip at X_JN, m.
[[nodiscard]] double needle_length_for(const Scene& scene, const Pose& X_JN);

/// Without --depth: deep enough for the joint's needle as planned.
void take_depth(const ViewOptions& options, const CompiledJoint& joint, View& view);

/// A view of a joint that is loaded and indexed.
struct LoadedView {
  View view;
  std::shared_ptr<const Scene> scene;
  Pose X_JP = Pose::Identity();
  std::optional<NeedleView> needle;

  [[nodiscard]] const CompiledJoint& joint() const noexcept { return scene->joint(); }
};

/// make_view, then the joint: a wrong flag is told before anything is loaded. `quiet` without
/// progress.
[[nodiscard]] Result<LoadedView> load_view(const JointOptions& joint, const ViewOptions& options,
                                           bool quiet);

}  // namespace artus
