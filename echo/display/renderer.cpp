// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/echo/renderer.h"

#include <cmath>
#include <utility>

#include "artus/detail/core/check.h"
#include "artus/detail/core/rigid.h"
#include "artus/detail/echo/display/echo_pipeline.h"
#include "artus/detail/echo/display/shown_places.h"

namespace artus {
namespace {

constexpr double kFarthest = 1000;  // m from the joint, beyond which a pose is a mistake
constexpr double kFinest = 0.1e-3;  // m, of a settling suspension's upper side
constexpr double kSizes = 0.3;      // by which its grains' speeds differ. assumed

bool is_usable(const Pose& pose) noexcept {
  return is_rigid(pose) && pose.translation().norm() <= kFarthest;
}

bool is_usable(const NeedleView& needle) noexcept {
  const NeedleShape& shape = needle.shape;
  return is_usable(needle.X_JN) && needle.v_JN.allFinite() && shape.outer_diameter > 0 &&
         shape.bore >= 0 && shape.length >= 0 &&
         std::isfinite(shape.outer_diameter + shape.bore + shape.length);
}

/// The regions of `joint` as the probe meets them, with the fibres' courses of `known`, which are
/// those of the same body.
std::vector<RegionAcoustics> with_courses_of(const std::vector<RegionAcoustics>& known,
                                             const CompiledJoint& joint,
                                             const Transducer& transducer) {
  std::vector<RegionAcoustics> regions = make_region_acoustics(joint, transducer);
  for (std::size_t i = 0; i < regions.size() && i < known.size(); ++i) {
    regions[i].course = known[i].course;
    regions[i].vessel = known[i].vessel;
    regions[i].continues_as = known[i].continues_as;
    regions[i].junction = known[i].junction;
  }
  return regions;
}

}  // namespace

struct Renderer::Impl {
  EchoBody body;
  std::vector<float> contact;  // as set, for the next pipeline
  std::unique_ptr<EchoPipeline> pipeline;

  Settling settling;
  std::shared_ptr<const CompiledJoint> levelled;  // whose levels these are; null: none are known
  ClearLevels levels;

