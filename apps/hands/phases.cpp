// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cmath>
#include <cstdio>
#include <system_error>

#include "artus/detail/apps/hands/hands_commands.h"
#include "artus/detail/core/printed.h"

namespace artus {
namespace {

/// Shows pictures pass until `seconds` are over, and counts down aloud.
Result<void> count_down(kit::PictureSource& source, double seconds) {
  double begin = 0;
  int told = -1;
  for (;;) {
    auto picture = source.next();
    ARTUS_TRY(picture);
    if (!*picture) return {};
    if (begin == 0) begin = (*picture)->time;
    const double left = seconds - ((*picture)->time - begin);
    if (left <= 0) return {};
    if (static_cast<int>(std::ceil(left)) != told) {
      told = static_cast<int>(std::ceil(left));
      if (told <= 3 || told % 5 == 0) tell(printed("  begins in %d s", told));
    }
  }
}

Result<void> run_phase(kit::PictureSource& source, double seconds,
                       const std::function<bool(const kit::Picture8&)>& on_picture) {
  double begin = 0;
  for (;;) {
    auto picture = source.next();
    ARTUS_TRY(picture);
    if (!*picture) return {};
    if (begin == 0) begin = (*picture)->time;
    if (!on_picture(**picture)) return {};
    if (source.is_live() && seconds > 0 && (*picture)->time - begin > seconds) return {};
  }
}

}  // namespace

void tell(const std::string& line) {
  std::printf("%s\n", line.c_str());
  std::fflush(stdout);
}

void add_picture_options(Command* command, PictureOptions& options, const std::string& what) {
  command->add_option("source", options.sources, what)->required();
  command->add_option("--kit,-k", options.kit, "file of the kit's measures")->required();
  command
      ->add_option("--fps", options.fps, "pictures a second of a folder whose names tell no time")
      ->check(number_in(0, 1000));
  command->add_option("--lead-s", options.lead_s, "time to get ready before a webcam's phase")
      ->check(number_in(0, 120))
      ->capture_default_str();
  command->add_option("--phase-s", options.phase_s, "how long a webcam's phase lasts")
      ->check(number_in(1, 600))
      ->capture_default_str();
}

Result<kit::MeasuredKit> kit_of(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return kit::make_kit(kit::Hand::right, 1, 50e-3);
  return kit::read_kit(file);
}

Result<void> check_size(const kit::Lens& lens, const cv::Mat& grey) {
  if (grey.cols == lens.width && grey.rows == lens.height) return {};
  return fail(ErrorCode::invalid,
              printed("pictures are %d x %d, the camera was calibrated at %d x %d: calibrate again",
                      grey.cols, grey.rows, lens.width, lens.height),
              "camera");
}

Result<void> for_phases(const PictureOptions& options, const std::vector<Phase>& phases,
                        const std::function<bool(std::size_t, const kit::Picture8&)>& on_picture) {
  std::unique_ptr<kit::PictureSource> live;
  const bool one = options.sources.size() == 1;
  if (!one && options.sources.size() != phases.size())
    return fail(ErrorCode::invalid,
                printed("a webcam, or %zu files or folders, one for each phase", phases.size()),
                "source");
  for (std::size_t k = 0; k < phases.size(); ++k) {
    std::unique_ptr<kit::PictureSource> own;
    if (live == nullptr) {
      auto opened = kit::open_pictures(options.sources[one ? 0 : k], {options.fps});
      ARTUS_TRY(opened);
      own = std::move(*opened);
      if (own->is_live()) live = std::move(own);
    }
    if (live == nullptr && one && phases.size() > 1)
      return fail(ErrorCode::invalid,
                  printed("%zu files or folders, one for each phase", phases.size()), "source");
    kit::PictureSource& source = live ? *live : *own;
    tell(printed("%zu of %zu: %s", k + 1, phases.size(), phases[k].what.c_str()));
    if (source.is_live()) ARTUS_TRY(count_down(source, options.lead_s));
    const double seconds = phases[k].seconds > 0 ? phases[k].seconds : options.phase_s;
    ARTUS_TRY(run_phase(source, seconds,
                        [&](const kit::Picture8& picture) { return on_picture(k, picture); }));
  }
  return {};
}

}  // namespace artus
