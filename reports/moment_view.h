// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <vector>

#include "artus/detail/reports/mesh_picture.h"
#include "artus/detail/training/scenario.h"
#include "artus/raycast/scene.h"
#include "artus/simulation/session_params.h"

namespace artus {

/// Draws an attempt's moments in three dimensions for a page: the joint cut open at the picture's
/// plane and seen obliquely from the side, its bones, the target or what is to be shown (green) and
/// what must be spared (red), the probe's face, the picture's outline, the needle, and the way from
/// its tip to the plane. The view stands still beside the probe.
class MomentView {
 public:
  MomentView(const Scenario& scenario, const Scene& scene, const SessionParams& params);

  /// (height, width) blue, green, red. Cost: linear in the triangles of what is drawn.
  [[nodiscard]] cv::Mat draw(const Pose& X_JP, const std::optional<Pose>& X_JN,
                             cv::Size size) const;

 private:
  [[nodiscard]] std::vector<ColouredMesh> outline() const;
  void add_needle(const Pose& X_PN, const Eigen::AlignedBox3d& around,
                  std::vector<ColouredMesh>& meshes) const;

  std::vector<ColouredMesh> body_;  // frame J
  Transducer transducer_;
  double depth_;   // m
  double length_;  // m, of the needle
};

}  // namespace artus
