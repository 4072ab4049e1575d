// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/devices/kit/board.h"
#include "artus/detail/devices/kit/lens.h"

namespace artus::kit {

/// Collects pictures of the board and says what is still missing. A picture counts when it shows
/// enough of the board and differs from those before it.
class CameraCalibration {
 public:
  static constexpr int kFewest = 15;       ///< pictures
  static constexpr int kFewestTilted = 9;  ///< of them tilted by 20 to 50 degrees
  CameraCalibration(int width, int height, double scale);

  /// Whether the picture was kept. Requires: of the camera's size.
  bool take(const cv::Mat& grey);
  /// What to do next, for people: "tilt the board by 25 to 45 degrees (6 of 9 tilted pictures)".
  /// Empty: enough.
  [[nodiscard]] std::string missing() const;
  [[nodiscard]] int pictures() const { return static_cast<int>(views_.size()); }
  [[nodiscard]] int tilted() const { return tilted_; }

  /// The lens, with its error: the largest of twice the focal length's standard deviation, of what
  /// two halves of the pictures differ by, and of 0.2 %. The rms proves nothing: a bowed board
  /// gives a small one. Errors: invalid (too few pictures, too few tilted, an rms above 1 pixel, a
  /// focal length that two halves do not agree about within 2 %).
  [[nodiscard]] Result<Lens> solve() const;

 private:
  struct View {
    std::vector<BoardCorner> corners;
    double tilt = 0;  // rad
    Vec3 place = Vec3::Zero();
    Vec3 normal = Vec3::Zero();
  };
  [[nodiscard]] Result<Lens> solve_of(const std::vector<const View*>& views, double& rms,
                                      double& deviation) const;

  int width_;
  int height_;
  double scale_;
  int tilted_ = 0;
  std::vector<View> views_;
};

}  // namespace artus::kit
