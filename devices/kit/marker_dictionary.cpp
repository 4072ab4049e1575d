// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/devices/kit/marker_dictionary.h"

#include <algorithm>

#include <opencv2/core/version.hpp>
#if CV_VERSION_MAJOR > 4 || CV_VERSION_MINOR >= 7
#include <opencv2/objdetect/aruco_detector.hpp>
#else
#include <opencv2/aruco.hpp>
#endif

#include "artus/detail/core/check.h"

namespace artus::kit {
namespace {

/// One window of the search, in pixels, as markers of 15 to 80 pixels need, and no correction of
/// bits: clutter must not be a marker.
template <class Parameters>
void set_search(Parameters& parameters) {
  parameters.adaptiveThreshWinSizeMin = 13;
  parameters.adaptiveThreshWinSizeMax = 13;
  parameters.minMarkerPerimeterRate = 0.03;
  parameters.maxMarkerPerimeterRate = 1.0;
  parameters.errorCorrectionRate = 0.0;
  parameters.minOtsuStdDev = 5.0;
}

#if CV_VERSION_MAJOR > 4 || CV_VERSION_MINOR >= 7
void draw(int id, cv::Mat& out) {
  cv::aruco::generateImageMarker(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50), id, 6,
                                 out, 1);
}
void detect(const cv::Mat& grey, std::vector<std::vector<cv::Point2f>>& corners,
            std::vector<int>& ids) {
  cv::aruco::DetectorParameters parameters;
  set_search(parameters);
  parameters.cornerRefinementMethod = cv::aruco::CORNER_REFINE_NONE;
  cv::aruco::ArucoDetector(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50), parameters)
      .detectMarkers(grey, corners, ids);
}
#else
void draw(int id, cv::Mat& out) {
  cv::aruco::drawMarker(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50), id, 6, out, 1);
}
void detect(const cv::Mat& grey, std::vector<std::vector<cv::Point2f>>& corners,
            std::vector<int>& ids) {
  const auto parameters = cv::aruco::DetectorParameters::create();
  set_search(*parameters);
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_NONE;
  cv::aruco::detectMarkers(grey, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50),
                           corners, ids, parameters);
}
#endif

}  // namespace

MarkerCells cells_of_marker(int id) {
  ARTUS_REQUIRE(id >= 0 && id < 50, "a marker of 4x4_50");
  cv::Mat drawn;
  draw(id, drawn);
  MarkerCells cells{};
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column)
      cells[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] =
          drawn.at<unsigned char>(row, column) > 127;
  return cells;
}

std::vector<FoundMarker> find_markers(const cv::Mat& grey) {
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  detect(grey, corners, ids);
  std::vector<FoundMarker> found;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (std::count(ids.begin(), ids.end(), ids[i]) != 1) continue;
    FoundMarker marker{ids[i], {}};
    std::copy_n(corners[i].begin(), 4, marker.corners.begin());
    found.push_back(marker);
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return found;
}

}  // namespace artus::kit
