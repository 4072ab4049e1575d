// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/reference_frame.h"

#include "artus/detail/core/units.h"
#include "artus/detail/echo/display/scan_converter.h"
#include "artus/detail/simulation/plain_pose.h"
#include "artus/echo/image_settings.h"

namespace artus {
namespace {

Pose ras_in_lps() {
  Pose pose = Pose::Identity();
  pose.linear().diagonal() = Vec3(-1, -1, 1);
  return pose;
}

}  // namespace

ReferenceFrame::ReferenceFrame() : X_JR_(ras_in_lps()) {}

ReferenceFrame::ReferenceFrame(const Pose& X_JR) : X_JR_(X_JR) {}

igtl::Matrix ReferenceFrame::to_reference(const Pose& X_JA) const {
  return millimetres_of(X_JR_.inverse() * X_JA);
}

Result<Pose> ReferenceFrame::from_reference(const igtl::Matrix& matrix) const {
  const auto pose = rigid_from(matrix);
  ARTUS_TRY(pose);
  return Pose(X_JR_ * *pose);
}

igtl::Matrix millimetres_of(const Pose& pose) {
  igtl::Matrix matrix = pose.affine();
  matrix.col(3) /= kMillimetre;
  return matrix;
}

Pose block_in_joint(const Pose& X_JP) {
  Pose X_PR = Pose::Identity();
  X_PR.linear().diagonal() = Vec3(1, -1, -1);
  return X_JP * X_PR;
}

Result<Pose> rigid_from(const igtl::Matrix& matrix) {
  constexpr double kTolerance = 1e-3;  // of an axis' length and of the angles between them
  const Eigen::Matrix3d r = matrix.leftCols<3>();
  if (!matrix.allFinite() || r.determinant() <= 0 ||
      !((r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kTolerance))
    return fail(ErrorCode::invalid, "invalid pose: its axes are scaled, sheared or mirrored");
  if (!(matrix.col(3).cwiseAbs().maxCoeff() * kMillimetre < kDeviceReach))
    return fail(ErrorCode::invalid,
                "invalid pose: more than 10 m from the origin; lengths must be millimetres");
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(r).normalized().toRotationMatrix();
  pose.translation() = matrix.col(3) * kMillimetre;
  return pose;
}

igtl::Matrix image_to_probe(const Transducer& transducer, double pixel, int height) {
  // The converter knows where an image's corner is; a coarse one knows it as well as a fine one.
  ImageSettings coarse;
  coarse.pixel = 2e-3;
  coarse.n_samples = 2;
  coarse.depth = pixel * height;
  const auto corner = [&] {
    const Vec3 middle = ScanConverter(transducer, coarse).point_of(0, 0);
    return Vec3(middle - 0.5 * Vec3(coarse.pixel, 0, coarse.pixel));
  };
  const double above = corner().z();  // of a curved face, whatever the depth
  coarse.depth += above;
  igtl::Matrix matrix = igtl::Matrix::Zero();
  const double mm = pixel / kMillimetre;
  matrix(0, 0) = mm;
  matrix(2, 1) = mm;
  matrix(1, 2) = -mm;
  matrix.col(3) = (corner() + 0.5 * Vec3(pixel, 0, pixel)) / kMillimetre;
  return matrix;
}

igtl::Matrix chained(const igtl::Matrix& outer, const igtl::Matrix& inner) {
  igtl::Matrix product = outer.leftCols<3>() * inner;
  product.col(3) += outer.col(3);
  return product;
}

}  // namespace artus
