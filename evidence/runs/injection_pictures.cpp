// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/injection_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "artus/detail/anatomy/body/space.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"
#include "artus/detail/dataset/video_file.h"
#include "artus/detail/evidence/runs/injection_plume.h"
#include "artus/detail/evidence/runs/injection_view.h"
#include "artus/detail/simulation/fluid_shapes.h"
#include "artus/detail/soft/liquid/overflow.h"
#include "artus/detail/training/health/simulated_health.h"
#include "artus/echo/image_io.h"
#include "artus/echo/labels.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

constexpr double kApart = 0.1e-3;    // m between rays across a picture
constexpr double kGrid = 0.5e-3;     // m between parallel rays
constexpr double kReach = 70e-3;     // m around the tip that they cover
constexpr double kBelowTip = 12e-3;  // m that a picture shows below the tip
constexpr double kDeepest = 90e-3;   // m
constexpr double kAgree = 5;         // %
constexpr int kFrames = 36;          // of a video
constexpr double kFrameRate = 9;     // 1/s
constexpr double kAround = 2;        // s before the first flow and after the last in it
constexpr double kDrawn = 10e-9;     // m^3; less is left out

/// The places of a row as shapes, each where liquid first came to it.
std::vector<Injected> places_at(const CompiledJoint& joint, const InjectionRun& run,
                                const InjectionRow& row) {
  const auto spaces = make_joint_spaces(joint);
  if (!spaces) return {};
  std::vector<InjectedSite> sites;
  for (InjectedSite site : run.sites) {
    const std::string& name = spaces->spaces[spaces->of_region[site.region]].name;
    const auto place = std::find(run.places.begin(), run.places.end(), name);
    const auto k = static_cast<std::size_t>(place - run.places.begin());
    if (k >= row.volumes.size() || row.volumes[k] < kDrawn) continue;
    site.volume = row.volumes[k];
    sites.push_back(site);
  }
  return injected_of(joint, *spaces, sites);
}

std::shared_ptr<const Scene> scene_of(const OpenedSpaces& spaces, const InjectionRun& run,
                                      const std::vector<Injected>& places) {
  return std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(
      with_injected(spaces.joint(), places, run.plunger.liquid, {}, spaces)));
}

/// m^3 of the named regions around the tip, by parallel rays.
double volume_by_rays(const Scene& scene, const Pose& X_JN, std::span<const std::string> names) {
  const Vec3 axis = X_JN.linear().col(2);
  const Vec3 x = X_JN.linear().col(0);
  const Vec3 y = X_JN.linear().col(1);
  const auto n = static_cast<int>(kReach / kGrid);
  double length = 0;
  std::array<TissueInterval, 128> intervals;
  for (int i = -n; i <= n; ++i) {
    for (int j = -n; j <= n; ++j) {
      const Vec3 middle = X_JN.translation() + kGrid * (i * x + j * y);
      const QueryCount count =
          scene.find_intervals({middle - kReach * axis, middle + kReach * axis}, intervals);
      for (std::size_t k = 0; k < count.size; ++k) {
        const std::string& name = scene.joint().regions[intervals[k].region].name;
        if (std::find(names.begin(), names.end(), name) != names.end())
          length += intervals[k].exit - intervals[k].entry;
      }
    }
  }
  return length * kGrid * kGrid;
}

double area_of(const LabelImage& labels, const Scene& scene, std::span<const std::string> names) {
  const auto pixels = std::count_if(labels.regions.begin(), labels.regions.end(), [&](RegionId r) {
    return std::find(names.begin(), names.end(), scene.joint().regions[r].name) != names.end();
  });
  return static_cast<double>(pixels) * labels.pixel * labels.pixel;
}

