// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "artus/core/result.h"
#include "artus/detail/exchange/igtl/message.h"
#include "artus/detail/exchange/reference_frame.h"
#include "artus/detail/exchange/tracker_calibration.h"
#include "artus/detail/session/shm/seqlock.h"
#include "artus/simulation/input_device.h"

namespace artus {

/// What a tracker said last, in the world W, and what the thumb does. Plain bytes.
struct TrackedPoses {
  PlainPose X_WN;
  PlainPose X_WP;
  std::int64_t needle_ns = 0;  ///< monotonic clock, when it arrived; 0: never
  std::int64_t probe_ns = 0;
  std::int64_t plunger_ns = 0;
  double plunger = 0;                    ///< N or m, by `sign`
  PlungerSign sign = PlungerSign::none;  ///< what the thumb was last told by
  std::uint64_t number = 0;              ///< grows with every pose that was taken
  std::int64_t refused_ns = 0;           ///< when a pose last came that cannot be one
};

/// Takes TRANSFORM messages of probe and needle and SENSOR messages of the plunger, by their device
/// names, for a TrackerDevice. One thread fills it (the server's), any may look.
class TrackerInbox {
 public:
  struct Names {
    std::string probe = "ProbeToReference";
    std::string needle = "NeedleToReference";
    std::string plunger = "Plunger";
  };
  TrackerInbox(const TrackerCalibration& calibration, const Names& names);

  /// A TRANSFORM or POSITION of one of the two names, or a TDATA or QTDATA with a tool of such a
  /// name (or of what stands before its "To"); others are left alone. A pose with metadata
  /// TransformStatus other than OK was not seen by the tracker: it is not taken. The plunger's
  /// SENSOR has one number, the thumb's force in newton (at most 1000) or the plunger's travel in
  /// metres (at most 1), positive in. Errors: as ReferenceFrame::from_reference, what is no
  /// TRANSFORM, a plunger that cannot be; then the thumb lets go.
  [[nodiscard]] Result<void> take(const igtl::Message& message, std::int64_t now_ns);

  /// Poses that come from now on are of a Reference that is there in the joint: as a task begins
  /// whose body stands elsewhere. From any thread.
  void register_at(const Pose& X_JR);

  /// What is to be told of the message that was taken last: a pose that flipped (its axis turned by
  /// more than a right angle in a quarter of a second) or leapt (faster than 2 m/s), told when the
  /// number of them doubles; names that nobody asked for, once. Empty: nothing.
  [[nodiscard]] std::string take_notice() { return std::exchange(notice_, {}); }

  [[nodiscard]] ARTUS_REALTIME bool load(TrackedPoses& out) const noexcept {
    return poses_.load(out);
  }

 private:
  [[nodiscard]] Result<void> take_plunger(const igtl::Message& message, std::int64_t now_ns);
  [[nodiscard]] Result<void> take_tools(const igtl::Message& message, std::int64_t now_ns);
  [[nodiscard]] Result<void> take_pose(const std::string& device,
                                       const Result<igtl::Matrix>& matrix,
                                       const igtl::Message& message, std::int64_t now_ns);
  void watch(bool probe, const Pose& pose, const igtl::Message& message, std::int64_t now_ns);
  void tell_unknown(const std::string& names);

  /// One hand as it was last, to see whether it flips or leaps.
  struct Watched {
    std::optional<Pose> pose;
    double time = 0;  // s, by the sender's clock, or by ours where it has none
    std::uint64_t odd = 0;
  };

  TrackerCalibration calibration_;
  std::mutex registering_;  // of reference_
  ReferenceFrame reference_;
  Names names_;
  TrackedPoses newest_;  // as stored last; of the filling thread
  Seqlock<TrackedPoses> poses_;
  Watched watched_[2];  // NOLINT(*-avoid-c-arrays): needle, probe
  std::set<std::string> told_;
  std::string notice_;
};

/// Needle and probe of a tracker, or of another program that sends its poses. A probe that is
/// silent is held for a while, as its picture may be; a needle that is silent is gone, since no
/// force may be made of an old pose; a thumb that is silent as long has let go. Forces are written
/// nowhere: a tracker has no motors.
class TrackerDevice final : public InputDevice {
 public:
  struct Holds {
    std::int64_t probe_ns = 500'000'000;    ///< assumed: longer than a hand hides a marker
    std::int64_t needle_ns = kPeerTimeout;  ///< longer only where no hand feels the force
  };
  TrackerDevice(std::shared_ptr<const TrackerInbox> inbox, const Holds& holds)
      : inbox_(std::move(inbox)), holds_(holds) {}

  [[nodiscard]] ARTUS_REALTIME DeviceSample read(std::int64_t now_ns) noexcept override;
  ARTUS_REALTIME void write(const DeviceFeedback& /*feedback*/) noexcept override {}
  [[nodiscard]] std::string_view name() const noexcept override { return "OpenIGTLink"; }

 private:
  std::shared_ptr<const TrackerInbox> inbox_;
  Holds holds_;
  TrackedPoses seen_;  // the newest that was read whole
};

}  // namespace artus
