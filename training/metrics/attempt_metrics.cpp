// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/attempt_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "artus/detail/core/units.h"
#include "artus/detail/training/metrics/placement.h"
#include "artus/detail/training/metrics/smoothness.h"

namespace artus {
namespace {

constexpr double kFastMove = 0.05;          // m/s
constexpr double kFastTurn = 50 * kDegree;  // rad/s
constexpr double kHold = 0.2;               // s
constexpr double kMoving = 2e-3;            // m/s
constexpr double kSquare = kMillimetre * kMillimetre;

using Value = std::optional<double>;

/// Puts metrics of one rule together.
class Sheet {
 public:
  void rule(MetricRule rule) { rule_ = std::move(rule); }
  void put(const char* role, const std::string& name, const char* unit, Value value,
           const std::string& definition) {
    if (value && !std::isfinite(*value)) value.reset();
    out_.push_back({name, role, unit, value, definition, rule_});
  }
  std::vector<Metric> take() { return std::move(out_); }

 private:
  MetricRule rule_ = motion_rule();
  std::vector<Metric> out_;
};

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

/// Pearson's correlation of two signals over what they share; empty when one does not vary.
Value correlation(std::vector<double> a, std::vector<double> b) {
  const std::size_t n = std::min(a.size(), b.size());
  if (n < 2) return std::nullopt;
  a.resize(n);
  b.resize(n);
  const double ma = mean_of(a);
  const double mb = mean_of(b);
  double ab = 0;
  double aa = 0;
  double bb = 0;
  for (std::size_t i = 0; i < n; ++i) {
    ab += (a[i] - ma) * (b[i] - mb);
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
  }
  if (aa <= 0 || bb <= 0) return std::nullopt;
  return ab / std::sqrt(aa * bb);
}

void put_hand(Sheet& sheet, const char* role, const std::vector<TrackPoint>& track,
              std::uint64_t left_out) {
  const std::vector<double> speeds = speeds_of(track);
  const std::vector<double> turns = turn_rates_of(track);
  const bool there = !speeds.empty();
  const auto sum = [](const std::vector<double>& values) {
    double total = 0;
    for (const double v : values) total += v / kTrackRate;
    return total;
  };
  const auto when = [there](double value) {
    return there ? Value(value) : Value();
  };
  sheet.put(role, "path_length_mm", "mm", when(sum(speeds) / kMillimetre),
            "sum of the steps of the pose's origin");
  sheet.put(role, "left_out", "count", when(static_cast<double>(left_out)),
            "poses that were left out: further from the one before than 2 m/s or 20 rad/s reach, "
            "and not there for 0.3 s");
  sheet.put(role, "rotation_deg", "deg", when(sum(turns) / kDegree), "sum of the steps' angles");
  sheet.put(role, "movements", "count", when(count_movements(speeds, kFastMove, kHold)),
            "runs faster than 50 mm/s for 0.2 s or more, closed after 0.2 s below");
  sheet.put(role, "rotations", "count", when(count_movements(turns, kFastTurn, kHold)),
            "runs faster than 50 deg/s for 0.2 s or more, closed after 0.2 s below");
  sheet.put(role, "sparc", "-", when(spectral_arc_length(speeds, kTrackRate)),
            "spectral arc length of the speed, up to 10 Hz, from 0.05 of the largest; nearer to 0 "
            "is smoother");
  sheet.put(role, "ldlj", "-", when(log_dimensionless_jerk(speeds, kTrackRate)),
            "log dimensionless jerk of the speed; nearer to 0 is smoother");
}

void put_course(Sheet& sheet, const AttemptView& view) {
  const auto& course = view.measures.course;
  const CourseTotals sum = sum_course(course);
  const bool in = sum.first_contact.has_value();
  const auto when = [in](double value) {
    return in ? Value(value) : Value();
  };
  sheet.put("needle", "time_s", "s", when(sum.last_inside.value_or(0) - sum.entered.value_or(0)),
            "begin of the first interval that ends with the tip inside the skin, to the last "
            "instant inside");
  sheet.put("needle", "time_to_contact_s", "s",
            when(sum.first_contact.value_or(0) - (course.empty() ? 0 : course.front().time)),
            "start to the first instant with the tip inside");
  sheet.put("needle", "time_in_tissue_s", "s", sum.time_in_tissue,
            "intervals that end with the tip inside");
  sheet.put("needle", "path_in_tissue_mm", "mm", sum.path_in_tissue / kMillimetre,
            "steps that end with the tip inside");
  sheet.put("needle", "swept_area_mm2", "mm2", sum.swept_area / kSquare,
            "area between neighbouring shafts from tip to the skin on the line to 300 mm back; "
            "both ends inside");
  sheet.put("needle", "swept_volume_mm3", "mm3",
            sum.swept_area * view.options.needle.outer_diameter / (kSquare * kMillimetre),
            "swept area times the needle's outer diameter");
  sheet.put("needle", "deepest_mm", "mm", sum.deepest / kMillimetre,
            "largest distance from the skin to the tip along the needle");
  const auto idle = find_idle(course, view.measures.probe);
  double still = 0;
  for (const Run& run : idle) still += run.amount;
  const double start = course.empty() ? 0 : course.front().time;
  sheet.put("needle", "done_s", "s", when(sum.last_inside.value_or(start) - start),
            "start to the last instant with the tip inside");
  sheet.put("needle", "withdrawn", "-",
            course.empty() ? Value() : Value(course.back().inside() ? 0 : 1),
            "1 when the tip was outside the body at the end");
  sheet.put("needle", "idle", "count", static_cast<double>(idle.size()),
            "times inside, longer than 3 s, with the tip slower than 2 mm/s and the probe, too, "
            "which turns slower than 2 deg/s");
  sheet.put("needle", "idle_s", "s", still, "sum of those times");
  sheet.put("needle", "passes", "count", static_cast<double>(find_passes(course).size()),
            "1 and every advance of 5 mm or more after a withdrawal of 5 mm or more");
  sheet.put(
      "needle", "redirections", "count", static_cast<double>(find_redirections(course).size()),
      "turns of the shaft by more than 5 degrees inside between two rests, without a pass; a turn "
      "ends when the shaft keeps within 1 degree for 0.5 s");
}

/// s of Doppler before the needle went in, from one picture to the next.
double doppler_before_needle(const AttemptView& view) {
  constexpr double kSame = 0.5;  // s; pictures further apart are not of one look
  const auto& course = view.measures.course;
  const auto entry = std::find_if(course.begin(), course.end(),
                                  [](const CoursePoint& point) { return point.inside(); });
  double looked = 0;
  for (std::size_t i = 1; i < view.coloured.size(); ++i) {
    if (entry != course.end() && view.coloured[i] >= entry->time) break;
    const double step = view.coloured[i] - view.coloured[i - 1];
    if (step < kSame) looked += step;
  }
  return looked;
}

void put_sight(Sheet& sheet, const AttemptView& view) {
  const SightTotals sum = sum_sight(view.measures.course, view.measures.sights);
  const bool there = sum.time > 0;
  const auto scaled = [](Value value, double unit) {
    return value ? Value(*value / unit) : value;
  };
  sheet.put(
      "both", "in_plane_fraction", "-",
      sum.advanced > 0 ? Value(sum.advanced_in_plane / sum.advanced) : Value(),
      "share of the distance advanced in tissue with the tip within half the slice's thickness at "
      "its depth and the shaft within 5 degrees of the plane");
  sheet.put("both", "plane_offset_median_mm", "mm",
            scaled(percentile(sum.offsets, 0.5), kMillimetre), "tip to image plane, inside");
  sheet.put("both", "plane_offset_p90_mm", "mm", scaled(percentile(sum.offsets, 0.9), kMillimetre),
            "its 90th percentile");
  sheet.put("both", "plane_angle_median_deg", "deg", scaled(percentile(sum.angles, 0.5), kDegree),
            "shaft to image plane, inside");
  sheet.put("both", "plane_angle_p90_deg", "deg", scaled(percentile(sum.angles, 0.9), kDegree),
            "its 90th percentile");
  sheet.put(
      "both", "tip_seen", "-", there ? Value(sum.time_seen / sum.time) : Value(),
      "share of the time in tissue with the last 5 mm of the shaft, and the last 2 mm alone, 4 "
      "dB above lines beside it in the pictures of that moment, where its echo is not 12 dB "
      "below muscle's; without pictures, with the tip between the outermost lines, not shadowed, "
      "and its echo 6 dB above muscle after what angle and distance to the plane take");
  double unseen = 0;
  for (const Run& run : sum.unseen) unseen += run.amount;
  sheet.put("both", "unseen_advances", "count",
            there ? Value(static_cast<double>(sum.unseen_advances)) : Value(),
            "runs of 1 mm or more advanced in tissue while the tip is not seen, ended by 3 s "
            "without advance; each 5 mm of one beyond the way to the picture's edge is one more");
  sheet.put("both", "unseen_mm", "mm", there ? Value(unseen / kMillimetre) : Value(),
            "distance advanced in those runs");
  sheet.put(
      "both", "unseen_entry_mm", "mm", there ? Value(sum.outside_picture / kMillimetre) : Value(),
      "distance advanced in tissue before the tip first came between the picture's edges; 0 when "
      "it never did");
  sheet.put("probe", "doppler_before_s", "s", doppler_before_needle(view),
            "time with colour or power Doppler on before the needle went in");
  std::vector<double> face;
  double drift = 0;
  double needling = 0;
  const auto& m = view.measures;
  const std::vector<double> probe = speeds_of(m.probe);
  for (std::size_t i = 1; i < m.course.size(); ++i) {
    if (!m.course[i].inside()) continue;
    if (m.sights[i]) face.push_back(m.sights[i]->face_angle);
    if (i - 1 >= probe.size() || m.course[i].step * kTrackRate < kMoving) continue;
    needling += 1 / kTrackRate;
    drift += probe[i - 1] / kTrackRate;
  }
  sheet.put("both", "face_angle_median_deg", "deg", scaled(percentile(face, 0.5), kDegree),
            "shaft to the probe's face (the image's x axis), inside");
  sheet.put("probe", "drift_mm_s", "mm/s",
            needling > 0 ? Value(drift / needling / kMillimetre) : Value(),
            "the probe's mean speed while the tip moves faster than 2 mm/s inside");
  sheet.put("both", "bimanual", "-", correlation(speeds_of(m.needle), probe),
            "correlation of the two hands' speeds");
}

/// Where and how the needle first went in; nothing where no entry is asked for.
void put_entry(Sheet& sheet, const AttemptView& view) {
  if (!view.options.goals.entry) return;
  const auto& course = view.measures.course;
  const auto& sights = view.measures.sights;
  const auto first = std::find_if(course.begin(), course.end(),
                                  [](const CoursePoint& point) { return point.inside(); });
  Value offset;
  Value angle;
  if (first != course.end()) {
    offset = (first->entry - *view.options.goals.entry).norm() / kMillimetre;
    const auto& sight = sights[static_cast<std::size_t>(first - course.begin())];
    if (sight) angle = sight->face_angle / kDegree;
  }
  sheet.put("needle", "entry_offset_mm", "mm", offset,
            "where the shaft crossed the skin at the first instant with the tip inside, to the "
            "entry asked for");
  sheet.put("both", "entry_angle_deg", "deg", angle,
            "shaft to the probe's face at the first instant with the tip inside");
}

void put_goals(Sheet& sheet, const AttemptView& view) {
  const Goals& goals = view.options.goals;
  const auto& course = view.measures.course;
  if (goals.target) {
    const auto placed = find_placement(course, &*goals.target, view.measures.doses);
    sheet.put(
        "needle", "distance_mm", "mm",
        placed ? Value(distance_to(*goals.target, course[*placed].tip) / kMillimetre) : Value(),
        "tip to " + goals.target->name +
            " where the needle was placed: where half of what was given had been, else its stay of "
            "0.5 s or more that came nearest, those on the way out aside, else its deepest");
  }
  double time = 0;
  double depth = 0;
  int fatal = 0;
  int entries = 0;
  for (const AvoidZone& zone : goals.avoid) {
    const Intrusion in = find_intrusion(zone, course);
    time += in.time;
    depth = std::max(depth, in.depth);
    entries += in.entries;
    if (zone.fatal) fatal += in.entries;
    sheet.put("needle", "avoid_depth_mm:" + zone.name, "mm", in.depth / kMillimetre,
              "deepest intrusion of the tip beyond the zone's edge");
  }
  if (goals.avoid.empty()) return;
  sheet.put("needle", "avoid_time_s", "s", time, "time of the tip inside the zones to avoid");
  sheet.put("needle", "avoid_depth_mm", "mm", depth / kMillimetre, "deepest intrusion of all");
  sheet.put("needle", "avoid_entries", "count", entries, "times that the tip came into a zone");
  sheet.put("needle", "avoid_fatal", "count", fatal,
            "times that the tip came into a zone that must never be entered");
}

/// What was to be shown with the probe; nothing where nothing was.
void put_sought(Sheet& sheet, const AttemptView& view) {
  const auto& sought = view.measures.sought;
  if (sought.empty()) return;
  double count = 0;
  for (const Sought& one : sought) count += one.found >= 0 ? 1 : 0;
  sheet.put(
      "probe", "found", "count", count,
      "structures that were shown when asked for: each in turn, its middle within 4 mm of the "
      "beam's middle for 1.5 s");
  const double last = sought.back().found;
  const auto& probe = view.measures.probe;
  sheet.put("probe", "find_s", "s",
            last >= 0 && !probe.empty() ? Value(last - probe.front().time) : Value(),
            "start to the moment at which the last of them was found");
}

void put_forces(Sheet& sheet, const AttemptView& view) {
  sheet.rule({"none, every tick", 0});
  const auto& m = view.measures;
  const auto when = [&view](double value) {
    return view.no_forces ? Value() : Value(value);
  };
  double peak = 0;
  double speed = 0;
  double scratch = 0;
  for (const FeltTouch& touch : m.touches) {
    peak = std::max(peak, touch.peak);
    speed = std::max(speed, touch.speed);
    scratch += touch.scratch;
  }
  sheet.put("needle", "bone_contacts", "count", when(static_cast<double>(view.touch_count)),
            "times that the tip came onto bone, 0.3 s or more apart");
  sheet.put("needle", "bone_peak_n", "N", when(peak), "largest force on bone");
  sheet.put("needle", "bone_speed_mm_s", "mm/s", when(speed / kMillimetre),
            "fastest touch of bone");
  sheet.put("needle", "bone_scratch_mm", "mm", when(scratch / kMillimetre),
            "path length of the tip while it stood on bone");
  const auto& regions = view.scene.joint().regions;
  for (std::size_t i = kFirstRegion; i < m.layers.size(); ++i) {
    const LayerForce& layer = m.layers[i];
    if (layer.time <= 0) continue;
    const std::string& name = regions[i].name;
    sheet.put("needle", "force_peak_n:" + name, "N", layer.peak,
              "largest cutting and friction along the needle with the tip in this layer");
    sheet.put("needle", "force_mean_n:" + name, "N", layer.impulse / layer.time, "its mean");
    sheet.put("needle", "force_impulse_n_s:" + name, "N s", layer.impulse, "its sum over time");
  }
}

void put_doses(Sheet& sheet, const AttemptView& view) {
  const auto& doses = view.measures.doses;
  const auto& target = view.options.goals.target;
  const double given = view.measures.syringe.given;
  const auto share = [given](double part) {
    return given > 0 ? Value(part / given) : Value();
  };
  double off = 0;
  double in_target = 0;
  const std::vector<bool> target_place =
      place_of(target && target->body ? target->name : "", view.scene.joint());
  std::vector<double> by_region(view.scene.joint().regions.size());
  for (const Dose& dose : doses) {
    if (dose.region < by_region.size()) by_region[dose.region] += dose.volume;
    if (!target) continue;
    const double distance = distance_to(*target, dose.tip);
    off += dose.volume * distance;
    if (dose.region < target_place.size() && target_place[dose.region]) in_target += dose.volume;
  }
  if (target) {
    const auto mean = share(off);
    sheet.put("syringe", "given_distance_mm", "mm", mean ? Value(*mean / kMillimetre) : mean,
              "tip to " + target->name + ", mean over the volume given");
    sheet.put("syringe", "in_target", "-", target->body ? share(in_target) : Value(),
              "share of the volume that went into the place of " + target->name);
  }
  for (std::size_t i = 0; i < by_region.size(); ++i)
    if (by_region[i] > 0)
      sheet.put("syringe", "given_ml:" + view.scene.joint().regions[i].name, "ml",
                by_region[i] / kCubicCentimetre, "given into the place of this layer");
}

void put_syringe(Sheet& sheet, const AttemptView& view) {
  sheet.rule({"none, every tick", 0});
  const SyringeTotals& sum = view.measures.syringe;
  const auto when = [&sum](double value) {
    return sum.used ? Value(value) : Value();
  };
  sheet.put("syringe", "given_ml", "ml", when(sum.given / kCubicCentimetre),
            "out of the tip in all, whatever was drawn back");
  sheet.put("syringe", "syringe_s", "s", when(sum.busy),
            "time that it flowed, the barrel sucked or the thumb pressed or pulled");
  sheet.put("syringe", "flow_mean_ml_s", "ml/s",
            sum.flowing > 0 ? Value(sum.given / sum.flowing / kCubicCentimetre) : Value(),
            "volume given over the time that it flowed (more than 1 ul/s)");
  sheet.put("syringe", "flow_peak_ml_s", "ml/s", when(sum.peak_flow / kCubicCentimetre),
            "largest flow");
  sheet.put("syringe", "plunger_peak_n", "N", when(sum.peak_thumb), "largest force on the thumb");
  sheet.put("syringe", "pressure_peak_kpa", "kPa", when(sum.peak_pressure / 1e3),
            "largest pressure in the barrel");
  sheet.put("syringe", "tip_drift_mm", "mm", when(sum.tip_drift / kMillimetre),
            "farthest distance of the tip from where a flow began, while it lasted");
  sheet.put("syringe", "test_dose_ml", "ml",
            sum.pauses > 0 ? Value(sum.test_dose / kCubicCentimetre) : Value(),
            "given before the first pause of 2 s or more; none when nothing came after one");
  sheet.put("syringe", "look_pauses", "count", when(sum.pauses),
            "pauses of 2 s or more between two flows");
  sheet.put("syringe", "aspirations", "count", when(sum.aspirations),
            "times that the barrel's pressure was below -5 kPa for 2 s or more");
  sheet.put("syringe", "aspirated_first", "-", when(sum.aspirated_first ? 1 : 0),
            "1 when one of them came before anything was given");
  put_doses(sheet, view);
}

void put_images(Sheet& sheet, const AttemptView& view) {
  sheet.rule({"none, every picture", 0});
  const auto& course = view.measures.course;
  double inside = 0;
  double visible = 0;
  std::vector<double> contrast;
  std::size_t k = 0;
  for (const ImageSight& sight : view.images) {
    while (k + 1 < course.size() && course[k + 1].time <= sight.time) ++k;
    if (k >= course.size() || !course[k].inside()) continue;
    ++inside;
    visible += sight.visible ? 1 : 0;
    if (sight.contrast_db) contrast.push_back(*sight.contrast_db);
  }
  sheet.put("both", "tip_visible", "-", inside > 0 ? Value(visible / inside) : Value(),
            "share of the pictures in tissue in which the last 5 mm of the shaft, and the last 2 "
            "mm alone, are 4 dB above lines that run beside it; a shaft across the plane: the "
            "disc of 1.5 mm where the tip shows above what is typical of the ring of 2 to 4 mm "
            "around it");
  sheet.put("both", "tip_contrast_median_db", "dB", percentile(contrast, 0.5),
            "that contrast's median");
}

}  // namespace

std::vector<Metric> compute_metrics(const AttemptView& view) {
  Sheet sheet;
  put_course(sheet, view);
  put_hand(sheet, "needle", view.measures.needle, view.measures.needle_left_out);
  put_hand(sheet, "probe", view.measures.probe, view.measures.probe_left_out);
  put_sight(sheet, view);
  put_entry(sheet, view);
  put_goals(sheet, view);
  put_sought(sheet, view);
  put_forces(sheet, view);
  put_syringe(sheet, view);
  put_images(sheet, view);
  return sheet.take();
}

std::vector<std::string> metric_names() {
  const CompiledJoint empty = [] {
    CompiledJoint joint;
    joint.tissues.resize(1);
    joint.regions.resize(kFirstRegion);
    return joint;
  }();
  const Scene scene(std::make_shared<const CompiledJoint>(empty));
  MeterOptions options;
  options.goals.target = Target{"target", Vec3::Zero(), nullptr};
  options.goals.avoid.push_back({});
  options.goals.entry = Vec3::Zero();
  AttemptMeasures nothing;
  nothing.sought.resize(1);
  std::vector<std::string> names{"asked"};  // of whoever leads the attempt (add_asked)
  for (const Metric& m : compute_metrics({scene, options, nothing, {}, {}, true, 0}))
    if (m.name.find(':') == std::string::npos &&
        std::find(names.begin(), names.end(), m.name) == names.end())
      names.push_back(m.name);
  return names;
}

}  // namespace artus