/// m^3 of the named regions around the needle's tip, by the labels of parallel pictures.
double volume_by_labels(const Scene& scene, const Pose& X_JP, const Vec3& tip,
                        std::span<const std::string> names) {
  constexpr double kBetween = 1e-3;  // m
  constexpr double kPixel = 0.25e-3;
  Transducer wide;
  wide.width = 2 * kReach;
  ImageSettings settings;
  settings.depth = 2 * kReach;
  settings.pixel = kPixel;
  const LabelRenderer renderer(wide, settings);
  const auto n = static_cast<int>(kReach / kBetween);
  double volume = 0;
  for (int k = -n; k <= n; ++k) {
    Pose slice = X_JP;
    slice.translation() = tip + X_JP.linear() * Vec3(0, kBetween * k, -kReach);
    volume += kBetween * area_of(renderer.render(scene, slice), scene, names);
  }
  return volume;
}

/// m^2 of the named regions in the picture's plane, by its labels.
double area_by_labels(const Scene& scene, const Pose& X_JP, const InjectionPictureOptions& options,
                      std::span<const std::string> names) {
  return area_of(render_labels(scene, X_JP, options.transducer, options.settings), scene, names);
}

/// m of them along each of parallel lines in the picture's plane, kApart apart, `slant` rad from
/// the beam, within what the labels show: by rays across the plane, another way to the same.
std::vector<double> depths_by_rays(const Scene& scene, const Pose& X_JP,
                                   const InjectionPictureOptions& options, double slant,
                                   std::span<const std::string> names) {
  const double half = options.transducer.width / 2;
  const double deep = options.settings.depth;
  const double reach = std::hypot(half, deep / 2);
  const Vec3 along(std::sin(slant), 0, std::cos(slant));
  const Vec3 across(std::cos(slant), 0, -std::sin(slant));
  std::vector<double> depths;
  for (double t = -reach + kApart / 2; t < reach; t += kApart) {
    double& depth = depths.emplace_back();
    // Within the picture from `from` to `to` of the line.
    const Vec3 middle = Vec3(0, 0, deep / 2) + t * across;
    double from = -reach;
    double to = reach;
    const auto cut = [&](double at, double displacement, double low, double high) {
      if (std::abs(displacement) < 1e-9) {
        if (at < low || at > high) to = from;
        return;
      }
      from = std::max(from, std::min((low - at) / displacement, (high - at) / displacement));
      to = std::min(to, std::max((low - at) / displacement, (high - at) / displacement));
    };
    cut(middle.x(), along.x(), -half, half);
    cut(middle.z(), along.z(), 0, deep);
    if (!(to > from)) continue;
    for (const TissueInterval& s :
         tissue_intervals(scene, {X_JP * (middle + from * along), X_JP * (middle + to * along)})) {
      const std::string& name = scene.joint().regions[s.region].name;
      if (std::find(names.begin(), names.end(), name) != names.end()) depth += s.exit - s.entry;
    }
  }
  return depths;
}

/// What rays find in the picture's plane: area, and as callipers would, square to the layer, how
/// far the liquid is thicker than before where that is most and how wide it is by half of that.
void measure_seen(const Scene& before, const Scene& after, const Pose& X_JP,
                  const InjectionPictureOptions& options, std::span<const std::string> names,
                  InjectionPictures& out) {
  constexpr double kMaxSlant = 75;  // degrees from the beam
  constexpr double kTurn = 5;
  for (double slant = -kMaxSlant; slant <= kMaxSlant; slant += kTurn) {
    const std::vector<double> was = depths_by_rays(before, X_JP, options, slant * kDegree, names);
    std::vector<double> more = depths_by_rays(after, X_JP, options, slant * kDegree, names);
    if (slant == 0) out.ray_area = kApart * std::accumulate(more.begin(), more.end(), 0.0);
    for (std::size_t k = 0; k < more.size(); ++k) more[k] -= was[k];
    const double opening = *std::max_element(more.begin(), more.end());
    if (slant == 0) out.beam_opening = opening;
    if (!(opening > 0) || (out.seen_opening > 0 && opening >= out.seen_opening)) continue;
    out.seen_opening = opening;
    out.seen_width =
        kApart * static_cast<double>(std::count_if(more.begin(), more.end(),
                                                   [&](double m) { return m >= opening / 2; }));
  }
}

