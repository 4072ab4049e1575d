// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/image_core.h"

#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "artus/detail/echo/display/motion_picture.h"
#include "artus/detail/echo/probe/pressing_face.h"
#include "artus/detail/haptics/plunger/bevel.h"

namespace artus {
namespace {

/// s that new tables may take; see bench_echo for how long they do.
constexpr double kTableTime = 0.3;

Liquid liquid_of(const SessionParams& params) {
  auto made = make_plunger_params(params.syringe, needle_length_of(params));
  ARTUS_REQUIRE(made.has_value(), "the parameters must be valid");
  return std::move(made->liquid);
}

}  // namespace

ImageCore::ImageCore(std::shared_ptr<const Scene> scene, const SessionParams& params,
                     std::size_t extra_scene_holders, const std::optional<Pose>& X_JP,
                     const PreparedBody& prepared)
    : probe_(params.transducer),
      image_(params.image),
      needle_shape_(params.needle_shape),
      controls_(controls_of(params)),
      rest_(scene),
      drawn_(scene),
      shapes_(scene->shared_joint(), liquid_of(params), params.image_rate, prepared.spaces),
      fluid_(MovingScene::kGoingRound + extra_scene_holders),
      plume_(liquid_of(params)),
      image_time_(1 / params.image_rate),
      images_to_change_(static_cast<std::uint64_t>(std::ceil(kTableTime * params.image_rate))) {
  needle_shape_.length = needle_length_of(params);
  if (!params.deform) return;
  const auto make_tissue = [&]() -> Result<TissueCore> {
    const auto face = pressing_face(params.transducer);
    ARTUS_TRY(face);
    const Pose X_JC = X_JP.value_or(scene->joint().X_JP_default);
    if (prepared.tissue && prepared.tissue->cage_pose().matrix() == X_JC.matrix())
      return TissueCore::make_beside(*prepared.tissue, params.image_rate, *face,
                                     params.wait_for_cage, extra_scene_holders);
    return TissueCore::make(scene->shared_joint(), X_JC, params.image_rate, *face,
                            params.wait_for_cage, extra_scene_holders);
  };
  auto tissue = make_tissue();
  if (tissue)
    tissue_.emplace(std::move(*tissue));
  else
    refusal_ = tissue.error().message;
}

ImagedBody ImageCore::advance(const FrameInput& input) {
  const std::span<const InjectedSite> sites(std::begin(input.sites), input.n_sites);
  const FluidState fluid = shapes_.step(sites);
  if (!tissue_) {
    shapes_.follow(sites, nullptr);
    return {input.number, rest_, {}, fluid};
  }
  std::optional<Pose> X_JP;
  if (input.has_probe != 0) X_JP = to_pose(input.X_JP);
  std::optional<NeedleGrip> needle;
  if (input.has_needle != 0) needle = NeedleGrip{to_pose(input.X_JN), input.load};
  tissue_->step(X_JP, needle, fluid.rest_of());
  shapes_.follow(sites, tissue_->tissue());
  TissuePacket packet = tissue_->packet();
  packet.probe.tick = input.tick;
  return {input.number, tissue_->scene(), packet, fluid};
}

/// What is drawn: the body with what was injected.
void ImageCore::update_scene(const FrameInput& input, const ImagedBody& body) {
  if (!body.fluid.shape) fluid_.prepare(*body.scene);
  const auto& filled = fluid_.at(body.fluid, body.scene->tissue());
  drawn_ = filled ? filled : body.scene;
  drawn_liquid_ = body.fluid.liquid();
  if (filled || filled_)
    renderer_->set_filled_scene(drawn_);
  else if (tissue_)
    renderer_->set_scene(drawn_);
  update_particles(input, filled.get());
  filled_ = filled != nullptr;
}

void ImageCore::update_particles(const FrameInput& input, const Scene* filled) {
  constexpr double kLongest = 0.5;  // s; images further apart are not of one course
  if (filled == nullptr) {
    if (filled_) plume_.clear();
    if (filled_) renderer_->set_drifting_points({});
    if (filled_) renderer_->set_settling({});
    return;
  }
  const double since = 1e-9 * static_cast<double>(input.sample_time_ns - before_.sample_time_ns);
  std::optional<PlumeSource> source;
  if (input.has_needle != 0) {
    const Pose X_JN = to_pose(input.X_JN);
    const Vec3 axis = X_JN.linear().col(2);
    source = {X_JN.translation() - bevel_middle(needle_shape_.outer_diameter) * axis, axis,
              needle_shape_.bore, 0};
    for (std::uint32_t k = 0; k < input.n_sites; ++k) source->given += input.sites[k].volume;
  }
  plume_.step(*filled, source, Vec3::UnitZ(), since > 0 && since < kLongest ? since : image_time_);
  renderer_->set_drifting_points(plume_.points());
  renderer_->set_settling({Vec3::UnitZ(), plume_.fallen()});
}

void ImageCore::follow(const ImageControls& controls) {
  controls_ = controls;
  Transducer probe = probe_;
  ImageSettings image = image_;
  image.depth = controls.depth;
  image.gain_db = controls.gain_db;
  image.tgc_db_cm_mhz = controls.tgc_db_cm_mhz;
  image.dynamic_range_db = controls.dynamic_range_db;
  probe.frequency = controls.frequency;
  probe.elevation_focus = controls.elevation_focus;
  image.persistence = controls.persistence;
  image.grey_curve = controls.grey_curve;
  image.look = controls.look;
  image.compound_angles = probe.radius == 0 ? static_cast<int>(controls.compound_angles) : 1;
  image.doppler = image.doppler || controls.motion != MotionShown::none;
  if (!validate(probe) || !validate(image)) return;
  probe_ = probe;
  image_ = image;
  renderer_->set_live(image_);
}

void ImageCore::take_tables() {
  renderer_->set_pipeline(next_.get());
  renderer_->set_live(image_);
}

void ImageCore::start_tables() {
  due_ = images_ + images_to_change_;
  next_ = std::async(std::launch::async, [probe = probe_, image = image_] {
    return std::make_unique<EchoPipeline>(probe, image);
  });
}

const Frame& ImageCore::render(const FrameInput& input, const ImagedBody& body) {
  if (!renderer_) renderer_.emplace(rest_, probe_, image_);
  update_scene(input, body);
  ++images_;
  if (!(input.controls == controls_)) follow(input.controls);
  if (next_.valid() && images_ == due_) take_tables();
  const TableSettings& tables = image_;
  const bool shown = tables == renderer_->settings() && probe_ == renderer_->transducer();
  if (!shown && !next_.valid()) start_tables();
  std::optional<NeedleView> needle;
  if (input.has_needle != 0)
    needle = NeedleView{to_pose(input.X_JN), needle_shape_, velocity_of_needle(input)};
  before_ = input;
  const bool colours = controls_.motion != MotionShown::none;
  renderer_->set_flow_time(colours ? std::optional(1e-9 * static_cast<double>(input.sample_time_ns))
                                   : std::nullopt);
  frame_ = &renderer_->render(to_pose(input.X_JP), needle);
  return *frame_;
}

Vec3 ImageCore::velocity_of_needle(const FrameInput& input) const noexcept {
  constexpr std::int64_t kLongest = 500'000'000;  // ns; images further apart tell of no speed
  const std::int64_t dt = input.sample_time_ns - before_.sample_time_ns;
  if (input.controls.motion == MotionShown::none || before_.has_needle == 0 || dt <= 0 ||
      dt > kLongest)
    return Vec3::Zero();
  const Vec3 direction = to_pose(input.X_JN).translation() - to_pose(before_.X_JN).translation();
  return direction / (1e-9 * static_cast<double>(dt));
}

std::vector<std::uint8_t> ImageCore::motion() const {
  if (controls_.motion == MotionShown::none || frame_ == nullptr || frame_->velocity.empty())
    return {};
  return motion_picture(*frame_, renderer_->converter(), renderer_->settings(), controls_.motion);
}

}  // namespace artus
