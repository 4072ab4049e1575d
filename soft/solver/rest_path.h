// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>

#include "artus/detail/soft/solver/deformed_body.h"

namespace artus {

/// Where the tissue of one point of a line was at rest.
struct RestKnot {
  double along = 0;               ///< m from the line's start
  Vec3 rest_J = Vec3::Zero();     ///< m
  Vec3 onward_J = Vec3::UnitZ();  ///< how `rest_J` goes on per metre of line
  Vec3 displacement_J = Vec3::Zero();
  double moved = 0;                                         ///< m, its length
  Eigen::Matrix3d inverse_J = Eigen::Matrix3d::Identity();  ///< of F from here on
  Vec3 rest_C = Vec3::Zero();                               ///< m, in the cage's frame, as the next
  Vec3 onward_C = Vec3::UnitZ();
  std::int32_t cell = -1;  ///< of the cage; -1: outside
  double ahead = 0;        ///< m beyond the cube that are worth a try: it went on straight

  /// Where the tissue at a point near by, some mm away, was at rest, by the displacement and the
  /// gradient here.
  [[nodiscard]] Vec3 beside(const Vec3& p_J) const noexcept {
    return rest_J + inverse_J * (p_J - rest_J - displacement_J);
  }
};

/// A straight line through a body that gives way, and the way that its tissue had at rest: knots
/// where it passes from cube to cube, between which the path is straight to 8 um. Keeps references.
class RestPath {
 public:
  /// `direction_J`: unit.
  RestPath(const DeformedBody& body, const Vec3& origin_J, const Vec3& direction_J) noexcept;

  /// The knot at `along`; `guess`: a displacement it may have. Cost: some 0.1 us.
  [[nodiscard]] RestKnot at(double along, const Vec3& guess_J = Vec3::Zero()) const noexcept;
  /// The one behind `left`. Cost: 0.1 us.
  [[nodiscard]] RestKnot next(const RestKnot& left) const noexcept;

 private:
  [[nodiscard]] double to_face(const RestKnot& left) const noexcept;
  [[nodiscard]] bool meets_layers(const RestKnot& left, double from, double to) const noexcept;
  void finish(const Eigen::Matrix3d& gradient_C, RestKnot& knot) const noexcept;

  const DeformedBody* body_;
  Vec3 origin_J_;
  Vec3 direction_J_;
  Vec3 origin_C_;
  Vec3 direction_C_;
};

}  // namespace artus
