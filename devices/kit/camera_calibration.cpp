// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/devices/kit/camera_calibration.h"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>

#include "artus/detail/core/check.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus::kit {
namespace {

constexpr double kLeastTilt = 20 * kDegree;
constexpr double kMostTilt = 55 * kDegree;

void pack(const std::vector<BoardCorner>& corners, std::vector<cv::Point3f>& on_board,
          std::vector<cv::Point2f>& on_picture) {
  for (const BoardCorner& corner : corners) {
    on_board.emplace_back(static_cast<float>(corner.p_B.x()), static_cast<float>(corner.p_B.y()),
                          0.0F);
    on_picture.emplace_back(static_cast<float>(corner.pixel.x()),
                            static_cast<float>(corner.pixel.y()));
  }
}

}  // namespace

CameraCalibration::CameraCalibration(int width, int height, double scale)
    : width_(width), height_(height), scale_(scale) {}

bool CameraCalibration::take(const cv::Mat& grey) {
  ARTUS_REQUIRE(grey.cols == width_ && grey.rows == height_, "pictures of one size");
  constexpr std::size_t kCorners = 12;
  constexpr double kOtherTilt = 8 * kDegree;
  constexpr double kOtherPlace = 0.06;  // m
  View view;
  view.corners = find_board(grey, scale_);
  if (view.corners.size() < kCorners) return false;
  std::vector<cv::Point3f> on_board;
  std::vector<cv::Point2f> on_picture;
  pack(view.corners, on_board, on_picture);
  const double f = 0.8 * width_;  // a usual webcam's, to see the tilt
  cv::Mat turn;
  cv::Mat shift;
  const cv::Matx33d guess(f, 0, width_ / 2.0, 0, f, height_ / 2.0, 0, 0, 1);
  if (!cv::solvePnP(on_board, on_picture, guess, cv::noArray(), turn, shift)) return false;
  const Vec3 axis(turn.at<double>(0), turn.at<double>(1), turn.at<double>(2));
  const double angle = axis.norm();
  view.normal = angle > 0 ? Vec3(Eigen::AngleAxisd(angle, axis / angle) * Vec3::UnitZ())
                          : Vec3(Vec3::UnitZ());
  view.place = Vec3(shift.at<double>(0), shift.at<double>(1), shift.at<double>(2));
  view.tilt = std::acos(std::min(1.0, std::abs(view.normal.z())));
  const bool known = std::any_of(views_.begin(), views_.end(), [&](const View& other) {
    return (other.place - view.place).norm() < kOtherPlace &&
           std::acos(std::min(1.0, std::abs(other.normal.dot(view.normal)))) < kOtherTilt;
  });
  if (known) return false;
  if (view.tilt > kLeastTilt && view.tilt < kMostTilt) ++tilted_;
  views_.push_back(std::move(view));
  return true;
}

std::string CameraCalibration::missing() const {
  if (tilted_ < kFewestTilted)
    return printed("tilt the board by 25 to 45 degrees, to all sides (%d of %d tilted pictures)",
                   tilted_, kFewestTilted);
  if (pictures() < kFewest)
    return printed("hold the board elsewhere, also near the corners of the picture (%d of %d)",
                   pictures(), kFewest);
  return "";
}

Result<Lens> CameraCalibration::solve_of(const std::vector<const View*>& views, double& rms,
                                         double& deviation) const {
  std::vector<std::vector<cv::Point3f>> on_board(views.size());
  std::vector<std::vector<cv::Point2f>> on_picture(views.size());
  for (std::size_t i = 0; i < views.size(); ++i)
    pack(views[i]->corners, on_board[i], on_picture[i]);
  cv::Mat matrix = cv::initCameraMatrix2D(on_board, on_picture, {width_, height_});
  cv::Mat bend = cv::Mat::zeros(1, 5, CV_64F);
  std::vector<cv::Mat> turns;
  std::vector<cv::Mat> shifts;
  cv::Mat spread;
  try {
    rms = cv::calibrateCamera(on_board, on_picture, {width_, height_}, matrix, bend, turns, shifts,
                              spread, cv::noArray(), cv::noArray(),
                              cv::CALIB_FIX_ASPECT_RATIO | cv::CALIB_FIX_K3);
  } catch (const cv::Exception&) {
    return fail(ErrorCode::invalid, "no lens fits these pictures: take others");
  }
  Lens lens;
  lens.width = width_;
  lens.height = height_;
  lens.fx = matrix.at<double>(0, 0);
  lens.fy = matrix.at<double>(1, 1);
  lens.cx = matrix.at<double>(0, 2);
  lens.cy = matrix.at<double>(1, 2);
  for (std::size_t i = 0; i < 5; ++i) lens.distortion[i] = bend.at<double>(static_cast<int>(i));
  deviation = spread.at<double>(0) / lens.fx;
  return lens;
}

Result<Lens> CameraCalibration::solve() const {
  constexpr double kMostRms = 1;  // pixel
  constexpr double kMostApart = 0.02;
  constexpr double kLeastError = 2e-3;  // assumed: a board that is bowed by 0.2 mm shows in nothing
  if (const std::string more = missing(); !more.empty())
    return fail(ErrorCode::invalid, more, "camera");
  std::vector<const View*> all;
  std::vector<const View*> halves[2];  // NOLINT(*-avoid-c-arrays)
  for (std::size_t i = 0; i < views_.size(); ++i) {
    all.push_back(&views_[i]);
    halves[i % 2].push_back(&views_[i]);
  }
  double rms = 0;
  double deviation = 0;
  auto lens = solve_of(all, rms, deviation);
  ARTUS_TRY(lens);
  double other = 0;
  double unused = 0;
  const auto even = solve_of(halves[0], unused, other);
  ARTUS_TRY(even);
  const auto odd = solve_of(halves[1], unused, other);
  ARTUS_TRY(odd);
  const double apart = std::abs(even->fx - odd->fx) / lens->fx;
  if (!(rms < kMostRms))
    return fail(ErrorCode::invalid,
                printed("the board does not fit by %.2f pixels: it is bent, or the focus changed; "
                        "lay it under glass, lock the focus, begin again",
                        rms),
                "camera");
  if (apart > kMostApart)
    return fail(ErrorCode::invalid,
                printed("two halves of the pictures say focal lengths %.1f %% apart: take more, "
                        "most of them tilted",
                        100 * apart),
                "camera");
  lens->focal_error = std::max({kLeastError, 2 * deviation, apart});
  return lens;
}

}  // namespace artus::kit
