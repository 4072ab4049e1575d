// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/view_options.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "artus/detail/anatomy/body/standard_view.h"
#include "artus/detail/apps/options/arguments.h"
#include "artus/detail/apps/options/command.h"
#include "artus/detail/core/units.h"
#include "artus/detail/echo/probe/grey_curve_file.h"
#include "artus/detail/echo/probe/setting_ranges.h"
#include "artus/echo/transducer_file.h"

namespace artus {
namespace {

constexpr double kMegahertz = 1e6;  // Hz
constexpr double kUsualDepth = 40;  // mm of a picture

/// A flag's range in its own unit.
FlagCheck within(const Range& range, double unit = 1) {
  const Range shown = in_unit(range, unit);
  return number_in(shown.low, shown.high);
}
FlagCheck whole_within(const Range& range) {
  return whole_number_in(std::lround(range.low), std::lround(range.high));
}

Look look_of(const std::string& name) {
  const auto at = std::find(kLookNames.begin(), kLookNames.end(), name);
  return static_cast<Look>(at - kLookNames.begin());
}

Result<Transducer> make_transducer(const ViewOptions& options) {
  const auto preset = find_transducer(options.transducer);
  if (!preset) {
    Error error = preset.error();
    if (error.where.empty()) error.where = "--transducer";
    return tl::unexpected(error);
  }
  Transducer transducer = preset->transducer;
  if (options.frequency_mhz) transducer.frequency = *options.frequency_mhz * kMegahertz;
  if (options.focus_mm) transducer.elevation_focus = *options.focus_mm * kMillimetre;
  if (options.transmit_focus_mm)
    transducer.transmit_focus = *options.transmit_focus_mm * kMillimetre;
  if (options.steering_deg) transducer.steering = *options.steering_deg * kDegree;
  if (options.lines) transducer.n_lines = *options.lines;
  return transducer;
}

}  // namespace

void add_gauge_option(Command* command, int& gauge) {
  command
      ->add_option("--gauge", gauge,
                   "needle gauge, in the picture and for the flow: 18 to 23, 25 or 27")
      ->capture_default_str();
}

void add_threads_option(Command* command, int& threads) {
  command
      ->add_option(
          "--threads", threads,
          "threads of the imaging; 0: as many as processors. The image does not depend on it")
      ->check(whole_within(ImageRanges::n_threads))
      ->capture_default_str();
}

namespace {

void add_look_options(Command* command, ViewOptions& options) {
  command
      ->add_option("--look", options.look,
                   "what the scanner makes of the echoes: raw, clinical (clutter, grey curve, "
                   "speckle reduction, grain) or compound (clinical with averaged speckle)")
      ->one_of({"raw", "clinical", "compound"})
      ->capture_default_str();
  command
      ->add_option("--grey-curve", options.grey_curve,
                   "clinical, linear, hard, or a .toml file; not of the raw look")
      ->capture_default_str();
}

}  // namespace

void add_imaging_options(Command* command, ViewOptions& options) {
  command
      ->add_option("--transducer", options.transducer,
                   "linear-6-18, linear-4-9, hockey-7-15, curved-2-5, or a .toml file")
      ->capture_default_str();
  add_gauge_option(command, options.gauge);
  add_needle_length_option(command, options.needle_length_mm);
  command->add_flag("--echogenic", options.echogenic, "dimpled needle, seen at steep angles, too");
  command
      ->add_option("--depth", options.depth_mm,
                   "image depth, mm (default: 40, or more where the joint's needle goes deeper)")
      ->check(within(ImageRanges::depth, kMillimetre));
  command->add_option("--gain", options.gain_db, "gain, dB")
      ->check(within(ImageRanges::gain_db))
      ->capture_default_str();
  command->add_option("--dynamic-range", options.dynamic_range_db, "dB between black and white")
      ->check(within(ImageRanges::dynamic_range_db))
      ->capture_default_str();
  command
      ->add_option("--frequency", options.frequency_mhz,
                   "centre frequency, MHz (default: the transducer's)")
      ->check(within(TransducerRanges::frequency, kMegahertz));
  command
      ->add_option("--focus", options.focus_mm,
                   "elevation focus of the lens, mm (default: the transducer's)")
      ->check(within(TransducerRanges::elevation_focus, kMillimetre));
  command
      ->add_option("--transmit-focus", options.transmit_focus_mm,
                   "focus of the transmitted beam, 2 mm or more; 0: at every depth (default: the "
                   "transducer's)")
      ->check(within({0, TransducerRanges::transmit_focus.high}, kMillimetre));
  command
      ->add_option("--steering", options.steering_deg,
                   "tilt of the scanlines toward +x, degrees (default: the transducer's)")
      ->check(within(TransducerRanges::steering, kDegree));
  command->add_option("--lines", options.lines, "scanlines (default: the transducer's)")
      ->check(whole_within(TransducerRanges::n_lines));
  command->add_option("--pixel", options.pixel_mm, "pixel size, mm")
      ->check(within(ImageRanges::pixel, kMillimetre))
      ->capture_default_str();
  command->add_option("--smoothing", options.smoothing, "0 none .. 1, of the compressed lines")
      ->check(within(ImageRanges::smoothing))
      ->capture_default_str();
  add_look_options(command, options);
  command
      ->add_option("--compound", options.compound,
                   "steered frames that are averaged, an odd number; 1: none")
      ->one_of({"1", "3", "5", "7", "9"})
      ->capture_default_str();
  command->add_option("--planes", options.planes, "elevation planes of the slice's thickness")
      ->check(whole_within(ImageRanges::n_planes))
      ->capture_default_str();
  add_threads_option(command, options.threads);
  command->add_option("--seed", options.seed, "seed of speckle and noise")
      ->check(whole_number_in(0, 1000000000))
      ->capture_default_str();
}

void add_view_options(Command* command, ViewOptions& options) {
  command->add_option("--probe", options.probe,
                      "position/direction[/lateral], each x,y,z; position in mm "
                      "(default: the joint's probe pose)");
  command->add_option("--needle", options.needle,
                      "entry/tip, each x,y,z in mm, or 'default' for the joint's (default: none)");
  add_imaging_options(command, options);
}

Result<NeedleShape> needle_of_flag(int gauge) {
  if (const auto shape = needle_of_gauge(gauge)) return *shape;
  return fail(
      ErrorCode::invalid,
      "no needle of gauge " + std::to_string(gauge) + "; choose 18, 19, 20, 21, 22, 23, 25 or 27",
      "--gauge");
}

Result<View> make_view(const ViewOptions& options) {
  View view;
  if (!options.probe.empty()) {
    const auto pose = parse_probe_pose(options.probe, "--probe");
    ARTUS_TRY(pose);
    view.X_JP = *pose;
  }
  view.default_needle = options.needle == "default";
  if (!options.needle.empty() && !view.default_needle) {
    const auto pose = parse_needle_pose(options.needle, "--needle");
    ARTUS_TRY(pose);
    view.X_JN = *pose;
  }
  const auto shape = needle_of_flag(options.gauge);
  ARTUS_TRY(shape);
  view.needle_shape = *shape;
  view.needle_shape.echogenic = options.echogenic;
  if (options.needle_length_mm) view.needle_shape.length = *options.needle_length_mm * kMillimetre;
  const auto transducer = make_transducer(options);
  ARTUS_TRY(transducer);
  view.transducer = *transducer;
  view.settings.depth = options.depth_mm.value_or(kUsualDepth) * kMillimetre;
  view.settings.gain_db = options.gain_db;
  view.settings.dynamic_range_db = options.dynamic_range_db;
  view.settings.pixel = options.pixel_mm * kMillimetre;
  view.settings.smoothing = options.smoothing;
  view.settings.compound_angles = options.compound;
  view.settings.look = look_of(options.look);
  const auto curve = find_grey_curve(options.grey_curve);
  ARTUS_TRY(curve);
  view.settings.grey_curve = curve->curve;
  view.settings.n_planes = options.planes;
  view.settings.n_threads = options.threads;
  view.settings.seed = options.seed;
  for (const auto& valid : {validate(view.transducer), validate(view.settings)})
    if (!valid) {
      Error error = valid.error();
      error.where = "--transducer, --transmit-focus";  // all other flags have their range
      return tl::unexpected(error);
    }
  return view;
}

Pose View::probe(const CompiledJoint& joint) const {
  return X_JP.value_or(joint.X_JP_default);
}

std::optional<NeedleView> View::needle(const CompiledJoint& joint) const {
  if (X_JN) return NeedleView{*X_JN, needle_shape};
  if (default_needle) return NeedleView{joint.X_JN_default, needle_shape};
  return std::nullopt;
}

double depth_for(const CompiledJoint& joint) {
  constexpr double kBeyondTip = 8e-3;  // m
  constexpr double kStep = 10e-3;      // m
  if (const StandardView* view = view_at_default_probe(joint); view != nullptr && view->depth > 0)
    return view->depth;
  const Vec3 p_PN = joint.X_JP_default.inverse() * joint.X_JN_default.translation();
  const double depth = kStep * std::ceil((p_PN.z() + kBeyondTip) / kStep - 1e-9);
  return std::clamp(depth, kUsualDepth * kMillimetre, ImageRanges::depth.high);
}

double needle_length_for(const Scene& scene, const Pose& X_JN) {
  constexpr double kFarthest = 0.3;    // m, more than any needle
  constexpr double kOutOfSkin = 8e-3;  // m of shaft between hub and skin
  // Those that are sold, m.
  constexpr std::array<double, 7> kLengths{35e-3, 50e-3, 80e-3, 100e-3, 120e-3, 150e-3, 200e-3};
  const Vec3 tip = X_JN.translation();
  const Vec3 axis = X_JN.linear().col(2);
  double entry = kFarthest;  // from the far end to the skin
  for (const TissueInterval& s : tissue_intervals(scene, {tip - kFarthest * axis, tip}))
    if (s.region < kFirstRegion) entry = s.exit;
  const double way = kFarthest - entry;
  const auto fits = std::find_if(kLengths.begin(), kLengths.end(),
                                 [&](double length) { return length >= way + kOutOfSkin; });
  return fits != kLengths.end() ? *fits : kLengths.back();
}

void take_depth(const ViewOptions& options, const CompiledJoint& joint, View& view) {
  if (!options.depth_mm) view.settings.depth = depth_for(joint);
}

Result<LoadedView> load_view(const JointOptions& joint_options, const ViewOptions& options,
                             bool quiet) {
  auto view = make_view(options);
  ARTUS_TRY(view);
  const auto joint = load(joint_options, make_progress_printer(quiet));
  ARTUS_TRY(joint);
  LoadedView loaded;
  loaded.X_JP = view->probe(**joint);
  loaded.needle = view->needle(**joint);
  loaded.view = std::move(*view);
  take_depth(options, **joint, loaded.view);
  loaded.scene = std::make_shared<const Scene>(*joint);
  if (loaded.needle && !options.needle_length_mm)
    loaded.needle->shape.length = loaded.view.needle_shape.length =
        needle_length_for(*loaded.scene, loaded.needle->X_JN);
  return loaded;
}

}  // namespace artus
