// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/echo_phantom.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "artus/detail/core/check.h"
#include "artus/detail/core/known_names.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kWidth = 160e-3;   // m, along x
constexpr double kBreadth = 60e-3;  // m, along y
constexpr double kDepth = 120e-3;   // m: below the deepest usual image
constexpr double kNeperPerMetre = 100 / kDecibelPerNeper;
constexpr double kWire = 0.1;         // echo of a wire on the axis: 20 dB over the speckle
constexpr double kCystRadius = 4e-3;  // m
constexpr double kCystDepth = 20e-3;  // m

double displayed_mm(double depth, double speed) {
  return depth * kDisplaySpeedOfSound / speed / kMillimetre;
}

EchoPhantom make_homogeneous() {
  EchoPhantom phantom;
  phantom.title = "homogeneous block: speckle statistics, attenuation slope";
  const std::array<FlatLayer, 1> block{{{"tissue_mimic", kDepth}}};
  phantom.scene = make_block_scene(block);
  phantom.truth = {{"speed_of_sound_m_s", 1540},
                   {"attenuation_db_cm_mhz", 0.5},
                   {"envelope_mean_over_sd", 1.913},
                   {"sd_of_decibel_image", 5.57}};
  return phantom;
}

EchoPhantom make_points() {
  EchoPhantom phantom;
  phantom.title = "point targets: resolution along, across and beside the plane";
  const std::array<FlatLayer, 1> block{{{"tissue_mimic", kDepth}}};
  phantom.scene = make_block_scene(block, silence);
  auto points = nlohmann::json::array();
  const auto add = [&](double x, double y, double z) {
    phantom.reflectors.push_back({Vec3(x, y, z), kWire});
    points.push_back({x / kMillimetre, y / kMillimetre, z / kMillimetre});
  };
  for (int mm = 5; mm <= 115; mm += 5) add(0, 0, mm * kMillimetre);
  for (int mm = -15; mm <= 15; mm += 5)
    if (mm != 0) add(mm * kMillimetre, 0, 20e-3);
  for (int k = 1; k <= 4; ++k) {  // ever farther from the plane: the slice's thickness
    add(-10e-3 + 2.5e-3 * k, 0.5e-3 * k, 30e-3);
  }
  phantom.truth = {{"points_mm", points}, {"amplitude_db", 20 * std::log10(kWire)}};
  return phantom;
}

EchoPhantom make_cyst() {
  EchoPhantom phantom;
  phantom.title = "ball of fluid: black lumen, enhancement below, edge shadows, slice thickness";
  auto body = std::make_shared<CompiledJoint>(make_block_with_sphere(
      make_phantom_tissues(), {"tissue_mimic", Vec3(kWidth, kBreadth, kDepth), Vec3::Zero(),
                               "fluid", Vec3(0, 0, kCystDepth), kCystRadius, 5}));
  phantom.truth = {{"centre_mm", {0, 0, kCystDepth / kMillimetre}},
                   {"radius_mm", kCystRadius / kMillimetre},
                   {"enhancement_db_per_mhz_on_axis", 2 * 0.5 * 2 * kCystRadius * 100}};
  phantom.scene = std::make_shared<const Scene>(body);
  return phantom;
}

EchoPhantom make_layers() {
  EchoPhantom phantom;
  phantom.title =
      "skin, fat, muscle, bursa, tendon, bone: levels and displayed depths of interfaces";
  const std::array<FlatLayer, 6> layers{{{"skin", 1.8e-3},
                                         {"fat", 6e-3},
                                         {"muscle", 12e-3},
                                         {"bursa", 1.2e-3},
                                         {"tendon", 5e-3},
                                         {"bone", kDepth}}};
  phantom.scene = make_block_scene(layers, [](CompiledJoint& joint) {
    for (Region& region : joint.regions) {
      const TissueKind kind = joint.tissues[region.tissue].acoustic.kind;
      if (kind == TissueKind::muscle || kind == TissueKind::tendon)
        region.fibre_axis = Vec3::UnitX();
    }
  });
  const CompiledJoint& joint = phantom.scene->joint();
  auto list = nlohmann::json::array();
  double depth = 0;
  double shown = 0;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const auto region = static_cast<RegionId>(kFirstRegion + i);
    const Acoustic& here = joint.tissue_of(region).acoustic;
    const double above =
        i == 0 ? 1.49e6 : joint.tissue_of(static_cast<RegionId>(region - 1)).acoustic.impedance();
    const double step = (here.impedance() - above) / (here.impedance() + above);
    list.push_back({{"tissue", layers[i].tissue},
                    {"top_mm", depth / kMillimetre},
                    {"displayed_top_mm", shown},
                    {"reflection_db", 20 * std::log10(std::abs(step))}});
    depth += layers[i].thickness;
    shown += displayed_mm(layers[i].thickness, here.speed_of_sound);
  }
  phantom.truth = {{"layers", list}};
  return phantom;
}

