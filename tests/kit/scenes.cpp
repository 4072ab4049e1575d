// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/kit/scenes.h"

#include <cmath>

namespace artus::test {

Pose camera_at(double distance, double above, double beside) {
  constexpr double kLooksAt = 0.08;  // m over the sheet
  const Vec3 from(std::sin(beside) * std::cos(above), -std::cos(beside) * std::cos(above),
                  std::sin(above));
  const Vec3 target(0, 0, kLooksAt);
  const Vec3 z = -from;
  const Vec3 x = z.cross(Vec3::UnitZ()).normalized();
  return make_pose(target + distance * from, z, x);
}

Pose needle_towards(const Vec3& tip_P, double steepness, double offset, const Pose& X_SP) {
  const Vec3 direction(std::cos(steepness), 0, std::sin(steepness));
  // the syringe's markers (y of its body, as of the needle) look to the camera
  const Vec3 y(0, 1, 0);
  Pose X_PN = make_pose(tip_P + Vec3(0, offset, 0), direction, y.cross(direction));
  return X_SP * X_PN;
}

KitScene make_scene(std::mt19937_64& random, double distance, double depth) {
  std::uniform_real_distribution<double> any(-1, 1);
  const auto turned = [&](double angle) {
    return Eigen::AngleAxisd(angle * any(random),
                             Vec3(any(random), any(random), any(random)).normalized());
  };
  KitScene scene;
  scene.X_SC = camera_at(distance, 0.65 + 0.2 * any(random), 0.25 * any(random));
  const Vec3 place(0.02 * any(random), 0.02 * any(random), 0.05);
  scene.X_SP = make_pose(place, -Vec3::UnitZ(), Vec3::UnitX());
  scene.X_SP.linear() = turned(0.25) * scene.X_SP.linear();
  scene.X_SN = needle_towards({-0.005 + 0.01 * any(random), 0, depth}, 0.5 + 0.25 * any(random),
                              2e-3 * any(random), scene.X_SP);
  scene.X_SN.linear() = turned(0.35) * scene.X_SN.linear();
  scene.plunger = 0.03 + 0.02 * any(random);
  return scene;
}

std::vector<ShownBody> bodies_of(const KitScene& scene, const kit::Kit& kit) {
  const Pose X_CS = scene.X_SC.inverse();
  std::vector<ShownBody> shown;
  shown.push_back({kit.sheet, X_CS, 0.4, {0.1485, 0.105}});
  shown.push_back({kit.probe, X_CS * scene.X_SP * kit.X_BP.inverse(), 0.17, {}});
  ShownBody syringe{kit.syringe, X_CS * scene.X_SN * kit.X_BN.inverse(), 1.0 / 6, {}};
  kit::Marker plunger = kit.plunger;
  for (Vec3& corner : plunger.corners) corner.z() += scene.plunger - kit::kStroke;
  syringe.body.markers.push_back(plunger);
  shown.push_back(syringe);
  return shown;
}

}  // namespace artus::test
