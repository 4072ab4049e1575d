// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/outside/outside_body.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "artus/detail/anatomy/body/joint_path.h"
#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/toml_table.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kFarthest = 3;  // m from the joint: no person is longer

/// What keeps its size whatever the patient weighs: a head, a hand.
struct Firm {
  Vec3 centre;
  double radius;
};

/// A person's file, still in its own frame.
struct Person {
  OutsideBody body;
  std::vector<Firm> firm;
  double per_bmi = 0;  // m for each kg/m2
};

Vec3 place(TomlTable& toml, std::string_view key) {
  const Vec3 p = toml.required_vector(key, kMillimetre);
  if (p.norm() > kFarthest) toml.problem_at(key, "lies more than 3 m away: a slip of the unit");
  return p;
}

std::vector<Vec3> places(TomlTable& toml, std::string_view name) {
  std::vector<Vec3> all;
  for (const auto* t : toml.tables(name)) {
    TomlTable mark(*t, std::string(name), toml.problems());
    all.push_back(place(mark, "position"));
    mark.finish();
  }
  return all;
}

void read_marks(TomlTable& toml, Person& person) {
  for (const auto* t : toml.tables("landmark")) {
    TomlTable mark(*t, "landmark", toml.problems());
    BodyLandmark out;
    out.name = mark.required_text("name");
    if (!is_plain_name(out.name, '_')) mark.problem("its name may contain only a-z, 0-9 and _");
    out.position = place(mark, "position");
    mark.finish();
    person.body.landmarks.push_back(std::move(out));
  }
  person.body.right = places(toml, "right");
  person.body.left = places(toml, "left");
  for (const auto* t : toml.tables("support")) {
    TomlTable box(*t, "support", toml.problems());
    Support out;
    out.X_JS.translation() = place(box, "centre");
    out.half = place(box, "half_extent");
    box.finish();
    person.body.supports.push_back(out);
  }
  for (const auto* t : toml.tables("firm")) {
    TomlTable ball(*t, "firm", toml.problems());
    const Vec3 centre = place(ball, "centre");
    person.firm.push_back({centre, ball.required_number("radius", 1, 1000, kMillimetre)});
    ball.finish();
  }
}

Result<Person> read_person(const std::filesystem::path& file) {
  const auto bytes = read_bytes(file);
  ARTUS_TRY(bytes);
  const auto document = parse_toml(*bytes, file.string());
  ARTUS_TRY(document);
  Problems problems;
  TomlTable toml(*document, "person", problems);
  Person person;
  static_cast<void>(toml.required_number("format", 1, 1));
  const std::string skin = toml.required_text("skin");
  person.body.posture = toml.required_text("posture");
  person.per_bmi = toml.number("mm_per_bmi", 0, 20, kMillimetre).value_or(0);
  read_marks(toml, person);
  toml.finish();
  if (!problems.empty()) return problems.refusal(ErrorCode::invalid, file.string());
  auto mesh = read_surface(file.parent_path() / skin, kMillimetre);
  ARTUS_TRY(mesh);
  person.body.skin = std::move(*mesh);
  return person;
}

std::vector<Vec3> normals_of(const SurfaceMesh& mesh) {
  std::vector<Vec3> normals(mesh.vertices.size(), Vec3::Zero());
  for (const Triangle& t : mesh.triangles) {
    const auto& v = mesh.vertices;
    const Vec3 normal = (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]);
    for (const std::uint32_t corner : t) normals[corner] += normal;
  }
  for (Vec3& n : normals) n.stableNormalize();
  return normals;
}

double from_hole(const RegionOfInterest& hole, const Vec3& p) {
  const Vec3 local = p - hole.centre;
  if (hole.half_extent) return (local.cwiseAbs() - *hole.half_extent).maxCoeff();
  return local.norm() - hole.radius;
}

/// How much of what a person weighs more shows at a place of the person's own frame.
double share_of_weight(const Person& person, const Vec3& own, double beyond) {
  constexpr double kRun = 0.12;  // m beyond the joint's own skin; assumed
  double share = std::clamp(beyond / kRun, 0.0, 1.0);
  for (const Firm& f : person.firm)
    share = std::min(share, std::clamp((own - f.centre).norm() / f.radius - 1, 0.0, 1.0));
  return share;
}

