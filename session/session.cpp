// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/session/session.h"

#include <algorithm>
#include <utility>

namespace artus {

Session::Session(std::shared_ptr<const Scene> scene, const SessionParams& params,
                 std::unique_ptr<InputDevice> device)
    : scene_(std::move(scene)),
      params_(params),
      device_(std::move(device)),
      core_(scene_, params_),
      times_(std::make_unique<SessionTimes>()),
      start_ns_(monotonic_ns()) {
  controls_.store(controls_of(params_));
}

Result<std::unique_ptr<Session>> Session::start(std::shared_ptr<const Scene> scene,
                                                const SessionParams& params,
                                                std::unique_ptr<InputDevice> device,
                                                const Options& options) {
  ARTUS_REQUIRE(scene != nullptr && device != nullptr, "a session needs a scene and a device");
  ARTUS_TRY(validate(params));
  std::unique_ptr<Session> session(new Session(std::move(scene), params, std::move(device)));
  if (!options.recording.empty()) {
    auto recorder =
        Recorder::start(options.recording, make_head(session->scene_->joint(), session->params_));
    ARTUS_TRY(recorder);
    session->recorder_ = std::move(*recorder);
  }
  if (options.share_images) {
    auto channel = SharedChannel<artus_shm_image>::open(options.image_segment_prefix, kImageLayout,
                                                        SegmentAccess::owner_writes);
    ARTUS_TRY(channel);
    session->image_prefix_ = options.image_segment_prefix;
    session->shared_image_.emplace(std::move(*channel));
    session->image_bytes_ = std::make_unique<artus_shm_image>();
  }
  Session* running = session.get();
  const ThreadWishes haptics = options.haptic_wishes;
  const ThreadWishes imaging = options.imaging_wishes;
  session->haptic_thread_ = std::thread([running, haptics] { running->run_haptics(haptics); });
  session->imaging_thread_ = std::thread([running, imaging] { running->run_imaging(imaging); });
  return session;
}

Session::~Session() {
  stop_ = true;
  if (haptic_thread_.joinable()) haptic_thread_.join();
  if (imaging_thread_.joinable()) imaging_thread_.join();
  if (shared_image_) SharedSegment::remove(image_prefix_, kImageLayout);
}

std::uint64_t Session::unrecorded() const noexcept {
  return recorder_ ? recorder_->dropped() : 0;
}

std::vector<std::string> Session::refusals() const {
  const std::lock_guard<std::mutex> lock(refusals_mutex_);
  return refusals_;
}

void Session::ask(const char* who, const ThreadWishes& wishes) {
  for (const std::string& refused : request_from_system(wishes)) {
    const std::lock_guard<std::mutex> lock(refusals_mutex_);
    refusals_.push_back(std::string(who) + ": " + refused);
  }
}

void Session::run_haptics(const ThreadWishes& wishes) {
  ask("haptics", wishes);
  PeriodicSchedule schedule(params_.haptic_rate);
  LateWatch watch(schedule.period_ns());
  for (std::uint64_t number = 1; !stop_.load(std::memory_order_relaxed); ++number) {
    const std::int64_t late = schedule.wait();
    times_->haptic_lateness.add_with_missed(late, schedule.period_ns());
    overruns_.store(schedule.overruns(), std::memory_order_relaxed);
    tick(number, watch.step(late));
  }
  DeviceFeedback last;  // zero force, whoever still listens
  last.status = SessionStatus::kStopped;
  last.time_ns = monotonic_ns();
  device_->write(last);
}

void Session::tick(std::uint64_t number, bool too_late) noexcept {
  const std::int64_t begin = monotonic_ns();
  const std::int64_t cpu_begin = thread_cpu_ns();
  TickInput input;
  input.device = device_->read(begin);
  input.tick = number;
  if (paused_.load(std::memory_order_relaxed)) input.command |= SessionCommand::kPause;
  if (too_late) input.command |= SessionCommand::kLate;
  if (reset_.exchange(false, std::memory_order_relaxed)) input.command |= SessionCommand::kReset;
  const HapticSnapshot& out = core_.step(input);
  DeviceFeedback feedback = out.feedback;
  feedback.time_ns = monotonic_ns();
  device_->write(feedback);
  haptic_.store(out);
  if (recorder_) recorder_->add(to_record(out));
  const Vec3 axis = to_pose(out.X_JN).linear().col(2);
  const Vec3 force(out.force_J[0], out.force_J[1], out.force_J[2]);
  const double along = force.dot(axis);
  TracePoint point;
  point.time = 1e-9 * static_cast<double>(begin - start_ns_);
  point.depth = out.feedback.depth;
  point.force = static_cast<float>(-along);
  point.lateral = static_cast<float>((force - along * axis).norm());
  point.region = static_cast<std::uint16_t>(out.feedback.region);
  point.contact = static_cast<std::uint16_t>(out.feedback.contact);
  trace_.push(point);
  ticks_.store(number, std::memory_order_relaxed);
  times_->haptic_cpu.add(thread_cpu_ns() - cpu_begin);
  times_->haptic_compute.add(monotonic_ns() - begin);
}

void Session::run_imaging(const ThreadWishes& wishes) {
  ask("imaging", wishes);  // before the renderer's workers start, which inherit it
  ImageCore core(scene_, params_);
  PeriodicSchedule schedule(params_.image_rate);
  std::uint64_t number = 0;
  while (!stop_.load(std::memory_order_relaxed)) {
    schedule.wait();
    if (frozen_.load(std::memory_order_relaxed))
      n_images_ = 0;  // a pause is no gap
    else
      image(core, ++number);
  }
}

void Session::image(ImageCore& core, std::uint64_t number) {
  HapticSnapshot snapshot;
  ImageControls controls;
  if (ticks_.load(std::memory_order_relaxed) == 0 || !haptic_.load(snapshot, 1000) ||
      !controls_.load(controls, 1000))
    return;
  const std::int64_t begin = monotonic_ns();
  const FrameInput input = frame_input(snapshot, controls, number);
  const Frame& frame = core.render(input);
  ImageSnapshot& out = images_.slot();
  out.grey.assign(frame.image.begin(), frame.image.end());
  out.width = frame.width;
  out.height = frame.height;
  out.pixel = frame.pixel;
  out.probe_width = core.transducer().width;
  out.input = input;
  out.ready_ns = monotonic_ns();
  if (shared_image_) share(out);
  if (recorder_) recorder_->add(FrameRecord{input, digest_of(frame)});
  times_->image_render.add(out.ready_ns - begin);
  note_image(out.ready_ns);
  if (snapshot.input.device.state == PeerState::alive)
    times_->pose_to_image.add(out.ready_ns - input.sample_time_ns);
  images_.publish();
  frames_.store(number, std::memory_order_relaxed);
}

void Session::note_image(std::int64_t ready_ns) {
  const auto before = [this](std::size_t n) {
    return image_times_[(n_images_ - n) % image_times_.size()];
  };
  if (n_images_ >= 1) times_->image_interval.add(ready_ns - before(1));
  if (n_images_ >= 30) times_->image_thirty.add(ready_ns - before(30));
  image_times_[n_images_ % image_times_.size()] = ready_ns;
  ++n_images_;
}

void Session::share(const ImageSnapshot& image) {
  artus_shm_image& out = *image_bytes_;
  const std::size_t n = image.grey.size();
  if (n > std::size(out.grey)) return;
  out.frame = image.input.number;
  out.time_ns = static_cast<std::uint64_t>(image.ready_ns);
  out.pos_time_ns = static_cast<std::uint64_t>(image.input.sample_time_ns);
  out.pixel = image.pixel;
  out.width = static_cast<std::uint32_t>(image.width);
  out.height = static_cast<std::uint32_t>(image.height);
  std::copy(image.grey.begin(), image.grey.end(), std::begin(out.grey));
  shared_image_->write_prefix(out, offsetof(artus_shm_image, grey) + n);
}

}  // namespace artus
