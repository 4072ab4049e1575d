// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "artus/detail/session/record/recorder.h"
#include "artus/detail/session/session_exchange.h"
#include "artus/detail/session/session_histogram.h"
#include "artus/detail/session/session_thread.h"
#include "artus/detail/session/shm/reopening_channel.h"
#include "artus/detail/session/shm/seqlock.h"
#include "artus/simulation/simulation.h"

namespace artus {

template <class T>
class DroppingRing;
class ImageHandover;
struct ImageJob;

/// An image as the window gets it.
struct ImageSnapshot {
  std::vector<std::uint8_t> grey;  ///< (height, width), x fastest
  /// As grey: what moves toward the probe or away, see motion_picture; empty unless the
  /// controls want it.
  std::vector<std::uint8_t> motion;
  int width = 0;           ///< pixels
  int height = 0;          ///< pixels
  double pixel = 0;        ///< m
  double probe_width = 0;  ///< m
  FrameInput input;        ///< what it shows
  /// What it was drawn from: the body as it gave way at its instant, with what was injected.
  std::shared_ptr<const Scene> body;
  std::int64_t ready_ns = 0;  ///< monotonic clock
};

/// One tick for the force plot.
struct TracePoint {
  double time = 0;    ///< s since the session's start
  double depth = 0;   ///< m
  float force = 0;    ///< N along the needle, positive against insertion
  float lateral = 0;  ///< N, norm of the rest
  std::uint16_t region = 0;
  std::uint16_t contact = 0;
  bool felt = true;  ///< false: the tick was too late, and the force rests
  float probe = 0;   ///< N on the probe's hand, see press_of_probe
};

/// N with which the tissue holds against the probe along its face's axis; 0 without a probe.
[[nodiscard]] double press_of_probe(const HapticSnapshot& tick) noexcept;

/// Where the time goes; each is written by one thread and may be read by any.
struct SessionTimes {
  LatencyHistogram haptic_compute;   ///< one tick from the pose to the published force
  LatencyHistogram haptic_cpu;       ///< the same in processor time: without what was taken from it
  LatencyHistogram tissue_age;       ///< of the tissue that a tick feels
  LatencyHistogram haptic_lateness;  ///< wake-up after its schedule
  LatencyHistogram haptic_floor;     ///< the same of ticks that do nothing, before the first
  LatencyHistogram haptic_fixed;     ///< clock time of a fixed work after each tick, see fixed_work
  LatencyHistogram tissue_step;      ///< of the tissue that gives way, with its scene
  LatencyHistogram tissue_interval;  ///< from one of its answers to the hands to the next
  LatencyHistogram image_render;     ///< of a picture, once its body is laid
  LatencyHistogram image_interval;   ///< from image to image
  LatencyHistogram image_thirty;     ///< that the last 30 images took: 1 s is 30 Hz
  LatencyHistogram pose_to_image;    ///< from the device's time stamp to the finished image
  LatencyHistogram fixed_work;  ///< clock time of a work that is always the same: what it spreads
                                ///< is the machine's
};

/// Who looks on while a session runs, from within its threads, and must outlive it. Each call is
/// made by one thread alone, in order; the two may run at the same time.
class SessionObserver {
 public:
  virtual ~SessionObserver() = default;
  /// Every tick, in the haptic thread.
  ARTUS_REALTIME virtual void on_tick(const HapticSnapshot& tick) noexcept = 0;
  /// Every drawn picture, in the imaging thread; what it throws is told like any failure.
  virtual void on_frame(const FrameInput& input, const Frame& frame) = 0;
};

/// A running session: a haptic thread and an imaging thread over one scene and one device, and one
/// that looks after what the outside world may spoil. They never wait for each other or for a
/// reader; everybody takes the newest there is. Imaging is two in turn: while one draws an image
/// the other makes the tissue's next step, and no image is left out between them. What fails in
/// imaging is told, and the hand goes on.
class Session {
 public:
  struct Options {
    ThreadOptions haptic_options{80, 0, true, -1};
    ThreadOptions imaging_options{0, -10, false, -1};
    std::filesystem::path recording;   ///< empty: nothing is recorded
    std::string image_segment_prefix;  ///< of IMAGE
    bool images = true;                ///< false: tissue gives way all the same, nothing is drawn
    bool share_images = false;         ///< write IMAGE
    /// Time a fixed work beside, in the haptic thread and another one (SessionTimes::haptic_fixed,
    /// fixed_work).
    bool gauge = false;
    double floor_seconds = 0;  ///< of ticks that do nothing, before the first: how late the machine
                               ///< is by itself (SessionTimes::haptic_floor)
    /// Who keep the body of a picture (ImageSnapshot::body) while the next are drawn, as a window
    /// does: for each a scene more is made at the start instead of while it runs.
    std::size_t extra_scene_holders = 0;
    /// Called with each new image in the imaging thread; what it throws is told like any failure.
    std::function<void(const ImageSnapshot&)> on_image;
    SessionObserver* observer = nullptr;  ///< not owned
  };

  /// Requires: valid params, a scene, a device. Errors: those of the recording and of IMAGE.
  [[nodiscard]] static Result<std::unique_ptr<Session>> start(std::shared_ptr<const Scene> scene,
                                                              const SessionParams& params,
                                                              std::unique_ptr<InputDevice> device,
                                                              const Options& options);
  /// stop(), closes the recording, removes IMAGE.
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Whether all of the recording was written, once stopped; good without one. Errors: unreadable
  /// (a full disk).
  [[nodiscard]] const Result<void>& recorded() const noexcept { return recorded_; }

