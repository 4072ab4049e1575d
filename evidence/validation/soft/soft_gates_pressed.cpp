// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "artus/detail/anatomy/body/tissue.h"
#include "artus/detail/core/noise.h"
#include "artus/detail/evidence/validation/soft/soft_gates.h"
#include "artus/detail/soft/solver/soft_block.h"
#include "artus/detail/soft/solver/soft_solver.h"

namespace artus {
namespace {

constexpr double kNu = 0.47;
constexpr double kFrame = 1.0 / 60;  // s

/// Skin, fat and muscle under the face, as gates press them.
SoftBlock layered_block(bool quarter) {
  SoftBlock block;
  block.quarter = quarter;
  block.half_x = 48e-3;
  block.half_y = 36e-3;
  block.layers = {{2e-3, linear_material(150e3, kNu)},
                  {6e-3, linear_material(3e3, kNu)},
                  {16e-3, linear_material(15e3, kNu)}};
  return block;
}

struct Setup {
  double cube = 3e-3;
  double nu = kNu;
  bool quarter = true;
  double friction = 0;
  double reach = 2e-3;  ///< m beyond the face
  bool large = false;   ///< as large as a joint's region of interest, not a small block
};

/// A block under a face of 40 x 6 mm, cubes of `cube` near the face and 6 mm beyond.
struct PressedBlock {
  SoftBlock block;
  std::shared_ptr<const SoftModel> model;
  std::unique_ptr<SoftSolver> solver;

  explicit PressedBlock(const Setup& setup) {
    block = layered_block(setup.quarter);
    if (setup.large) {
      block.half_x = block.half_y = 60e-3;
      block.layers.back().thickness = 52e-3;
    }
    for (SoftLayer& layer : block.layers)
      layer.material.bulk = lame_lambda(layer.material.shear, setup.nu);
    const Vec3 zone(24e-3 + setup.reach, 7e-3 + setup.reach, 6e-3);
    model = make_block_model(block, 6e-3, {{-zone, zone, setup.cube}});
    const Vec3 reach(20e-3 + setup.reach, 3e-3 + setup.reach, 1);
    const SkinPatch skin = make_flat_skin(block, 3e-3);
    solver = std::make_unique<SoftSolver>(model, contact_unknowns(*model, skin, -reach, reach));
    ProbeFace face;
    face.length -= 0.6 * setup.cube;  // inset as SoftBodyParams has it
    face.width -= 0.6 * setup.cube;
    const double spacing = std::min(setup.cube, 1.5e-3);
    face.points_x = 2 * static_cast<int>(std::lround(20e-3 / spacing));
    face.points_y = 2 * static_cast<int>(std::lround(3e-3 / spacing));
    face.friction = setup.friction;
    solver->set_face(skin, face);
  }

  bool at_rest = true;  ///< so were all states that `press` and `settle` left

  void settle(const Pose& pose, double tolerance, int max_steps) {
    at_rest = solver->settle(pose, tolerance, max_steps) && at_rest;
  }

  /// N with the face pressed by so much, in steps of 1 mm.
  double press(double depth, double tolerance = 1e-6) {
    Pose pose = Pose::Identity();
    for (double z = 1e-3; z < depth; z += 1e-3) {
      pose.translation().z() = z;
      solver->refresh();
      solver->step(pose, 1e9);
    }
    pose.translation().z() = depth;
    settle(pose, tolerance, 40);
    return -(block.quarter ? 4 : 1) * solver->last().contact.force.z();
  }

  [[nodiscard]] double largest_displacement() const {
    double most = 0;
    for (const Vec3& u : solver->displacements()) most = std::max(most, u.norm());
    return most;
  }
};

/// Skin, fat and muscle of the library over bone, pressed by the face as a probe's: measured bands
/// are of people, who have skin.
struct Limb {
  static constexpr double kFat = 12e-3;     // m
  static constexpr double kMuscle = 30e-3;  // m
  SoftBlock block;
  std::shared_ptr<const SoftModel> model;
  std::unique_ptr<SoftSolver> solver;

