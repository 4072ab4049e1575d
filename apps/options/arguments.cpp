// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/arguments.h"

#include <cmath>
#include <locale>
#include <sstream>

#include "artus/detail/core/check.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = text.find(separator, begin);
    parts.emplace_back(text.substr(begin, end - begin));
    if (end == std::string_view::npos) return parts;
    begin = end + 1;
  }
}

Result<Vec3> parse_triple(std::string_view text, const std::string& flag) {
  const auto parts = split(text, ',');
  const auto refuse = [&] {
    return fail(ErrorCode::malformed,
                "'" + std::string(text) + "' is not three numbers; write x,y,z", flag);
  };
  if (parts.size() != 3) return refuse();
  Vec3 v = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    std::istringstream in(parts[static_cast<std::size_t>(i)]);
    in.imbue(std::locale::classic());
    if (!(in >> v[i]) || !(in >> std::ws).eof() || !std::isfinite(v[i])) return refuse();
  }
  return v;
}

}  // namespace

Result<Vec3> parse_point_mm(std::string_view text, const std::string& flag) {
  constexpr double kFarthest = 10e3;  // mm
  auto v = parse_triple(text, flag);
  ARTUS_TRY(v);
  if (!(v->norm() <= kFarthest))
    return fail(ErrorCode::malformed,
                "'" + std::string(text) +
                    "' lies beyond 10000 mm from the joint's origin; points are in mm",
                flag);
  *v *= kMillimetre;
  return v;
}

Result<Pose> parse_probe_pose(std::string_view text, const std::string& flag) {
  const auto parts = split(text, '/');
  if (parts.size() < 2 || parts.size() > 3)
    return fail(ErrorCode::malformed,
                "a probe pose is position/direction[/lateral], each x,y,z: 0,0,30/0,0,-1/1,0,0",
                flag);
  const auto position = parse_point_mm(parts[0], flag);
  ARTUS_TRY(position);
  const auto direction = parse_triple(parts[1], flag);
  ARTUS_TRY(direction);
  if (direction->norm() < 1e-12)
    return fail(ErrorCode::invalid, "the direction into the body is zero", flag);
  if (parts.size() == 2) return make_pose(*position, *direction, Vec3::Zero());
  const auto lateral = parse_triple(parts[2], flag);
  ARTUS_TRY(lateral);
  if (direction->normalized().cross(lateral->normalized()).norm() < 1e-6)
    return fail(ErrorCode::invalid, "the lateral direction is zero or along the beam", flag);
  return make_pose(*position, *direction, *lateral);
}

Result<Segment> parse_entry_and_tip(std::string_view text, const std::string& flag) {
  const auto parts = split(text, '/');
  if (parts.size() != 2)
    return fail(ErrorCode::malformed, "a needle is entry/tip, each x,y,z: 0,0,30/5,0,10", flag);
  const auto entry = parse_point_mm(parts[0], flag);
  ARTUS_TRY(entry);
  const auto tip = parse_point_mm(parts[1], flag);
  ARTUS_TRY(tip);
  if ((*tip - *entry).norm() < 1e-9)
    return fail(ErrorCode::invalid, "entry and tip are the same point", flag);
  return Segment{*entry, *tip};
}

Result<Pose> parse_needle_pose(std::string_view text, const std::string& flag) {
  const auto line = parse_entry_and_tip(text, flag);
  ARTUS_TRY(line);
  return make_pose(line->end, line->end - line->start, Vec3::Zero());
}

double length_unit(std::string_view name) {
  ARTUS_REQUIRE(name == "mm" || name == "cm" || name == "m", "a flag's check lets these pass");
  return name == "mm" ? kMillimetre : name == "cm" ? 1e-2 : 1;
}

}  // namespace artus
