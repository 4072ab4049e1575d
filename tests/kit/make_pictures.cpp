// SPDX-License-Identifier: AGPL-3.0-or-later
// For scripts/check-hands: the pictures of a whole calibration, rendered with a kit that is not as
// drawn, a folder for each phase, and truth.toml with what it is. Usage: artus_kit_pictures FOLDER
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>

#include <opencv2/imgcodecs.hpp>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/devices/kit/board.h"
#include "artus/detail/devices/kit/kit_file.h"
#include "tests/kit/scenes.h"

namespace artus {
namespace {

using kit::Kit;
constexpr double kPi = 3.14159265358979323846;

/// Writes pictures of one phase.
class Phases {
 public:
  Phases(std::filesystem::path folder, const kit::Lens& lens)
      : folder_(std::move(folder)), renderer_(lens) {
    flaws_.hidden = 0.01;
  }
  void write(const char* phase, int n,
             const std::function<std::vector<test::ShownBody>(int)>& bodies) {
    std::filesystem::create_directories(folder_ / phase);
    for (int k = 0; k < n; ++k)
      cv::imwrite((folder_ / phase / printed("%05dms.jpg", k * 33)).string(),
                  renderer_.render(bodies(k), flaws_, ++seed_));
  }
  void write_board(int n) {
    std::filesystem::create_directories(folder_ / "board");
    for (int k = 0; k < n; ++k) {
      const double tilt = k % 4 == 3 ? 0.1 : 0.55 + 0.15 * std::sin(2.3 * k);
      Pose X_CB = Pose::Identity();
      X_CB.linear() = Eigen::AngleAxisd(tilt, Vec3(std::cos(1.1 * k), std::sin(1.1 * k), 0)) *
                      Eigen::AngleAxisd(kPi, Vec3::UnitX()) *
                      Eigen::AngleAxisd(0.3 * std::sin(k), Vec3::UnitZ()).toRotationMatrix();
      X_CB.translation() =
          Vec3(0.1 * std::sin(1.7 * k), 0.05 * std::cos(2.9 * k), 0.43 + 0.08 * std::sin(k));
      const test::ShownBoard board{X_CB, kit::kBoardColumns, kit::kBoardRows, kit::kBoardSquare};
      test::ViewFlaws flaws = flaws_;
      flaws.hidden = 0;
      cv::imwrite((folder_ / "board" / printed("%05dms.jpg", k * 500)).string(),
                  renderer_.render({{kit::make_board(), X_CB, 0, {}}}, flaws, ++seed_, &board));
    }
  }

