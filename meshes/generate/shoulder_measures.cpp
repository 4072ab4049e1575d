// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/shoulder_measures.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/units.h"
#include "artus/detail/meshes/generate/scapular_frame.h"

namespace artus {
namespace {

constexpr double kStep = kMeasureStep;

double groove_depth(const Field& bone) {
  const Vec3 groove = Vec3(-17.2, -20, 0).normalized();
  const auto radius = [&](double degrees) {
    const Vec3 out = Eigen::AngleAxisd(degrees * kDegree, Vec3::UnitZ()) * groove;
    return last_inside(Vec3::Zero(), out, 40e-3, bone);
  };
  double lateral = 0;
  double medial = 0;
  for (double degrees = 2; degrees < 24; ++degrees) {
    lateral = std::max(lateral, radius(degrees));
    medial = std::max(medial, radius(-degrees));
  }
  return std::min(lateral, medial) - radius(0);
}

/// From the edge of the cartilage to the edge of the facet under the supraspinatus.
double footprint_width(const ScapularFrame& frame, const Field& bone, const Field& cartilage,
                       const Field& tendon) {
  double width = 0;
  Vec3 before = Vec3::Zero();
  for (double degrees = 25; degrees < 75; degrees += 0.25) {
    const Vec3 out = ScapularFrame::outward(degrees);
    const double on_bone = last_inside(frame.at(0, 2, 0), out, 40e-3, bone);
    const Vec3 p = frame.at(0, 2, 0) + on_bone * out;
    const Vec3 over = p + 0.1e-3 * out;
    const bool inserts = cartilage(over) >= 0 && tendon(over) < 0;
    if (inserts && before.norm() > 0) width += (p - before).norm();
    before = inserts ? p : Vec3(Vec3::Zero());
  }
  return width;
}

double acromiohumeral_distance(const ScapularFrame& frame, const Field& scapula,
                               const Field& bone) {
  double least = 1;
  for (double u = -6; u <= 10; u += 2)
    for (double v = -6; v <= 22; v += 2) {
      const Vec3 foot = frame.at(u, v, 0);
      const double head = last_inside(foot, Vec3::UnitZ(), 30e-3, bone);
      for (double z = head + 1e-3; head > 0 && z < 50e-3; z += kStep)
        if (scapula(foot + z * Vec3::UnitZ()) < 0) {
          least = std::min(least, z - head);
          break;
        }
    }
  return least;
}

}  // namespace

std::vector<Measure> measure_shoulder(const ShoulderSize& size) {
  const std::vector<Solid> solids = make_shoulder(size);
  const ScapularFrame frame(size.head_radius);
  const Field bone = field_of(solids, "humerus");
  const Field cartilage = field_of(solids, "humeral_cartilage");
  const Field supraspinatus = field_of(solids, "supraspinatus_tendon");
  const std::vector<Field> head{bone, cartilage};
  const auto over_head = [&](const Field& tendon, const Vec3& out) {
    return length_inside(15e-3 * out, out, 25e-3, tendon, head) / kMillimetre;
  };
  const Vec3 up = ScapularFrame::outward(12);
  const Vec3 back = Vec3(-6, 24.4, 7.2).normalized();
  const Vec3 front = Vec3(8, -26, -3).normalized();
  const Vec3 facet = frame.at(-20, 2, 0);
  const Vec3 below_belly = frame.at(60, 7, -5);
  return {
      {"radius of the humeral head", size.head_radius / kMillimetre, 19, 28, "[Iannotti1992]"},
      {"top of the head above the superior facet",
       (size.head_radius - last_inside(facet, Vec3::UnitZ(), 30e-3, bone)) / kMillimetre, 3.7, 9.3,
       "[NormalGH] 6.5 +- 1.4, 2 SD"},
      {"acromiohumeral distance",
       acromiohumeral_distance(frame, field_of(solids, "scapula"), bone) / kMillimetre, 3.3, 15.7,
       "[NormalGH] 9.5 +- 3.1, 2 SD"},
      {"depth of the bicipital groove", groove_depth(bone) / kMillimetre, 3.8, 6.3, "[Groove2024]"},
      {"cartilage of the head, in its middle",
       length_inside(15e-3 * Vec3(0.64, 0.30, 0.71).normalized(),
                     Vec3(0.64, 0.30, 0.71).normalized(), 15e-3, cartilage, {bone}) /
           kMillimetre,
       1.2, 3.2, "[CartilageGH] 2.2 +- 0.5, 2 SD"},
      {"supraspinatus tendon over the head", over_head(supraspinatus, up), 3.9, 6.6,
       "[Karthikeyan2014] 4.9 and 5.6; assumed: 1 mm about both"},
      {"infraspinatus tendon over the head",
       over_head(field_of(solids, "infraspinatus_tendon"), back), 3.4, 5.9,
       "[Karthikeyan2014] 4.4 and 4.9; assumed: 1 mm about both"},
      {"subscapularis tendon over the head",
       over_head(field_of(solids, "subscapularis_tendon"), front), 2.8, 5.4,
       "[Karthikeyan2014] 3.8 and 4.4; assumed: 1 mm about both"},
      {"footprint of the supraspinatus, medial to lateral",
       footprint_width(frame, bone, cartilage, supraspinatus) / kMillimetre, 12.5, 16.9,
       "[Karthikeyan2014] 13.5 and 14.9, [Curtis2006] 16; assumed: 1 mm about them"},
      {"supraspinatus in the fossa",
       length_inside(below_belly, Vec3::UnitZ(), 60e-3, field_of(solids, "supraspinatus"), {}) /
           kMillimetre,
       13, 21.4, "[Han2012] 17.2 +- 2.1, 2 SD"},
      {"subacromial bursa",
       length_inside(15e-3 * up, up, 25e-3, field_of(solids, "subacromial_bursa"), {}) /
           kMillimetre,
       0, 1, "[Prev] below 1 in 71 of 200"}};
}

}  // namespace artus
