// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/atlas/atlas_frame.h"

#include <algorithm>
#include <array>

#include "artus/detail/core/printed.h"

namespace artus {
namespace {

/// Units that files come in beside the one they were read in; 27.66: one atlas's files for the web.
constexpr std::array<double, 9> kScales{1,    1000,       0.001, 100,        0.01,
                                        25.4, 1.0 / 25.4, 27.66, 1.0 / 27.66};

std::vector<Eigen::Matrix3d> axis_turns() {
  std::vector<Eigen::Matrix3d> turns;
  std::array<int, 3> axes{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
      for (int row = 0; row < 3; ++row)
        turn(row, axes[static_cast<std::size_t>(row)]) = (signs >> row & 1) != 0 ? -1 : 1;
      if (turn.determinant() > 0) turns.push_back(turn);
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  std::stable_partition(turns.begin(), turns.end(),
                        [](const Eigen::Matrix3d& t) { return t.isIdentity(0); });
  return turns;
}

}  // namespace

Eigen::AlignedBox3d AtlasFrame::apply(const Eigen::AlignedBox3d& box) const {
  Eigen::AlignedBox3d out(apply(box.min()));
  out.extend(apply(box.max()));
  return out;
}

std::string AtlasFrame::to_string() const {
  std::string text = scale == 1 ? "" : printed("times %g", scale);
  if (turn.isIdentity(0)) return text;
  text += (text.empty() ? "" : ", ") + std::string("x y z from");
  for (int row = 0; row < 3; ++row)
    for (int axis = 0; axis < 3; ++axis)
      if (turn(row, axis) != 0)
        text += printed(" %s%c", turn(row, axis) < 0 ? "-" : "", "xyz"[axis]);
  return text;
}

double corners_apart(const AtlasFrame& frame, const KnownBox& box) {
  const Eigen::AlignedBox3d found = frame.apply(box.found);
  return std::max((found.min() - box.known.min()).cwiseAbs().maxCoeff(),
                  (found.max() - box.known.max()).cwiseAbs().maxCoeff());
}

std::optional<AtlasFrame> find_atlas_frame(const std::vector<KnownBox>& boxes) {
  std::optional<AtlasFrame> best;
  std::size_t most = 0;
  for (const double scale : kScales)
    for (const Eigen::Matrix3d& turn : axis_turns()) {
      const AtlasFrame frame{scale, turn};
      const auto fits = static_cast<std::size_t>(std::count_if(
          boxes.begin(), boxes.end(),
          [&](const KnownBox& box) { return corners_apart(frame, box) <= box.near; }));
      if (fits <= most) continue;
      most = fits;
      best = frame;
    }
  return best;
}

}  // namespace artus
