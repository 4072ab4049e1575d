// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/echo/echo_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>

#include <opencv2/imgproc.hpp>

#include "artus/detail/core/check.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/echo/display/frame_measure.h"
#include "artus/detail/evidence/runs/echo_phantom.h"
#include "artus/detail/evidence/validation/echo/echo_muscle_view.h"
#include "artus/echo/image_io.h"
#include "artus/echo/renderer.h"
#include "artus/echo/transducer_file.h"

namespace artus {
namespace {

constexpr int kPatch = 96;  // px, as the reference measured
constexpr std::size_t kPatches = 5;
constexpr double kTrend = 12;         // px, as far as can be told from the reference's own values
constexpr double kPixel = 0.0854e-3;  // m, of the reference's bone images

/// What is left of a patch without its slow changes of brightness (layers, shadows).
cv::Mat without_trend(const cv::Mat& values) {
  cv::Mat trend;
  cv::GaussianBlur(values, trend, {}, kTrend, kTrend, cv::BORDER_REFLECT);
  return values - trend;
}

/// Full width at half maximum of the autocorrelation along the rows of `values`, px.
double correlation_width(const cv::Mat& values) {
  std::vector<double> lag;
  std::vector<double> sum;
  for (int k = 0; k < values.cols; ++k) {
    lag.push_back(k);
    sum.push_back(values.colRange(0, values.cols - k).dot(values.colRange(k, values.cols)));
    if (sum.back() < sum.front() / 2) break;
  }
  return full_width(lag, sum);
}

std::vector<std::string> split_tabs(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  std::string cell;
  while (std::getline(in, cell, '\t')) cells.push_back(cell);
  return cells;
}

bool is_wanted(const std::string& name, std::span<const std::string> prefixes) {
  return prefixes.empty() || std::any_of(prefixes.begin(), prefixes.end(), [&](const auto& prefix) {
           return name.rfind(prefix, 0) == 0;
         });
}

void widen(PatchRange& range, const PatchStatistics& s) {
  const auto each = [&](double PatchStatistics::*member) {
    range.least.*member = range.images == 0 ? s.*member : std::min(range.least.*member, s.*member);
    range.most.*member = range.images == 0 ? s.*member : std::max(range.most.*member, s.*member);
  };
  each(&PatchStatistics::mean);
  each(&PatchStatistics::deviation);
  each(&PatchStatistics::axial_width);
  each(&PatchStatistics::lateral_width);
  ++range.images;
}

/// One view of muscle to compare. All its claims are fitted; `why` says by what.
struct MuscleView {
  std::string picture;
  std::string name;
  std::string why;
  std::shared_ptr<const Scene> scene;
  Pose X_JP = Pose::Identity();
};

/// Muscle under skin and fat, its fibres 15 degrees to the face: the long axis of the references.
std::shared_ptr<const Scene> long_axis_block() {
  const std::array<FlatLayer, 3> layers{{{"skin", 1.5e-3}, {"fat", 4e-3}, {"muscle", 80e-3}}};
  return make_block_scene(layers, [](CompiledJoint& joint) {
    joint.regions.back().fibre_axis = Vec3(std::cos(15 * kDegree), 0, std::sin(15 * kDegree));
  });
}

/// The probe and the pixels of the reference.
struct ReferenceView {
  Transducer transducer;
  ImageSettings settings;
};

ReferenceView reference_view() {
  const auto preset = find_transducer("linear-4-9");
  ARTUS_REQUIRE(preset.has_value(), "the bundled transducer is missing");
  ReferenceView view;
  view.settings.look = Look::raw;
  view.transducer = preset->transducer;
  view.settings.pixel = kPixel;
  view.settings.depth = 50e-3;
  return view;
}

/// Adds what one view shows to the gate.
void compare_view(Gate& gate, const MuscleView& view, const MuscleFinder& finder,
                  const PatchRange& range) {
  const ReferenceView as = reference_view();
  Renderer renderer(view.scene, as.transducer, as.settings);
  cv::Mat image = grey_image(renderer.render(view.X_JP)).clone();
  const auto patches = finder.find_patches(view.X_JP, kPatch, kPatches);
  PatchStatistics mean;
  for (const cv::Rect& patch : patches) {
    const PatchStatistics s = measure_patch(image, patch);
    const double share = 1 / static_cast<double>(patches.size());
    mean.mean += s.mean * share;
    mean.deviation += s.deviation * share;
    mean.axial_width += s.axial_width * share;
    mean.lateral_width += s.lateral_width * share;
  }
  for (const cv::Rect& patch : patches) cv::rectangle(image, patch, cv::Scalar(255));
  add_picture(gate, "muscle-" + view.picture, image);
  gate.claims.push_back(claim_at_least({ClaimKind::fitted, view.why},
                                       view.name + ": patches of muscle",
                                       static_cast<double>(patches.size()), 1, ""));
  if (patches.empty()) return;
  const auto compare = [&](const char* what, double PatchStatistics::*member, const char* unit) {
    const double least = range.least.*member;
    const double most = range.most.*member;
    gate.claims.push_back(claim_within({ClaimKind::fitted, view.why}, view.name + ": " + what,
                                       mean.*member, (least + most) / 2, (most - least) / 2, unit));
  };
  compare("mean", &PatchStatistics::mean, "grey");
  compare("spread", &PatchStatistics::deviation, "grey");
  compare("autocorrelation width along depth", &PatchStatistics::axial_width, "px");
  compare("autocorrelation width across", &PatchStatistics::lateral_width, "px");
}

}  // namespace

PatchStatistics measure_patch(const cv::Mat& image, const cv::Rect& patch) {
  ARTUS_REQUIRE(image.type() == CV_8UC1 && (patch & cv::Rect({0, 0}, image.size())) == patch,
                "the patch must lie in an 8-bit grey image");
  cv::Mat values;
  image(patch).convertTo(values, CV_64F);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(values, mean, deviation);
  const cv::Mat fine = without_trend(values);
  return {mean[0], deviation[0], correlation_width(fine.t()), correlation_width(fine)};
}

std::vector<cv::Rect> find_muscle_patches(const LabelImage& labels, const CompiledJoint& joint,
                                          int size, std::size_t count) {
  cv::Mat other(labels.height, labels.width, CV_8UC1);
  for (int y = 0; y < labels.height; ++y)
    for (int x = 0; x < labels.width; ++x) {
      const RegionId region =
          labels.regions[static_cast<std::size_t>(y) * static_cast<std::size_t>(labels.width) +
                         static_cast<std::size_t>(x)];
      const bool muscle =
          region >= kFirstRegion && joint.tissue_of(region).acoustic.kind == TissueKind::muscle;
      other.at<std::uint8_t>(y, x) = muscle ? 0 : 1;
    }
  cv::Mat sums;
  cv::integral(other, sums, CV_32S);
  constexpr int kStep = 4;
  std::vector<cv::Rect> patches;
  for (int y = 0; y + size <= labels.height && patches.size() < count; y += kStep)
    for (int x = 0; x + size <= labels.width && patches.size() < count; x += kStep) {
      const int outside = sums.at<int>(y + size, x + size) - sums.at<int>(y, x + size) -
                          sums.at<int>(y + size, x) + sums.at<int>(y, x);
      const cv::Rect patch(x, y, size, size);
      const bool overlaps = std::any_of(patches.begin(), patches.end(), [&](const cv::Rect& taken) {
        return !(taken & patch).empty();
      });
      if (outside == 0 && !overlaps) patches.push_back(patch);
    }
  return patches;
}

Result<PatchRange> read_patch_range(const std::filesystem::path& file,
                                    std::span<const std::string> prefixes) {
  const auto text = read_bytes(file);
  ARTUS_TRY(text);
  std::istringstream in(*text);
  std::string line;
  std::getline(in, line);
  const auto header = split_tabs(line);
  std::map<std::string, std::size_t> column;
  for (std::size_t i = 0; i < header.size(); ++i) column[header[i]] = i;
  PatchRange range;
  for (int number = 2; std::getline(in, line); ++number) {
    const auto cells = split_tabs(line);
    if (cells.empty() || !is_wanted(cells.front(), prefixes)) continue;
    const auto value = [&](const char* name) -> double {
      const auto place = column.find(name);
      if (place == column.end() || place->second >= cells.size()) return std::nan("");
      std::istringstream cell(cells[place->second]);
      cell.imbue(std::locale::classic());
      double v = 0;
      return cell >> v ? v : std::nan("");
    };
    const PatchStatistics s{value("mean"), value("std"), value("acf_fwhm_axial_px"),
                            value("acf_fwhm_lateral_px")};
    if (!std::isfinite(s.mean + s.deviation + s.axial_width + s.lateral_width))
      return fail(ErrorCode::malformed, "a column or a number is missing",
                  file.string() + ":" + std::to_string(number));
    widen(range, s);
  }
  if (range.images == 0)
    return fail(ErrorCode::malformed, "there is no row of a wanted image in it", file.string());
  return range;
}

Gate measure_muscle(const std::shared_ptr<const Scene>& scene, const PatchRange& range) {
  Gate gate;
  gate.name = "muscle-patch";
  gate.title = "Grey of muscle in joint " + scene->joint().name + " against " +
               std::to_string(range.images) + " real images (4-9 MHz, 0.0854 mm a pixel)";
  gate.assumed = {
      "level of muscle's speckle, chosen for the grey of such images; sizes of perimysium, chosen "
      "beside real images; pulse, aperture and focus of their probe"};
  const ReferenceView as = reference_view();
  const std::string chosen = "level and grain of muscle were chosen beside such images";
  const Pose& X_JDefault = scene->joint().X_JP_default;
  const MuscleFinder finder(*scene, as.transducer, as.settings);
  const Pose X_JP = finder.slide_to_muscle(X_JDefault, kPatch).value_or(X_JDefault);
  const long slid = std::lround((X_JP.translation() - X_JDefault.translation()).norm() / 1e-3);
  const std::string moved = std::to_string(slid) + " mm";
  const std::string name = slid == 0 ? "default" : moved + " from default";
  const std::string why =
      slid == 0 ? chosen : chosen + ", and the probe was slid by " + moved + " to where muscle is";
  const Pose X_JTurned = X_JP * Eigen::AngleAxisd(90 * kDegree, Vec3::UnitZ());
  compare_view(gate, {"long", name, why, scene, X_JP}, finder, range);
  compare_view(gate, {"turned", name + ", turned", why, scene, X_JTurned}, finder, range);
  const auto block = long_axis_block();
  compare_view(gate,
               {"block", "block", chosen + ", and the block's layers and fibres like theirs", block,
                Pose::Identity()},
               MuscleFinder(*block, as.transducer, as.settings), range);
  return gate;
}

}  // namespace artus