/// The last row whose given volume is at most `share` of the end's.
const InjectionRow* row_at(const InjectionRun& run, double share) {
  const InjectionRow* found = nullptr;
  const auto sum = [](const InjectionRow& row) {
    double all = 0;
    for (const double v : row.volumes) all += v;
    return all;
  };
  for (const InjectionRow& row : run.rows) {
    if (row.phase == "withdraw") break;
    if (sum(row) <= share * run.given) found = &row;
  }
  return found;
}

cv::Mat draw(const std::shared_ptr<const Scene>& scene, const InjectionRun& run, const Pose& X_JP,
             const InjectionPictureOptions& options, InjectionPlume& plume, double time) {
  const NeedleView needle{run.X_JN, options.needle, Vec3::Zero()};
  Renderer renderer(scene, options.transducer, options.settings);
  plume.show(renderer, *scene, time);
  const Pose X_JS = ride_on_skin(*scene, X_JP, options.transducer);
  const Frame& frame = renderer.render(X_JS, needle);
  cv::Mat bmode;
  cv::cvtColor(annotated_image(frame, options.transducer), bmode, cv::COLOR_GRAY2BGR);
  const LabelImage labels = render_shown_labels(renderer, X_JS, needle);
  cv::Mat colours = colour_labels(labels, scene->joint());
  const int border = bmode.cols - colours.cols;
  cv::copyMakeBorder(colours, colours, 4, 4, border / 2, border - border / 2, cv::BORDER_CONSTANT);
  cv::Mat both;
  cv::vconcat(bmode, colours, both);
  return both;
}

/// m^2 of the named region's walls that come apart by at least `least` m.
double area_apart(const CompiledJoint& joint, const std::vector<Vec3>& moved,
                  const std::string& region, double least) {
  double area = 0;
  for (const Interface& f : joint.mesh.interfaces) {
    if (joint.regions[f.front].name != region && joint.regions[f.back].name != region) continue;
    const auto& p = joint.mesh.vertices;
    const auto& [a, b, c] = f.vertices;
    double apart = 0;
    for (const std::uint32_t v : f.vertices) apart += (moved[v] - p[v]).norm() / 3;
    if (apart >= least) area += (p[b] - p[a]).cross(p[c] - p[a]).norm() / 2;
  }
  return area;
}

/// How far the roof is lifted, and by half of that over which length and over a disc of which size.
void measure_opening(const OpenedSpaces& spaces, const std::vector<Injected>& places,
                     InjectionPictures& out) {
  for (const Injected& place : places) {
    if (!place.cavity || !(place.volume > 0)) continue;
    const CompiledJoint& joint = spaces.joint();
    const auto at = std::find_if(joint.regions.begin(), joint.regions.end(),
                                 [&](const Region& r) { return r.name == place.region; });
    const OpenedSpace& space = spaces.of(static_cast<RegionId>(at - joint.regions.begin()));
    const double opening = space.largest_opening(place.tip, place.volume);
    if (opening <= out.opening) continue;
    out.opening = opening;
    out.confined = space.confines(place.tip, place.volume);
    const std::vector<Vec3> moved = space.vertices(joint.mesh, {place.tip, place.volume, {}});
    double widest = 0;
    for (const Interface& f : joint.mesh.interfaces) {
      if (joint.regions[f.front].name != place.region && joint.regions[f.back].name != place.region)
        continue;
      for (const std::uint32_t v : f.vertices)
        if ((moved[v] - joint.mesh.vertices[v]).norm() >= opening / 2)
          widest = std::max(widest, (joint.mesh.vertices[v] - place.tip).norm());
    }
    out.length = 2 * widest;
    const double area = area_apart(joint, moved, place.region, opening / 2);
    out.width = std::sqrt(4 * area / std::numbers::pi);
  }
}

/// Of what was put where.
HealthQuestion question_of(const std::shared_ptr<const Scene>& rest,
                           const std::shared_ptr<const Scene>& drawn,
                           const std::vector<Injected>& places, const Pose& X_JP,
                           const InjectionPictureOptions& options) {
  HealthQuestion question;
  question.before = rest;
  question.after = drawn;
  question.X_JP = X_JP;
  question.transducer = options.transducer;
  question.settings = options.settings;
  if (!places.empty()) question.liquid.p_J = places.front().tip;
  for (const Injected& place : places) question.liquid.volume += place.volume;
  add_drawn(rest->joint(), drawn->joint(), question.liquid);
  return question;
}

