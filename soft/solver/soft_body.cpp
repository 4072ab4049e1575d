// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/soft_body.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "artus/detail/anatomy/body/holders.h"
#include "artus/detail/core/check.h"

namespace artus {
namespace {

/// The side of the region of interest on which nothing is meshed: points that are in no tetrahedron
/// and beyond the nearest of the surfaces that end it, not outside the skin.
class BeyondTest {
 public:
  explicit BeyondTest(const CompiledJoint& joint) : mesh_(joint.mesh) {
    for (const Interface& i : mesh_.interfaces) {
      if (i.front == kBeyond || i.back == kBeyond) faces_.push_back(i);
    }
  }

  /// Whether the nearest corner of the end surfaces has the point on its far side.
  [[nodiscard]] bool holds(const Vec3& p_J, double within) const {
    double nearest = within * within;
    bool beyond = false;
    for (const Interface& i : faces_) {
      const Vec3& a = mesh_.vertices[i.vertices[0]];
      const double distance = (p_J - a).squaredNorm();
      if (distance >= nearest) continue;
      nearest = distance;
      const Vec3 normal =
          (mesh_.vertices[i.vertices[1]] - a).cross(mesh_.vertices[i.vertices[2]] - a);
      const double side = normal.dot(p_J - a);
      beyond = i.front == kBeyond ? side >= 0 : side <= 0;
    }
    return beyond;
  }

 private:
  const TetMesh& mesh_;
  std::vector<Interface> faces_;
};

MaterialField make_joint_field(const CompiledJoint& joint, const Pose& X_JC, double poisson_ratio,
                               std::shared_ptr<const TetLocator> locator) {
  MaterialField field;
  const auto values = read_bundled_soft_tissues().value();
  for (const Region& region : joint.regions) {
    const Vec3 fibre = X_JC.linear().transpose() * region.fibre_axis;
    field.materials.push_back(
        make_soft_material(joint.tissues[region.tissue], values, fibre, poisson_ratio));
  }
  field.at = [&joint, X_JC, locator = std::move(locator)](const Vec3& p_C) {
    const std::int64_t tet = locator->find(X_JC * p_C);
    return tet < 0 ? kNoMaterial
                   : static_cast<int>(joint.mesh.regions[static_cast<std::size_t>(tet)]);
  };
  return field;
}

CageZone zone_around(const ProbeFace& face, double margin, double depth, double cell) {
  const Vec3 half(0.5 * face.length + margin, 0.5 * face.width + margin, depth);
  return {Vec3(-half.x(), -half.y(), -depth), half, cell};
}

CageParams cage_of(const TetMesh& mesh, const Pose& X_CJ, const SoftBodyParams& p) {
  CageParams cage;
  Vec3 low = Vec3::Constant(1e9);
  Vec3 high = -low;
  for (const Vec3& v : mesh.vertices) {
    const Vec3 v_C = X_CJ * v;
    low = low.cwiseMin(v_C);
    high = high.cwiseMax(v_C);
  }
  // The lattice passes through the footprint's centre plane, so that a cube's face meets z = 0.
  for (int k = 0; k < 3; ++k) cage.low[k] = p.coarse_cell * std::floor(low[k] / p.coarse_cell);
  cage.high = high;
  cage.cell = p.coarse_cell;
  cage.zones.push_back(zone_around(p.face, p.far, p.far_depth, p.far_cell));
  cage.zones.push_back(zone_around(p.face, p.near, p.near_depth, p.near_cell));
  cage.zones.push_back(zone_around(p.face, p.fine_margin, p.fine_depth, p.fine_cell));
  return cage;
}

constexpr double kTurnedAway =
    0.48;  // sine: a face that turns by half a radian meets no skin beyond

/// Skin triangles within `reach` of the footprint, sideways, that face the probe, those of a thin
/// limb's other side not; `numbers`: of its vertices in the mesh.
SkinPatch skin_of(const TetMesh& mesh, const Pose& X_CJ, const ProbeFace& face, double reach,
                  std::vector<std::uint32_t>& numbers) {
  SkinPatch skin;
  std::vector<std::int64_t> number(mesh.vertices.size(), -1);
  for (const Interface& i : mesh.interfaces) {
    if (i.front != kOutside && i.back != kOutside) continue;
    if (i.front == kBeyond || i.back == kBeyond) continue;
    Vec3 middle = Vec3::Zero();
    std::array<std::uint32_t, 3> corners = i.vertices;
    if (i.back == kOutside) std::swap(corners[1], corners[2]);  // normal out of the body
    for (const std::uint32_t v : corners) middle += X_CJ * mesh.vertices[v] / 3;
    if (std::abs(middle.x()) > 0.5 * face.length + reach ||
        std::abs(middle.y()) > 0.5 * face.width + reach || std::abs(middle.z()) > 0.04)
      continue;
    const Vec3& a = mesh.vertices[corners[0]];
    const Vec3 normal =
        X_CJ.linear() * (mesh.vertices[corners[1]] - a).cross(mesh.vertices[corners[2]] - a);
    if (normal.z() > kTurnedAway * normal.norm()) continue;
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      auto& n = number[corners[k]];
      if (n < 0) {
        n = static_cast<std::int64_t>(skin.vertices.size());
        skin.vertices.push_back(X_CJ * mesh.vertices[corners[k]]);
        numbers.push_back(corners[k]);
      }
      triangle[k] = static_cast<std::uint32_t>(n);
    }
    skin.triangles.push_back(triangle);
  }
  return skin;
}

/// Whether enough nodes are held that the body cannot go as a whole.
bool is_held(const SoftModel& model) {
  constexpr int kFewest = 3;
  int held = 0;
  for (std::uint32_t n = 0; n < model.cage().nodes().size() && held < kFewest; ++n)
    held += model.held(n).all() ? 1 : 0;
  return held == kFewest;
}

}  // namespace

