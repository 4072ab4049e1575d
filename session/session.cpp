// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/session/session.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "artus/detail/core/noise.h"
#include "artus/detail/core/plain_reason.h"
#include "artus/detail/session/haptic_loop.h"
#include "artus/detail/session/image_handover.h"
#include "artus/detail/session/record/dropping_ring.h"

namespace artus {
namespace {

constexpr std::int64_t kHousekeepingPeriod =
    20'000'000;                                      // ns between two looks at what may be spoiled
constexpr std::int64_t kAfterFailure = 500'000'000;  // ns before imaging is tried again
constexpr std::size_t kMaxNotices = 100;

TracePoint trace_point_of(const HapticSnapshot& out, double time) noexcept {
  const Vec3 axis = to_pose(out.X_JN).linear().col(2);
  const Vec3 force(out.force_J[0], out.force_J[1], out.force_J[2]);
  const double along = force.dot(axis);
  TracePoint point;
  point.time = time;
  point.depth = out.feedback.depth;
  point.force = static_cast<float>(-along);
  point.lateral = static_cast<float>((force - along * axis).norm());
  point.region = static_cast<std::uint16_t>(out.feedback.region);
  point.contact = static_cast<std::uint16_t>(out.feedback.contact);
  point.felt = (out.status & TickStatus::kLate) == 0;
  point.probe = static_cast<float>(press_of_probe(out));
  return point;
}

/// What an exception says.
std::string reason_of(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const std::exception& e) {
    return plain_reason(e.what());
  } catch (...) {
    return "an unknown failure";
  }
}

constexpr int kOperationsOfATick = 1000;       // some us
constexpr int kOperationsOfAnImage = 100'000;  // some tenths of a ms

/// Clock time of a chain of dependent operations without memory.
void time_fixed_work(int operations, LatencyHistogram& into) noexcept {
  const std::int64_t begin = monotonic_ns();
  std::uint64_t x = 1;
  for (int i = 0; i < operations; ++i) x = mix_bits(x);
  if (x != 0) into.add(monotonic_ns() - begin);  // never zero: it is not left out
}

}  // namespace

double press_of_probe(const HapticSnapshot& tick) noexcept {
  if (tick.input.device.has_probe == 0) return 0;
  const double* force = tick.feedback.probe_force;
  return -Vec3(force[0], force[1], force[2]).dot(to_pose(tick.input.device.X_WP).linear().col(2));
}

Session::Session(std::shared_ptr<const Scene> scene, const SessionParams& params,
                 std::unique_ptr<InputDevice> device, const Options& options)
    : scene_(std::move(scene)),
      params_(params),
      device_(std::move(device)),
      simulation_(scene_, params_, options.extra_scene_holders),
      draws_(options.images),
      times_(std::make_unique<SessionTimes>()),
      trace_(std::make_unique<DroppingRing<TracePoint>>(8192)),
      handover_(std::make_unique<ImageHandover>()),
      prepared_(!options.images && !params.deform),
      start_ns_(monotonic_ns()) {
  controls_.store(controls_of(params_));
}

