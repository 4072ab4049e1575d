// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>

#include "artus/detail/soft/solver/soft_block.h"
#include "artus/detail/soft/solver/soft_solver.h"

namespace artus::test {

inline constexpr double kNu = 0.47;

/// A small layered block with a face that is pressed on it.
struct Pressed {
  SoftBlock block;
  std::shared_ptr<const SoftModel> model;
  std::unique_ptr<SoftSolver> solver;

  explicit Pressed(double friction = 0, const SoftSolverParams& params = {}) {
    block.half_x = 24e-3;
    block.half_y = 18e-3;
    block.layers = {{2e-3, linear_material(120e3, kNu)},
                    {6e-3, linear_material(3e3, kNu)},
                    {10e-3, linear_material(12e3, kNu)}};
    model =
        make_block_model(block, 6e-3, {{Vec3(-14e-3, -6e-3, -1), Vec3(14e-3, 6e-3, 6e-3), 3e-3}});
    const SkinPatch skin = make_flat_skin(block, 3e-3);
    solver = std::make_unique<SoftSolver>(
        model, contact_unknowns(*model, skin, Vec3(-14e-3, -8e-3, -1), Vec3(14e-3, 8e-3, 1)),
        params);
    ProbeFace face;
    face.length = 20e-3;
    face.points_x = 10;
    face.friction = friction;
    solver->set_face(skin, face);
  }
};

inline Pose face_at(double depth) {
  Pose pose = Pose::Identity();
  pose.translation().z() = depth;
  return pose;
}

}  // namespace artus::test