/// Where the probe lies, and how deep it looks.
std::pair<Pose, InjectionPictureOptions> view_of(const Scene& scene, const InjectionRun& run,
                                                 const InjectionPictureOptions& options) {
  const Pose X_JP = find_view_of(scene, run.X_JN, options.transducer.width).X_JP;
  InjectionPictureOptions deep = options;
  const double tip = (X_JP.inverse() * run.X_JN.translation()).z();
  deep.settings.depth = std::clamp(tip + kBelowTip, options.settings.depth, kDeepest);
  return {X_JP, deep};
}

/// What is not where it was given, a line each.
void tell_overflow(const std::vector<Injected>& given, const std::vector<Injected>& drawn,
                   std::vector<std::string>& lines) {
  const auto tell = [&](double volume, const std::string& what) {
    lines.push_back(printed("%.2f ml ", volume / kCubicCentimetre) + what);
  };
  double less = 0;
  for (std::size_t k = 0; k < given.size(); ++k) {
    const double spread = given[k].volume - drawn[k].volume;
    if (given[k].cavity) less += spread;
    if (!given[k].cavity && spread > kDrawn)
      tell(spread, "spread too thin to be drawn in " + given[k].region);
  }
  for (std::size_t k = given.size(); k < drawn.size(); ++k) {
    less -= drawn[k].volume;
    tell(drawn[k].volume, "are more than the space holds, and part " + drawn[k].region);
  }
  if (less > kDrawn)
    tell(less, "are in parts of the space that the body does not have, and are not drawn");
}

}  // namespace

Result<std::string> write_injection_video(const std::shared_ptr<const Scene>& scene,
                                          const InjectionRun& run,
                                          const InjectionPictureOptions& options,
                                          const std::filesystem::path& folder) {
  const auto injects = [](const InjectionRow& row) {
    return row.phase == "inject";
  };
  const auto first = std::find_if(run.rows.begin(), run.rows.end(), injects);
  if (first == run.rows.end()) return fail(ErrorCode::invalid, "nothing was injected", "the run");
  const auto last = std::find_if(run.rows.rbegin(), run.rows.rend(), injects);
  const auto [X_JP, deep] = view_of(*scene, run, options);
  InjectionPlume plume(*scene, run, deep.needle.bore);
  std::optional<VideoFile> video;
  const OpenedSpaces spaces(scene->shared_joint());
  for (int k = 0; k < kFrames; ++k) {
    const double from = first->time - kAround;
    const InjectionRow& row = row_of(run, from + k * (last->time + kAround - from) / (kFrames - 1));
    const auto body = scene_of(spaces, run, places_at(scene->joint(), run, row));
    Pose X_JN = run.X_JN;
    X_JN.translation() += (row.depth - run.depth) * X_JN.linear().col(2);
    Renderer renderer(body, deep.transducer, deep.settings);
    plume.show(renderer, *body, row.time);
    const Pose X_JS = ride_on_skin(*body, X_JP, deep.transducer);
    const Frame& frame = renderer.render(X_JS, NeedleView{X_JN, deep.needle, Vec3::Zero()});
    cv::Mat picture = annotated_image(frame, deep.transducer);
    cv::putText(picture,
                printed("%.1f s  %.2f ml  %.1f N  %.0f kPa", row.time - first->time,
                        (run.plunger.syringe.filled - row.plunger.content) / kCubicCentimetre,
                        row.thumb, 1e-3 * row.plunger.pressure),
                {40, picture.rows - 8}, cv::FONT_HERSHEY_SIMPLEX, 0.45, cv::Scalar(255), 1,
                cv::LINE_AA);
    if (!video) {
      auto opened = VideoFile::open(folder / "injection.mp4", picture.size(), false, kFrameRate);
      ARTUS_TRY(opened);
      video = std::move(*opened);
    }
    video->write(picture);
  }
  const auto written = video->finish();
  ARTUS_TRY(written);
  return written->filename().string();
}