Result<std::unique_ptr<Session>> Session::start(std::shared_ptr<const Scene> scene,
                                                const SessionParams& params,
                                                std::unique_ptr<InputDevice> device,
                                                const Options& options) {
  ARTUS_REQUIRE(scene != nullptr && device != nullptr, "a session needs a scene and a device");
  ARTUS_TRY(validate(params));
  std::unique_ptr<Session> session(
      new Session(std::move(scene), params, std::move(device), options));
  if (!options.recording.empty()) {
    auto recorder =
        Recorder::start(options.recording, make_head(session->scene_->joint(), session->params_));
    ARTUS_TRY(recorder);
    session->recorder_ = std::move(*recorder);
  }
  session->on_image_ = options.on_image;
  session->observer_ = options.observer;
  session->gauges_ = options.gauge;
  if (options.images && options.share_images) {
    auto channel = ReopeningChannel<artus_shm_image>::open(
        options.image_segment_prefix, kImageLayout, SegmentAccess::owner_writes);
    ARTUS_TRY(channel);
    session->shared_image_ = std::move(*channel);
    session->image_bytes_ = std::make_unique<artus_shm_image>();
  }
  Session* running = session.get();
  const ThreadOptions haptics = options.haptic_options;
  const ThreadOptions imaging = options.imaging_options;
  session->haptic_thread_ = std::thread(
      [running, haptics, floor = options.floor_seconds] { running->run_haptics(haptics, floor); });
  if (options.images)
    session->drawing_thread_ = std::thread([running, imaging] { running->run_drawing(imaging); });
  if (options.images || params.deform)
    session->imaging_thread_ = std::thread([running, imaging] { running->run_imaging(imaging); });
  session->housekeeping_thread_ = std::thread([running] { running->run_housekeeping(); });
  return session;
}

void Session::stop() {
  stop_ = true;
  for (std::thread* thread : {&haptic_thread_, &imaging_thread_, &housekeeping_thread_})
    if (thread->joinable()) thread->join();
  handover_->end();
  if (drawing_thread_.joinable()) drawing_thread_.join();
  if (recorder_) recorded_ = recorder_->finish();
}

Session::~Session() {
  stop();
  if (shared_image_) shared_image_->remove_own();
}

bool Session::next_trace_point(TracePoint& out) noexcept {
  return trace_->pop(out);
}

std::uint64_t Session::unrecorded() const noexcept {
  return recorder_ ? recorder_->dropped() : 0;
}

std::vector<std::string> Session::refusals() const {
  const std::lock_guard<std::mutex> lock(told_mutex_);
  return refusals_;
}

std::vector<std::string> Session::notices() const {
  const std::lock_guard<std::mutex> lock(told_mutex_);
  return notices_;
}

void Session::request_priority(const char* who, const ThreadOptions& options) {
  for (const std::string& refused : request_from_system(options)) {
    const std::lock_guard<std::mutex> lock(told_mutex_);
    refusals_.push_back(std::string(who) + ": " + refused);
  }
}

void Session::tell(const std::string& notice) {
  const std::lock_guard<std::mutex> lock(told_mutex_);
  if (!notices_.empty() && notices_.back() == notice) return;
  if (notices_.size() == kMaxNotices) notices_.erase(notices_.begin());
  notices_.push_back(notice);
}

void Session::rest(std::int64_t ns) const noexcept {
  constexpr std::int64_t kStep = 20'000'000;  // ns, so that a stop is soon seen
  const std::int64_t end = monotonic_ns() + ns;
  while (!stop_.load(std::memory_order_relaxed) && monotonic_ns() < end)
    std::this_thread::sleep_for(std::chrono::nanoseconds(std::min(ns, kStep)));
}

void Session::measure_floor(double seconds) noexcept {
  PeriodicSchedule schedule(params_.haptic_rate);
  const std::int64_t end = monotonic_ns() + static_cast<std::int64_t>(1e9 * seconds);
  while (monotonic_ns() < end && !stop_.load(std::memory_order_relaxed))
    times_->haptic_floor.add_with_missed(schedule.wait(), schedule.period_ns());
}

void Session::run_haptics(const ThreadOptions& options, double floor_seconds) {
  request_priority("haptics", options);
  measure_floor(floor_seconds);
  wait_until_prepared();
  HapticLoop loop(simulation_, *device_, params_.haptic_rate, haptic_,
                  {times_->haptic_compute, times_->haptic_cpu, times_->haptic_lateness});
  while (!stop_.load(std::memory_order_relaxed)) {
    loop.wait();
    overruns_.store(loop.overruns(), std::memory_order_relaxed);
    take_packet(loop.ticks() + 1);
    publish(loop.step(take_command()));
    if (gauges_) time_fixed_work(kOperationsOfATick, times_->haptic_fixed);
  }
}

