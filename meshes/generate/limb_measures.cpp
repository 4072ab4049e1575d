// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/limb_measures.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "artus/detail/core/units.h"
#include "artus/detail/meshes/generate/solids/millimetres.h"

namespace artus {
namespace {

constexpr double kFine = 0.4e-3;  // m between the places that are looked at for a width
constexpr double kSquareMillimetre = 1e-6;

/// Takes lengths, areas and thicknesses of a joint's solids; what stands before a solid in the
/// list has its share.
class Ruler {
 public:
  Ruler(std::vector<Solid> solids, double scale)
      : mm_(Millimetres::of_scale(scale)), solids_(std::move(solids)) {}

  [[nodiscard]] Field field(const std::string& name) const { return field_of(solids_, name); }
  [[nodiscard]] const Millimetres& mm() const { return mm_; }

  /// mm, of the solid without what stands before it, along a line of 30 mm.
  [[nodiscard]] double thickness(const std::string& name, const Vec3& from_mm,
                                 const Vec3& along) const {
    std::vector<Field> before;
    for (const Solid& s : solids_) {
      if (s.name == name) break;
      if (s.name != "body") before.push_back(s.field);
    }
    return length_inside(place(from_mm), along.normalized(), mm_.length(30), field(name), before) /
           kMillimetre;
  }

  /// mm2, across `along`.
  [[nodiscard]] double section(const std::string& name, const Vec3& at_mm,
                               const Vec3& along) const {
    return area_across(field(name), place(at_mm), along.normalized(), mm_.length(6)) /
           kSquareMillimetre;
  }

  /// mm, within `half_mm` of `centre_mm`.
  [[nodiscard]] double width(const std::string& name, const Vec3& centre_mm, const Vec3& half_mm,
                             int axis) const {
    return width_along(field(name), place(centre_mm), place(half_mm), axis, kFine) / kMillimetre;
  }

  /// mm from the line's beginning.
  [[nodiscard]] double last(const std::string& name, const Vec3& from_mm, const Vec3& along) const {
    return last_inside(place(from_mm), along, mm_.length(60), field(name)) / kMillimetre;
  }

 private:
  [[nodiscard]] Vec3 place(const Vec3& p) const { return mm_.at(p.x(), p.y(), p.z()); }

