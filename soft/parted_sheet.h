// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <vector>

#include <Eigen/Core>

#include "artus/soft/bolus.h"

namespace artus {

/// The sheets along which a region parts around a point: z = height(p) + level over p = (x, y), m,
/// along the first two of its axes; none crosses another. They follow the fibres or, where those
/// are unknown, the region's walls.
class PartedSheet {
 public:
  /// `axes`: unit, in columns: along the fibres, beside them, the way that sheets are stacked.
  PartedSheet(const CompiledJoint& joint, RegionId region, const Vec3& tip,
              const Eigen::Matrix3d& axes, const FibreField& fibres);

  [[nodiscard]] double height(const Eigen::Vector2d& p) const;  ///< m; 0 at the tip
  [[nodiscard]] Eigen::Vector2d slope(const Eigen::Vector2d& p) const;
  [[nodiscard]] const Eigen::Matrix2d& bend() const noexcept { return bend_; }  ///< 1/m
  /// Whether the sheet at `level` lies in the region there, and goes on from the tip, with a film
  /// of tissue above and below. Cost: some ns.
  [[nodiscard]] bool allows(const Eigen::Vector2d& p, double level) const;
  /// The nearest level that is allowed at the tip, m.
  [[nodiscard]] double nearest_level(double level) const;
  /// Unit, along the fibres as far as they run in the sheet.
  [[nodiscard]] Eigen::Vector2d along(const Eigen::Vector2d& p, double level) const;
  /// Frame J.
  [[nodiscard]] Vec3 point(const Eigen::Vector2d& p, double level) const;

 private:
  struct Span {
    double low = 0;  // m
    double high = 0;
    [[nodiscard]] bool is_there() const { return high > low; }
  };
  struct Wall {
    std::array<Vec3, 3> corners;  // m, along the axes from the tip
    bool is_top = false;          // the region ends there on the way up
  };
  void find_spans(const std::vector<Wall>& walls);
  void fit_height();
  [[nodiscard]] const Span& span_at(const Eigen::Vector2d& p) const;

  RegionId region_;
  Vec3 tip_;
  Eigen::Matrix3d axes_;
  const FibreField* fibres_;
  std::vector<Span> spans_;  // by cell: where it goes on from the tip
  Eigen::Vector2d slope_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d bend_ = Eigen::Matrix2d::Zero();
};

}  // namespace artus
