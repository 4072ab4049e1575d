// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/body_pictures.h"

#include <opencv2/imgproc.hpp>

#include "artus/detail/core/text_file.h"
#include "artus/echo/image_io.h"
#include "artus/echo/labels.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

cv::Mat draw(const HealthQuestion& question, const std::shared_ptr<const Scene>& scene) {
  Renderer renderer(scene, question.transducer, question.settings);
  cv::Mat bmode;
  cv::cvtColor(annotated_image(renderer.render(question.X_JP), question.transducer), bmode,
               cv::COLOR_GRAY2BGR);
  const LabelImage labels =
      render_labels(*scene, question.X_JP, question.transducer, question.settings);
  cv::Mat colours = colour_labels(labels, scene->joint());
  const int border = bmode.cols - colours.cols;
  cv::copyMakeBorder(colours, colours, 4, 4, border / 2, border - border / 2, cv::BORDER_CONSTANT);
  cv::Mat both;
  cv::vconcat(bmode, colours, both);
  return both;
}

}  // namespace

Result<void> write_body_pictures(const HealthQuestion& question,
                                 const std::filesystem::path& folder, const std::string& name) {
  ARTUS_TRY(make_folder(folder));
  ARTUS_TRY(write_image(draw(question, question.before), folder / (name + "-before.png")));
  return write_image(draw(question, question.after), folder / (name + "-after.png"));
}

}  // namespace artus
