// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <memory>
#include <optional>

#include "artus/detail/apps/hands/hands_commands.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/devices/kit/tip_calibration.h"

namespace artus {
namespace {

/// Poses of a body relative to another (the sheet, or the probe) over the pictures of phases.
class Watcher {
 public:
  explicit Watcher(const kit::Kit& kit) : kit_(kit) {}

  /// False: the pictures are not those of the calibrated camera.
  bool take(const kit::MarkerBody& body, const kit::MarkerBody& base, const kit::Picture8& picture,
            std::vector<Pose>& poses) {
    sized_ = check_size(kit_.lens, picture.grey);
    if (!sized_) return false;
    const auto seen = kit::see_markers(picture.grey);
    const auto X_CB = kit::find_pose(body, seen, kit_.lens, before(X_CB_));
    const auto X_CA = kit::find_pose(base, seen, kit_.lens, before(X_CA_));
    X_CB_ = X_CB ? std::optional<Pose>(X_CB->X_CB) : std::nullopt;
    X_CA_ = X_CA ? std::optional<Pose>(X_CA->X_CB) : X_CA_;
    if (X_CB && X_CA) poses.push_back(X_CA->X_CB.inverse() * X_CB->X_CB);
    return true;
  }
  [[nodiscard]] const Result<void>& sized() const { return sized_; }

 private:
  static const Pose* before(const std::optional<Pose>& pose) { return pose ? &*pose : nullptr; }
  const kit::Kit& kit_;
  std::optional<Pose> X_CB_;
  std::optional<Pose> X_CA_;
  Result<void> sized_;
};

Result<kit::MeasuredKit> ready_kit(const std::filesystem::path& file) {
  auto measured = kit_of(file);
  ARTUS_TRY(measured);
  if (!measured->has_camera)
    return fail(ErrorCode::invalid, "calibrate the camera first", file.string());
  return measured;
}

Result<void> pivot(const PictureOptions& options) {
  constexpr double kTouch = 5;  // s
  auto measured = ready_kit(options.kit);
  ARTUS_TRY(measured);
  const kit::Kit& kit = measured->kit;
  std::array<std::vector<Pose>, 4> poses;
  Watcher watcher(kit);
  ARTUS_TRY(for_phases(
      options,
      {{"the tip rests in a pit of the plate on the sheet: lean the syringe to all sides, by 30 "
        "degrees",
        0},
       {"the tip rests in one pit, still", kTouch},
       {"the tip rests in the other pit, still", kTouch},
       {"the tip in a pit, upright: roll the syringe about its needle by 45 degrees to both sides",
        0}},
      [&](std::size_t phase, const kit::Picture8& picture) {
        return watcher.take(kit.syringe, kit.sheet, picture, poses[phase]);
      }));
  ARTUS_TRY(watcher.sized());
  auto fit = kit::fit_tip(poses[0]);
  ARTUS_TRY(fit);
  fit = kit::with_divots(*fit, {poses[1], poses[2]});
  ARTUS_TRY(fit);
  const Vec3 nominal = kit::nominal_needle().linear().col(2);
  const auto axis = kit::fit_axis(poses[3], nominal);
  ARTUS_TRY(axis);
  measured->kit.X_BN = kit::needle_on_syringe(fit->tip_B, *axis);
  measured->kit.tip_error = fit->error;
  measured->has_tip = true;
  ARTUS_TRY(write_text(options.kit, to_toml(*measured)));
  tell(printed("tip at %.1f %.1f %.1f mm of the syringe, +- %.2f mm (condition %.1f, %zu pictures)",
               fit->tip_B.x() / kMillimetre, fit->tip_B.y() / kMillimetre,
               fit->tip_B.z() / kMillimetre, fit->error / kMillimetre, fit->condition,
               poses[0].size()));
  return {};
}

Result<void> face(const PictureOptions& options) {
  constexpr double kTouch = 6;  // s
  auto measured = ready_kit(options.kit);
  ARTUS_TRY(measured);
  if (!measured->has_tip)
    return fail(ErrorCode::invalid, "find the needle's tip first (artus hands pivot)",
                options.kit.string());
  const kit::Kit& kit = measured->kit;
  std::array<std::vector<Vec3>, 3> touches;
  Watcher watcher(kit);
  ARTUS_TRY(for_phases(
      options,
      {{"touch the cross at the left end of the probe's face, seen by the camera", kTouch},
       {"touch the cross in its middle", kTouch},
       {"touch the cross at its right end", kTouch}},
      [&](std::size_t phase, const kit::Picture8& picture) {
        std::vector<Pose> poses;
        if (!watcher.take(kit.syringe, kit.probe, picture, poses)) return false;
        for (const Pose& X_PB : poses) touches[phase].push_back(X_PB * kit.X_BN.translation());
        return true;
      }));
  ARTUS_TRY(watcher.sized());
  const auto fit = kit::fit_face(touches, kit::nominal_face(kit.hand), kit.tip_error);
  ARTUS_TRY(fit);
  measured->kit.X_BP = fit->X_BP;
  measured->kit.face_error = fit->error;
  measured->has_face = true;
  ARTUS_TRY(write_text(options.kit, to_toml(*measured)));
  tell(printed("middle of the face at %.1f %.1f %.1f mm of the probe, +- %.2f mm",
               fit->X_BP.translation().x() / kMillimetre, fit->X_BP.translation().y() / kMillimetre,
               fit->X_BP.translation().z() / kMillimetre, fit->error / kMillimetre));
  return {};
}

}  // namespace

void add_tip_commands(Command& app, ExitCode& code) {
  auto cone = std::make_shared<PictureOptions>();
  Command* command = add_command(
      app, "pivot", "The needle's tip and direction, with an error that covers the truth",
      "Four phases: lean with the tip in a pit; rest in one pit; in the other; roll.\n"
      "Examples:\n"
      "  artus hands pivot webcam -k hands.toml\n"
      "  artus hands pivot lean.mp4 one.mp4 other.mp4 roll.mp4 -k hands.toml");
  add_picture_options(command, *cone, "webcam, or four files, one for each phase");
  on_run(command, code, [cone] { return pivot(*cone); });

  auto touch = std::make_shared<PictureOptions>();
  command = add_command(app, "face", "The probe's face, by touching its marks with the needle",
                        "Needs the tip. Three phases: left end, middle, right end.\n"
                        "Examples:\n"
                        "  artus hands face webcam -k hands.toml\n"
                        "  artus hands face left.mp4 middle.mp4 right.mp4 -k hands.toml");
  add_picture_options(command, *touch, "webcam, or three files, one for each phase");
  on_run(command, code, [touch] { return face(*touch); });
}

}  // namespace artus
