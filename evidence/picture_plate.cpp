// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/picture_plate.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "artus/echo/image_io.h"

namespace artus {

Result<void> write_plate(std::span<const std::filesystem::path> pictures,
                         std::span<const std::string> names, const std::filesystem::path& file) {
  std::vector<cv::Mat> columns;
  int height = 0;
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    cv::Mat picture = cv::imread(pictures[k].string());
    if (picture.empty())
      return fail(ErrorCode::not_found, "there is no picture", pictures[k].string());
    cv::copyMakeBorder(picture, picture, 28, 0, 4, 4, cv::BORDER_CONSTANT);
    cv::putText(picture, names[k], {10, 20}, cv::FONT_HERSHEY_SIMPLEX, 0.55, {255, 255, 255}, 1,
                cv::LINE_AA);
    height = std::max(height, picture.rows);
    columns.push_back(std::move(picture));
  }
  for (cv::Mat& column : columns)
    cv::copyMakeBorder(column, column, 0, height - column.rows, 0, 0, cv::BORDER_CONSTANT);
  cv::Mat plate;
  cv::hconcat(columns, plate);
  return write_image(plate, file);
}

}  // namespace artus
