// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>

#include "artus/detail/meshes/generate/hip.h"
#include "artus/detail/meshes/generate/solids/millimetres.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

/// A station of a flat strand: x, y, z, half width, half thickness, mm.
using StrandStation = std::array<double, 5>;

struct Strand {
  const char* name;
  Vec3 normal;
  std::vector<StrandStation> stations;
  double facet_size = 3.4e-3;       // m
  double facet_distance = 0.15e-3;  // m
  double power = 2;                 // of its section, as of make_ribbon
};

Solid make_strand(const Millimetres& mm, const Strand& strand) {
  std::vector<RibbonStation> ribbon;
  for (const auto& s : strand.stations)
    ribbon.push_back({mm.at(s[0], s[1], s[2]), strand.normal, mm.length(s[3]), mm.length(s[4])});
  const auto& inner = strand.stations.at(strand.stations.size() / 2);
  return {strand.name,
          make_ribbon(ribbon, strand.power),
          mm.at(inner[0], inner[1], inner[2]),
          mm.length(260),
          strand.facet_size,
          strand.facet_distance};
}

// Iliopsoas on the capsule with its tendon behind and medial in it, rectus femoris lateral of it;
// over them sartorius and tensor under the skin [ESSRhip].
std::vector<Strand> strands_before_the_hip() {
  const Vec3 oblique = Vec3(-0.35, -0.93, 0).normalized();
  return {{"iliopsoas_tendon",
           Vec3(0.1, -0.75, -0.6).normalized(),
           {{17, -34, 62, 3, 0.5},
            {15, -35, 38, 4.5, 1.6},
            {12, -34.5, 16, 5, 2.3},
            {7, -34.5, 0, 5, 2.4},
            {-3, -29, -22, 4.5, 2.3},
            {-17, -10, -44, 4, 2},
            {-30, 12, -58, 4, 1.6},
            {-35, 20, -61, 3, 0.8}},
           2.3e-3,
           0.09e-3},
          {"iliopsoas",
           Vec3(0.1, -1, 0),
           {{12, -28, 110, 20, 13},
            {10, -36, 66, 19, 11},
            {7, -39.5, 34, 17, 10},
            {4, -40, 12, 17, 9.5},
            {0, -39, -8, 16, 9.5},
            {-7, -31, -28, 13, 9},
            {-20, -11, -48, 9, 6},
            {-31, 8, -60, 4, 1.5}}},
          {"rectus_femoris_tendon",
           oblique,
           {{-2, -25, 39, 4, 1.2},
            {-6, -32, 30, 5, 2.4},
            {-13, -38.5, 14, 5, 2.2},
            {-20, -41.5, -4, 5, 1.6},
            {-25, -43, -24, 5, 0.8},
            {-28, -43.5, -46, 4, 0.3}},
           2.3e-3,
           0.09e-3},
          {"rectus_femoris",
           oblique,
           {{-9, -37, 20, 4, 0.6},
            {-15, -41, 6, 9, 3},
            {-21, -43, -12, 13, 6},
            {-27, -44, -40, 17, 9},
            {-32, -43, -80, 20, 12},
            {-34, -42, -130, 21, 13}}}};
}

std::vector<Strand> strands_under_the_groin() {
  const Vec3 oblique = Vec3(-0.35, -0.93, 0).normalized();
  const Vec3 lateral = Vec3(-0.75, -0.66, 0).normalized();
  return {{"sartorius",
           oblique,
           {{-29, -40, 92, 3, 0.8},
            {-27, -45, 74, 7, 3},
            {-22, -49.5, 44, 11, 4},
            {-13, -53, 14, 12, 4.2},
            {-1, -54, -20, 12, 4.4},
            {13, -52.5, -62, 12, 5},
            {24, -50, -130, 12, 6}}},
          {"tensor_fasciae_latae",
           lateral,
           {{-33, -38, 92, 3, 0.8},
            {-42, -38, 70, 9, 4},
            {-51, -36, 36, 14, 6.5},
            {-57, -33, 0, 15, 7},
            {-61, -29, -36, 13, 5.5},
            {-64, -25, -80, 9, 1.2}}},
          {"pectineus",
           Vec3(0.25, -0.97, 0),
           {{62, -38, -4, 12, 2},
            {46, -34, -14, 14, 7},
            {24, -22, -36, 13, 8},
            {-4, -4, -62, 10, 6},
            {-30, 10, -84, 7, 1.5}}}};
}

// Deep to superficial beside the trochanter: minimus, medius with its tendon, the iliotibial band.
std::vector<Strand> strands_beside_the_hip() {
  const Vec3 outward = Vec3(-0.95, 0.05, 0.3).normalized();
  return {{"gluteus_medius_tendon",
           outward,
           {{-47, 16, 40, 10, 0.4},
            {-55, 16, 22, 11, 1.4},
            {-61.5, 17, 8, 10, 2.2},
            {-68, 15, -6, 8, 2.2},
            {-71.5, 13, -18, 6, 1.2},
            {-72, 12, -28, 4, 0.3}},
           2.2e-3,
           0.08e-3,
           2.4},
          {"gluteus_minimus",
           outward,
           {{-14, 4, 96, 20, 6},
            {-27, 6, 62, 20, 8.5},
            {-40, 4, 32, 15, 7},
            {-53, 0, 6, 9, 4},
            {-63, 0, -14, 5, 1.6},
            {-67, 0, -26, 4, 0.4}}},
          {"gluteus_medius",
           outward,
           {{-26, 18, 110, 28, 8},
            {-42, 18, 72, 26, 11},
            {-53, 18, 40, 20, 9.5},
            {-61, 18, 18, 13, 5.5},
            {-67.5, 17, 0, 9, 1.6},
            {-70.5, 15, -10, 7, 0.4}}},
          {"iliotibial_band",
           Vec3(-1, 0.05, 0.1),
           {{-66, 8, 70, 22, 0.9},
            {-74, 8, 30, 24, 1},
            {-80, 8, -10, 24, 1.1},
            {-80, 6, -50, 22, 1.1},
            {-76, 4, -130, 18, 1}},
           4e-3,
           0.15e-3,
           2.4},
          {"vastus_lateralis",
           outward,
           {{-68, 4, -36, 6, 0.8},
            {-70, 0, -52, 14, 6},
            {-69, -4, -80, 20, 10},
            {-66, -6, -140, 22, 13}}}};
}

}  // namespace

std::vector<Solid> make_hip_muscles(const HipSize& size) {
  const Millimetres mm(size.head_radius);
  std::vector<Solid> solids;
  for (const auto& strands :
       {strands_before_the_hip(), strands_under_the_groin(), strands_beside_the_hip()})
    for (const Strand& strand : strands) solids.push_back(make_strand(mm, strand));
  return solids;
}

}  // namespace artus