  Millimetres mm_;
  std::vector<Solid> solids_;
};

const Vec3 kForward = -Vec3::UnitY();
const Vec3 kDown = -Vec3::UnitZ();

/// Of the joint's end of the radius, how much lower its styloid lies than its ulnar edge, degrees.
double radial_inclination(const Ruler& ruler) {
  const auto lowest = [&](double x) {
    return ruler.last("radius", Vec3(x, 1, 10), kDown);
  };
  double tip = -23;
  for (double x = -26; x < -18; x += 0.25)
    if (lowest(x) > lowest(tip)) tip = x;
  constexpr double kUlnarEdge = 2.6;  // mm, beside the notch for the ulna
  return std::atan2(lowest(tip) - lowest(kUlnarEdge), kUlnarEdge - tip) / kDegree;
}

/// Of the ligament in its middle plane, what lies between both bones, mm.
double talofibular_length(const Ruler& ruler) {
  const Field ligament = ruler.field("anterior_talofibular_ligament");
  const Field fibula = ruler.field("fibula");
  const Field talus = ruler.field("talus");
  double sum = 0;
  Vec3 before = Vec3::Zero();
  // From one bone's surface to the other's along the stations of the ligament.
  const std::vector<Vec3> course{{-24, -1, -1}, {-19, -7.4, -0.5}, {-12.5, -13, 0.5}};
  for (std::size_t i = 0; i + 1 < course.size(); ++i)
    for (double t = 0; t < 1; t += 0.005) {
      const Vec3 at = course[i] + t * (course[i + 1] - course[i]);
      const Vec3 p = ruler.mm().at(at.x(), at.y(), at.z());
      const bool is_free = fibula(p) > 0 && talus(p) > 0;
      if (is_free && before != Vec3::Zero()) sum += (p - before).norm();
      before = is_free ? p : Vec3::Zero();
    }
  return sum / kMillimetre;
}

}  // namespace

std::vector<Measure> measure_elbow(const ElbowSize& size) {
  const Ruler ruler(make_elbow(size), size.scale);
  const Vec3 inward = Vec3::UnitX();
  const auto extensor = [&](double y, double z) {
    return ruler.thickness("common_extensor_tendon", Vec3(-36, y, z), inward);
  };
  return {
      {"width of the humerus over the epicondyles",
       ruler.width("humerus", Vec3(0, 4, 3), Vec3(40, 8, 8), 0), 49.2, 68.8,
       "[DistalHumerus2024] 59.0 +- 4.9, 2 SD"},
      {"radius of the capitellum, in front", ruler.last("humerus", Vec3(-13, -0.5, 0), kForward),
       8.8, 14.4, "[Sabo2011] 11.6 +- 1.4, 2 SD"},
      {"diameter of the head of the radius",
       ruler.width("radius", Vec3(-13, -19, 0), Vec3(14, 1, 14), 0), 19, 25,
       "[RadialHead2022] 22; assumed: 3 mm about it"},
      {"cartilage of the capitellum, in front",
       ruler.thickness("humeral_cartilage", Vec3(-13, -6, 3), kForward), 0.4, 1.8,
       "[HumeralCartilage] 0.4 to 1.8"},
      {"common extensor tendon over the epicondyle", extensor(-2.5, 3.1), 3.6, 5.6,
       "[Ustuner2013] 4.60; assumed: 1 mm about it"},
      {"common extensor tendon over the joint", extensor(-12, 1.8), 2.55, 4.55,
       "[Ustuner2013] 3.55; assumed: 1 mm about it"},
      {"common extensor tendon over the head of the radius", extensor(-20, 0.6), 2.17, 4.17,
       "[Ustuner2013] 3.17; assumed: 1 mm about it"},
      {"ulnar nerve at the epicondyle, mm2",
       ruler.section("ulnar_nerve", Vec3(21.9, 14, 7), Vec3(0.1, 0.12, 1)), 3.9, 10.7,
       "[Bae2021] 7.31 +- 1.69, 2 SD"},
      {"median nerve in front of the elbow, mm2",
       ruler.section("median_nerve", Vec3(11, -28, 16), Vec3(0.2, 0.45, 1)), 4.1, 13.8,
       "[Bae2021] 8.96 +- 2.41, 2 SD"},
      {"radial nerve in front of the elbow, mm2",
       ruler.section("radial_nerve", Vec3(-15, -19, 18), Vec3(0, 0.55, 1)), 3.9, 10.7,
       "[Bae2021] 7.26 +- 1.70, 2 SD"},
      {"olecranon bursa", ruler.thickness("olecranon_bursa", Vec3(5, 4, -36), Vec3::UnitZ()), 0, 1,
       "assumed: a film"}};
}

std::vector<Measure> measure_wrist(const WristSize& size) {
  const Ruler ruler(make_wrist(size), size.scale);
  const Vec3 back = Vec3::UnitY();
  const Vec3 along = Vec3::UnitZ();
  return {
      {"width of the radius at its end, from the front",
       ruler.width("radius", Vec3(-10, 1, 2), Vec3(20, 10, 4), 0), 24.7, 29.4,
       "[Dawadi2021] 27.05 +- 1.16, 2 SD"},
      {"depth of the radius at its end, from the side",
       ruler.width("radius", Vec3(-10, 1, 2), Vec3(20, 14, 4), 1), 16.4, 21,
       "[Dawadi2021] 18.7 +- 1.12, 2 SD"},
      {"inclination of the radius, degrees", radial_inclination(ruler), 16.5, 31.5,
       "[Hadi2013] 23.99 +- 3.75, 2 SD"},
      {"ulnar variance",
       ruler.last("ulna", Vec3(14, 2, 10), kDown) - ruler.last("radius", Vec3(2.6, 1, 10), kDown),
       -4.5, 3.6, "[Hadi2013] -0.45 +- 2.03, 2 SD"},
      {"median nerve at the inlet of the tunnel, mm2",
       ruler.section("median_nerve", Vec3(-5.8, -13.6, -16), along), 5.2, 9.6,
       "[Mani2011] 7.4 +- 1.1, 2 SD"},
      {"carpal tunnel, from the palm's side to the back, with its tendons",
       length_inside(ruler.mm().at(-2, -22, -20), back, ruler.mm().length(30),
                     ruler.field("carpal_tunnel"), {}) /
           kMillimetre,
       8.2, 12.6, "[Mani2011] 10.4 +- 1.1, 2 SD"},
      {"ulnar nerve, mm2", ruler.section("ulnar_nerve", Vec3(14.8, -10.6, -6), along), 2.5, 7.7,
       "[Bae2021] 5.09 +- 1.29, 2 SD"},
      {"radial artery",
       std::sqrt(ruler.section("radial_artery", Vec3(-19, -11, 25), along) /
                 (std::numbers::pi / 4)),
       1.5, 3.1, "[Beniwal2014] 2.33 +- 0.4, 2 SD"},
      {"ulnar artery",
       std::sqrt(ruler.section("ulnar_artery", Vec3(12.6, -10.8, 20), along) /
                 (std::numbers::pi / 4)),
       1.6, 3.1, "[Beniwal2014] 2.36 +- 0.39, 2 SD"},
      {"superficial radial nerve, mm2",
       ruler.section("radial_nerve", Vec3(-29.2, 4, 6), Vec3(0, -0.15, 1)), 0.8, 4.2,
       "[Bae2021] in the forearm 2.50 +- 0.86, 2 SD"},
      {"retinaculum of the first compartment",
       ruler.thickness("first_compartment_retinaculum", Vec3(-36, 1.2, 1), Vec3::UnitX()), 0.2, 1.7,
       "[DeQuervainUS] 0.35 +- 0.07 in the healthy to 0.94 +- 0.37 in disease, 2 SD"},
      {"length of that retinaculum",
       ruler.width("first_compartment_retinaculum", Vec3(-27, 1, 2), Vec3(4, 7, 14), 2), 8.4, 21.2,
       "[FirstCompartment2024] 14.8 +- 3.2, 2 SD"}};
}

std::vector<Measure> measure_ankle(const AnkleSize& size) {
  const Ruler ruler(make_ankle(size), size.scale);
  const Vec3 up = Vec3::UnitZ();
  const Vec3 outward(0, 0.97, 0.24);
  return {
      {"radius of the talar dome", ruler.last("talus", Vec3(0, 0, 0), up), 15.5, 25.9,
       "[Hayes2006] 20.7 +- 2.6, 2 SD"},
      {"width of the talar dome, in its middle",
       ruler.width("talus", Vec3(0, 0, 15), Vec3(20, 1, 2), 0), 24.9, 30.9,
       "[Hayes2006] 27.9; assumed: 3 mm about it"},
      {"cartilage of the talar dome", ruler.thickness("talar_cartilage", Vec3(0, 0, 10), up), 0.55,
       1.79, "[Sugimoto2005] women 1.11 +- 0.28, men 1.35 +- 0.22, 2 SD"},
      {"cartilage of the tibia", ruler.thickness("tibial_cartilage", Vec3(0, 0, 10), up), 0.88,
       1.44, "[Millington2007] 1.16 +- 0.14, 2 SD"},
      {"Achilles tendon above the heel",
       ruler.thickness("achilles_tendon", Vec3(0, 56, 30), kForward), 3.13, 6.13,
       "[Mohammed2023] 4.63; assumed: 1.5 mm about it"},
      {"width of the Achilles tendon there",
       ruler.width("achilles_tendon", Vec3(0, 47.8, 28), Vec3(14, 3, 1), 0), 10.2, 14.2,
       "[Mohammed2023] 12.20; assumed: 2 mm about it"},
      {"width of the Achilles tendon at its insertion",
       ruler.width("achilles_tendon", Vec3(0, 55, -12), Vec3(16, 8, 8), 0), 19.8, 23.8,
       "[Mohammed2023] 21.85; assumed: 2 mm about it"},
      {"retrocalcaneal bursa", ruler.thickness("retrocalcaneal_bursa", Vec3(0, 56, 10.6), -outward),
       0.3, 1, "assumed: a film, as fluid is seen in a quarter of healthy heels [Schmidt2004]"},
      {"tibial nerve above the malleolus, mm2",
       ruler.section("tibial_nerve", Vec3(15.4, 25.5, 16), Vec3(-0.2, 0.12, 1)), 8.9, 13.3,
       "[Singh2022] 11.1 +- 1.1, 2 SD"},
      {"tibialis posterior tendon at the malleolus, mm2",
       ruler.section("tibialis_posterior_tendon", Vec3(22, 9.5, 10), Vec3(-0.15, 0.4, 1)), 9.6,
       28.8, "[TibialisPosterior2000] 19.2 +- 4.8, 2 SD"},
      {"anterior talofibular ligament, between both bones", talofibular_length(ruler), 12.6, 20,
       "[Talofibular2019] 16.27 +- 1.86 with the toes down, 2 SD"}};
}

}  // namespace artus
