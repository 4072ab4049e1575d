// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "artus/detail/anatomy/body/space.h"
#include "artus/detail/haptics/plunger/needle_flow.h"
#include "artus/detail/haptics/plunger/syringe.h"

namespace artus {

/// What a tick of the plunger did; bits.
struct PlungerStatus {
  static constexpr std::uint32_t kMoving = 1U << 0U;
  static constexpr std::uint32_t kFlowing = 1U << 1U;    ///< into or out of the tip's place
  static constexpr std::uint32_t kClosed = 1U << 2U;     ///< the tip's place has not opened
  static constexpr std::uint32_t kEmpty = 1U << 3U;      ///< the stopper is at its end
  static constexpr std::uint32_t kDrawnOut = 1U << 4U;   ///< the stopper is at the barrel's rim
  static constexpr std::uint32_t kClogged = 1U << 5U;    ///< grains in the bore
  static constexpr std::uint32_t kRuptured = 1U << 6U;   ///< a place of the tip has torn
  static constexpr std::uint32_t kOutside = 1U << 7U;    ///< the tip is outside the body
  static constexpr std::uint32_t kFlash = 1U << 8U;      ///< what was drawn is seen in the barrel
  static constexpr std::uint32_t kNotFinite = 1U << 9U;  ///< the thumb's numbers: none was taken
  static constexpr std::uint32_t kLimited = 1U << 10U;   ///< the thumb's force was cut
  static constexpr std::uint32_t kTense = 1U << 11U;     ///< above the place's stop pressure
  static constexpr std::uint32_t kJumped = 1U << 12U;  ///< the device's plunger went faster than a
                                                       ///< thumb: refused, it begins anew
};

/// How much of the bevel's opening is in a place; the shares of a tip add up to 1.
struct TipShare {
  std::uint32_t space = 0;
  double share = 0;
};

/// What goes into a tick.
struct PlungerInput {
  double force = 0;      ///< N of the thumb, positive pushes in
  double position = 0;   ///< m the thumb wants the plunger to be, from its start
  double stiffness = 0;  ///< N/m with which it wants that; 0: by force alone
  std::array<TipShare, 2> tip{};
  double depth = 0;  ///< m along the needle: where it is, to know whether it still is
};

/// One place's scalars.
struct SpaceState {
  double volume = 0;    ///< m^3 put in and still there
  double drawn = 0;     ///< m^3 of its own that was drawn out
  double relaxing = 0;  ///< Pa above what is held in the long run
  bool ruptured = false;
  bool open = false;      ///< to the tip
  double open_depth = 0;  ///< m, where it opened
  double idle = 0;        ///< s since something flowed
};

/// What comes out of a tick.
struct PlungerState {
  double pressure = 0;        ///< Pa in the barrel
  double travel = 0;          ///< m, positive in
  double flow = 0;            ///< m^3/s out of the tip, at the tick's end
  double force = 0;           ///< N, what the thumb feels: friction and pressure
  double on_needle = 0;       ///< N, what of it pushes the needle on
  double tip_pressure = 0;    ///< Pa of what is open to the tip, the lowest of two; when nothing
                              ///< is, of the tip's places by share
  double bevel_pressure = 0;  ///< Pa inside the bevel, after the bore
  double content = 0;         ///< m^3 of liquid in the syringe
  double drawn = 0;           ///< m^3 of the patient's own in it
  std::uint32_t status = 0;
};

struct PlungerParams {
  Syringe syringe;
  NeedleBore needle;
  Liquid liquid;
  std::vector<Liquid> liquids;                 ///< those that a space's contents may name
  double entry_loss = NeedleFlow::kEntryLoss;  ///< see NeedleFlow
  double unbalanced = 0.05;  ///< of the thumb's force goes into the needle; assumed: 0.05 for the
                             ///< skilled to 0.2, 0 with an extension line
  double max_force = 100;    ///< N; assumed: the limit of one hand
  double reopen_distance = 0.5e-3;  ///< m the tip may move before its place is closed to it again
  double reopen_time = 30;          ///< s without flow before it is
  double lost_resistance = 1e9;     ///< Pa s/m^3 from a torn place to its surroundings; assumed
  double grip = 35e3;               ///< Pa from which on liquid follows the needle out; assumed
  double track_resistance =
      1.1e11;             ///< Pa s/m^3 of that path; assumed: 0.1 mm around 20 mm of 22 G
  double clog_time = 20;  ///< s at rest after which grains clog 27 G and thinner, in the mean;
                          ///< assumed
  std::uint64_t seed = 1;
};

/// Thumb, stopper, needle and the places of a joint: five scalars and one volume for each place,
/// stepped explicitly at any rate from 1 kHz on. The stopper sticks until its break-loose force is
/// reached and glides without mass; the barrel is a spring; the needle's flow is explicit; a place
/// answers with a pressure by its volume. Where the bevel lies in two places, both are fed by one
/// bore, each through its share of the bevel's opening: what opens at a low pressure keeps the rest
/// shut. Volumes balance to rounding: what left the barrel is somewhere, the last of
/// spaces() being what lies around the others (leaks and tears end there).
/// Not for several threads at once.
class Plunger {
 public:
  /// Requires: dt in (0, 0.01] s; at least one space; a liquid for each name of contents.
  Plunger(const PlungerParams& params, std::vector<Space> spaces, double dt);

  /// One period. Errors: none; the status says what was wrong. Requires: tip's spaces in range.
  ARTUS_REALTIME const PlungerState& step(const PlungerInput& input) noexcept;

