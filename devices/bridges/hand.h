// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>

#include "artus_shm.h"

namespace artus::bridge {

using Triple = std::array<double, 3>;
/// Row after row: columns are the axes of one frame in another.
using Turn = std::array<double, 9>;

/// What a device says in one tick, in its own frame D.
struct Reading {
  bool sound = false;  ///< false: an error; nothing below counts
  Triple position{};   ///< m
  bool has_wrist = false;
  Turn rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< of the tool, where there is a wrist
  std::uint32_t buttons = 0;                 ///< bit 0: the first
};

/// What a hand may be given: of the maker's data sheet.
struct HandLimits {
  double peak = 1;       ///< N, for moments
  double lasting = 0.5;  ///< N, for hours
};

/// How a device is set up as a hand.
struct HandSetup {
  bool probe = false;  ///< else the needle
  HandLimits limits;
  Turn R_WD{1, 0, 0, 0, 0, -1, 0, 1, 0};   ///< x right, y up, z to the user: W has z up, y away
  Turn R_TN{1, 0, 0, 0, -1, 0, 0, 0, -1};  ///< needle (or probe) on the tool: z against the tool's
  Triple centre{};                         ///< m in W, where the device's origin lies
  Triple direction{0, 0, -1};  ///< in W, of a needle without a wrist until it has entered
  double gravity = 0;          ///< N upwards, what a mounted handle weighs
  std::uint32_t clutch = 2;    ///< mask of the button that shifts; 0: none
  std::uint32_t choose = 1;    ///< mask of the button that chooses the entry point
};

/// Why a hand feels nothing at the moment.
enum class Rest { none, waiting, silent, clutched, fast, fault, not_finite };

/// A device as a hand of artus: its readings as poses in W at scale 1:1, and artus' forces as
/// forces of the device. Zero after a fault, while artus is silent, while shifted, above 1 m/s and
/// until the hand moved or pressed for the first time; then a ramp of 0.2 s. A force that lasts is
/// folded back from the peak to what the device can give for hours. Allocates and locks nothing.
class Hand {
 public:
  explicit Hand(const HandSetup& setup) : setup_(setup), shift_(setup.centre) {}

  /// The pose of this reading into the hand's part of `pos`; false: there is none.
  bool pose(const Reading& reading, const artus_shm_force& felt, std::uint64_t now_ns,
            artus_shm_pos& pos) noexcept;
  /// The force on the device, N in D, at the tick of pose(). `fresh`: artus has answered.
  [[nodiscard]] Triple force(const artus_shm_force& felt, bool fresh,
                             std::uint64_t now_ns) noexcept;

  /// The device was lost: the next one must move or press first.
  void forget() noexcept { begun_ = free_ = false; }
  /// From now on this is the other hand; its force begins anew.
  void become(bool probe) noexcept;
  [[nodiscard]] const HandSetup& setup() const noexcept { return setup_; }
  [[nodiscard]] Rest rest() const noexcept { return rest_; }

 private:
  void find_motion(const Reading& reading, std::uint64_t now_ns) noexcept;
  [[nodiscard]] Triple direction(const Triple& tip, const artus_shm_force& felt) noexcept;
  [[nodiscard]] double fold_back(double wanted, double seconds) noexcept;

  HandSetup setup_;
  Triple shift_;      // m, W
  Triple first_{};    // m, D
  Triple last_{};     // m, D, of which the speed was taken
  Triple held_{};     // m, W, while the clutch is pressed
  Triple entered_{};  // m, W, of a needle without a wrist
  std::uint64_t last_ns_ = 0;
  std::uint64_t tick_ns_ = 0;  // of the last force
  std::uint64_t ramp_ns_ = 0;  // when the ramp began; 0: it is to begin
  double spent_ = 0;           // N s above what lasts
  bool begun_ = false;         // there was a reading
  bool free_ = false;          // the hand has moved or pressed
  bool inside_ = false;
  bool clutched_ = false;
  bool fast_ = false;
  bool fault_ = true;
  Rest rest_ = Rest::waiting;
};

}  // namespace artus::bridge
