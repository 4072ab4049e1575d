// SPDX-License-Identifier: AGPL-3.0-or-later
// What a picture shows of injected liquid, on flat layers and without texture, so that what is seen
// of fibres is the liquid's doing.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/acquire/liquid_plume.h"
#include "artus/detail/echo/display/clear_level.h"
#include "artus/detail/echo/display/frame_measure.h"
#include "artus/detail/soft/liquid/injected_body.h"
#include "artus/echo/labels.h"
#include "artus/echo/renderer.h"
#include "tests/support/layered_body.h"
#include "tests/support/meshed_block.h"

namespace artus {
namespace {

constexpr double kDepth = 30e-3;     // m of the pictures
constexpr double kAlpha = 0.7;       // dB/cm/MHz of tissue
constexpr double kDecibel = 8.6859;  // per neper

/// 80 mm x 60 mm of tissue that all loses as much and reflects nothing but by its grains.
CompiledJoint make_body(const std::vector<FlatLayer>& layers, const Vec3& fibres) {
  CompiledJoint joint = test::make_meshed_block(layers, 80e-3, 60e-3, 4e-3);
  for (Tissue& tissue : joint.tissues) {
    tissue.acoustic.speed_of_sound = 1540;
    tissue.acoustic.density = 1000;
    tissue.acoustic.attenuation = 100 * kAlpha / kDecibel;
    tissue.acoustic.attenuation_power = 1;
  }
  for (Region& region : joint.regions)
    if (region.name == "muscle" || region.name == "tendon") region.fibre_axis = fibres;
  return joint;
}

Liquid water() {
  Liquid liquid;
  liquid.name = "saline";
  liquid.tissue = "none";
  return liquid;
}

std::shared_ptr<const Scene> scene_of(CompiledJoint joint) {
  // A liquid of a name that no tissue has is water: it loses nothing and scatters nothing.
  for (Tissue& tissue : joint.tissues)
    if (tissue.name.starts_with("injected_")) {
      tissue.acoustic.speed_of_sound = 1540;
      tissue.acoustic.density = 1000;
      tissue.acoustic.attenuation = 0;
    }
  return std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(std::move(joint)));
}

CompiledJoint filled(const CompiledJoint& body, const std::string& region, double depth,
                     double volume) {
  const bool cavity = region == "bursa";
  return with_injected(body, {{region, volume, cavity, Vec3(0, 0, depth)}}, water());
}

ImageSettings plain_settings() {
  ImageSettings settings = bare_settings();
  settings.depth = kDepth;
  return settings;
}

Pose probe_over(double z) {
  return make_pose(Vec3(0, 0, z), Vec3::UnitZ(), Vec3::UnitX());
}

/// m^3 of the injected region, by rays half a millimetre apart.
double volume_by_rays(const Scene& scene) {
  double length = 0;
  for (double x = -39.7e-3; x < 40e-3; x += 0.5e-3)
    for (double y = -29.7e-3; y < 30e-3; y += 0.5e-3)
      for (const TissueInterval& s :
           tissue_intervals(scene, {Vec3(x, y, -20e-3), Vec3(x, y, 40e-3)}))
        if (scene.joint().regions[s.region].name == "injected") length += s.exit - s.entry;
  return length * 0.5e-3 * 0.5e-3;
}

/// Mean length, m, of the stretches of liquid along the rows or the columns of the truth.
double mean_stretch(const LabelImage& labels, RegionId liquid, bool along_rows) {
  const int rows = along_rows ? labels.height : labels.width;
  const int columns = along_rows ? labels.width : labels.height;
  int pixels = 0;
  int stretches = 0;
  for (int r = 0; r < rows; ++r) {
    bool before = false;
    for (int c = 0; c < columns; ++c) {
      const int at = along_rows ? r * labels.width + c : c * labels.width + r;
      const bool is = labels.regions[static_cast<std::size_t>(at)] == liquid;
      pixels += is ? 1 : 0;
      stretches += is && !before ? 1 : 0;
      before = is;
    }
  }
  return stretches > 0 ? labels.pixel * pixels / stretches : 0;
}

/// How alike grey values are that lie `lag` m apart along the rows or the columns, within a box
/// around the liquid: 1 the same, 0 nothing to do with each other.
double likeness(const Frame& frame, const LabelImage& labels, RegionId liquid, double lag,
                bool along_rows) {
  int left = labels.width;
  int right = 0;
  int top = labels.height;
  int bottom = 0;
  for (int y = 0; y < labels.height; ++y)
    for (int x = 0; x < labels.width; ++x)
      if (labels.regions[static_cast<std::size_t>(y * labels.width + x)] == liquid) {
        left = std::min(left, x);
        right = std::max(right, x);
        top = std::min(top, y);
        bottom = std::max(bottom, y);
      }
  const int shift = static_cast<int>(std::lround(lag / labels.pixel));
  std::vector<double> one;
  std::vector<double> other;
  for (int y = top; y + (along_rows ? 0 : shift) <= bottom; ++y)
    for (int x = left; x + (along_rows ? shift : 0) <= right; ++x) {
      const int far = along_rows ? y * frame.width + x + shift : (y + shift) * frame.width + x;
      one.push_back(frame.image[static_cast<std::size_t>(y * frame.width + x)]);
      other.push_back(frame.image[static_cast<std::size_t>(far)]);
    }
  return fit_line(one, other).correlation;
}

const std::vector<FlatLayer> kMuscleBody{
    {"skin", 2e-3}, {"fat", 3e-3}, {"muscle", 18e-3}, {"bone", 20e-3}};

TEST(InjectedPicture, MuscleHasStreaksAlongItsFibresThatHoldTheVolume) {
  const ImageSettings settings = plain_settings();
  std::array<double, 2> alike_along{};
  for (const bool turned : {false, true}) {
    const CompiledJoint body = make_body(kMuscleBody, turned ? Vec3::UnitY() : Vec3::UnitX());
    const CompiledJoint with = filled(body, "muscle", 14e-3, 1e-6);
    const auto scene = scene_of(with);
    EXPECT_NEAR(volume_by_rays(*scene), 1e-6, 0.05e-6);
    EXPECT_EQ(with.mesh.vertices, filled(body, "muscle", 14e-3, 1e-6).mesh.vertices);
    const auto liquid = static_cast<RegionId>(with.regions.size() - 1);
    EXPECT_EQ(scene->region_at(Vec3(0, 0, 14e-3)), liquid) << "where the tip is";
    Renderer renderer(scene, Transducer{}, settings);
    const Frame& frame = renderer.render(probe_over(0));
    const LabelImage labels = render_labels(*scene, probe_over(0), Transducer{}, settings);
    const double along = mean_stretch(labels, liquid, true);
    const double across = mean_stretch(labels, liquid, false);
    EXPECT_LT(across, 2e-3) << "no lake";
    EXPECT_GT(along, (turned ? 3 : 6) * across);
    if (turned) {
      EXPECT_LT(along, 10e-3) << "narrower beside the fibres";
    }
    alike_along[turned ? 1 : 0] = likeness(frame, labels, liquid, 4e-3, true);
    EXPECT_GT(likeness(frame, labels, liquid, 1e-3, true),
              likeness(frame, labels, liquid, 1e-3, false) + 0.4)
        << "dark, bright, dark from streak to streak";
  }
  EXPECT_GT(alike_along[0], 0.35);
  EXPECT_GT(alike_along[0], alike_along[1] + 0.1) << "along the fibres, wherever they run";
}

TEST(InjectedPicture, MoreLiquidOpensMoreStreaksAndNoneJumps) {
  const CompiledJoint body = make_body(kMuscleBody, Vec3::UnitX());
  double before = 0;
  std::size_t most = 0;
  for (const double volume : {0.05e-6, 0.14e-6, 0.15e-6, 0.3e-6, 0.301e-6, 1e-6, 4e-6}) {
    const RegionId muscle = region_named(body, "muscle");
    const auto boluses = make_boluses(body, muscle, Vec3(0, 0, 14e-3), volume);
    double sum = 0;
    double largest = 0;
    for (const Bolus& bolus : boluses) {
      sum += bolus.volume;
      largest = std::max(largest, bolus.volume);
    }
    EXPECT_NEAR(sum, volume, 1e-15);
    EXPECT_GE(boluses.size(), most);
    EXPECT_GE(largest, before);
    EXPECT_EQ(boluses.back().centre, Vec3(0, 0, 14e-3)) << "the tip's own";
    most = boluses.size();
    before = largest;
  }
  EXPECT_GT(most, 6U);
}

TEST(InjectedPicture, FibrilsStayBrightAcrossTheSplitInATendon) {
  const std::vector<FlatLayer> layers{
      {"skin", 2e-3}, {"fat", 5e-3}, {"tendon", 6e-3}, {"bone", 20e-3}};
  const CompiledJoint body = make_body(layers, Vec3::UnitX());
  const CompiledJoint with = filled(body, "tendon", 10e-3, 0.6e-6);
  const auto scene = scene_of(with);
  EXPECT_NEAR(volume_by_rays(*scene), 0.6e-6, 0.03e-6);
  const auto liquid = static_cast<RegionId>(with.regions.size() - 1);
  Renderer renderer(scene, Transducer{}, plain_settings());
  const Frame& frame = renderer.render(probe_over(0));
  // Along the middle lines: liquid, a strand of tendon, liquid.
  int strands = 0;
  double dark = 0;
  double bright = 0;
  int n_dark = 0;
  for (int line = frame.n_lines / 2 - 20; line < frame.n_lines / 2 + 20; ++line) {
    const double x = ((line + 0.5) / frame.n_lines - 0.5) * Transducer{}.width;
    const auto path = tissue_intervals(*scene, {Vec3(x, 0, 0), Vec3(x, 0, kDepth)});
    for (std::size_t k = 0; k < path.size(); ++k) {
      if (path[k].region == liquid && path[k].exit - path[k].entry > 0.6e-3) {
        const double middle = (path[k].entry + path[k].exit) / 2;
        dark += peak_value(frame, line, middle - 0.1e-3, middle + 0.1e-3);
        ++n_dark;
      }
      if (k == 0 || k + 1 == path.size() || path[k].region == liquid) continue;
      if (path[k - 1].region != liquid || path[k + 1].region != liquid) continue;
      EXPECT_EQ(with.regions[path[k].region].name, "tendon");
      EXPECT_LT(path[k].exit - path[k].entry, 1e-3) << "thin";
      bright += peak_value(frame, line, path[k].entry, path[k].exit);
      ++strands;
    }
  }
  ASSERT_GT(strands, 40);
  ASSERT_GT(n_dark, 40);
  EXPECT_GT(decibel(bright / strands) - decibel(dark / n_dark), 15);
}

TEST(InjectedPicture, ThePictureBehindIsBrighterByWhatTheLiquidDoesNotTake) {
  const std::vector<FlatLayer> layers{
      {"skin", 2e-3}, {"muscle", 8e-3}, {"bursa", 1e-3}, {"muscle", 30e-3}};
  const CompiledJoint body = make_body(layers, Vec3::Zero());
  const Transducer probe;
  const auto behind = [&](const std::shared_ptr<const Scene>& scene, double& liquid) {
    const auto path = tissue_intervals(*scene, {Vec3(1e-4, 2e-4, -20e-3), Vec3(1e-4, 2e-4, 35e-3)});
    double skin = 0;
    for (const TissueInterval& s : path) {
      const std::string& name = scene->joint().regions[s.region].name;
      if (name == "skin") skin = s.entry - 20e-3;
      if (name == "bursa") liquid = s.exit - s.entry;
    }
    Renderer renderer(scene, probe, plain_settings());
    const Frame& frame = renderer.render(probe_over(skin));
    double sum = 0;
    int n = 0;
    for (int line = frame.n_lines / 2 - 16; line < frame.n_lines / 2 + 16; ++line)
      for (const float e : envelope_line(frame, line)
                               .subspan(static_cast<std::size_t>(18e-3 / frame.sample_depth),
                                        static_cast<std::size_t>(9e-3 / frame.sample_depth))) {
        sum += static_cast<double>(e) * e;
        ++n;
      }
    return 10 * std::log10(sum / n);
  };
  double before = 0;
  double after = 0;
  CompiledJoint shut = filled(body, "bursa", 10.5e-3, 2e-9);  // a film of the same liquid
  const double dark = behind(scene_of(std::move(shut)), before);
  const double bright = behind(scene_of(filled(body, "bursa", 10.5e-3, 4e-6)), after);
  ASSERT_GT(after - before, 3e-3);
  const double megahertz = 1e-6 * probe.frequency;
  const double expected = 2 * kAlpha * megahertz * 100 * (after - before);
  EXPECT_NEAR(bright - dark, expected, 0.15 * expected);
}

/// Mean level, dB, of the liquid between two shares of its height, of a basin that lies so that up
/// is to the picture's left, `fallen` m after it was stirred.
double basin_level(const std::shared_ptr<const Scene>& scene, double fallen, double from,
                   double to) {
  ImageSettings settings = plain_settings();
  Renderer renderer(scene, Transducer{}, settings);
  renderer.set_settling({-Vec3::UnitX(), fallen});
  const Frame& frame = renderer.render(probe_over(0));
  double sum = 0;
  int n = 0;
  for (int line = 0; line < frame.n_lines; ++line) {
    const double share = (line + 0.5) / frame.n_lines;
    if (share < from || share > to) continue;
    for (const float e : envelope_line(frame, line)
                             .subspan(static_cast<std::size_t>(7e-3 / frame.sample_depth),
                                      static_cast<std::size_t>(6e-3 / frame.sample_depth))) {
      sum += static_cast<double>(e) * e;
      ++n;
    }
  }
  return 10 * std::log10(sum / n);
}

TEST(InjectedPicture, ASuspensionClearsFromAboveAtItsGrainsSpeedAndStaysGreyBelow) {
  // A basin as wide as the body, up along -x: what it clears from is its side at x = -40 mm.
  const std::vector<FlatLayer> layers{
      {"skin", 2e-3}, {"muscle", 3e-3}, {"bursa", 10e-3}, {"muscle", 10e-3}};
  CompiledJoint body = make_body(layers, Vec3::Zero());
  const Liquid suspension = *find_liquid(*read_bundled_liquids(), "steroid");
  for (Tissue& tissue : body.tissues)
    if (tissue.name == "bursa") {
      tissue.name = "injected_steroid";
      tissue.acoustic.backscatter = suspension.backscatter;
    }
  const auto scene = scene_of(std::move(body));
  const ClearLevels levels(scene->joint(), -Vec3::UnitX());
  const RegionId basin = region_named(scene->joint(), "bursa");
  EXPECT_TRUE(std::isinf(levels.height(basin, 0)));
  for (const double fallen : {1e-3, 20e-3, 60e-3})
    EXPECT_NEAR(levels.height(basin, fallen), 40e-3 - fallen, 0.3e-3) << "upright walls: no faster";

  // Leaning by 45 degrees its long wall sheds clear liquid, which gathers in the upper corner:
  // roofs of 80 and 10 mm by 60 mm give 3818 mm^3 a millimetre, which there reach 8.03 mm down.
  const Vec3 leaning = Vec3(-1, 0, -1).normalized();
  EXPECT_NEAR(ClearLevels(scene->joint(), leaning).height(basin, 1e-3),
              35e-3 / std::numbers::sqrt2 - 8.03e-3, 0.1e-3);

  // How long it takes is told by the grains: 5 um in 3 mPa s.
  LiquidPlume plume(suspension);
  PlumeSource source;
  source.p_J = Vec3(0, 0, 10e-3);
  source.given = 1e-6;
  plume.step(*scene, source, -Vec3::UnitX(), 0.1);
  EXPECT_EQ(plume.fallen(), 0) << "it flows";
  for (int k = 0; k < 600; ++k) plume.step(*scene, source, -Vec3::UnitX(), 0.1);
  const double speed = 2.0 / 9 * (1320 - 1020) * 9.81 * 25e-12 / 3e-3;
  EXPECT_NEAR(plume.fallen(), 60 * speed, 1e-3 * 60 * speed);

  // The probe sees x from -19 to 19 mm.
  const double cloud = basin_level(scene, 0, 0.02, 0.2);
  EXPECT_NEAR(cloud, basin_level(scene, 0, 0.5, 0.98), 2);
  EXPECT_LT(basin_level(scene, 40e-3, 0.02, 0.2), cloud - 20) << "clear above";
  EXPECT_NEAR(basin_level(scene, 25e-3, 0.7, 0.98), cloud, 2) << "grey below";
}

}  // namespace
}  // namespace artus
