// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <numbers>
#include <string>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/compile/labels/compile_surfaces.h"
#include "artus/detail/core/units.h"
#include "tests/anatomy/surfaces/surface_samples.h"

namespace artus::test {

inline double ball_volume(double radius) {
  return 4.0 / 3 * std::numbers::pi * radius * radius * radius;
}

/// A ball among the structures of a joint.
struct Ball {
  std::string name;
  std::string tissue;
  Vec3 centre = Vec3::Zero();  ///< m
  double radius = 0;           ///< m
};

inline PreparedSurface prepared(const SurfaceMesh& mesh) {
  PreparedSurface surface;
  surface.mesh = mesh;
  surface.tree = DistanceTree(mesh);
  surface.thickness = 2 * signed_volume(mesh) / surface_area(mesh);
  return surface;
}

/// A joint of balls in a body, as the joint file and the repaired surfaces would give it.
struct BallsJoint {
  JointFile file;
  PreparedSurfaces surfaces;

  BallsJoint(double body_radius, const std::vector<Ball>& balls) {
    file.name = "balls";
    file.filler_name = "filler";
    file.facet_size = 4e-3;
    file.facet_distance = 0.4e-3;
    file.cell_size = 8e-3;
    file.body.name = "body";
    file.body.tissue = "fat";
    surfaces.body = prepared(make_sphere(Vec3::Zero(), body_radius));
    for (const Ball& ball : balls) {
      Structure structure;
      structure.name = ball.name;
      structure.tissue = ball.tissue;
      file.structures.push_back(structure);
      surfaces.structures.emplace_back(prepared(make_sphere(ball.centre, ball.radius)));
    }
  }
  void add_construct(const std::string& name, decltype(Structure::shape) shape) {
    Structure structure;
    structure.name = name;
    structure.tissue = "skin";
    structure.shape = std::move(shape);
    file.structures.push_back(structure);
    surfaces.structures.emplace_back(std::nullopt);
  }
  /// One report a structure behind the filler's, as compile_joint begins it.
  [[nodiscard]] CompileReport empty_report() const {
    CompileReport report;
    report.structures.resize(file.structures.size() + 1);
    report.structures[0].name = file.filler_name;
    report.structures[0].kind = "filler";
    for (std::size_t i = 0; i < file.structures.size(); ++i) {
      report.structures[i + 1].name = file.structures[i].name;
      report.structures[i + 1].tissue = file.structures[i].tissue;
      report.structures[i + 1].kind = "surface";
      if (surfaces.structures[i])
        report.structures[i + 1].surface_volume = signed_volume(surfaces.structures[i]->mesh);
    }
    return report;
  }
};

}  // namespace artus::test
