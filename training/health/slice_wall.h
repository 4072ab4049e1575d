// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/detail/anatomy/body/tet_mesh.h"
#include "artus/echo/transducer.h"

namespace artus {

/// The walls of a space where a picture's plane cuts them, each piece with how long it was before
/// the space was opened.
class SliceWall {
 public:
  /// `before` and `after`: the same body; where they are not (tissue was parted) nothing is known
  /// of any wall. `regions`: the space's, by RegionId. `transducer`: beams as find_walls has them.
  SliceWall(const TetMesh& before, const TetMesh& after, const std::vector<bool>& regions,
            const Pose& X_JP, const Transducer& transducer);

  /// m, what the walls between beam `beam` and the next, from `from` to `to` m from the face but
  /// for half a beam's spacing at both ends, were long before. Cost: all pieces of the slice.
  [[nodiscard]] double length_before(std::size_t beam, double from, double to) const;

 private:
  struct Piece {
    Vec3 a = Vec3::Zero();  ///< m, frame P, in the plane y = 0
    Vec3 b = Vec3::Zero();
    double before = 0;  ///< m
  };
  void cut(const TetMesh& before, const TetMesh& after, const std::array<std::uint32_t, 3>& facet,
           const Pose& X_PJ);

  Transducer beams_;
  std::vector<Piece> pieces_;
};

}  // namespace artus