/// What all bodies in one cage begin with.
struct SoftBody::Start {
  std::shared_ptr<const CompiledJoint> joint;
  std::shared_ptr<const BodyMap> map;
  SkinPatch skin;                       // before the face
  std::vector<std::uint32_t> vertices;  // of that skin, numbers in the joint's mesh
  std::vector<std::uint32_t> contact;   // unknowns that the face may press
  ProbeFace face;
  SoftSolverParams solver;
};

SoftBody SoftBody::begin(std::shared_ptr<const Start> start) {
  SoftBody body;
  body.joint_ = start->joint;
  body.map_ = start->map;
  body.solver_ = std::make_unique<SoftSolver>(start->map->model, start->contact, start->solver);
  body.solver_->set_face(start->skin, start->face);
  body.start_ = std::move(start);
  return body;
}

SoftBody SoftBody::another_at_rest() const {
  return begin(start_);
}

Result<SoftBody> SoftBody::make(std::shared_ptr<const CompiledJoint> joint, const Pose& X_JP,
                                const SoftBodyParams& params) {
  if (joint->mesh.tetrahedra.empty())
    return fail(ErrorCode::invalid, "a body without tetrahedra cannot give way", joint->name);
  if (!find_holders(*joint).any()) return fail(ErrorCode::invalid, explain_unheld(), joint->name);
  const Pose X_CJ = X_JP.inverse();
  const auto locator = std::make_shared<const TetLocator>(joint->mesh);
  const BeyondTest beyond(*joint);
  SoftModelParams model;
  model.cage = cage_of(joint->mesh, X_CJ, params);
  model.held = [&](const Vec3& p_C) {
    HeldNode node;
    const Vec3 p_J = X_JP * p_C;
    const bool held = locator->find(p_J) < 0 && beyond.holds(p_J, 2 * params.coarse_cell);
    node.held = {held, held, held};
    return node;
  };
  Start start;
  start.joint = joint;
  start.map =
      make_body_map(*joint, X_JP,
                    std::make_shared<const SoftModel>(
                        make_joint_field(*joint, X_JP, params.poisson_ratio, locator), model));
  if (!is_held(*start.map->model))
    return fail(
        ErrorCode::invalid,
        "what holds the tissue is too small: the cubes that carry the tissue have fewer than "
        "three corners in it; give the body more bone, or a [region_of_interest] that cuts "
        "it (" +
            describe(find_holders(*joint)) + ")",
        joint->name);
  start.skin = skin_of(joint->mesh, X_CJ, params.face, params.far, start.vertices);
  if (start.skin.triangles.empty())
    return fail(ErrorCode::invalid, "no skin below the probe: move it over the body", joint->name);
  const Vec3 reach(0.5 * params.face.length + params.reach, 0.5 * params.face.width + params.reach,
                   0.04);
  start.contact = contact_unknowns(*start.map->model, start.skin, -reach, reach);
  start.face = params.face;
  start.face.length -= 2 * params.inset * params.fine_cell;
  start.face.width -= 2 * params.inset * params.fine_cell;
  start.solver = params.solver;
  return begin(std::make_shared<const Start>(std::move(start)));
}

/// Displacements of this cage's nodes in another's, frame C.
std::vector<Vec3> SoftBody::nodes_in(const DeformedBody& other) const {
  const Pose& X_JC = map_->X_JC;
  std::vector<Vec3> moved;
  for (const Vec3& node : map_->model->cage().nodes())
    moved.emplace_back(X_JC.linear().transpose() * other.displacement(X_JC * node));
  return moved;
}

void SoftBody::follow(const DeformedBody& before) {
  solver_->start_from(nodes_in(before));
}

void SoftBody::follow_with_factor(const DeformedBody& before) {
  solver_->go_on_from(nodes_in(before));
}

bool SoftBody::lift_skin(const RestOf& rest_of) {
  std::vector<Vec3> lifts;
  if (rest_of) {
    const Eigen::Matrix3d R_CJ = map_->X_JC.linear().transpose();
    lifts.reserve(start_->vertices.size());
    for (const std::uint32_t v : start_->vertices)
      lifts.emplace_back(R_CJ * (rest_of(v) - joint_->mesh.vertices[v]));
  }
  if (lifts == lifts_) return false;
  lifts_ = lifts;
  solver_->set_skin_lifts(std::move(lifts));
  return true;
}

