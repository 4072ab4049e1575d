// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include <opencv2/core.hpp>

#include "artus/detail/apps/hands/hands_commands.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/devices/kit/picture_check.h"
#include "artus/detail/devices/kit/pose_sender.h"
#include "artus/detail/devices/kit/tracker.h"

namespace artus {
namespace {

struct TrackOptions {
  PictureOptions pictures;
  std::string connect;
  std::string listen = "18944";
  std::filesystem::path out;
};

double realtime_now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// A line a second: what is seen, how sure it is, how late it comes.
class Status {
 public:
  void take(const kit::HandsFrame& frame, double delay, bool live, std::size_t peers) {
    ++n_;
    needle_ += frame.X_SN ? 1 : 0;
    probe_ += frame.X_SP ? 1 : 0;
    sheet_ += frame.sheet ? 1 : 0;
    if (frame.X_PN) error_ = frame.told_error;
    delay_ = std::max(delay_, delay);
    if (begin_ == 0) begin_ = frame.time;
    const double span = frame.time - begin_;
    if (span < 1) return;
    std::string line = printed("needle %d %% probe %d %% sheet %d %% of %.0f pictures a second",
                               100 * needle_ / n_, 100 * probe_ / n_, 100 * sheet_ / n_, n_ / span);
    if (error_ > 0) line += printed(", +- %.1f mm", error_ / kMillimetre);
    if (live) line += printed(", %.0f ms late", 1e3 * delay_);
    tell(line + printed(", %zu listening", peers));
    if (live && n_ / span < 15)
      tell("note: few pictures a second: more light, a shorter exposure, no other program");
    *this = Status();
    begin_ = frame.time;
  }

