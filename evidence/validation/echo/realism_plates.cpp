// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"
#include "artus/detail/evidence/validation/echo/echo_gates.h"
#include "artus/detail/evidence/validation/echo/realism_gates.h"
#include "artus/detail/evidence/validation/echo/realism_scenes.h"
#include "artus/detail/evidence/validation/echo/screen_measures.h"
#include "artus/echo/image_io.h"
#include "artus/echo/renderer.h"
#include "artus/echo/transducer_file.h"

namespace artus {
namespace {

constexpr int kGap = 8;            // px between the pictures of a plate
constexpr int kPlateHeight = 450;  // px of 0.1 mm

/// A real picture: the part of the file that is tissue, and its scale.
struct RealPicture {
  const char* file;
  cv::Rect part;
  double pixel;  // m
};

// pixels: of the bone pictures as published; of the vastus from a face of 50 mm over 514 px; of the
// Mindray's inferred from a face of 50 mm over the width
constexpr double kBonePixel = 0.0854e-3;
constexpr double kVastusPixel = 0.0973e-3;
constexpr double kTe7Pixel = 0.0977e-3;

Result<cv::Mat> read_real(const std::filesystem::path& folder, const RealPicture& real) {
  const std::filesystem::path file = folder / real.file;
  cv::Mat whole;
  if (std::filesystem::is_regular_file(file))
    whole = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
  if (whole.empty())
    return fail(ErrorCode::not_found, "no picture there; give the folder that holds it",
                file.string());
  cv::Mat part = whole(real.part & cv::Rect({0, 0}, whole.size()));
  const double scale = real.pixel / screen_settings().pixel;
  cv::Mat scaled;
  cv::resize(part, scaled, {}, scale, scale, cv::INTER_LINEAR);
  return scaled.rowRange(0, std::min(scaled.rows, kPlateHeight)).clone();
}

/// Pictures beside each other, as high as the highest.
cv::Mat beside(const std::vector<cv::Mat>& pictures) {
  int height = 0;
  int width = 0;
  for (const cv::Mat& picture : pictures) {
    height = std::max(height, picture.rows);
    width += picture.cols + kGap;
  }
  cv::Mat plate(height, width - kGap, CV_8UC1, cv::Scalar(80));
  int x = 0;
  for (const cv::Mat& picture : pictures) {
    picture.copyTo(plate(cv::Rect(x, 0, picture.cols, picture.rows)));
    x += picture.cols + kGap;
  }
  return plate;
}

cv::Mat muscle_picture(Look look, double turn, const char* transducer) {
  ImageSettings settings = screen_settings();
  settings.look = look;
  const Pose X_JP(Eigen::AngleAxisd(turn, Vec3::UnitZ()));
  const auto preset = find_transducer(transducer);
  return grey_image(render_bmode(long_axis_muscle(), X_JP, {}, preset->transducer, settings))
      .clone();
}

/// A scene by both looks.
std::vector<cv::Mat> pictures_of(const std::shared_ptr<const Scene>& scene) {
  std::vector<cv::Mat> pictures;
  for (const Look look : {Look::clinical, Look::compound}) {
    ImageSettings settings = screen_settings();
    settings.look = look;
    pictures.push_back(grey_image(render_bmode(scene, Pose::Identity(), {}, {}, settings)).clone());
  }
  return pictures;
}

cv::Mat needle_picture_at(double degrees) {
  const ScreenNeedle needle = make_screen_needle(degrees * kDegree);
  return grey_image(
             render_bmode(long_axis_muscle(), Pose::Identity(), needle.view, {}, screen_settings()))
      .clone();
}

/// The percentiles of a picture's middle, as a row of a table.
std::vector<std::string> grey_row(const std::string& name, const cv::Mat& image) {
  const cv::Rect middle(image.cols / 4, image.rows / 4, image.cols / 2, image.rows / 2);
  const cv::Mat everywhere(middle.size(), CV_8UC1, cv::Scalar(255));
  const std::vector<double> grey = sorted_grey(image(middle), everywhere);
  std::vector<std::string> row{name};
  for (const double share : {0.05, 0.5, 0.95, 0.99})
    row.push_back(printed("%.0f", sorted_percentile(grey, share)));
  row.push_back(printed("%.2f", fine_skewness(image(middle))));
  return row;
}

}  // namespace

Result<Gate> measure_plates(const std::filesystem::path& folder) {
  Gate gate;
  gate.title = "Our pictures (left) beside real ones (right) at 0.1 mm a pixel";
  gate.assumed = {"the scale of the real pictures of a nerve, from the width of the face"};
  const RealPicture long_axis{"timtrack_more/S1_L20_step_025.png", {0, 0, 514, 458}, kVastusPixel};
  const RealPicture other{"timtrack_more/S4_L20_step_025.png", {0, 0, 514, 458}, kVastusPixel};
  const RealPicture bone{"plus_bone/BoneUltrasound_L14_05.png", {176, 3, 467, 613}, kBonePixel};
  const RealPicture nerve{"usgra/0003.png", {0, 68, 512, 334}, kTe7Pixel};
  const RealPicture vessel{"usgra/0007.png", {0, 68, 512, 334}, kTe7Pixel};
  const RealPicture fat{"usgra/0002.png", {0, 0, 512, 474}, kTe7Pixel};
  TextTable table{{"picture", "5 %", "median", "95 %", "99 %", "skewness, finest"}, {}};
  const auto add = [&](const std::string& name, const std::vector<cv::Mat>& ours,
                       const RealPicture& real) -> Result<void> {
    auto picture = read_real(folder, real);
    ARTUS_TRY(picture);
    std::vector<cv::Mat> all = ours;
    all.push_back(*picture);
    add_picture(gate, "plate-" + name, beside(all));
    table.rows.push_back(grey_row(name + ", ours", ours.front()));
    table.rows.push_back(grey_row(name + ", real", *picture));
    return {};
  };
  ARTUS_TRY(add("muscle-long",
                {muscle_picture(Look::clinical, 0, "linear-6-18"),
                 muscle_picture(Look::compound, 0, "linear-4-9")},
                long_axis));
  ARTUS_TRY(
      add("muscle-short", {muscle_picture(Look::clinical, 90 * kDegree, "linear-6-18")}, other));
  ARTUS_TRY(add("bone", {picture_of_bone("linear-4-9").image, picture_of_bone("linear-6-18").image},
                bone));
  ARTUS_TRY(
      add("needle", {needle_picture_at(15), needle_picture_at(30), needle_picture_at(50)}, nerve));
  ARTUS_TRY(add("nerve-artery", pictures_of(nerve_beside_artery()), vessel));
  ARTUS_TRY(add("fat", pictures_of(deep_fat()), fat));
  gate.tables.emplace_back("Grey in the middle of each picture", table);
  gate.claims.push_back(claim_that({ClaimKind::fitted, "that the plates are there is no evidence"},
                                   "every plate has its real picture", true));
  return gate;
}

}  // namespace artus
