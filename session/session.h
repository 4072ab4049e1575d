// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "artus/session/recording.h"
#include "artus/session/seqlock.h"
#include "artus/session/session_core.h"
#include "artus/session/session_exchange.h"
#include "artus/session/session_histogram.h"
#include "artus/session/session_thread.h"
#include "artus/session/shared_memory.h"

namespace artus {

/// An image as the window gets it.
struct ImageSnapshot {
  std::vector<std::uint8_t> grey;  ///< (height, width), x fastest
  int width = 0;                   ///< pixels
  int height = 0;                  ///< pixels
  double pixel = 0;                ///< m
  double probe_width = 0;          ///< m
  FrameInput input;                ///< what it shows
  std::int64_t ready_ns = 0;       ///< monotonic clock
};

/// One tick for the force plot.
struct TracePoint {
  double time = 0;    ///< s since the session's start
  double depth = 0;   ///< m
  float force = 0;    ///< N along the needle, positive against insertion
  float lateral = 0;  ///< N, norm of the rest
  std::uint16_t region = 0;
  std::uint16_t contact = 0;
};

/// Where the time goes; each is written by one thread and may be read by any.
struct SessionTimes {
  LatencyHistogram haptic_compute;   ///< one tick: device, scene, laws, publication
  LatencyHistogram haptic_cpu;       ///< the same in processor time: without what was taken from it
  LatencyHistogram haptic_lateness;  ///< wake-up after its schedule
  LatencyHistogram image_render;
  LatencyHistogram image_interval;  ///< from image to image
  LatencyHistogram image_thirty;    ///< that the last 30 images took: 1 s is 30 Hz
  LatencyHistogram pose_to_image;   ///< from the device's time stamp to the finished image
};

/// A running session: a haptic thread and an imaging thread over one scene and one device. The
/// threads never wait for each other or for a reader; everybody takes the newest there is.
class Session {
 public:
  struct Options {
    ThreadWishes haptic_wishes{80, 0, true, -1};
    ThreadWishes imaging_wishes{0, -10, false, -1};
    std::filesystem::path recording;   ///< empty: nothing is recorded
    std::string image_segment_prefix;  ///< of IMAGE
    bool share_images = false;         ///< write IMAGE
  };

  /// Requires: valid params, a scene, a device. Errors: those of the recording and of IMAGE.
  [[nodiscard]] static Result<std::unique_ptr<Session>> start(std::shared_ptr<const Scene> scene,
                                                              const SessionParams& params,
                                                              std::unique_ptr<InputDevice> device,
                                                              const Options& options);
  /// Stops both threads, closes the recording, removes IMAGE.
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

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
  [[nodiscard]] bool next_trace_point(TracePoint& out) noexcept { return trace_.pop(out); }
  /// What the system refused to the threads; for people.
  [[nodiscard]] std::vector<std::string> refusals() const;

 private:
  Session(std::shared_ptr<const Scene> scene, const SessionParams& params,
          std::unique_ptr<InputDevice> device);
  void run_haptics(const ThreadWishes& wishes);
  void run_imaging(const ThreadWishes& wishes);
  void ask(const char* who, const ThreadWishes& wishes);
  void note_image(std::int64_t ready_ns);
  ARTUS_REALTIME void tick(std::uint64_t number, bool too_late) noexcept;
  void image(ImageCore& core, std::uint64_t number);
  void share(const ImageSnapshot& image);

  std::shared_ptr<const Scene> scene_;
  SessionParams params_;
  std::unique_ptr<InputDevice> device_;
  HapticCore core_;
  std::unique_ptr<SessionTimes> times_;
  std::unique_ptr<Recorder> recorder_;
  std::optional<SharedChannel<artus_shm_image>> shared_image_;
  std::unique_ptr<artus_shm_image> image_bytes_;
  std::string image_prefix_;

  Seqlock<HapticSnapshot> haptic_;
  Seqlock<ImageControls> controls_;
  NewestMailbox<ImageSnapshot> images_;
  SpscRing<TracePoint> trace_{8192};
  std::atomic<bool> stop_{false};
  std::atomic<bool> paused_{false};
  std::atomic<bool> frozen_{false};
  std::atomic<bool> reset_{false};
  std::atomic<std::uint64_t> ticks_{0};
  std::atomic<std::uint64_t> frames_{0};
  std::atomic<std::uint64_t> overruns_{0};
  std::int64_t start_ns_ = 0;
  std::array<std::int64_t, 31> image_times_{};  // ns, a ring of the last images
  std::size_t n_images_ = 0;
  mutable std::mutex refusals_mutex_;  // between start-up and a person's question, never in a tick
  std::vector<std::string> refusals_;
  std::thread haptic_thread_;
  std::thread imaging_thread_;
};

}  // namespace artus