  /// A new syringe, and a body that nothing was put into.
  ARTUS_REALTIME void reset() noexcept;

  /// Shaken, or changed for a wider one: what clogged the needle is gone.
  ARTUS_REALTIME void clear_needle() noexcept;

  [[nodiscard]] const PlungerState& state() const noexcept { return state_; }
  [[nodiscard]] std::span<const SpaceState> states() const noexcept { return states_; }
  [[nodiscard]] std::span<const Space> spaces() const noexcept { return spaces_; }
  [[nodiscard]] const PlungerParams& params() const noexcept { return params_; }
  /// Pa in a place, with what relaxes.
  [[nodiscard]] ARTUS_REALTIME double pressure(std::size_t space) const noexcept;

 private:
  [[nodiscard]] double rise(std::size_t space) const noexcept;
  struct Leak {
    std::uint32_t from;
    std::uint32_t to;
    double opening;
    double resistance;
    bool by_rupture;
  };
  /// The barrel as the needle sees it in a step: p = pressure - lag * flow, where the flow is
  /// taken.
  struct Drive {
    double pressure;
    double lag;   // Pa s/m^3
    double step;  // s
  };
  /// The thumb in a step: its force runs from one to the other, less what the stopper's travel
  /// takes.
  struct Push {
    double from;       // N
    double to;         // N, if the stopper stayed
    double stiffness;  // N/m
    double step;       // s
    [[nodiscard]] Push part(double share) const noexcept {
      return {from, from + share * (to - from), stiffness, share * step};
    }
  };
  /// The stopper's mean speed in the direction it goes, in its last step.
  struct StopperMotion {
    double speed = 0;  // m/s
    double step = 0;   // s
  };
  struct Before {
    PlungerState state;
    std::array<SpaceState, 2> spaces;
    std::array<double, 2> flows;
    int direction;
    StopperMotion motion;
  };
  /// A place that is not open to the tip, and by how much the pressure is over its opening, Pa.
  struct Shut {
    const TipShare* tip = nullptr;
    double over = 0;
  };
  void open(const TipShare& tip, double depth) noexcept;
  void meet_places(const PlungerInput& input) noexcept;
  [[nodiscard]] Shut easiest(const PlungerInput& input, double pressure) const noexcept;
  /// One of the tip's places as the bevel sees it: takes (p - pressure) / resistance.
  struct Branch {
    bool open = false;
    double pressure = 0;
    double resistance = 1;  // Pa s/m^3
  };
  /// Both, fed by one bore: flows, m^3/s, and the pressure where they part.
  struct BevelFlow {
    std::array<double, 2> flows{};
    double pressure = 0;
  };
  [[nodiscard]] Branch branch(const PlungerInput& input, std::size_t which, double step,
                              bool out) const noexcept;
  [[nodiscard]] const NeedleFlow* flow_in(const TipShare& tip) const noexcept;
  [[nodiscard]] BevelFlow part(const PlungerInput& input, const Drive& drive,
                               bool out) const noexcept;
  [[nodiscard]] BevelFlow flow_out(const PlungerInput& input, const Drive& drive) const noexcept;
  [[nodiscard]] double instant(double slope, double step) const noexcept;
  [[nodiscard]] double pressed(double volume) const noexcept;
  [[nodiscard]] double taken(double pressure) const noexcept;
  [[nodiscard]] double softness() const noexcept;
  [[nodiscard]] double gliding(double thumb, double stiffness) const noexcept;
  double glide(const PlungerInput& input, const Push& push) noexcept;
  void rest(const PlungerInput& input, double step) noexcept;
  void move(const PlungerInput& input, const Push& push) noexcept;
  void meet(const PlungerInput& input) noexcept;
  [[nodiscard]] int breaks_loose(double net) const noexcept;
  void break_loose(int direction, double thumb, double stiffness) noexcept;
  double move_to_event(const PlungerInput& input, const Push& push) noexcept;
  [[nodiscard]] double felt(const Push& push, double travel) const noexcept;
  double run(const PlungerInput& input, Push push) noexcept;
  void take_flows(const PlungerInput& input, const BevelFlow& bevel_flow, double step) noexcept;
  void take_out(std::size_t space, double volume) noexcept;
  void change_volume(std::size_t space, double by) noexcept;
  bool leak(const PlungerInput& input, double step) noexcept;
  void clog() noexcept;
  void describe(const PlungerInput& input, double thumb) noexcept;

  PlungerParams params_;
  double dt_;
  double area_;
  double in_end_;       // m of travel, the barrel's end
  double out_end_;      // m, its rim
  double bevel_share_;  // of the needle's length
  NeedleFlow own_;
  std::vector<NeedleFlow> others_;      // of contents
  std::vector<std::int32_t> contents_;  // (n_spaces) index into others_, -1: none
  std::vector<Space> spaces_;
  std::vector<SpaceState> states_;
  std::vector<double> fading_;  // (n_spaces) of `relaxing` in a tick
  std::vector<Leak> leaks_;
  PlungerState state_;
  std::array<double, 2> flows_{};  // m^3/s into the tip's places, now
  std::uint32_t outside_ = 0;
  int direction_ = 0;  // of the stopper: 1 in, -1 out, 0 at rest
  StopperMotion motion_;
  double hold_ = 0;       // N, to break loose now
  bool started_ = false;  // the thumb's force has been told
  double rest_time_ = 0;  // s
  double clogging_ = 0;   // 0 free .. 1 clogged
  double clog_after_;     // s at rest
};

}  // namespace artus
