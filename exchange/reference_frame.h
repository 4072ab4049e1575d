// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/core/geometry.h"
#include "artus/core/result.h"
#include "artus/detail/exchange/igtl/contents.h"
#include "artus/echo/transducer.h"

namespace artus {

/// What other programs call Reference, in millimetres, against the joint's frame J in metres. The
/// joint is LPS; Reference is RAS, or whatever a tracker's reference sensor is registered to.
class ReferenceFrame {
 public:
  /// J itself with its first two axes turned round: RAS, the origin the same.
  ReferenceFrame();
  /// `X_JR`: Reference in J, lengths in metres.
  explicit ReferenceFrame(const Pose& X_JR);

  /// A pose in J as the matrix <A>ToReference.
  [[nodiscard]] igtl::Matrix to_reference(const Pose& X_JA) const;
  /// A matrix <A>ToReference as a pose in J. Errors: invalid, when its rotation is scaled, sheared
  /// or mirrored by more than a thousandth, or it lies farther off than kDeviceReach.
  [[nodiscard]] Result<Pose> from_reference(const igtl::Matrix& matrix) const;

  [[nodiscard]] const Pose& X_JR() const noexcept { return X_JR_; }

 private:
  Pose X_JR_;
};

/// Reference in the joint for hands over a block on a table (x and y along the table, z up, origin
/// in the middle of the block's top): a probe that stands there, its x along the block's, is the
/// one at `X_JP`.
[[nodiscard]] Pose block_in_joint(const Pose& X_JP);

/// A matrix in millimetres as a rigid pose in metres. Errors: as from_reference.
[[nodiscard]] Result<Pose> rigid_from(const igtl::Matrix& matrix);
[[nodiscard]] igtl::Matrix millimetres_of(const Pose& pose);

/// Where an image of `height` rows of `pixel` m lies on its probe: right is x, down is z, the
/// middle of pixel (0, 0) is the origin. Frame P, mm a pixel: the matrix ImageToProbe.
[[nodiscard]] igtl::Matrix image_to_probe(const Transducer& transducer, double pixel, int height);

/// ImageToReference = ProbeToReference * ImageToProbe.
[[nodiscard]] igtl::Matrix chained(const igtl::Matrix& outer, const igtl::Matrix& inner);

}  // namespace artus
