// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/session/recording.h"
#include "artus/simulation/simulation.h"

namespace artus {

/// What the recording of a loop without a clock holds of its pictures.
enum class RecordedPictures {
  drawn,   ///< inputs and digests
  listed,  ///< inputs alone: for who draws them again and does not compare
  none     ///< none; what the tissue answered is kept all the same
};

/// A simulation's loop that is recorded as a session's is: each tick, what the tissue answered and
/// from which tick on, each image.
class SimulationRecorder {
 public:
  /// Writes the head. All arguments outlive it.
  SimulationRecorder(Simulation& simulation, Recording& recording,
                     RecordedPictures pictures = RecordedPictures::drawn);

  /// A tick, and the tissue's step and picture of the image that is then due.
  const HapticSnapshot& step(const TickInput& input);

  /// Of the due image in the last step(): its picture; null: none was drawn.
  [[nodiscard]] const Frame* drawn() const noexcept { return drawn_; }
  /// Its input. Requires: a picture was drawn.
  [[nodiscard]] const FrameInput& shown() const noexcept { return shown_; }
  /// Whether the images of later steps are drawn, when the recording has drawn pictures.
  void set_drawing(bool on) noexcept { draws_ = on; }
  /// Whether ticks are kept.
  void set_keeping(bool on) noexcept { keeps_ = on; }

 private:
  void take_image(std::uint64_t tick);

  Simulation& simulation_;
  Recording& recording_;
  RecordedPictures pictures_;
  bool draws_ = true;
  bool keeps_ = true;
  const Frame* drawn_ = nullptr;
  FrameInput shown_;
};

}  // namespace artus
