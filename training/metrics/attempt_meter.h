// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <vector>

#include "artus/detail/training/metrics/force_layers.h"
#include "artus/detail/training/metrics/goals.h"
#include "artus/detail/training/metrics/image_sight.h"
#include "artus/detail/training/metrics/metric.h"
#include "artus/detail/training/metrics/motion_gate.h"
#include "artus/detail/training/metrics/needle_course.h"
#include "artus/detail/training/metrics/raw_motion.h"
#include "artus/detail/training/metrics/sight_course.h"
#include "artus/detail/training/metrics/structure_search.h"
#include "artus/detail/training/metrics/syringe_course.h"
#include "artus/detail/training/metrics/tip_sight.h"

namespace artus {

/// What an attempt is measured with.
struct MeterOptions {
  Transducer transducer;
  double image_depth = 40e-3;  ///< m
  NeedleShape needle;
  Look look = Look::clinical;  ///< of the picture in which the tip is looked for
  Goals goals;
  double longest = 1800;  ///< s that are kept
};

/// Something that happened at a moment, for the report's clips and the record's events.
struct AttemptEvent {
  double time = 0;     ///< s
  std::string kind;    ///< "contact", "unseen", "bone", "avoid:<name>", "fatal:<name>", "pass",
                       ///< "placed", "idle", "left_in", "flow", "misplaced", "pressure", "fastest",
                       ///< "found", "not_found"
  std::string region;  ///< at the tip
  double value = 0;    ///< mm, N, s, ml, kPa or ml/s, as the kind says
  std::string text;    ///< with the cause, from the truth
};

/// Everything about an attempt that can be computed from its stream.
struct AttemptMeasures {
  std::vector<TrackPoint> needle;  ///< 20 Hz
  std::vector<TrackPoint> probe;
  std::vector<CoursePoint> course;
  std::vector<std::optional<TipSight>> sights;
  std::vector<LayerForce> layers;
  std::vector<FeltTouch> touches;
  SyringeTotals syringe;
  std::vector<Dose> doses;
  std::vector<Sought> sought;
  std::uint64_t needle_left_out = 0;  ///< poses that no hand makes (MotionGate)
  std::uint64_t probe_left_out = 0;
  std::vector<Metric> metrics;
  std::vector<Metric> raw;  ///< PerkTutor's rows from the 20 Hz tracks
  std::vector<AttemptEvent> events;
};

/// Measures an attempt while it runs. Poses and forces may come from the tick, pictures' sights and
/// flow from other threads' own meters: no number depends on how these streams are interleaved, so
/// a session, its replay and its assessment give the same digits. What is added only goes into
/// memory taken at the start; everything else is computed by measure().
class AttemptMeter {
 public:
  /// Requires: a scene, valid transducer.
  AttemptMeter(std::shared_ptr<const Scene> scene, MeterOptions options);

  ARTUS_REALTIME void add_needle(double time, const Vec3& p, const Eigen::Quaterniond& q) noexcept {
    needle_gate_.add(time, p, q, needle_);
  }
  ARTUS_REALTIME void add_probe(double time, const Vec3& p, const Eigen::Quaterniond& q) noexcept {
    probe_gate_.add(time, p, q, probe_);
  }
  ARTUS_REALTIME void add_felt(const FeltTick& tick) noexcept { forces_.add(tick); }
  ARTUS_REALTIME void add_syringe(const SyringeTick& tick) noexcept { syringe_.add(tick); }
  void add_sight(const ImageSight& sight) { images_.push_back(sight); }
  /// A picture of colour or power Doppler at `time`, s.
  void add_coloured(double time) { coloured_.push_back(time); }

  [[nodiscard]] const MeterOptions& options() const noexcept { return options_; }

  /// All numbers of what came so far. Cost: linear in points.
  [[nodiscard]] AttemptMeasures measure() const;

 private:
  std::shared_ptr<const Scene> scene_;
  MeterOptions options_;
  TipSightFinder finder_;
  PoseSampler needle_;
  PoseSampler probe_;
  MotionGate needle_gate_;
  MotionGate probe_gate_;
  ForceLayers forces_;
  SyringeCourse syringe_;
  std::vector<ImageSight> images_;
  std::vector<double> coloured_;  // s
};

}  // namespace artus