Result<InjectionPictures> write_injection_pictures(const std::shared_ptr<const Scene>& scene,
                                                   const InjectionRun& run,
                                                   const InjectionPictureOptions& options,
                                                   const std::filesystem::path& folder) {
  InjectionPictures out;
  const auto [X_JP, deep] = view_of(*scene, run, options);
  InjectionPlume plume(*scene, run, deep.needle.bore);
  std::vector<Injected> last;
  std::shared_ptr<const Scene> body = scene;
  const OpenedSpaces spaces(scene->shared_joint());
  for (const auto& [file, share] :
       {std::pair{"before.png", 0.0}, {"during.png", 0.5}, {"after.png", 1.0}}) {
    const InjectionRow* row = row_at(run, share);
    if (row == nullptr) continue;
    last = places_at(scene->joint(), run, *row);
    body = scene_of(spaces, run, last);
    ARTUS_TRY(write_image(draw(body, run, X_JP, deep, plume, row->time), folder / file));
    out.files.emplace_back(file);
  }
  const std::vector<Injected> given = last;
  last = with_overflow(spaces, std::move(last));
  tell_overflow(given, last, out.overflow);
  out.at_rest = question_of(scene, body, last, X_JP, deep);
  out.drawn_volume = out.at_rest.liquid.volume;
  const std::vector<std::string>& names = out.at_rest.liquid.regions;
  out.ray_volume = volume_by_rays(*body, run.X_JN, names) - volume_by_rays(*scene, run.X_JN, names);
  const Vec3& tip = run.X_JN.translation();
  out.label_volume =
      volume_by_labels(*body, X_JP, tip, names) - volume_by_labels(*scene, X_JP, tip, names);
  out.label_area = area_by_labels(*body, X_JP, deep, names);
  if (options.transducer.radius == 0) measure_seen(*scene, *body, X_JP, deep, names, out);
  measure_opening(spaces, last, out);
  return out;
}

std::vector<Claim> claims_of(const InjectionPictures& pictures) {
  std::vector<Claim> claims;
  if (pictures.drawn_volume > 0)
    claims.push_back(claim_near({ClaimKind::input, "the shapes are scaled to the volumes"},
                                "liquid that rays find in the drawn body",
                                pictures.ray_volume * 1e6, pictures.drawn_volume * 1e6,
                                kAgree / 100, "ml"));
  if (pictures.drawn_volume > 0)
    claims.push_back(claim_near({ClaimKind::input, "the shapes are scaled to the volumes"},
                                "liquid in the labels of slices 1 mm apart",
                                pictures.label_volume * 1e6, pictures.drawn_volume * 1e6,
                                kAgree / 100, "ml"));
  if (pictures.ray_area > 0)
    claims.push_back(claim_near({ClaimKind::input, "labels and rays see the same drawn scene"},
                                "area of liquid in the labels", pictures.label_area * 1e6,
                                pictures.ray_area * 1e6, kAgree / 100, "mm2"));
  return claims;
}

std::vector<Claim> compare_with_published(const InjectionRun& run,
                                          const InjectionPictures& pictures) {
  std::vector<Claim> claims;
  constexpr double kPublished = 5e-6;  // m^3, what opens a bursa by 2 to 6 mm over 10 to 30 mm
  if (run.target_like == "bursa" && std::abs(run.given / kPublished - 1) < 0.2) {
    const ClaimBasis basis{ClaimKind::fitted, pictures.confined
                                                  ? "all of the bursa opens, as a plate does"
                                                  : "the patch's radius was chosen for it"};
    claims.push_back(claim_within(basis, "the bursa opens at its widest by", pictures.opening * 1e3,
                                  4, 2, "mm"));
    if (pictures.seen_width > 0)
      claims.push_back(claim_within(basis, "by half of that or more it is seen open over",
                                    pictures.seen_width * 1e3, 20, 10, "mm"));
  }
  return claims;
}

}  // namespace artus
