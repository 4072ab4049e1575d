// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/attempt_meter.h"

#include <utility>

#include "artus/detail/training/metrics/attempt_events.h"
#include "artus/detail/training/metrics/attempt_metrics.h"

namespace artus {
namespace {

void add_raw(std::vector<Metric>& out, const std::vector<TrackPoint>& track,
             const std::shared_ptr<const Scene>& scene, bool needle) {
  RawMotion raw(scene, needle);
  for (const TrackPoint& point : track) raw.add(point.time, pose_of(point));
  for (Metric& m : raw.metrics(needle ? "Needle" : "Probe")) {
    m.rule = motion_rule();
    out.push_back(std::move(m));
  }
}

}  // namespace

AttemptMeter::AttemptMeter(std::shared_ptr<const Scene> scene, MeterOptions options)
    : scene_(std::move(scene)),
      options_(std::move(options)),
      finder_(options_.transducer, options_.image_depth, options_.needle, options_.look),
      needle_(options_.longest),
      probe_(options_.longest),
      forces_(scene_->joint().regions.size()) {}

AttemptMeasures AttemptMeter::measure() const {
  AttemptMeasures out;
  out.needle = smooth(needle_.points());
  out.probe = smooth(probe_.points());
  out.needle_left_out = needle_gate_.left_out();
  out.probe_left_out = probe_gate_.left_out();
  out.course = make_course(*scene_, out.needle);
  out.sights = look_along(*scene_, finder_, out.needle, out.probe);
  look_at_pictures(out.course, images_, out.sights);
  out.layers = forces_.layers();
  out.touches = forces_.touches();
  out.syringe = syringe_.totals();
  out.doses = syringe_.doses();
  StructureSearch search(scene_->joint(), options_.goals.sought, options_.transducer,
                         options_.image_depth);
  for (const TrackPoint& point : out.probe) search.look(*scene_, point.time, pose_of(point));
  out.sought.assign(search.sought().begin(), search.sought().end());
  const AttemptView view{
      *scene_, options_, out, images_, coloured_, forces_.empty(), forces_.touch_count()};
  out.metrics = compute_metrics(view);
  out.events = find_events(view);
  add_raw(out.raw, out.needle, scene_, true);
  add_raw(out.raw, out.probe, nullptr, false);
  return out;
}

}  // namespace artus
