// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <cmath>
#include <vector>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/display/frame_measure.h"
#include "artus/detail/evidence/runs/echo_phantom.h"
#include "artus/detail/evidence/validation/echo/echo_gates.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

std::shared_ptr<const Scene> layered_block() {
  const std::array<FlatLayer, 4> layers{
      {{"skin", 2e-3}, {"fat", 6e-3}, {"muscle", 14e-3}, {"bone", 20e-3}}};
  return make_block_scene(layers);
}

double count_differences(const Frame& a, const Frame& b) {
  double different = a.image.size() == b.image.size() && a.envelope.size() == b.envelope.size()
                         ? 0.0
                         : static_cast<double>(a.image.size());
  if (different > 0) return different;
  for (std::size_t i = 0; i < a.image.size(); ++i) different += a.image[i] != b.image[i] ? 1 : 0;
  for (std::size_t i = 0; i < a.envelope.size(); ++i)
    different += a.envelope[i] != b.envelope[i] ? 1 : 0;
  return different;
}

/// Correlation of the speckle before and after a motion by one line, that line apart.
double shifted_correlation() {
  const std::array<FlatLayer, 1> block{{{"muscle", 60e-3}}};
  const auto scene = make_block_scene(
      block, [](CompiledJoint& joint) { acoustic_of(joint, "muscle").attenuation = 0; });
  const Transducer transducer;
  Renderer renderer(scene, transducer, bare_settings());
  const Frame before = renderer.render(Pose::Identity());
  Pose moved = Pose::Identity();
  moved.translation().x() = transducer.pitch();
  const Frame& after = renderer.render(moved);
  std::vector<double> a;
  std::vector<double> b;
  for (int l = 20; l < 230; ++l) {
    const auto line_before = envelope_line(before, l + 1);
    const auto line_after = envelope_line(after, l);
    a.insert(a.end(), line_before.begin() + 30, line_before.end());
    b.insert(b.end(), line_after.begin() + 30, line_after.end());
  }
  return fit_line(a, b).correlation;
}

}  // namespace

Gate gate_motion() {
  Gate gate;
  gate.title = "Rigid motion of body and probe together, sideways motion by one line, threads";
  const auto scene = layered_block();
  const Pose X_JP = make_pose(Vec3(1e-3, 2e-3, 0), Vec3(0.1, 0.05, 1), Vec3(1, 0.2, 0));
  const NeedleView needle = needle_in_plane(X_JP, Vec3(2e-3, 0, 14e-3), 0.4);
  Renderer renderer(scene, Transducer{}, raw_settings());
  const Frame still = renderer.render(probe_in_joint(Pose::Identity(), X_JP), needle);
  double different = 0;
  for (int k = 1; k <= 3; ++k) {
    Pose X_WJ = Pose::Identity();
    X_WJ.linear() = Eigen::AngleAxisd(0.7 * k, Vec3(1, 2, -k).normalized()).toRotationMatrix();
    X_WJ.translation() = Vec3(0.3 * k, -1.1, 0.7);
    different +=
        count_differences(still, renderer.render(probe_in_joint(X_WJ, X_WJ * X_JP), needle));
  }
  gate.claims.push_back(claim_at_most(
      ClaimKind::input, "values that differ after three rigid motions", different, 0, ""));
  gate.claims.push_back(claim_at_least(ClaimKind::input,
                                       "correlation of the speckle, one line on, after one pitch",
                                       shifted_correlation(), 0.999, ""));
  different = 0;
  for (const int threads : {1, 2, 7}) {
    ImageSettings settings = raw_settings();
    settings.n_threads = threads;
    const Frame frame =
        render_bmode(scene, probe_in_joint(Pose::Identity(), X_JP), needle, {}, settings);
    different += count_differences(still, frame);
  }
  gate.claims.push_back(claim_at_most(
      ClaimKind::input, "values that differ between 1, 2 and 7 threads", different, 0, ""));
  return gate;
}

}  // namespace artus
