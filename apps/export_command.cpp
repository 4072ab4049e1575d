// SPDX-License-Identifier: AGPL-3.0-or-later
#include <chrono>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "artus/detail/apps/export_labels.h"
#include "artus/detail/apps/options/pose_files.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"
#include "artus/detail/exchange/sequence_maker.h"
#include "artus/detail/reports/recording_page.h"
#include "artus/echo/image_io.h"
#include "artus/echo/renderer.h"
#include "artus/session/replay.h"
#ifdef ARTUS_HAS_DICOM
#include "artus/detail/exchange/dicom_file.h"
#endif

namespace artus {
namespace {

struct ExportOptions : PoseListOptions {
  std::filesystem::path recording;
  std::filesystem::path sweep;
  std::filesystem::path mha;
  std::filesystem::path dicom;
  std::filesystem::path report;
  double rate = 0;
  bool compress = false;
  LabelExportOptions labels;
};

/// The images to be written, and the page about a recording.
struct Export {
  ImageSequence sequence;
  std::string joint;
  std::string side;
  cv::Mat page;
};

PlacedPicture placed(const Frame& frame, double time, const Pose& X_JP,
                     const std::optional<Pose>& X_JN) {
  return {time, X_JP, X_JN, frame.pixel, frame.width, frame.height, frame.image};
}

Result<ImageSequence> sequence_of_poses(const ExportOptions& options, const LoadedView& loaded) {
  constexpr double kApart = 0.04;  // s between poses that have no time
  auto poses = read_any_poses(options.poses, options.tracker);
  if (poses && options.rate > 0) poses = sample_path(*poses, options.rate);
  ARTUS_TRY(poses);
  Renderer renderer(loaded.scene, loaded.view.transducer, loaded.view.settings);
  SequenceMaker maker;
  for (std::size_t i = 0; i < poses->size(); ++i) {
    const ListedPose& pose = (*poses)[i];
    std::optional<NeedleView> needle;
    if (pose.X_JN) needle = NeedleView{*pose.X_JN, loaded.view.needle_shape};
    const double time = pose.time.value_or(kApart * static_cast<double>(i));
    ARTUS_TRY(maker.add(placed(renderer.render(pose.X_JP, needle), time, pose.X_JP, pose.X_JN),
                        loaded.view.transducer));
  }
  return maker.sequence();
}

/// The image's time since the first; by its number where the device had no clock.
double time_of(const FrameInput& input, std::int64_t start, double rate) {
  return start > 0 ? 1e-9 * static_cast<double>(input.sample_time_ns - start)
                   : static_cast<double>(input.number - 1) / rate;
}

Result<ImageSequence> sequence_of_recording(const ExportOptions& options,
                                            const std::shared_ptr<const Scene>& scene,
                                            cv::Mat& page) {
  const auto recording = read_any_recording(options.recording, scene, options.tracker);
  ARTUS_TRY(recording);
  if (recording->frames.empty())
    return fail(ErrorCode::invalid, "the recording has no images", options.recording.string());
  const SessionParams& params = recording->head.params;
  RecordingPage about(scene->joint().name, ARTUS_VERSION, params.haptic_rate);
  SequenceMaker maker;
  Result<void> all;
  const std::int64_t start = recording->frames.front().input.sample_time_ns;
  ReplayListener listener;
  listener.on_tick = [&](const HapticSnapshot& tick) {
    about.take(tick);
  };
  listener.on_frame = [&](const FrameRecord& record, const Frame& frame) {
    const FrameInput& input = record.input;
    std::optional<Pose> needle;
    if (input.has_needle != 0) needle = to_pose(input.X_JN);
    about.take(input, frame, params.transducer);
    if (all)
      all = maker.add(
          placed(frame, time_of(input, start, params.image_rate), to_pose(input.X_JP), needle),
          params.transducer);
  };
  const auto replayed = replay(*recording, scene, listener, options.view.threads);
  ARTUS_TRY(replayed);
  ARTUS_TRY(all);
  page = about.draw();
  return maker.sequence();
}

Result<ImageSequence> sequence_of(const ExportOptions& options, const LoadedView& loaded,
                                  cv::Mat& page) {
  if (!options.sweep.empty()) return sequence_of_sweep(options.sweep);
  if (!options.poses.empty()) return sequence_of_poses(options, loaded);
  return sequence_of_recording(options, loaded.scene, page);
}

#ifdef ARTUS_HAS_DICOM
/// Day and time (UTC) of the file or folder that is exported.
void date(const std::filesystem::path& source, DicomSeries& series) {
  std::error_code error;
  const auto written = std::filesystem::last_write_time(source, error);
  if (error) return;
  const std::time_t seconds =
      std::chrono::system_clock::to_time_t(std::chrono::file_clock::to_sys(written));
  std::tm utc{};
  if (gmtime_r(&seconds, &utc) == nullptr) return;
  series.date = printed("%04d%02d%02d", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday);
  series.time = printed("%02d%02d%02d", utc.tm_hour, utc.tm_min, utc.tm_sec);
}

Result<void> write_dicom_files(const ExportOptions& options, const Export& out) {
  const ImageSequence& sequence = out.sequence;
  DicomSeries series;
  series.joint = out.joint;
  series.side = out.side;
  series.engine = ARTUS_VERSION;
  series.pixel = sequence.frames.front().image_to_reference.col(0).norm() * kMillimetre;
  for (const auto* source : {&options.recording, &options.poses, &options.sweep})
    if (!source->empty()) date(*source, series);
  if (!options.dicom.empty()) ARTUS_TRY(write_dicom(options.dicom, sequence, series));
  if (options.report.empty()) return {};
  cv::Mat colours;
  cv::cvtColor(out.page, colours, cv::COLOR_BGR2RGB);
  return write_dicom_report(options.report,
                            {colours.cols, colours.rows, {colours.datastart, colours.dataend}},
                            sequence, series);
}
#else
Result<void> write_dicom_files(const ExportOptions& /*options*/, const Export& /*out*/) {
  return fail(ErrorCode::unsupported, "this artus was built without DCMTK", "--dicom, --report");
}
#endif

Result<void> write_files(const ExportOptions& options, const Export& out) {
  if (!options.mha.empty())
    ARTUS_TRY(write_mha(options.mha, out.sequence,
                        options.compress ? PixelCoding::zlib : PixelCoding::raw));
  const bool picture = options.report.extension() == ".png";
  if (picture) ARTUS_TRY(write_image(out.page, options.report));
  if (options.dicom.empty() && (options.report.empty() || picture)) return {};
  return write_dicom_files(options, out);
}

/// What of the flags cannot go together.
std::optional<Error> find_mistake(const ExportOptions& options) {
  const int sources = static_cast<int>(!options.poses.empty()) +
                      static_cast<int>(!options.recording.empty()) +
                      static_cast<int>(!options.sweep.empty());
  if (sources != 1)
    return Error{ErrorCode::invalid,
                 "give a recording, a list of poses or a sweep; or --labels for a label map",
                 "--recording"};
  if (options.mha.empty() && options.dicom.empty() && options.report.empty())
    return Error{ErrorCode::invalid, "say which file to write, --mha, --dicom or --report",
                 "--mha"};
  if (!options.report.empty() && options.recording.empty())
    return Error{ErrorCode::invalid, "a report is about a recording", "--report"};
  return std::nullopt;
}

ExitCode run_export(const ExportOptions& options) {
  if (!options.labels.file.empty()) {
    if (!options.poses.empty() || !options.recording.empty() || !options.sweep.empty())
      return report_error(
          {ErrorCode::invalid, "a label map is of a joint alone: no images go with it", "--labels"},
          options.json);
    return export_labels(options.labels, options.joint, options.json);
  }
  if (const auto mistake = find_mistake(options)) return report_error(*mistake, options.json);
  const auto loaded = load_view(options.joint, options.view, options.json);
  if (!loaded) return report_error(loaded.error(), options.json);
  Export out{{}, loaded->joint().name, loaded->joint().side, {}};
  auto collected = sequence_of(options, *loaded, out.page);
  if (!collected) return report_error(collected.error(), options.json);
  out.sequence = std::move(*collected);
  const auto written = write_files(options, out);
  if (!written) return report_error(written.error(), options.json);
  const ImageSequence& sequence = out.sequence;
  if (options.json)
    std::cout << nlohmann::json{{"frames", sequence.frames.size()},
                                {"width", sequence.width},
                                {"height", sequence.height}}
                     .dump(2)
              << '\n';
  else
    std::printf("%zu frames of %d x %d pixels: %s %s %s\n", sequence.frames.size(), sequence.width,
                sequence.height, options.mha.c_str(), options.dicom.c_str(),
                options.report.c_str());
  return ExitCode::ok;
}

}  // namespace

void add_export_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<ExportOptions>();
  Command* command = add_command(
      app, "export", "Images with their places, or a joint's regions, as other programs read them",
      "A sequence (.igs.mha) has ImageToReference, ProbeToReference and "
      "NeedleToReference for each\n"
      "frame, RAS in millimetres; 3D Slicer and PLUS read it.\n"
      "Examples:\n"
      "  artus export -j shoulder.artus --recording session.rec --mha session.igs.mha\n"
      "  artus export -j shoulder.artus --recording session.rec --dicom us.dcm --report "
      "report.dcm\n"
      "  artus export -j shoulder.artus --poses path.csv --rate 25 --mha path.igs.mha\n"
      "  artus export -j shoulder.artus --poses out/run/poses.csv --rate 25 --mha run.igs.mha\n"
      "  artus export -j shoulder.artus --sweep out/sweep --mha sweep.igs.mha\n"
      "  artus export -j shoulder.artus --labels shoulder.seg.nrrd --spacing 0.4,0.4,0.7");
  add_pose_list_options(command, *options);
  command->add_option("--recording", options->recording,
                      "of serve or view, or poses that lead a session (.jsonl, .csv, .mha)");
  command->add_option("--sweep", options->sweep, "folder of a sweep or of its shards");
  command->add_option("--rate", options->rate, "images a second of a path with times; 0: as listed")
      ->check(number_in(0, 1000));
  command->add_option("--mha", options->mha, "sequence for 3D Slicer and PLUS");
  command->add_flag("--compress", options->compress,
                    "pixels of --mha compressed, as PLUS writes them");
  command->add_option("--dicom", options->dicom, "Ultrasound Multi-frame Image for a PACS");
  command->add_option("--report", options->report,
                      "a page about the recording: DICOM Secondary Capture, or .png");
  add_label_export_options(command, options->labels);
  on_run(command, code, [options] { return run_export(*options); });
}

}  // namespace artus
