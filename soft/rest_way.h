// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>

#include "artus/soft/deformed_body.h"

namespace artus {

/// Where the tissue of one point of a line was at rest.
struct RestPoint {
  double along = 0;               ///< m from the line's start
  Vec3 rest_J = Vec3::Zero();     ///< m
  Vec3 onward_J = Vec3::UnitZ();  ///< how `rest_J` goes on per metre of line
  double moved = 0;               ///< m, length of the displacement
};

/// The same with what goes on from there.
struct RestKnot : RestPoint {
  Vec3 displacement_J = Vec3::Zero();                       ///< m
  Eigen::Matrix3d inverse_J = Eigen::Matrix3d::Identity();  ///< of F, from here on
  Vec3 rest_C = Vec3::Zero();                               ///< m, in the cage's frame, as two more
  Vec3 onward_C = Vec3::UnitZ();
  Eigen::Matrix3d gradient_C = Eigen::Matrix3d::Identity();  ///< F from here on
  std::int32_t cell = -1;                                    ///< of the cage; -1: outside
  double ahead = 0;  ///< m beyond the cube that are worth a try: it went on straight
};

/// A straight line through a body that gives way, and the way that its tissue had at rest: knots
/// where it passes from cube to cube, between which the way is straight to 8 um. Keeps references.
class RestWay {
 public:
  /// `direction_J`: unit.
  RestWay(const DeformedBody& body, const Vec3& origin_J, const Vec3& direction_J) noexcept;

  /// The knot at `along`; `guess`: a displacement it may have. Cost: some 0.1 us.
  [[nodiscard]] RestKnot at(double along, const Vec3& guess_J = Vec3::Zero()) const noexcept;
  /// The one behind `left`. Cost: 0.1 us.
  [[nodiscard]] RestKnot next(const RestKnot& left) const noexcept;

  /// The point at `along` as a line near by says, whose knot `other` is less than some mm away:
  /// where the tissue is by its displacement and gradient there. Cost: 10 ns.
  [[nodiscard]] RestPoint beside(const RestKnot& other, double along) const noexcept;
  /// The same as a knot that `next` can go on from.
  [[nodiscard]] RestKnot knot_beside(const RestKnot& other, double along) const noexcept;

  /// F v at a knot, frame J: a fibre as the tissue carries it.
  [[nodiscard]] Vec3 carried(const RestKnot& knot, const Vec3& v_J) const noexcept;

 private:
  [[nodiscard]] double to_face(const RestKnot& left) const noexcept;
  void finish(RestKnot& knot) const noexcept;

  const DeformedBody* body_;
  Eigen::Matrix3d R_JC_;
  Vec3 origin_J_;
  Vec3 direction_J_;
  Vec3 origin_C_;
  Vec3 direction_C_;
};

}  // namespace artus