  /// Stops all threads; the device's last force is zero. What an observer gathered is then at rest,
  /// and what the session tells of itself stays. For the thread that owns it.
  void stop();

  // For any thread.
  void set_paused(bool paused) noexcept { paused_ = paused; }
  [[nodiscard]] bool paused() const noexcept { return paused_; }
  void set_frozen(bool frozen) noexcept { frozen_ = frozen; }
  [[nodiscard]] bool frozen() const noexcept { return frozen_; }
  /// The insertion is forgotten and the joint goes back to its first place at the next tick.
  void reset() noexcept { reset_ = true; }
  [[nodiscard]] bool newest(HapticSnapshot& out) const noexcept { return haptic_.load(out); }
  [[nodiscard]] const SessionTimes& times() const noexcept { return *times_; }
  [[nodiscard]] std::uint64_t ticks() const noexcept { return ticks_; }
  [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }
  [[nodiscard]] std::uint64_t overruns() const noexcept { return overruns_; }
  [[nodiscard]] std::uint64_t unrecorded() const noexcept;
  [[nodiscard]] const SessionParams& params() const noexcept { return params_; }
  [[nodiscard]] const Scene& scene() const noexcept { return *scene_; }
  [[nodiscard]] std::string_view device_name() const noexcept { return device_->name(); }

  // For one thread, the window's.
  void set_controls(const ImageControls& controls) noexcept { controls_.store(controls); }
  [[nodiscard]] const ImageSnapshot* newest_image() noexcept { return images_.newest(); }
  [[nodiscard]] bool next_trace_point(TracePoint& out) noexcept;
  /// What the system refused to the threads; for people.
  [[nodiscard]] std::vector<std::string> refusals() const;
  /// What went wrong since the start and what was done about it, the newest last; for people.
  [[nodiscard]] std::vector<std::string> notices() const;

 private:
  Session(std::shared_ptr<const Scene> scene, const SessionParams& params,
          std::unique_ptr<InputDevice> device, const Options& options);
  void run_haptics(const ThreadOptions& options, double floor_seconds);
  void run_imaging(const ThreadOptions& options);
  void run_drawing(const ThreadOptions& options);
  void run_housekeeping();
  void tell_of_plunger();
  void measure_floor(double seconds) noexcept;
  void wait_until_prepared() noexcept;
  void request_priority(const char* who, const ThreadOptions& options);
  void tell(const std::string& notice);
  void note_image(std::int64_t ready_ns);
  [[nodiscard]] std::uint32_t take_command() noexcept;
  void take_packet(std::uint64_t tick) noexcept;
  void publish(const HapticSnapshot& out) noexcept;
  [[nodiscard]] bool advance(std::uint64_t number);
  void draw(const ImageJob& job);
  void share(const ImageSnapshot& image);
  void share_again() noexcept;
  void rest(std::int64_t ns) const noexcept;

  std::shared_ptr<const Scene> scene_;
  SessionParams params_;
  std::unique_ptr<InputDevice> device_;
  Simulation simulation_;
  bool draws_;
  std::unique_ptr<SessionTimes> times_;
  std::unique_ptr<Recorder> recorder_;
  Result<void> recorded_;
  std::unique_ptr<ReopeningChannel<artus_shm_image>> shared_image_;
  std::unique_ptr<artus_shm_image> image_bytes_;  // as last shared
  std::size_t n_image_bytes_ = 0;
  std::function<void(const ImageSnapshot&)> on_image_;
  SessionObserver* observer_ = nullptr;
  bool gauges_ = false;

  Seqlock<HapticSnapshot> haptic_;
  Seqlock<ImageControls> controls_;
  Seqlock<TissuePacket> packets_;
  std::uint64_t packet_felt_ = 0;  // number of the last that the haptic thread took
  NewestMailbox<ImageSnapshot> images_;
  std::unique_ptr<DroppingRing<TracePoint>> trace_;
  std::unique_ptr<ImageHandover> handover_;
  std::int64_t answered_ns_ = 0;   // when the tissue last answered the hands
  std::uint64_t imaged_tick_ = 0;  // of the newest image
  std::atomic<bool> stop_{false};
  std::atomic<bool> paused_{false};
  std::atomic<bool> frozen_{false};
  std::atomic<bool> reset_{false};
  std::atomic<std::uint64_t> ticks_{0};
  std::atomic<std::uint64_t> frames_{0};
  std::atomic<std::uint64_t> overruns_{0};
  std::atomic<bool> prepared_;                  // tissue and picture, or tried in vain
  std::int64_t start_ns_ = 0;                   // of the first tick
  std::array<std::int64_t, 31> image_times_{};  // ns, a ring of the last images
  std::size_t n_images_ = 0;
  mutable std::mutex told_mutex_;  // between slow threads and a person's question, never in a tick
  std::vector<std::string> refusals_;
  std::vector<std::string> notices_;
  std::thread haptic_thread_;
  std::thread imaging_thread_;
  std::thread drawing_thread_;
  std::thread housekeeping_thread_;
};

}  // namespace artus