/// No hand is felt and no clock runs before there is tissue to feel and a picture can be drawn.
void Session::wait_until_prepared() noexcept {
  constexpr std::int64_t kLongest = 20'000'000'000;  // ns; assumed: then it begins all the same
  const std::int64_t end = monotonic_ns() + kLongest;
  while (!prepared_.load(std::memory_order_acquire) && !stop_.load(std::memory_order_relaxed) &&
         monotonic_ns() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  start_ns_ = monotonic_ns();
}

/// The newest packet of the tissue, from tick `tick` on.
void Session::take_packet(std::uint64_t tick) noexcept {
  TissuePacket packet;
  if (!packets_.try_load(packet) || packet.probe.number == packet_felt_) return;
  packet_felt_ = packet.probe.number;
  simulation_.take(packet);
  if (recorder_) recorder_->add(PacketRecord{tick, packet});
}

std::uint32_t Session::take_command() noexcept {
  std::uint32_t command = 0;
  if (paused_.load(std::memory_order_relaxed)) command |= SessionCommand::kPause;
  if (reset_.exchange(false, std::memory_order_relaxed)) command |= SessionCommand::kReset;
  return command;
}

void Session::publish(const HapticSnapshot& out) noexcept {
  if (recorder_) recorder_->add(to_record(out));
  if (out.feedback.tissue_age > 0)
    times_->tissue_age.add(std::llround(1e9 * out.feedback.tissue_age));
  if (observer_ != nullptr) observer_->on_tick(out);
  trace_->push(trace_point_of(out, 1e-9 * static_cast<double>(monotonic_ns() - start_ns_)));
  ticks_.store(out.input.tick, std::memory_order_relaxed);
}

void Session::run_housekeeping() {
  while (!stop_.load(std::memory_order_relaxed)) {
    try {
      for (const std::string& said : device_->repair_connection()) tell(said);
      const auto said = shared_image_ ? shared_image_->repair_connection() : std::nullopt;
      if (said) tell(*said);
      tell_of_plunger();
      if (const std::string trouble = recorder_ ? recorder_->trouble() : ""; !trouble.empty())
        tell("the recording cannot be written: " + trouble);
    } catch (...) {
      tell(reason_of(std::current_exception()));
    }
    if (gauges_) time_fixed_work(kOperationsOfAnImage, times_->fixed_work);
    rest(kHousekeepingPeriod);
  }
}

void Session::tell_of_plunger() {
  HapticSnapshot now;
  if (haptic_.load(now, 1000) && (now.feedback.plunger.status & PlungerStatus::kJumped) != 0)
    tell(
        "the device's plunger went faster than a thumb can push it: refused, it begins anew where "
        "it is, without a force");
}

void Session::run_imaging(const ThreadOptions& options) {
  request_priority("imaging", options);
  bool prepared = false;
  PeriodicSchedule schedule(params_.image_rate);
  std::uint64_t number = 0;
  while (!stop_.load(std::memory_order_relaxed)) {
    schedule.wait();
    std::string failure = handover_->take_failure();
    try {
      if (failure.empty() && !prepared) {
        simulation_.prepare_imaging();
        prepared = true;
        const std::string& refusal = simulation_.refusal();
        if (!refusal.empty()) tell("the tissue stays rigid: " + refusal);
      }
      if (failure.empty() && frozen_.load(std::memory_order_relaxed)) {
        handover_->rest();
        n_images_ = 0;  // a pause is no gap
        answered_ns_ = 0;
        share_again();
      } else if (failure.empty() && advance(number + 1)) {
        ++number;
      }
    } catch (...) {
      failure = reason_of(std::current_exception());
    }
    prepared_.store(true, std::memory_order_release);
    if (failure.empty()) continue;
    tell("imaging failed: " + failure + "; trying again");
    handover_->rest();
    simulation_.restart_imaging();
    prepared = false;
    rest(kAfterFailure);
  }
  handover_->rest();
}

/// The tissue's step to image `number`, and its picture to who draws. False: nothing is known yet,
/// or nothing since the image before.
bool Session::advance(std::uint64_t number) {
  HapticSnapshot snapshot;
  ImageControls controls;
  if (ticks_.load(std::memory_order_relaxed) == 0 || !haptic_.load(snapshot, 1000) ||
      !controls_.load(controls, 1000) || snapshot.input.tick == imaged_tick_)
    return false;
  imaged_tick_ = snapshot.input.tick;
  const std::int64_t begin = monotonic_ns();
  const FrameInput input = frame_input(snapshot, controls, number);
  ImagedBody body = simulation_.advance(input);
  if (body.packet) {
    packets_.store(*body.packet);
    const std::int64_t now = monotonic_ns();
    times_->tissue_step.add(now - begin);
    if (answered_ns_ > 0) times_->tissue_interval.add(now - answered_ns_);
    answered_ns_ = now;
  }
  if (draws_) {
    handover_->put({input, std::move(body), snapshot.input.device.state == PeerState::alive});
  } else if (recorder_ && body.packet) {
    FrameRecord record;
    record.input = input;
    record.packet = digest_of(*body.packet);
    recorder_->add(record);
  }
  return true;
}

void Session::run_drawing(const ThreadOptions& options) {
  request_priority("imaging", options);  // before the renderer's workers start, which inherit it
  while (const ImageJob* job = handover_->take()) {
    std::string failure;
    try {
      draw(*job);
    } catch (...) {
      failure = reason_of(std::current_exception());
    }
    handover_->done(std::move(failure));
  }
}

void Session::draw(const ImageJob& job) {
  const std::int64_t begin = monotonic_ns();
  ImageSnapshot& out = images_.slot();
  out.body = nullptr;  // of an image long gone: its scene is used again
  const Frame& frame = simulation_.render(job.input, job.body);
  out.grey.assign(frame.image.begin(), frame.image.end());
  out.motion = simulation_.motion();
  out.width = frame.width;
  out.height = frame.height;
  out.pixel = frame.pixel;
  out.probe_width = simulation_.transducer().width;
  out.input = job.input;
  out.body = simulation_.drawn_scene();
  out.ready_ns = monotonic_ns();
  if (shared_image_) share(out);
  if (on_image_) on_image_(out);
  if (recorder_) {
    FrameRecord record = to_record(job.input, frame, simulation_.transducer());
    if (job.body.packet) record.packet = digest_of(*job.body.packet);
    recorder_->add(record);
  }
  if (observer_ != nullptr) observer_->on_frame(job.input, frame);
  times_->image_render.add(out.ready_ns - begin);
  note_image(out.ready_ns);
  if (job.alive) times_->pose_to_image.add(out.ready_ns - job.input.sample_time_ns);
  images_.publish();
  frames_.store(job.input.number, std::memory_order_relaxed);
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
  if (n > std::size(out.grey)) {
    tell("an image of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
         " pixels is too large for IMAGE");
    return;
  }
  out.frame = image.input.number;
  out.time_ns = static_cast<std::uint64_t>(image.ready_ns);
  out.pos_time_ns = static_cast<std::uint64_t>(image.input.sample_time_ns);
  out.pixel = image.pixel;
  out.width = static_cast<std::uint32_t>(image.width);
  out.height = static_cast<std::uint32_t>(image.height);
  std::copy(image.grey.begin(), image.grey.end(), std::begin(out.grey));
  n_image_bytes_ = offsetof(artus_shm_image, grey) + n;
  share_again();
}

void Session::share_again() noexcept {
  if (n_image_bytes_ > 0) shared_image_->use().write_prefix(*image_bytes_, n_image_bytes_);
}

}  // namespace artus