  Limb() {
    block.quarter = true;
    block.half_x = 48e-3;
    block.half_y = 36e-3;
    const auto tissues = read_bundled_tissues().value();
    const auto values = read_bundled_soft_tissues().value();
    for (const auto& [name, thickness] :
         {std::pair{"skin", 2e-3}, std::pair{"fat", kFat}, std::pair{"muscle", kMuscle}}) {
      const auto tissue = std::find_if(tissues.begin(), tissues.end(),
                                       [n = name](const Tissue& t) { return t.name == n; });
      block.layers.push_back({thickness, make_soft_material(*tissue, values, Vec3::UnitX(), kNu)});
    }
    const Vec3 zone(27e-3, 12e-3, 12e-3);
    model = make_block_model(block, 6e-3, {{-zone, zone, 3e-3}});
    const Vec3 reach(22e-3, 5e-3, 1);
    const SkinPatch skin = make_flat_skin(block, 3e-3);
    solver = std::make_unique<SoftSolver>(model, contact_unknowns(*model, skin, -reach, reach));
    ProbeFace face;
    face.length -= 0.6 * 3e-3;  // inset as SoftBodyParams has it
    face.width -= 0.6 * 3e-3;
    face.friction = 0;
    solver->set_face(skin, face);
  }

  struct State {
    bool at_rest = false;
    double force = 0;  // N
    double fat = 0;    // of its thickness, compressed
    double muscle = 0;
  };
  State press(double depth) {
    Pose pose = Pose::Identity();
    pose.translation().z() = depth;
    const bool at_rest = solver->settle(pose, 2e-6, 100);
    const auto now = layer_thicknesses(block, *model, solver->displacements(), 0, 0);
    return {at_rest, -4 * solver->last().contact.force.z(), 1 - now[1] / kFat,
            1 - now[2] / kMuscle};
  }
};

/// A hand that presses, slides and tilts at random; what it leaves behind.
std::vector<Vec3> run_hand(PressedBlock& pressed, int frames, bool& finite) {
  for (int k = 0; k < frames; ++k) {
    const auto i = static_cast<std::uint64_t>(k);
    if (k % 6 == 0) pressed.solver->begin_refresh();
    if (k % 6 == 4) pressed.solver->end_refresh();
    Pose pose = Pose::Identity();
    pose.translation() =
        Vec3(8e-3 * (uniform_noise(2, i / 5) - 0.5), 8e-3 * (uniform_noise(4, i / 5) - 0.5),
             -4e-3 + 20e-3 * uniform_noise(1, i / 7));
    pose.rotate(Eigen::AngleAxisd(0.5 * (uniform_noise(3, i / 9) - 0.5), Vec3::UnitX()));
    pressed.solver->step(pose, kFrame);
    finite = finite && pressed.solver->last().contact.force.allFinite();
    for (const Vec3& u : pressed.solver->displacements()) finite = finite && u.allFinite();
  }
  return {pressed.solver->displacements().begin(), pressed.solver->displacements().end()};
}

}  // namespace

Gate gate_layers() {
  Gate gate;
  gate.title =
      "Skin 2, fat 6, muscle 16 mm pressed 5 mm by a face of 40 x 6 mm, cubes of 3 mm against a "
      "quarter";
  bool at_rest = true;
  const auto force = [&](double cube) {
    PressedBlock block({cube, 0.45, true, 0, 2e-3, false});
    const double newtons = block.press(5e-3);
    at_rest = at_rest && block.at_rest;
    return newtons;
  };
  const double shipped = force(3e-3);
  const double half = force(1.5e-3);
  const double quarter = force(0.75e-3);
  gate.claims.push_back(claim_near(
      ClaimKind::independent, "V7: force with the shipped cubes against cubes a quarter as large",
      shipped, quarter, 0.10, "N"));
  gate.claims.push_back(claim_near(ClaimKind::independent,
                                   "V7: force with cubes half as large against a quarter", half,
                                   quarter, 0.10, "N"));
  PressedBlock thin({3e-3, 0.45, true, 0, 2e-3, false});
  thin.press(5e-3);
  gate.claims.push_back(claim_at_rest("V7: the layered block", at_rest && thin.at_rest));
  const auto layers =
      layer_thicknesses(thin.block, *thin.model, thin.solver->displacements(), 1e-3, 1e-3);
  gate.claims.push_back(claim_that({ClaimKind::input, "fat is given the lowest stiffness"},
                                   "fat thins by the larger share of its thickness than muscle",
                                   layers[1] / 6e-3 < layers[2] / 16e-3));
  return gate;
}

Gate gate_volume() {
  Gate gate;
  gate.title = "Layered block of a joint's size (864 cm3) pressed by 8 mm: change of its volume";
  PressedBlock pressed({3e-3, kNu, true, 0, 2e-3, true});
  pressed.press(8e-3, 1e-5);
  gate.claims.push_back(claim_at_rest("V8: the block", pressed.at_rest));
  double rest = 0;
  double now = 0;
  const auto cells = pressed.model->cage().cells();
  for (std::size_t c = 0; c < cells.size(); ++c) {
    CellVector u;
    for (std::size_t a = 0; a < 8; ++a)
      u.segment<3>(static_cast<Eigen::Index>(3 * a)) =
          pressed.solver->displacements()[cells[c].nodes[a]];
    const double edge = pressed.model->cage().edge(cells[c]);
    rest += std::pow(edge, 3);
    now += cell_dilatation(pressed.model->materials()[c], edge, u) * std::pow(edge, 3);
  }
  gate.claims.push_back(claim_at_most(ClaimKind::independent,
                                      "V8: volume lost or gained at nu 0.47",
                                      std::abs(now / rest - 1), 0.01, "of the block"));
  return gate;
}

Gate gate_balance() {
  Gate gate;
  gate.title =
      "Layered block pressed by 3 mm: force against reaction, compliance, energy of a path";
  PressedBlock pressed({3e-3, kNu, false, 0, 6e-3, false});
  SoftSolver& solver = *pressed.solver;
  const double force = pressed.press(3e-3, 1e-9);
  const double gap = (solver.last().contact.force - solver.reaction()).norm();
  gate.claims.push_back(claim_at_most(ClaimKind::independent,
                                      "V9: force less reaction of what holds", gap / force, 1e-4,
                                      "of the force"));
  const double peak = solver.forces().energy;
  double work = 0;
  Pose pose = Pose::Identity();
  Vec3 from(0, 0, 3e-3);
  Vec3 before = solver.last().contact.force;
  // Slide, lift, slide back in the air, press again: nothing is lost without friction.
  std::vector<Vec3> path;
  for (int k = 1; k <= 6; ++k) path.emplace_back(0.5e-3 * k, 0, 3e-3);
  for (int k = 1; k <= 12; ++k) path.emplace_back(3e-3, 0, 3e-3 - 0.25e-3 * k);
  path.emplace_back(0, 0, 0);
  for (int k = 1; k <= 12; ++k) path.emplace_back(0, 0, 0.25e-3 * k);
  for (const Vec3& to : path) {
    pose.translation() = to;
    pressed.settle(pose, 1e-7, 30);
    const Vec3 now = solver.last().contact.force;
    work -= 0.5 * (before + now).dot(to - from);
    before = now;
    from = to;
  }
  gate.claims.push_back(claim_at_rest("V9, V11: the block on all of the path", pressed.at_rest));
  gate.claims.push_back(
      claim_at_most(ClaimKind::independent,
                    "V11: work of press, slide, lift and back, to the peak's stored energy",
                    std::abs(work) / peak, 0.005, ""));
  return gate;
}

Gate gate_turned() {
  Gate gate;
  gate.title = "The face turned by 30 degrees on the same block: the cage must not be felt";
  Setup setup{3e-3, kNu, false, 0, 9e-3, false};
  PressedBlock pressed(setup);
  const double straight = pressed.press(3e-3);
  Pose pose = Pose::Identity();
  pose.translation().z() = 3e-3;
  pose.rotate(Eigen::AngleAxisd(0.5235987755982988, Vec3::UnitZ()));
  pressed.solver->reset();
  pressed.settle(pose, 1e-6, 60);
  gate.claims.push_back(claim_at_rest("V12: the block, straight and turned,", pressed.at_rest));
  gate.claims.push_back(claim_near(ClaimKind::independent, "V12: force, turned against straight",
                                   -pressed.solver->last().contact.force.z(), straight, 0.03, "N"));
  return gate;
}

Gate gate_limb() {
  Gate gate;
  gate.title =
      "2 mm of skin, 12 mm of fat and 30 mm of muscle over bone under the face, slope of stress "
      "over "
      "compression against [Isogai2022]";
  constexpr double kArea = 40e-3 * 6e-3;  // m^2; the source's indenter is not known here: assumed
  Limb limb;
  std::vector<Limb::State> curve;
  double max_force = 0;  // of the last state at rest
  for (int mm = 1; mm <= 22 && max_force < 6; ++mm) {
    const Limb::State state = limb.press(1e-3 * mm);
    if (!state.at_rest) break;
    curve.push_back(state);
    max_force = state.force;
  }
  // The source's moduli are slopes of the curve, not stress over strain: between the states on both
  // sides of the force.
  const auto slope_at = [&](double force, double Limb::State::*strain) {
    for (std::size_t i = 1; i < curve.size(); ++i) {
      if (curve[i].force < force) continue;
      return (curve[i].force - curve[i - 1].force) / kArea /
             (curve[i].*strain - curve[i - 1].*strain);
    }
    return 0.0;
  };
  bool hardens = curve.size() > 3;
  for (std::size_t i = 2; i < curve.size(); ++i)
    hardens =
        hardens && curve[i].force - curve[i - 1].force > curve[i - 1].force - curve[i - 2].force;
  gate.claims.push_back(claim_at_least(ClaimKind::independent,
                                       "H1: pressed to rest, millimetre by millimetre, up to",
                                       max_force, 5, "N"));
  gate.claims.push_back(claim_that(ClaimKind::independent,
                                   "H1: force grows ever faster with depth, as far as at rest",
                                   hardens));
  const ClaimBasis basis{ClaimKind::independent, "the indenter's area is assumed to be the face's"};
  gate.claims.push_back(claim_within(basis, "H1: fat at 1 N, mean and 2 deviations of 21 men",
                                     1e-3 * slope_at(1, &Limb::State::fat), 26.1, 38.0, "kPa"));
  gate.claims.push_back(claim_within(basis, "H1: muscle at 5 N, mean and 2 deviations of 21 men",
                                     1e-3 * slope_at(5, &Limb::State::muscle), 62.2, 20.6, "kPa"));
  return gate;
}

Gate gate_bytes() {
  Gate gate;
  gate.title = "The same hand twice, factors made by a second thread and taken at fixed frames";
  bool finite = true;
  PressedBlock first({3e-3, kNu, false, 0.05, 4e-3, false});
  PressedBlock second({3e-3, kNu, false, 0.05, 4e-3, false});
  const auto a = run_hand(first, 60, finite);
  const auto b = run_hand(second, 60, finite);
  gate.claims.push_back(claim_that({ClaimKind::input, "no sum depends on a thread"},
                                   "V13: the same bytes",
                                   std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)) == 0));
  return gate;
}

Gate gate_wild_hand() {
  Gate gate;
  gate.title = "10,000 frames of random presses to 16 mm, jumps and tilts";
  PressedBlock pressed({3e-3, kNu, false, 0.05, 6e-3, false});
  bool finite = true;
  run_hand(pressed, 10000, finite);
  gate.claims.push_back(claim_that({ClaimKind::input, "steps that are not finite are taken back"},
                                   "V14: every frame finite", finite));
  for (int k = 0; k < 60; ++k) {
    if (k % 6 == 0) pressed.solver->refresh();
    pressed.solver->step(std::nullopt, kFrame);
  }
  gate.claims.push_back(claim_at_most({ClaimKind::fitted, "the relaxation time was chosen for it"},
                                      "V14: largest displacement 1 s after release",
                                      pressed.largest_displacement() * 1e3, 1e-4, "mm"));
  return gate;
}

}  // namespace artus
