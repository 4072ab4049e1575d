// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/dataset/sweep_frame.h"

#include <optional>

#include "artus/detail/core/units.h"
#include "artus/detail/dataset/echo_truth.h"
#include "artus/detail/echo/display/shown_places.h"
#include "artus/detail/echo/probe/pressing_face.h"
#include "artus/detail/raycast/pressed_scene.h"
#include "artus/echo/image_io.h"
#include "artus/echo/labels.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

nlohmann::json identity_of(const CompiledJoint& joint) {
  return {{"name", joint.name}, {"digest", joint.source_digest}};
}

nlohmann::json to_json(const NeedleShape& shape) {
  return {{"outer_diameter_mm", shape.outer_diameter / kMillimetre},
          {"bore_mm", shape.bore / kMillimetre},
          {"length_mm", shape.length / kMillimetre},
          {"echogenic", shape.echogenic}};
}

/// Truth of the needle: in the picture, and in the joint as lists of poses have it.
nlohmann::json needle_truth(const NeedleView& needle, const NeedleTruth& truth,
                            const std::optional<PixelPoint>& tip_shown, const Scene& scene) {
  nlohmann::json out = to_json(truth, tip_shown);
  const auto triple = [](const Vec3& p) {
    return nlohmann::json{p.x() / kMillimetre, p.y() / kMillimetre, p.z() / kMillimetre};
  };
  const Vec3 tip = needle.X_JN.translation();
  const RegionId region = scene.region_at(tip);
  out["tip_region"] = scene.joint().regions[region].name;
  out["tip_tissue"] = scene.joint().tissue_of(region).name;
  out["tip_mm"] = triple(tip);
  out["entry_mm"] = triple(tip - needle.shape.length * needle.X_JN.linear().col(2));
  out.update(to_json(needle.shape));
  return out;
}

}  // namespace

std::string ending_of(std::string_view key, char separator) {
  if (key == kPictureKeys[0]) return ".png";
  return separator + std::string(key) + ".png";
}

Result<void> check_sweep(const SweepOptions& options, const std::string& where) {
  if (options.settings.persistence != 0)
    return fail(ErrorCode::invalid, "a sweep needs persistence = 0", where);
  if (options.rf) ARTUS_TRY(check_single_lines(options.settings));
  return {};
}

nlohmann::json describe_sweep(const CompiledJoint& joint, const SweepOptions& options) {
  nlohmann::json out{{"joint", identity_of(joint)},
                     {"transducer", to_json(options.transducer)},
                     {"settings", to_json(options.settings)},
                     {"needle", to_json(options.needle)},
                     {"truth", kSweepTruthNames[static_cast<std::size_t>(options.truth)]}};
  if (options.rf) out["rf"] = options.rf->ending;
  for (const auto& patient : options.patients)
    out["patients"].push_back(identity_of(patient->joint()));
  for (const TransducerPreset& preset : options.transducers)
    out["transducers"].push_back({{"name", preset.name}, {"values", to_json(preset.transducer)}});
  return out;
}

/// A probe's tables and one body's.
struct SweepDrawer::Scanner {
  Scanner(std::shared_ptr<const Scene> body, const Transducer& transducer,
          const ImageSettings& settings)
      : scene(std::move(body)),
        renderer(scene, transducer, settings),
        truth(transducer, settings) {}
  std::shared_ptr<const Scene> scene;
  Renderer renderer;
  LabelRenderer truth;
};

SweepDrawer::SweepDrawer(std::shared_ptr<const Scene> scene, const SweepOptions& options)
    : scene_(std::move(scene)), options_(options) {}
SweepDrawer::~SweepDrawer() = default;

SweepDrawer::Scanner& SweepDrawer::scanner(const FrameOrder& order) {
  auto& place = scanners_[{order.patient, order.transducer}];
  if (!place) {
    const Transducer& transducer = order.transducer == 0
                                       ? options_.transducer
                                       : options_.transducers[order.transducer - 1].transducer;
    place = std::make_unique<Scanner>(
        order.patient == 0 ? scene_ : options_.patients[order.patient - 1], transducer,
        options_.settings);
  }
  return *place;
}

nlohmann::json SweepDrawer::press(const FrameOrder& order, Pose& X_JP) {
  const Scanner& at_rest = scanner(order);
  const auto face = pressing_face(at_rest.renderer.transducer());
  if (!face) return nullptr;  // curved
  const auto pressed =
      press_scene(at_rest.scene->shared_joint(), order.X_JP, {order.press, {}}, *face);
  if (!pressed) return nullptr;  // no skin below the probe
  pressed_ =
      std::make_unique<Scanner>(pressed->scene, at_rest.renderer.transducer(), options_.settings);
  X_JP = pressed->press.X_JP;
  return {{"depth_mm", pressed->press.depth / kMillimetre},
          {"force_n", pressed->press.normal_force},
          {"settled", pressed->press.settled}};
}

SweepFrame SweepDrawer::draw(std::size_t index, const FrameOrder& order) {
  SweepFrame out;
  out.truth["index"] = index;
  Pose X_JP = order.X_JP;
  pressed_.reset();
  if (order.press > 0) out.truth["press"] = press(order, X_JP);
  Scanner& scanner = pressed_ ? *pressed_ : this->scanner(order);
  std::optional<NeedleView> needle;
  if (order.X_JN) needle = NeedleView{*order.X_JN, order.needle.value_or(options_.needle)};
  const Frame& frame = scanner.renderer.render(X_JP, needle);
  const CompiledJoint& joint = scanner.scene->joint();
  out.pictures = {{"image", grey_image(frame)}};
  if (options_.rf)
    if (auto lines =
            make_rf_lines(frame, scanner.renderer.transducer(), scanner.renderer.settings()))
      out.rf = std::move(*lines);
  const ShownPlaces places = scanner.renderer.shown_places(X_JP);
  const auto add = [&](const std::string& kind, const LabelImage& labels,
                       const ShownPlaces* shown_at) {
    out.pictures.emplace_back("labels_" + kind, id_image(labels));
    out.pictures.emplace_back("shadow_" + kind,
                              shadow_mask(frame, scanner.truth.converter(), shown_at));
    out.pictures.emplace_back("needle_" + kind, needle_mask(labels));
    if (!out.truth.contains("regions")) out.truth["regions"] = region_list(labels, joint);
  };
  if (options_.truth != SweepTruth::real)
    add("shown", scanner.truth.render_shown(places, X_JP, needle), nullptr);
  if (options_.truth != SweepTruth::shown)
    add("true", scanner.truth.render(*scanner.scene, X_JP, needle), &places);
  out.truth["probe"] = probe_json(X_JP);
  out.truth["pixel_mm"] = frame.pixel / kMillimetre;
  out.truth["contact"] = contact_json(frame);
  if (!options_.patients.empty()) out.truth["joint"] = joint.name;
  if (order.transducer > 0)
    out.truth["transducer"] = options_.transducers[order.transducer - 1].name;
  if (!order.name.empty()) out.truth["name"] = order.name;
  if (order.time) out.truth["time_s"] = *order.time;
  if (needle)
    out.truth["needle"] =
        needle_truth(*needle, scanner.truth.locate(*needle, X_JP), frame.tip_shown, *scanner.scene);
  return out;
}

}  // namespace artus