Result<EchoPhantom> make_needle(const PhantomOptions& options) {
  if (!(std::abs(options.needle_angle) <= 85 * kDegree))
    return fail(ErrorCode::invalid, "the needle's angle to the face must be within 85 degrees",
                "--needle-angle");
  if (!(options.needle_depth >= 1e-3 && options.needle_depth <= 100e-3))
    return fail(ErrorCode::invalid, "the needle's depth must be 1 to 100 mm", "--needle-depth");
  EchoPhantom phantom;
  phantom.title = "needle in a homogeneous block: brightness by angle, rings, shadow, tip";
  const std::array<FlatLayer, 1> block{{{"tissue_mimic", kDepth}}};
  phantom.scene = make_block_scene(block);
  const double angle = options.needle_angle;
  const Vec3 ahead = 8e-3 * Vec3(std::cos(angle), 0, std::sin(angle));
  phantom.needle = needle_in_plane(phantom.X_JP, Vec3(0, 0, options.needle_depth) + ahead, angle,
                                   options.needle);
  phantom.truth = {{"outer_diameter_mm", options.needle.outer_diameter / kMillimetre},
                   {"bore_mm", options.needle.bore / kMillimetre},
                   {"echogenic", options.needle.echogenic},
                   {"ring_pitch_mm", reverberation_pitch(options.needle) / kMillimetre}};
  return phantom;
}

using Maker = Result<EchoPhantom> (*)(const PhantomOptions&);

constexpr std::array<std::string_view, 5> kPhantomNames{"homogeneous", "points", "cyst", "layers",
                                                        "needle"};
constexpr std::array<Maker, kPhantomNames.size()> kMakers{
    [](const PhantomOptions&) -> Result<EchoPhantom> { return make_homogeneous(); },
    [](const PhantomOptions&) -> Result<EchoPhantom> { return make_points(); },
    [](const PhantomOptions&) -> Result<EchoPhantom> { return make_cyst(); },
    [](const PhantomOptions&) -> Result<EchoPhantom> { return make_layers(); }, make_needle};

}  // namespace

std::span<const std::string_view> echo_phantoms() noexcept {
  return kPhantomNames;
}

Result<EchoPhantom> make_echo_phantom(std::string_view name, const PhantomOptions& options) {
  const auto at = find_name(kPhantomNames, name, "phantom");
  ARTUS_TRY(at);
  Result<EchoPhantom> phantom = kMakers.at(*at)(options);
  if (phantom) phantom->name = name;
  return phantom;
}

std::vector<Tissue> make_phantom_tissues() {
  auto tissues = read_bundled_tissues();
  ARTUS_REQUIRE(tissues.has_value(), "the bundled tissue library cannot be read");
  Tissue mimic;
  mimic.name = "tissue_mimic";
  mimic.acoustic = {kDisplaySpeedOfSound, 1040, 0.5 * kNeperPerMetre, 1, 1, 0.5};
  mimic.source["acoustic"] = "assumed: as usual quality-assurance phantoms";
  tissues->push_back(mimic);
  return *tissues;
}

std::shared_ptr<const Scene> make_block_scene(std::span<const FlatLayer> layers,
                                              const std::function<void(CompiledJoint&)>& change) {
  auto joint = std::make_shared<CompiledJoint>(
      make_layered_block(make_phantom_tissues(), layers, kWidth, kBreadth));
  if (change) change(*joint);
  return std::make_shared<const Scene>(joint);
}

Acoustic& acoustic_of(CompiledJoint& joint, std::string_view tissue) {
  const auto found = std::find_if(joint.tissues.begin(), joint.tissues.end(),
                                  [&](const Tissue& t) { return t.name == tissue; });
  ARTUS_REQUIRE(found != joint.tissues.end(), "no such tissue: " + std::string(tissue));
  return found->acoustic;
}

void silence(CompiledJoint& joint) {
  for (Tissue& tissue : joint.tissues) {
    tissue.acoustic.attenuation = 0;
    tissue.acoustic.backscatter = 0;
  }
}

std::shared_ptr<const Scene> make_clear_block() {
  const std::array<FlatLayer, 1> layers{{{"tissue_mimic", 60e-3}}};
  return make_block_scene(layers, silence);
}

NeedleView needle_in_plane(const Pose& X_JP, const Vec3& tip_P, double angle,
                           const NeedleShape& shape) {
  const Vec3 along(std::cos(angle), 0, std::sin(angle));
  return {X_JP * make_pose(tip_P, along, Vec3::UnitY()), shape};
}

}  // namespace artus
