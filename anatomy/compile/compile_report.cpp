// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/anatomy/compile/compile_report.h"

#include <nlohmann/json.hpp>

namespace artus {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kCubicCentimetre = 1e-6;  // m^3
constexpr double kMillimetreHere = 1e-3;   // m
constexpr double kMegabyte = 1e6;          // bytes

Json to_value(const DistanceStatistics& d) {
  return {{"mean_mm", d.mean / kMillimetreHere},
          {"percentile95_mm", d.percentile95 / kMillimetreHere},
          {"max_mm", d.max / kMillimetreHere}};
}

Json to_value(const StructureReport& s) {
  Json value{{"name", s.name},
             {"tissue", s.tissue},
             {"kind", s.kind},
             {"repairs", s.repairs},
             {"warnings", s.warnings}};
  if (!s.refused.empty()) {
    value["refused"] = s.refused;
    return value;
  }
  value["surface_volume_cm3"] = s.surface_volume / kCubicCentimetre;
  value["region_volume_cm3"] = s.region_volume / kCubicCentimetre;
  value["lost_volume_cm3"] = s.lost_volume / kCubicCentimetre;
  value["resolved_volume_cm3"] = s.resolved_volume / kCubicCentimetre;
  value["volume_error_percent"] = 100 * s.volume_error();
  value["distance"] = to_value(s.distance);
  value["parts"] = s.parts;
  value["tetrahedra"] = s.tetrahedra;
  return value;
}

Json to_value(const TetQuality& q) {
  return {{"bin_deg", TetQuality::kBin},
          {"histogram", q.histogram},
          {"smallest_dihedral_deg", q.smallest_deg},
          {"largest_dihedral_deg", q.largest_deg},
          {"above_8_deg_percent", q.above_8_deg_percent()},
          {"below_8_deg", q.below_8_deg},
          {"inverted", q.inverted}};
}

}  // namespace

double StructureReport::volume_error() const noexcept {
  const double expected = region_volume - lost_volume;
  return expected > 0 ? resolved_volume / expected - 1 : 0;
}

std::string to_json(const CompileReport& report) {
  Json value;
  value["structures"] = Json::array();
  for (const StructureReport& s : report.structures) value["structures"].push_back(to_value(s));
  value["distance"] = to_value(report.distance);
  value["quality"] = to_value(report.quality);
  value["vertices"] = report.vertices;
  value["tetrahedra"] = report.tetrahedra;
  value["interfaces"] = report.interfaces;
  value["crumbs"] = report.crumbs;
  value["fill_method"] = report.fill_method;
  for (const StageTime& s : report.stages) value["stages_s"][s.stage] = s.seconds;
  value["seconds"] = report.seconds;
  value["peak_memory_mb"] = report.peak_memory / kMegabyte;
  return value.dump(2);
}

}  // namespace artus
