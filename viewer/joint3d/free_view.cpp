// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/joint3d/free_view.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/units.h"

namespace artus {

double covered_share(const OutsideBody& body, const OrbitCamera& camera) {
  constexpr double kHalfAngle = 0.35;  // rad
  const Vec3 eye = eye_of(camera);
  const Vec3 look = (camera.centre - eye).normalized();
  const auto& v = body.skin.vertices;
  double covered = 0;
  for (const Triangle& t : body.skin.triangles) {
    const Vec3 place = (v[t[0]] + v[t[1]] + v[t[2]]) / 3;
    const Vec3 way = place - eye;
    const double along = way.dot(look);
    if (along <= 0 || along > camera.distance - 0.5 * body.hole->radius) continue;
    if ((way - along * look).norm() > std::tan(kHalfAngle) * along || is_in_hole(body, place))
      continue;
    const Vec3 area = (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]) / 2;
    covered += std::max(0.0, -area.dot(way)) / (way.norm() * way.squaredNorm());
  }
  return covered / (4 * kHalfAngle * kHalfAngle);
}

OrbitCamera find_free_view(const OutsideBody& body, const OrbitCamera& asked) {
  constexpr double kStep = 15 * kDegree;
  constexpr int kSteps = 12;     // to either side: all around
  constexpr double kRise = 0.3;  // rad
  constexpr double kFree = 0.05;
  OrbitCamera best = asked;
  double least = 1e9;
  for (const double rise : {0.0, kRise, 2 * kRise})
    for (int i = 0; i <= kSteps; ++i)
      for (const double turn : {i * kStep, -i * kStep}) {
        OrbitCamera camera = asked;
        camera.yaw += turn;
        camera.pitch += rise;
        const double share = covered_share(body, camera);
        if (share <= kFree) return camera;
        if (share >= least) continue;
        least = share;
        best = camera;
      }
  return best;
}

}  // namespace artus