const SoftStep& SoftBody::step(const std::optional<Pose>& X_JP, double dt) {
  if (!X_JP) return solver_->step(std::nullopt, dt);
  return solver_->step(map_->X_JC.inverse() * *X_JP, dt);
}

bool SoftBody::settle(const std::optional<Pose>& X_JP, double tolerance, int max_steps) {
  if (!X_JP) return solver_->settle(std::nullopt, tolerance, max_steps);
  return solver_->settle(Pose(map_->X_JC.inverse() * *X_JP), tolerance, max_steps);
}

ContactForce SoftBody::to_J(ContactForce contact) const {
  contact.force = map_->X_JC.linear() * contact.force;
  contact.torque = map_->X_JC.linear() * contact.torque;
  contact.into = map_->X_JC.linear() * contact.into;
  for (PressingPiece& piece : contact.pieces) piece.p = map_->X_JC * piece.p;
  return contact;
}

ContactForce SoftBody::force_J() const {
  return to_J(solver_->last().contact);
}

FacePress SoftBody::press_at_rest_J() const {
  FacePress press = solver_->press_at_rest();
  press.contact = to_J(std::move(press.contact));
  return press;
}

FacePress SoftBody::try_press_J(const Pose& X_JP) const {
  FacePress press = solver_->try_press(map_->X_JC.inverse() * X_JP);
  press.contact = to_J(std::move(press.contact));
  return press;
}

double SoftBody::distance_to_held() const {
  const SoftModel& model = *map_->model;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::uint32_t n = 0; n < model.cage().nodes().size(); ++n)
    if (model.held(n).all()) nearest = std::min(nearest, model.cage().nodes()[n].norm());
  return nearest;
}

/// Nodes of the cage that a bone holds.
Result<std::vector<std::uint32_t>> SoftBody::nodes_of(const std::string& bone,
                                                      const TetLocator& locator) const {
  std::vector<std::uint32_t> nodes;
  const SoftModel& model = *map_->model;
  for (std::uint32_t n = 0; n < model.cage().nodes().size(); ++n) {
    if (!model.held(n).all()) continue;
    const std::int64_t tet = locator.find(map_->X_JC * model.cage().nodes()[n]);
    if (tet < 0) continue;
    const RegionId region = joint_->mesh.regions[static_cast<std::size_t>(tet)];
    if (joint_->regions[region].name == bone && joint_->tissue_of(region).haptic.hard)
      nodes.push_back(n);
  }
  if (nodes.empty())
    return fail(ErrorCode::not_found, "no bone '" + bone + "' holds the tissue around the probe",
                joint_->name);
  return nodes;
}

Result<void> SoftBody::move_bones(std::span<const BoneMotion> motions, int parts) {
  ARTUS_REQUIRE(parts > 0, "at least one part");
  const auto rest = map_->model->cage().nodes();
  const TetLocator locator(joint_->mesh);
  std::vector<std::vector<std::uint32_t>> nodes;
  std::vector<Vec3>
      middles;  // of the bones' nodes, frame C: they go straight, the bone turns on them
  for (const BoneMotion& motion : motions) {
    auto found = nodes_of(motion.structure, locator);
    ARTUS_TRY(found);
    Vec3 sum = Vec3::Zero();
    for (const std::uint32_t n : *found) sum += rest[n];
    middles.emplace_back(sum / static_cast<double>(found->size()));
    nodes.push_back(std::move(*found));
  }
  for (int part = 1; part <= parts; ++part) {
    const double share = static_cast<double>(part) / parts;
    std::vector<Vec3> moved(rest.size(), Vec3::Zero());
    for (std::size_t b = 0; b < motions.size(); ++b) {
      const Pose X_C = map_->X_JC.inverse() * motions[b].X_J * map_->X_JC;
      const Eigen::AngleAxisd whole(X_C.linear());
      const Eigen::Matrix3d R =
          Eigen::AngleAxisd(share * whole.angle(), whole.axis()).toRotationMatrix();
      const Vec3 offset = share * (X_C * middles[b] - middles[b]);
      for (const std::uint32_t n : nodes[b])
        moved[n] = R * (rest[n] - middles[b]) + middles[b] + offset - rest[n];
    }
    solver_->set_prescribed(std::move(moved));
    const bool last = part == parts;
    if (!solver_->settle(std::nullopt, last ? 2e-6 : 2e-4, last ? 60 : 20)) {
      solver_->set_prescribed(std::vector<Vec3>(rest.size(), Vec3::Zero()));
      solver_->reset();
      return fail(ErrorCode::failed, "the tissue does not follow the bones so far", joint_->name);
    }
  }
  return {};
}

std::shared_ptr<const DeformedBody> SoftBody::snapshot(const DeformedBody* before) const {
  return std::make_shared<const DeformedBody>(joint_, map_, solver_->displacements(), force_J(),
                                              before);
}

}  // namespace artus
