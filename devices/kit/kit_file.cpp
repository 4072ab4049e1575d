// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/devices/kit/kit_file.h"

#include <algorithm>

#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/toml_table.h"
#include "artus/detail/core/units.h"

namespace artus::kit {
namespace {

constexpr double kRuler = 100;  // mm
constexpr double kFar = 1e4;    // pixels or mm that nothing reaches

void read_print(TomlTable& root, MeasuredKit& kit, Problems& problems) {
  const toml::table* found = root.table("print");
  if (found == nullptr) return;
  TomlTable table(*found, "print", problems);
  const double ruler = table.number("ruler_mm", 80, 125).value_or(kRuler);
  const std::string hand = table.text("hand").value_or("right");
  if (hand != "right" && hand != "left") table.problem_at("hand", "'hand' is right or left");
  const double block = table.number("block_mm", 0, 300, kMillimetre).value_or(50e-3);
  table.finish();
  kit = make_kit(hand == "left" ? Hand::left : Hand::right, ruler / kRuler, block);
}

void read_camera(TomlTable& root, MeasuredKit& kit, Problems& problems) {
  const toml::table* found = root.table("camera");
  if (found == nullptr) return;
  TomlTable table(*found, "camera", problems);
  Lens& lens = kit.kit.lens;
  lens.width = static_cast<int>(table.required_number("width", 64, 8192));
  lens.height = static_cast<int>(table.required_number("height", 64, 8192));
  lens.fx = table.required_number("fx", 10, kFar);
  lens.fy = table.required_number("fy", 10, kFar);
  lens.cx = table.required_number("cx", 0, kFar);
  lens.cy = table.required_number("cy", 0, kFar);
  lens.focal_error = table.required_number("focal_error", 0, 1);
  const toml::array* bend = table.array("distortion");
  if (bend == nullptr || bend->size() != lens.distortion.size()) {
    table.problem("'distortion' must be five numbers: k1 k2 p1 p2 k3");
  } else {
    for (std::size_t i = 0; i < lens.distortion.size(); ++i)
      lens.distortion[i] = (*bend)[i].value<double>().value_or(0);
  }
  table.finish();
  kit.has_camera = true;
}

/// The marker of that number of both bodies; null: there is none.
Marker* find_marker(Kit& kit, int id) {
  for (MarkerBody* body : {&kit.probe, &kit.syringe})
    for (Marker& marker : body->markers)
      if (marker.id == id) return &marker;
  return nullptr;
}

void read_markers(TomlTable& root, MeasuredKit& kit, Problems& problems) {
  constexpr std::array<const char*, 4> kCorners{"top_left", "top_right", "bottom_right",
                                                "bottom_left"};
  for (const toml::table* found : root.tables("marker")) {
    TomlTable table(*found, "marker", problems);
    const int id = static_cast<int>(table.required_number("id", 0, 49));
    Marker* marker = find_marker(kit.kit, id);
    if (marker == nullptr) table.problem("no body has this marker");
    std::array<Vec3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i)
      corners[i] = table.required_vector(kCorners[i], kMillimetre);
    table.finish();
    if (marker != nullptr) marker->corners = corners;
    kit.has_markers = true;
  }
}

/// A table with origin, direction and error of a tool; whether it is there.
bool read_tool(TomlTable& root, const char* name, Pose& X, double& error, Problems& problems) {
  const toml::table* found = root.table(name);
  if (found == nullptr) return false;
  TomlTable table(*found, name, problems);
  const Vec3 p = table.required_vector("point_mm", kMillimetre);
  const Vec3 z = table.required_vector("z");
  const Vec3 x = table.required_vector("x");
  error = table.required_number("error_mm", 0, 100, kMillimetre);
  table.finish();
  if (!(z.norm() > 1e-9) || !(z.cross(x).norm() > 1e-9))
    table.problem("'z' and 'x' must be two directions");
  else
    X = make_pose(p, z, x);
  return true;
}

std::string number_text(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

std::string vector_text(const Vec3& v) {
  return "[" + number_text(v.x()) + ", " + number_text(v.y()) + ", " + number_text(v.z()) + "]";
}

std::string tool_text(const char* name, const Pose& X, double error) {
  return std::string("\n[") + name + "]\npoint_mm = " + vector_text(X.translation() / kMillimetre) +
         "\nz = " + vector_text(X.linear().col(2)) + "\nx = " + vector_text(X.linear().col(0)) +
         "\nerror_mm = " + number_text(error / kMillimetre) + "\n";
}

std::string camera_text(const Lens& lens) {
  std::string out = "\n[camera]\nwidth = " + std::to_string(lens.width) +
                    "\nheight = " + std::to_string(lens.height) + "\nfx = " + number_text(lens.fx) +
                    "\nfy = " + number_text(lens.fy) + "\ncx = " + number_text(lens.cx) +
                    "\ncy = " + number_text(lens.cy) +
                    "\nfocal_error = " + number_text(lens.focal_error) + "\ndistortion = [";
  for (std::size_t i = 0; i < lens.distortion.size(); ++i)
    out += (i == 0 ? "" : ", ") + number_text(lens.distortion[i]);
  return out + "]\n";
}

}  // namespace

MeasuredKit make_kit(Hand hand, double scale, double block_height) {
  MeasuredKit out;
  out.scale = scale;
  out.kit.hand = hand;
  out.kit.probe = make_probe_body(scale);
  out.kit.syringe = make_syringe_body(scale);
  out.kit.sheet = make_sheet_body(scale);
  out.kit.plunger = make_plunger_marker(hand, scale);
  out.kit.X_BP = nominal_face(hand);
  out.kit.block_height = block_height;
  return out;
}

Result<MeasuredKit> parse_kit(std::string_view text, const std::string& name) {
  const auto parsed = parse_toml(text, name);
  ARTUS_TRY(parsed);
  Problems problems;
  TomlTable root(*parsed, "kit", problems);
  MeasuredKit kit;
  read_print(root, kit, problems);
  read_camera(root, kit, problems);
  read_markers(root, kit, problems);
  kit.has_tip = read_tool(root, "needle", kit.kit.X_BN, kit.kit.tip_error, problems);
  kit.has_face = read_tool(root, "face", kit.kit.X_BP, kit.kit.face_error, problems);
  root.finish();
  if (!problems.empty()) return problems.refusal(ErrorCode::invalid, name);
  return kit;
}

Result<MeasuredKit> read_kit(const std::filesystem::path& file) {
  const auto text = read_bytes(file);
  ARTUS_TRY(text);
  return parse_kit(*text, file.string());
}

std::string to_toml(const MeasuredKit& kit) {
  std::string out = "# What artus hands measured of a kit (docs/hands.md).\n[print]\nruler_mm = " +
                    number_text(kRuler * kit.scale) + "\nhand = \"" +
                    (kit.kit.hand == Hand::left ? "left" : "right") +
                    "\"\nblock_mm = " + number_text(kit.kit.block_height / kMillimetre) + "\n";
  if (kit.has_camera) out += camera_text(kit.kit.lens);
  if (kit.has_tip) out += tool_text("needle", kit.kit.X_BN, kit.kit.tip_error);
  if (kit.has_face) out += tool_text("face", kit.kit.X_BP, kit.kit.face_error);
  if (!kit.has_markers) return out;
  for (const MarkerBody* body : {&kit.kit.probe, &kit.kit.syringe})
    for (const Marker& m : body->markers)
      out += "\n[[marker]]\nid = " + std::to_string(m.id) +
             "\ntop_left = " + vector_text(m.corners[0] / kMillimetre) +
             "\ntop_right = " + vector_text(m.corners[1] / kMillimetre) +
             "\nbottom_right = " + vector_text(m.corners[2] / kMillimetre) +
             "\nbottom_left = " + vector_text(m.corners[3] / kMillimetre) + "\n";
  return out;
}

}  // namespace artus::kit