  void take(std::shared_ptr<const Scene> scene) {
    body.scene = std::move(scene);
    body.tissue.reset();
    if (body.scene->tissue() != nullptr) body.tissue.emplace(body.scene->tissue());
  }
  void find_regions() {
    const CompiledJoint& joint = body.scene->joint();
    body.regions = make_region_acoustics(joint, pipeline->transducer());
    pipeline->workers().execute([&] { add_courses(joint, body.regions); });
    settle();
  }
  void settle() {
    if (settling.fallen > 0 && levelled != body.scene->shared_joint()) {
      levelled = body.scene->shared_joint();
      levels = ClearLevels(*levelled, settling.up_J);
    }
    for (std::size_t r = 0; r < body.regions.size(); ++r) {
      RegionAcoustics& region = body.regions[r];
      region.clear_above = levels.height(static_cast<RegionId>(r), settling.fallen);
      region.clear_blur = kFinest + kSizes * settling.fallen;
      region.up_J = settling.up_J;
    }
  }
};

Renderer::Renderer(std::shared_ptr<const Scene> scene, std::unique_ptr<EchoPipeline> pipeline)
    : impl_(std::make_unique<Impl>()) {
  ARTUS_REQUIRE(scene != nullptr && pipeline != nullptr, "no scene, or no pipeline");
  impl_->take(std::move(scene));
  impl_->pipeline = std::move(pipeline);
  impl_->find_regions();
}

Renderer::Renderer(std::shared_ptr<const Scene> scene, const Transducer& transducer,
                   const ImageSettings& settings)
    : Renderer(std::move(scene), std::make_unique<EchoPipeline>(transducer, settings)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const Frame& Renderer::render(const Pose& X_JP, const std::optional<NeedleView>& needle) {
  EchoPipeline& pipeline = *impl_->pipeline;
  const bool bad_needle = needle && !is_usable(*needle);
  const std::uint32_t status = bad_needle ? FrameStatus::kBadNeedle : FrameStatus::kOk;
  if (is_usable(X_JP)) {
    pipeline.render(impl_->body, X_JP, bad_needle ? std::nullopt : needle);
    pipeline.set_status(status);
  } else {
    pipeline.render_nothing(status | FrameStatus::kBadProbe);
  }
  return pipeline.frame();
}

ShownPlaces Renderer::shown_places(const Pose& X_JP) const {
  const EchoBody& body = impl_->body;
  return {*body.scene,
          body.tissue ? &*body.tissue : nullptr,
          body.regions,
          impl_->pipeline->transducer(),
          impl_->pipeline->settings(),
          X_JP};
}

void Renderer::set_contact(std::span<const float> coverage) {
  impl_->contact.assign(coverage.begin(), coverage.end());
  impl_->pipeline->set_contact(coverage);
}

void Renderer::set_point_reflectors(std::vector<PointReflector> reflectors) {
  for (const PointReflector& reflector : reflectors) {
    ARTUS_REQUIRE(reflector.p_J.allFinite() && std::isfinite(reflector.amplitude),
                  "a point reflector is not finite");
  }
  impl_->body.reflectors = std::move(reflectors);
}

void Renderer::set_drifting_points(std::span<const DriftingPoint> points) {
  for (const DriftingPoint& point : points) {
    ARTUS_REQUIRE(point.p_J.allFinite() && point.v_J.allFinite() &&
                      std::isfinite(point.amplitude + point.tail + point.phase),
                  "a drifting point is not finite");
  }
  impl_->body.drifting.assign(points.begin(), points.end());
}

void Renderer::set_flow_time(std::optional<double> time) {
  ARTUS_REQUIRE(!time || std::isfinite(*time), "the time is not finite");
  impl_->body.flow_time = time;
}

void Renderer::set_needle_tracks(std::vector<NeedleTrack> tracks) {
  for (const NeedleTrack& track : tracks) {
    ARTUS_REQUIRE(
        track.p_JEntry.allFinite() && track.p_JTip.allFinite() && std::isfinite(track.amplitude),
        "a needle track is not finite");
  }
  impl_->body.tracks = std::move(tracks);
}

void Renderer::set_live(const LiveSettings& live) {
  impl_->pipeline->set_live(live);
}

void Renderer::set_pipeline(std::unique_ptr<EchoPipeline> pipeline) {
  ARTUS_REQUIRE(pipeline != nullptr, "no pipeline");
  EchoBody& body = impl_->body;
  body.regions = with_courses_of(body.regions, body.scene->joint(), pipeline->transducer());
  impl_->settle();
  pipeline->set_contact(impl_->contact);
  impl_->pipeline = std::move(pipeline);
}

void Renderer::set_scene(std::shared_ptr<const Scene> scene) {
  ARTUS_REQUIRE(scene != nullptr, "no scene");
  const bool same_body = impl_->body.scene->shared_joint() == scene->shared_joint();
  impl_->take(std::move(scene));
  if (!same_body) impl_->find_regions();
}

void Renderer::set_filled_scene(std::shared_ptr<const Scene> scene) {
  ARTUS_REQUIRE(scene != nullptr, "no scene");
  EchoBody& body = impl_->body;
  const bool same_joint = body.scene->shared_joint() == scene->shared_joint();
  impl_->take(std::move(scene));
  if (same_joint) return;
  body.regions = with_courses_of(body.regions, body.scene->joint(), impl_->pipeline->transducer());
  impl_->settle();
}

void Renderer::set_settling(const Settling& settling) {
  ARTUS_REQUIRE(settling.up_J.allFinite() && std::isfinite(settling.fallen),
                "how far it settled is not finite");
  if (settling.up_J != impl_->settling.up_J) impl_->levelled = nullptr;
  impl_->settling = settling;
  impl_->settle();
}

const Transducer& Renderer::transducer() const noexcept {
  return impl_->pipeline->transducer();
}
const ImageSettings& Renderer::settings() const noexcept {
  return impl_->pipeline->settings();
}
const ScanConverter& Renderer::converter() const noexcept {
  return impl_->pipeline->converter();
}
const StageTimes& Renderer::stage_times() const noexcept {
  return impl_->pipeline->stage_times();
}

Frame render_bmode(const std::shared_ptr<const Scene>& scene, const Pose& X_JP,
                   const std::optional<NeedleView>& needle, const Transducer& transducer,
                   const ImageSettings& settings) {
  Renderer renderer(scene, transducer, settings);
  return renderer.render(X_JP, needle);
}

Pose probe_in_joint(const Pose& X_WJ, const Pose& X_WP) {
  constexpr double kUnit = 1e9;  // steps per metre, and per unit of a rotation's entries
  Pose X_JP = X_WJ.inverse() * X_WP;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) X_JP(i, j) = std::round(X_JP(i, j) * kUnit) / kUnit;
  }
  return X_JP;
}

}  // namespace artus