/// Skin as thick as the joint's own, and as the patient's weight makes it.
void fit_to_patient(Person& person, const Pose& X_JB, const JointFile& joint) {
  constexpr double kUsualBmi = 25;  // kg/m2, of which the persons are; assumed
  const double grow = std::get<SurfaceFile>(joint.body.shape).grow;
  double heavier = 0;
  for (const PatientValue& value : joint.patient)
    if (value.name == "bmi") heavier = person.per_bmi * (value.value - kUsualBmi);
  SurfaceMesh& mesh = person.body.skin;
  const std::vector<Vec3> normals = normals_of(mesh);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    Vec3& p = mesh.vertices[i];
    const double beyond = person.body.hole ? from_hole(*person.body.hole, X_JB * p) : 1;
    p += (grow + heavier * share_of_weight(person, p, beyond)) * normals[i];
  }
}

void name_sides(OutsideBody& body) {
  const std::vector<Vec3> normals = normals_of(body.skin);
  for (BodyLandmark& mark : body.landmarks) {
    const auto farther = [&](const Vec3& a, const Vec3& b) {
      return (a - mark.position).squaredNorm() < (b - mark.position).squaredNorm();
    };
    const auto& v = body.skin.vertices;
    const auto at = std::min_element(v.begin(), v.end(), farther);
    if (at != v.end()) mark.outward = normals[static_cast<std::size_t>(at - v.begin())];
  }
}

/// Into the frame of the joint; `mirror`: of the person's other side.
OutsideBody put_at(Person person, const Pose& X_JB, bool mirror) {
  OutsideBody body = std::move(person.body);
  const auto to_J = [&](Vec3& p) {
    p = X_JB * p;
    if (mirror) p.x() = -p.x();
  };
  for (Vec3& p : body.skin.vertices) to_J(p);
  if (mirror)
    for (Triangle& t : body.skin.triangles) std::swap(t[1], t[2]);
  for (BodyLandmark& mark : body.landmarks) to_J(mark.position);
  for (auto* side : {&body.right, &body.left})
    for (Vec3& p : *side) to_J(p);
  if (mirror) std::swap(body.right, body.left);
  for (Support& box : body.supports) {
    Vec3 centre = box.X_JS.translation();
    to_J(centre);
    box.X_JS = X_JB;
    box.X_JS.translation() = centre;
  }
  body.up = X_JB.linear().col(2);
  name_sides(body);
  return body;
}

}  // namespace

bool is_in_hole(const OutsideBody& body, const Vec3& p) {
  return body.hole && from_hole(*body.hole, p) < 0;
}

Result<std::shared_ptr<const OutsideBody>> read_outside(const JointFile& joint) {
  const std::filesystem::path file = joint.folder / "outside.toml";
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return nullptr;
  const auto bytes = read_bytes(file);
  ARTUS_TRY(bytes);
  const auto document = parse_toml(*bytes, file.string());
  ARTUS_TRY(document);
  Problems problems;
  TomlTable toml(*document, "outside", problems);
  static_cast<void>(toml.required_number("format", 1, 1));
  const std::string name = toml.required_text("person");
  const std::string side = toml.required_text("side");
  if (side != "left" && side != "right") toml.problem_at("side", "must be \"left\" or \"right\"");
  Pose X_BJ = Pose::Identity();
  X_BJ.translation() = place(toml, "origin");
  const Vec3 x = toml.vector("x").value_or(Vec3::UnitX());
  const Vec3 z = toml.vector("z").value_or(Vec3::UnitZ());
  toml.finish();
  if (x.cross(z).norm() < 1e-3) toml.problem_at("z", "must not be along x");
  if (!problems.empty()) return problems.refusal(ErrorCode::invalid, file.string());
  X_BJ.linear() = make_pose(Vec3::Zero(), z, x).linear();
  auto person = read_person(joint.folder / name);
  ARTUS_TRY(person);
  const bool mirror = joint.side != "none" && joint.side != side;
  person->body.hole = joint.region_of_interest;
  if (mirror && person->body.hole) person->body.hole->centre.x() *= -1;
  const Pose X_JB = X_BJ.inverse();
  fit_to_patient(*person, X_JB, joint);
  OutsideBody body = put_at(std::move(*person), X_JB, mirror);
  body.hole = joint.region_of_interest;
  return std::make_shared<const OutsideBody>(std::move(body));
}

Result<std::shared_ptr<const OutsideBody>> read_outside(const std::filesystem::path& joint) {
  if (!is_joint_folder(joint)) return nullptr;
  const auto file = read_joint(joint);
  ARTUS_TRY(file);
  return read_outside(*file);
}

}  // namespace artus
