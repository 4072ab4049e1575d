// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>

#include "artus/apps/pose_files.h"
#include "artus/apps/view_options.h"
#include "artus/core/units.h"
#include "artus/echo/renderer.h"
#include "artus/exchange/reference_frame.h"
#include "artus/exchange/sequence_file.h"
#include "artus/session/replay.h"
#ifdef ARTUS_HAS_DICOM
#include "artus/exchange/dicom_file.h"
#endif

namespace artus {
namespace {

struct ExportOptions {
  JointOptions joint;
  ViewOptions view;
  std::filesystem::path poses;
  std::filesystem::path recording;
  std::filesystem::path mha;
  std::filesystem::path dicom;
  double rate = 0;
  bool json = false;
};

/// Collects frames of one size.
class SequenceMaker {
 public:
  Result<void> add(const Frame& frame, const Transducer& transducer, double time,
                   const std::pair<Pose, std::optional<Pose>>& poses) {
    if (sequence_.frames.empty()) {
      sequence_.width = frame.width;
      sequence_.height = frame.height;
    }
    if (frame.width != sequence_.width || frame.height != sequence_.height)
      return fail(ErrorCode::invalid,
                  "the depth was changed in the middle: a sequence has images of one size");
    SequenceFrame out;
    out.time = time;
    out.probe_to_reference = reference_.to_reference(poses.first);
    out.image_to_reference =
        chained(out.probe_to_reference, image_to_probe(transducer, frame.pixel, frame.height));
    if (poses.second) out.needle_to_reference = reference_.to_reference(*poses.second);
    out.grey.assign(frame.image.begin(), frame.image.end());
    sequence_.frames.push_back(std::move(out));
    return {};
  }
  [[nodiscard]] const ImageSequence& sequence() const noexcept { return sequence_; }

 private:
  ReferenceFrame reference_;
  ImageSequence sequence_;
};

Result<ImageSequence> sequence_of_poses(const ExportOptions& options, const LoadedView& loaded) {
  constexpr double kApart = 0.04;  // s between poses that have no time
  auto poses = read_any_poses(options.poses);
  if (poses && options.rate > 0) poses = sample_path(*poses, options.rate);
  ARTUS_TRY(poses);
  Renderer renderer(loaded.scene, loaded.view.transducer, loaded.view.settings);
  SequenceMaker maker;
  for (std::size_t i = 0; i < poses->size(); ++i) {
    const ListedPose& pose = (*poses)[i];
    std::optional<NeedleView> needle;
    if (pose.X_JN) needle = NeedleView{*pose.X_JN, loaded.view.needle_shape};
    const double time = pose.time.value_or(kApart * static_cast<double>(i));
    ARTUS_TRY(maker.add(renderer.render(pose.X_JP, needle), loaded.view.transducer, time,
                        {pose.X_JP, pose.X_JN}));
  }
  return maker.sequence();
}

Result<ImageSequence> sequence_of_recording(const ExportOptions& options,
                                            const std::shared_ptr<const Scene>& scene) {
  const auto recording = read_recording(options.recording);
  ARTUS_TRY(recording);
  if (recording->frames.empty())
    return fail(ErrorCode::invalid, "the recording has no images", options.recording.string());
  SequenceMaker maker;
  Result<void> all;
  const std::int64_t start = recording->frames.front().input.sample_time_ns;
  ReplayListener listener;
  listener.on_frame = [&](const FrameRecord& record, const Frame& frame) {
    const FrameInput& input = record.input;
    std::optional<Pose> needle;
    if (input.has_needle != 0) needle = to_pose(input.X_JN);
    const double rate = recording->head.params.image_rate;
    const double time = input.sample_time_ns > start
                            ? 1e-9 * static_cast<double>(input.sample_time_ns - start)
                            : static_cast<double>(input.number) / rate;
    if (all)
      all =
          maker.add(frame, recording->head.params.transducer, time, {to_pose(input.X_JP), needle});
  };
  const auto replayed = replay(*recording, scene, listener, options.view.threads);
  ARTUS_TRY(replayed);
  ARTUS_TRY(all);
  return maker.sequence();
}

Result<void> write_files(const ExportOptions& options, const ImageSequence& sequence,
                         const CompiledJoint& joint) {
  if (!options.mha.empty()) ARTUS_TRY(write_mha(options.mha, sequence));
  if (options.dicom.empty()) return {};
#ifdef ARTUS_HAS_DICOM
  DicomSeries series;
  series.joint = joint.name;
  series.side = joint.side;
  series.engine = ARTUS_VERSION;
  series.pixel = sequence.frames.front().image_to_reference.col(0).norm() * kMillimetre;
  const std::size_t n = sequence.frames.size();
  const double time = sequence.frames.back().time - sequence.frames.front().time;
  if (n > 1 && time > 0) series.frame_time = time / static_cast<double>(n - 1);
  return write_dicom(options.dicom, sequence, series);
#else
  static_cast<void>(joint);
  return fail(ErrorCode::unsupported, "this artus was built without DCMTK", "--dicom");
#endif
}

ExitCode run_export(const ExportOptions& options) {
  if (options.poses.empty() == options.recording.empty())
    return report_error(
        {ErrorCode::invalid, "give either a recording or a list of poses", "--recording"},
        options.json);
  if (options.mha.empty() && options.dicom.empty())
    return report_error({ErrorCode::invalid, "say which file to write, --mha or --dicom", "--mha"},
                        options.json);
  const auto loaded = load_view(options.joint, options.view, options.json);
  if (!loaded) return report_error(loaded.error(), options.json);
  const auto sequence = options.poses.empty() ? sequence_of_recording(options, loaded->scene)
                                              : sequence_of_poses(options, *loaded);
  if (!sequence) return report_error(sequence.error(), options.json);
  const auto written = write_files(options, *sequence, loaded->joint());
  if (!written) return report_error(written.error(), options.json);
  if (options.json)
    std::cout << nlohmann::json{{"frames", sequence->frames.size()},
                                {"width", sequence->width},
                                {"height", sequence->height}}
                     .dump(2)
              << '\n';
  else
    std::printf("%zu frames of %d x %d pixels: %s %s\n", sequence->frames.size(), sequence->width,
                sequence->height, options.mha.c_str(), options.dicom.c_str());
  return ExitCode::ok;
}

}  // namespace

void add_export_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<ExportOptions>();
  Command* command =
      add_command(app, "export", "Images with their places as other programs read them",
                  "A sequence (.igs.mha) has ImageToReference, ProbeToReference and "
                  "NeedleToReference for each\n"
                  "frame, RAS in millimetres; 3D Slicer and PLUS read it.\n"
                  "Examples:\n"
                  "  artus export -j shoulder.artus --recording session.rec --mha session.igs.mha\n"
                  "  artus export -j shoulder.artus --poses path.csv --rate 25 --mha path.igs.mha\n"
                  "  artus export -j shoulder.artus --poses path.csv --rate 25 --dicom path.dcm");
  add_joint_options(command, options->joint);
  command->add_option("--recording", options->recording, "of serve or view");
  command->add_option("--poses", options->poses, "list of poses (.jsonl, .csv, .mha)");
  command->add_option("--rate", options->rate, "images a second of a path with times; 0: as listed")
      ->check(number_in(0, 1000));
  add_imaging_options(command, options->view);
  command->add_option("--mha", options->mha, "sequence for 3D Slicer and PLUS");
  command->add_option("--dicom", options->dicom, "Ultrasound Multi-frame Image for a PACS");
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_export(*options); });
}

}  // namespace artus