 private:
  std::filesystem::path folder_;
  test::ViewRenderer renderer_;
  test::ViewFlaws flaws_;
  std::uint64_t seed_ = 0;
};

/// A body that is turned before the camera.
std::vector<test::ShownBody> turned(const kit::MarkerBody& body, int k) {
  Pose X_CB = Pose::Identity();
  X_CB.linear() = Eigen::AngleAxisd(-kPi / 2 + 0.4 * std::sin(0.31 * k), Vec3::UnitX()) *
                  Eigen::AngleAxisd(0.8 * std::sin(0.17 * k), Vec3::UnitZ()).toRotationMatrix();
  X_CB.linear() = Eigen::AngleAxisd(0.3 * std::sin(0.07 * k), Vec3::UnitZ()) * X_CB.linear();
  X_CB.translation() = Vec3(0.05 * std::sin(0.23 * k), 0.03 * std::cos(0.19 * k), 0.42);
  return {{body, X_CB, 1.0 / 6, {}}};
}

/// The needle with its tip at a place of the sheet, leaning and rolled.
Pose needle_at(const Vec3& tip_S, double lean_x, double lean_y, double roll) {
  // upright: z down, the syringe's markers (y) to the camera, which is at -y of the sheet
  Pose upright = make_pose(Vec3::Zero(), -Vec3::UnitZ(), -Vec3::UnitX());
  upright.linear().col(1) = -Vec3::UnitY();
  upright.linear().col(0) = upright.linear().col(1).cross(upright.linear().col(2));
  Pose X_SN = Pose::Identity();
  X_SN.linear() = Eigen::AngleAxisd(lean_x, Vec3::UnitX()) *
                  Eigen::AngleAxisd(lean_y, Vec3::UnitY()) * upright.linear() *
                  Eigen::AngleAxisd(roll, Vec3::UnitZ());
  X_SN.translation() = tip_S;
  return X_SN;
}

void write_tip(Phases& phases, const Kit& real, const Pose& X_SC) {
  const auto shown = [&](const Pose& X_SN) {
    test::KitScene scene;
    scene.X_SC = X_SC;
    scene.X_SN = X_SN;
    scene.X_SP.translation() = Vec3(0, 0, -10);  // behind the table: not there
    auto bodies = test::bodies_of(scene, real);
    bodies.erase(bodies.begin() + 1);
    return bodies;
  };
  const Vec3 pit(0.02, 0.01, 0.003);
  const Vec3 apart(kit::kDivotsApart, 0, 0);
  phases.write("lean", 220, [&](int k) {
    return shown(needle_at(pit, 0.25 + 0.45 * std::sin(0.21 * k), 0.5 * std::cos(0.13 * k), 0));
  });
  phases.write("pit-a", 25, [&](int k) { return shown(needle_at(pit, 0.2, 0.01 * k, 0)); });
  phases.write("pit-b", 25, [&](int k) { return shown(needle_at(pit - apart, 0.2, 0.01 * k, 0)); });
  phases.write("roll", 60,
               [&](int k) { return shown(needle_at(pit, 0.25, 0, 0.75 * std::sin(0.11 * k))); });
}

void write_face(Phases& phases, const Kit& real, const Pose& X_SC) {
  const std::array<const char*, 3> names{"left", "middle", "right"};
  for (std::size_t i = 0; i < names.size(); ++i)
    phases.write(names[i], 20, [&](int k) {
      test::KitScene scene;
      scene.X_SC = X_SC;
      // the probe lies back, its face to the camera's side and up
      scene.X_SP = make_pose(Vec3(-0.02, 0.02, 0.12), Vec3(0.9, -0.3, 0.25), Vec3(0.2, 0.9, 0.3));
      const Vec3 mark((static_cast<double>(i) - 1) * kit::kTouchSpan, 0, 0);
      scene.X_SN = needle_at(scene.X_SP * mark, 0.2 + 0.004 * k, -1.0, 0);
      return test::bodies_of(scene, real);
    });
}

int write_all(const std::filesystem::path& folder) {
  kit::MeasuredKit truth = kit::make_kit(kit::Hand::right, 1, 50e-3);
  Kit& real = truth.kit;
  real.lens.fx = real.lens.fy = 985;
  real.lens.cx = 650;
  real.lens.cy = 352;
  real.lens.distortion = {0.08, -0.12, 5e-4, -3e-4, 0};
  real.X_BN.translation() += Vec3(1e-3, -1.5e-3, 2e-3);
  real.X_BP.translation() += Vec3(-0.5e-3, 0.8e-3, 1e-3);
  int k = 0;
  for (kit::MarkerBody* body : {&real.probe, &real.syringe})
    for (kit::Marker& marker : body->markers) {
      const Vec3 off = 0.25e-3 * Vec3(std::sin(1.0 + k), std::sin(2.0 * k), std::cos(3.0 * k));
      for (Vec3& corner : marker.corners) corner += off;
      ++k;
    }
  truth.has_camera = truth.has_markers = truth.has_tip = truth.has_face = true;
  Phases phases(folder, real.lens);
  phases.write_board(28);
  phases.write("probe", 120, [&](int i) { return turned(real.probe, i); });
  phases.write("syringe", 120, [&](int i) { return turned(real.syringe, i); });
  const Pose X_SC = test::camera_at(0.45, 0.6, 0.05);
  write_tip(phases, real, X_SC);
  write_face(phases, real, X_SC);
  const auto written = write_text(folder / "truth.toml", to_toml(truth));
  if (!written) std::fprintf(stderr, "%s\n", written.error().to_string().c_str());
  return written ? 0 : 1;
}

}  // namespace
}  // namespace artus

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: artus_kit_pictures FOLDER\n");
    return 2;
  }
  return artus::write_all(argv[1]);
}
