// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/leg_measures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "artus/detail/core/units.h"
#include "artus/detail/meshes/generate/solids/millimetres.h"

namespace artus {
namespace {

constexpr double kCoarse = 0.25e-3;  // m between the places that are looked at

/// Between the highest points of both ridges and the deepest of the groove between them, degrees,
/// in the transverse plane at `z`; forward is -y.
double sulcus_angle(const Field& surface, const Millimetres& mm, double z) {
  const auto front = [&](double x) {
    return last_inside(mm.at(x, 0, z), -Vec3::UnitY(), mm.length(45), surface);
  };
  Vec3 lateral = Vec3::Zero();
  Vec3 medial = Vec3::Zero();
  Vec3 groove(0, 1, 0);
  for (double x = -26; x <= 26; x += 0.5) {
    const double y = front(x);
    const Vec3 at(mm.at(x, 0, z).x(), y, 0);
    if (x < -8 && y > lateral.y()) lateral = at;
    if (x > 8 && y > medial.y()) medial = at;
    if (std::abs(x) <= 8 && y < groove.y()) groove = at;
  }
  const Vec3 a = (lateral - groove).normalized();
  const Vec3 b = (medial - groove).normalized();
  return std::acos(a.dot(b)) / kDegree;
}

/// How far the labrum runs out over the head from the socket's bone, in the plane along the neck,
/// m.
double labrum_width(const std::vector<Solid>& solids, const HipSize& size) {
  const Field head = unite(field_of(solids, "femur"), field_of(solids, "femoral_cartilage"), 0);
  const Field labrum = subtract(field_of(solids, "acetabular_labrum"), head, 0);
  const Field pelvis = field_of(solids, "pelvis");
  const Vec3 forward = -Vec3::UnitY();
  const Vec3 along = Vec3(0.8, 0, 0.6);
  double first = 1;
  double most = -1;
  for (double t = -0.3; t < 0.6; t += 0.002) {
    const Vec3 out = (forward + t * along).normalized();
    const double radius = size.head_radius + 2.6 * size.cartilage;
    if (labrum(radius * out) >= 0 || pelvis(radius * out) < 0) continue;
    first = std::min(first, std::atan(t) * radius);
    most = std::max(most, std::atan(t) * radius);
  }
  return most - first;
}

std::vector<Measure> measure_knee_bones(const std::vector<Solid>& solids, const Millimetres& mm) {
  const auto field = [&](const char* name) {
    return field_of(solids, name);
  };
  const Field femur = field("femur");
  const Field cartilage = field("femoral_cartilage");
  const Field patella = field("patella");
  const Field patellar_cartilage = field("patellar_cartilage");
  const Field femur_with = unite(femur, cartilage, 0);
  const Vec3 back = Vec3::UnitY();
  const Vec3 down = -Vec3::UnitZ();
  const auto thickness = [&](const Vec3& from, const Vec3& along, const char* name,
                             const std::vector<Field>& before) {
    return length_inside(from, along, mm.length(40), field(name), before) / kMillimetre;
  };
  const Vec3 half = mm.at(46, 40, 24);
  return {{"width of the femur at its condyles",
           width_along(femur, mm.at(0, 4, 8), half, 0) / kMillimetre, 58.4, 82,
           "[Hussain2013] women 64.5 +- 3.1, men 74.9 +- 3.5, 2 SD"},
          {"depth of the femur at its condyles",
           width_along(femur, mm.at(0, 4, 8), mm.at(46, 42, 18), 1) / kMillimetre, 50.8, 70.8,
           "[Hussain2013] women 57.3 +- 3.3, men 64.0 +- 3.4, 2 SD"},
          {"width of the tibia at its plateau",
           width_along(field("tibia"), mm.at(0, 3, -28), mm.at(46, 36, 8), 0) / kMillimetre, 61.2,
           87.7, "[Tibia2022] women of Korea 67.6 +- 3.2 to men of America 80.3 +- 3.7, 2 SD"},
          {"angle of the trochlear sulcus, degrees, on cartilage", sulcus_angle(femur_with, mm, 18),
           135.1, 157.1, "[Sulcus2003] 146.1 +- 5.5, 2 SD"},
          {"cartilage in the trochlear groove",
           thickness(mm.at(-1, -10, 18), -back, "femoral_cartilage", {femur}), 2.2, 4.6,
           "[Trochlea2021] 3.17 by ultrasound, 3.61 by MRI; assumed: 1 mm about both"},
          {"cartilage of the medial condyle, below",
           thickness(mm.at(19.5, 4, 0), down, "femoral_cartilage", {femur}), 1, 3.4,
           "[Trochlea2021] 1.95 by ultrasound, 2.35 by MRI; assumed: 1 mm about both"},
          {"width of the patella",
           width_along(patella, mm.at(-1, -42, 18), mm.at(32, 14, 28), 0) / kMillimetre, 35.2, 54.4,
           "[PatellaSize] 44.8 +- 4.8, 2 SD"},
          {"height of the patella",
           width_along(patella, mm.at(-1, -42, 18), mm.at(32, 14, 28), 2) / kMillimetre, 26.8, 42.1,
           "[PatellaSize] 34.4 +- 3.8, 2 SD; 42.1 the mean of men elsewhere"},
          {"thickness of the patella with its cartilage",
           length_inside(mm.at(-1, -60, 19), back, mm.length(40),
                         unite(patella, patellar_cartilage, 0), {femur_with}) /
               kMillimetre,
           17.8, 27, "[PatellaSize] 22.4 +- 2.3, 2 SD"},
          {"cartilage of the patella, at its ridge",
           thickness(mm.at(-1, -45, 20), back, "patellar_cartilage", {patella, femur_with}), 1.5,
           6.7, "[Patella2013] 4.1 +- 1.3, 2 SD"}};
}

/// The height of the middle of what two solids share within `half` of `centre`, m.
double height_of_overlap(const Field& a, const Field& b, const Vec3& centre, const Vec3& half) {
  double sum = 0;
  double n = 0;
  Vec3 d = Vec3::Zero();
  for (d.x() = -half.x(); d.x() <= half.x(); d.x() += kCoarse)
    for (d.y() = -half.y(); d.y() <= half.y(); d.y() += 4 * kCoarse)
      for (d.z() = -half.z(); d.z() <= half.z(); d.z() += 4 * kCoarse) {
        if (a(centre + d) >= 0 || b(centre + d) >= 0) continue;
        sum += centre.z() + d.z();
        ++n;
      }
  return n > 0 ? sum / n : 0;
}

std::vector<Measure> measure_knee_soft_tissue(const std::vector<Solid>& solids,
                                              const Millimetres& mm) {
  const auto field = [&](const char* name) {
    return field_of(solids, name);
  };
  const Vec3 back = Vec3::UnitY();
  const auto thickness = [&](const Vec3& from, const Vec3& along, const char* name) {
    return length_inside(from, along, mm.length(40), field(name), {}) / kMillimetre;
  };
  const Vec3 tendon = Vec3(0, 0.97, 0.25).normalized();
  const double insertion = height_of_overlap(field("medial_collateral_ligament"), field("femur"),
                                             mm.at(40, 2, 16), mm.at(4, 8, 12));
  const double joint_line =
      -last_inside(mm.at(19.5, 4, 0), -Vec3::UnitZ(), mm.length(40), field("femoral_cartilage"));
  return {
      {"patellar tendon, in its middle", thickness(mm.at(-1, -60, -20), tendon, "patellar_tendon"),
       3, 6.6, "[Eze2019] men 4.8 +- 0.9, 2 SD"},
      {"width of the patellar tendon",
       length_inside(mm.at(-30, -44, -18), Vec3::UnitX(), mm.length(60), field("patellar_tendon"),
                     {}) /
           kMillimetre,
       14.8, 30, "[Eze2019] 22.4 +- 3.8, 2 SD"},
      {"suprapatellar recess, from its lower to its upper end",
       width_along(field("suprapatellar_recess"), mm.at(-1, -31, 50), mm.at(6, 12, 34), 2) /
           kMillimetre,
       4.4, 51.2, "[Schmidt2004] least to most of 204 healthy knees"},
      {"popliteal artery",
       length_inside(mm.at(0, 22, 15), back, mm.length(20), field("popliteal_artery"), {}) /
           kMillimetre,
       4.2, 6.2, "[Jager1985] 5.2; assumed: 1 mm about it"},
      {"middle of the femoral insertion of the medial collateral ligament above the joint",
       (insertion - joint_line) / kMillimetre, 21.9, 40.3, "[Liu2010] 31.1 +- 4.6, 2 SD"}};
}

}  // namespace

std::vector<Measure> measure_knee(const KneeSize& size) {
  const std::vector<Solid> solids = make_knee(size);
  const Millimetres mm = Millimetres::of_scale(size.scale);
  std::vector<Measure> all = measure_knee_bones(solids, mm);
  for (Measure& m : measure_knee_soft_tissue(solids, mm)) all.push_back(std::move(m));
  return all;
}

std::vector<Measure> measure_hip(const HipSize& size) {
  const std::vector<Solid> solids = make_hip(size);
  const Millimetres mm(size.head_radius);
  const auto field = [&](const char* name) {
    return field_of(solids, name);
  };
  const Field femur = field("femur");
  const Field cartilage = field("femoral_cartilage");
  // The neck's axis runs from the head's centre through the middle of the neck's sections.
  const auto middle = [&](double x, const Vec3& across) {
    const Vec3 at = mm.at(x, 0.12 * -x, 0.72 * x);
    const double up = last_inside(at, across, mm.length(40), femur);
    const double low = last_inside(at, -across, mm.length(40), femur);
    return Vec3(at + 0.5 * (up - low) * across);
  };
  const Vec3 neck = middle(-24, Vec3(-0.58, 0, 0.81).normalized());
  const Vec3 section = middle(-24, Vec3::UnitY());
  const double shaft_angle = 90 + std::atan2(-neck.z(), -neck.x()) / kDegree;
  const double version = std::atan2(section.y(), -section.x()) / kDegree;
  const Vec3 forward = -Vec3::UnitY();
  const Vec3 on_neck = mm.at(-19, 0, -14.5);
  const double bone = last_inside(on_neck, forward, mm.length(40), femur);
  const double capsule = last_inside(on_neck, forward, mm.length(40), field("hip_capsule"));
  const Vec3 head = mm.at(-7, 0, -3);
  const auto across = [&](const Vec3& from, const Vec3& direction, const char* name) {
    return length_inside(from, direction, mm.length(30), field(name), {}) / kMillimetre;
  };
  return {{"angle between neck and shaft, degrees", shaft_angle, 119.3, 139.6,
           "[NeckShaft2023] 129.5 +- 5.1, 2 SD"},
          {"anteversion of the neck, degrees", version, 7.4, 20.4,
           "[Torsion2016] the middle half of 1070 femora"},
          {"bone of the neck to the outer side of the capsule, the recess full",
           (capsule - bone) / kMillimetre, 4, 9, "[HipCapsule] 4 to 9, 6.4 in the mean"},
          {"capsule over the neck", across(mm.at(-19, -10, -14.5), forward, "hip_capsule"), 2, 4,
           "[HipKey] 2 to 4 each layer"},
          {"cartilage of the head, at its dome",
           length_inside(0.5 * size.head_radius * Vec3(0.75, 0.3, 0.59).normalized(),
                         Vec3(0.75, 0.3, 0.59).normalized(), mm.length(20), cartilage, {femur}) /
               kMillimetre,
           1, 3, "assumed: 1 mm about 2"},
          {"labrum beyond the socket's bone, in front", labrum_width(solids, size) / kMillimetre,
           0.1, 10.5, "[Labrum2001] 5.3 +- 2.6, 2 SD"},
          {"femoral artery", across(mm.at(22, -36, 10), forward, "femoral_artery"), 7.2, 9.2,
           "[Jager1985] 8.2; assumed: 1 mm about it"},
          {"femoral nerve, front to back", across(mm.at(10.5, -40, 10), forward, "femoral_nerve"),
           1.5, 4.7, "[Gruber2003] 3.1 +- 0.8, 2 SD"},
          {"femoral nerve, side to side",
           across(mm.at(0, -49.4, 10), Vec3(1, -0.15, 0).normalized(), "femoral_nerve"), 5.6, 14,
           "[Gruber2003] 9.8 +- 2.1, 2 SD"},
          {"head under the skin, in front",
           (last_inside(head, forward, mm.length(90), field("body")) -
            last_inside(head, forward, mm.length(90), femur)) /
               kMillimetre,
           20, 60, "assumed: a slim adult to a stout one"}};
}

}  // namespace artus
