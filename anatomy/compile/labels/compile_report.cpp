// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/labels/compile_report.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "artus/detail/core/plain_reason.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMegabyte = 1e6;  // bytes

Json to_value(const DistanceStatistics& d) {
  return {{"mean_mm", d.mean / kMillimetre},
          {"percentile95_mm", d.percentile95 / kMillimetre},
          {"max_mm", d.max / kMillimetre}};
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

void read(const Json& value, DistanceStatistics& d) {
  d.mean = value.at("mean_mm").get<double>() * kMillimetre;
  d.percentile95 = value.at("percentile95_mm").get<double>() * kMillimetre;
  d.max = value.at("max_mm").get<double>() * kMillimetre;
}

StructureReport read_structure(const Json& value) {
  StructureReport s;
  value.at("name").get_to(s.name);
  value.at("tissue").get_to(s.tissue);
  value.at("kind").get_to(s.kind);
  value.at("repairs").get_to(s.repairs);
  value.at("warnings").get_to(s.warnings);
  if (value.contains("refused")) {
    value.at("refused").get_to(s.refused);
    return s;
  }
  s.surface_volume = value.at("surface_volume_cm3").get<double>() * kCubicCentimetre;
  s.region_volume = value.at("region_volume_cm3").get<double>() * kCubicCentimetre;
  s.lost_volume = value.at("lost_volume_cm3").get<double>() * kCubicCentimetre;
  s.resolved_volume = value.at("resolved_volume_cm3").get<double>() * kCubicCentimetre;
  read(value.at("distance"), s.distance);
  value.at("parts").get_to(s.parts);
  value.at("tetrahedra").get_to(s.tetrahedra);
  return s;
}

void read(const Json& value, TetQuality& q) {
  value.at("histogram").get_to(q.histogram);
  value.at("smallest_dihedral_deg").get_to(q.smallest_deg);
  value.at("largest_dihedral_deg").get_to(q.largest_deg);
  value.at("below_8_deg").get_to(q.below_8_deg);
  value.at("inverted").get_to(q.inverted);
}

CompileReport read_report(const Json& value) {
  CompileReport report;
  for (const Json& s : value.at("structures")) report.structures.push_back(read_structure(s));
  read(value.at("distance"), report.distance);
  read(value.at("quality"), report.quality);
  value.at("vertices").get_to(report.vertices);
  value.at("tetrahedra").get_to(report.tetrahedra);
  value.at("interfaces").get_to(report.interfaces);
  value.at("crumbs").get_to(report.fragments);
  value.at("fill_method").get_to(report.fill_method);
  value.at("notes").get_to(report.notes);
  value.at("body_kept").get_to(report.body_kept);
  value.at("parts_kept").get_to(report.parts_cached);
  for (const auto& [step, seconds] : value.at("stages_s").items())
    report.steps.push_back({step, seconds.get<double>()});
  value.at("seconds").get_to(report.seconds);
  report.peak_memory = value.at("peak_memory_mb").get<double>() * kMegabyte;
  return report;
}

}  // namespace

double StructureReport::volume_error() const noexcept {
  const double expected = region_volume - lost_volume;
  return expected > 0 ? resolved_volume / expected - 1 : 0;
}

bool StructureReport::is_changed() const noexcept {
  constexpr double kMuch = 0.05;
  return std::abs(volume_error()) > kMuch || lost_volume > kMuch * region_volume;
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
  value["crumbs"] = report.fragments;
  value["fill_method"] = report.fill_method;
  value["notes"] = report.notes;
  value["body_kept"] = report.body_kept;
  value["parts_kept"] = report.parts_cached;
  value["stages_s"] = Json::object();
  for (const StepTime& s : report.steps) value["stages_s"][s.step] = s.seconds;
  value["seconds"] = report.seconds;
  value["peak_memory_mb"] = report.peak_memory / kMegabyte;
  return value.dump(2);
}

Result<CompileReport> parse_compile_report(const std::string& text, const std::string& where) {
  try {
    return read_report(Json::parse(text));
  } catch (const Json::exception& e) {
    return fail(ErrorCode::malformed, plain_reason(e.what()), where);
  }
}

}  // namespace artus