 private:
  double begin_ = 0;
  int n_ = 0;
  int needle_ = 0;
  int probe_ = 0;
  int sheet_ = 0;
  double error_ = 0;
  double delay_ = 0;
};

Result<void> run_hands(const TrackOptions& options) {
  auto measured = kit_of(options.pictures.kit);
  ARTUS_TRY(measured);
  if (!measured->has_camera)
    return fail(ErrorCode::invalid, "calibrate the camera first (artus hands calibrate)",
                options.pictures.kit.string());
  if (!measured->has_tip || !measured->has_face)
    tell("note: tip or face were not measured: they are taken as drawn, +- 2 mm and more");
  kit::PictureSource::Options source_options;
  source_options.fps = options.pictures.fps;
  source_options.width = measured->kit.lens.width;
  source_options.height = measured->kit.lens.height;
  source_options.paced = true;
  auto source = kit::open_pictures(options.pictures.sources.front(), source_options);
  ARTUS_TRY(source);
  auto sender = kit::PoseSender::open(options.connect, options.listen);
  ARTUS_TRY(sender);
  if (options.connect.empty())
    tell(
        printed("OpenIGTLink: listening on port %d; artus serve --input igtl --needle-hold-ms 100 "
                "--igtl connect:127.0.0.1:%d",
                sender->port(), sender->port()));
  kit::Tracker tracker(measured->kit);
  kit::MirrorCheck mirror;
  kit::FrozenCheck frozen;
  kit::PictureNotes notes;
  Status status;
  double last = 0;
  for (;;) {
    auto picture = (*source)->next();
    ARTUS_TRY(picture);
    if (!*picture) return {};
    ARTUS_TRY(check_size(measured->kit.lens, (*picture)->grey));
    if (!((*picture)->time > last))
      tracker = kit::Tracker(measured->kit);  // the clock was set back
    last = (*picture)->time;
    const cv::Mat grey = mirror.right((*picture)->grey);
    const bool hangs = (*source)->is_live() && frozen.is((*picture)->grey);
    if (const std::string note = notes.take(mirror.is_mirrored(), hangs); !note.empty())
      tell("note: " + note);
    if (hangs) continue;
    const kit::HandsFrame frame = tracker.take(grey, last);
    sender->send(frame, measured->kit.block_height);
    status.take(frame, realtime_now() - frame.time, (*source)->is_live(), sender->peers());
    for (const std::string& notice : sender->take_notices()) tell("note: " + notice);
  }
  return {};
}

void append_cells(std::string& out, const std::optional<Pose>& X, double block_height) {
  std::vector<std::string> cells(7);
  if (X) {
    const Eigen::Quaterniond q(X->linear());
    const std::array<double, 7> values{X->translation().x() / kMillimetre,
                                       X->translation().y() / kMillimetre,
                                       (X->translation().z() - block_height) / kMillimetre,
                                       q.w(),
                                       q.x(),
                                       q.y(),
                                       q.z()};
    for (std::size_t i = 0; i < values.size(); ++i) append_number(cells[i], values[i]);
  }
  for (const std::string& cell : cells) out += "," + cell;
}

Result<void> track(const TrackOptions& options) {
  auto measured = kit_of(options.pictures.kit);
  ARTUS_TRY(measured);
  if (!measured->has_camera)
    return fail(ErrorCode::invalid, "calibrate the camera first", options.pictures.kit.string());
  auto source = kit::open_pictures(options.pictures.sources.front(), {options.pictures.fps});
  ARTUS_TRY(source);
  if ((*source)->is_live())
    return fail(ErrorCode::invalid, "a video or a folder of pictures: a webcam has no end",
                "source");
  kit::Tracker tracker(measured->kit);
  kit::MirrorCheck mirror;
  std::string out =
      "time_s,needle_x_mm,needle_y_mm,needle_z_mm,needle_qw,needle_qx,needle_qy,needle_qz,"
      "probe_x_mm,probe_y_mm,probe_z_mm,probe_qw,probe_qx,probe_qy,probe_qz\n";
  std::vector<double> errors;
  int n = 0;
  for (;; ++n) {
    auto picture = (*source)->next();
    ARTUS_TRY(picture);
    if (!*picture) break;
    ARTUS_TRY(check_size(measured->kit.lens, (*picture)->grey));
    const kit::HandsFrame frame = tracker.take(mirror.right((*picture)->grey), (*picture)->time);
    if (frame.X_PN) errors.push_back(frame.told_error);
    if (!frame.X_SN && !frame.X_SP) continue;
    append_number(out, frame.time);
    append_cells(out, frame.X_SN, measured->kit.block_height);
    append_cells(out, frame.X_SP, measured->kit.block_height);
    out += "\n";
  }
  ARTUS_TRY(write_text(options.out, out));
  std::sort(errors.begin(), errors.end());
  const double middle = errors.empty() ? 0 : errors[errors.size() / 2];
  if (mirror.is_mirrored()) tell("note: " + kit::PictureNotes().take(true, false));
  tell(printed("%d pictures, both hands in %zu of them, +- %.1f mm", n, errors.size(),
               middle / kMillimetre));
  return {};
}

}  // namespace

void add_tracking_commands(Command& app, ExitCode& code) {
  auto run = std::make_shared<TrackOptions>();
  Command* command = add_command(
      app, "run", "Give the hands to a session by OpenIGTLink, until it is stopped",
      "The session takes them with --input igtl --needle-hold-ms 100. A line a second says what\n"
      "is seen, how sure it is and how late it comes.\n"
      "Examples:\n"
      "  artus hands run webcam -k hands.toml\n"
      "  artus hands run webcam:1 -k hands.toml --connect 127.0.0.1:18944");
  add_picture_options(command, run->pictures, "webcam, webcam:NUMBER, a video or a folder");
  command->add_option("--igtl", run->listen, "[address:]port to listen on")->capture_default_str();
  command->add_option("--connect", run->connect, "HOST:PORT of a session that listens, instead");
  on_run(command, code, [run] { return run_hands(*run); });

  auto list = std::make_shared<TrackOptions>();
  command = add_command(app, "track", "Poses of a video or a folder as a table, for artus assess",
                        "Examples:\n"
                        "  artus hands track lesson.mp4 -k hands.toml -o poses.csv");
  add_picture_options(command, list->pictures, "a video or a folder of pictures");
  command->add_option("-o,--out", list->out, "table of poses (.csv)")->required();
  on_run(command, code, [list] { return track(*list); });
}

}  // namespace artus
