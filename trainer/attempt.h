// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "artus/detail/exchange/session_link.h"
#include "artus/detail/trainer/bodies.h"
#include "artus/detail/trainer/desk.h"
#include "artus/detail/trainer/led_hands.h"
#include "artus/detail/trainer/remote_controls.h"
#include "artus/detail/trainer/teacher_board.h"
#include "artus/detail/training/feedback.h"
#include "artus/detail/training/player.h"
#include "artus/detail/viewer/input/screen.h"
#include "artus/detail/viewer/window.h"
#include "artus/haptics/device.h"

namespace artus {

/// The name in records of hands that a camera sees, which feel no force of ours.
inline constexpr const char* kPaperHands = "hands";

/// By which hands and on what an attempt runs.
struct AttemptSetup {
  DeviceLimits device;
  std::string input = "hand";  ///< as records name it
  /// Makes the device of the hands; empty: mouse, keyboard and gamepad.
  std::function<Result<std::unique_ptr<InputDevice>>(const SessionParams&, const CompiledJoint&)>
      make_device;
  /// Called before each attempt, as to register the hands with its body; empty: nothing to do.
  std::function<void(const Scenario&)> before_attempt;
  /// Where the device lets a needle in; empty: as the session has it.
  std::optional<GestureParams> insertion;
  double pose_hold = 0;  ///< s that a device may hold a pose before it is stale; 0: the guard's own
  bool rigid = false;
  int image_threads = 0;      ///< 0: all
  int haptic_cpu = -1;        ///< -1: any
  bool share_images = false;  ///< as shared memory
  std::string prefix;         ///< of its names
};

/// What attempts one after the other share; the pointers outlive them.
struct TrainContext {
  Screen* screen = nullptr;
  TrainDesk* desk = nullptr;
  const AttemptSetup* setup = nullptr;
  SceneLoader load_scene;
  const WindowOptions* window = nullptr;  ///< how it looks; its script is of no use here
  PageScript* script = nullptr;
  SessionLink* link = nullptr;  ///< to other programs; null: none may listen
  RemoteTurns* turns = nullptr;
  TeacherBoard* teacher = nullptr;  ///< who looks on; null: nobody can
};

/// An attempt that someone is about to make.
struct TrainTask {
  std::string person;
  Scenario scenario;  ///< with its aids as they are for this person
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const OutsideBody> outside = nullptr;  ///< the person around the joint
  std::set<std::string> asked;                           ///< steps that were answered before
  KeyMap keys = KeyMap();                                ///< that the window tells of
  LedHand led = LedHand::none;                           ///< the hand that goes a way of its own
  std::vector<LedPose> way = {};                         ///< which
};

/// What came of it.
struct TrainOutcome {
  bool finished = false;  ///< false: the window was closed; the records show it as unfinished
  AttemptRecord record;
  PlayedAttempt played;
  Feedback feedback;                          ///< with what this person did before
  std::filesystem::path report;               ///< the page that was written
  std::string unrecorded;                     ///< why the recording is not whole; empty: it is
  std::vector<AttemptEvent> seen_by_teacher;  ///< remarks and what else somebody did who looked on
};

/// Lets a person do a task in the window; what was measured meanwhile is in the outcome, whatever
/// becomes of its recording. Errors: those of the session, the window and the records.
[[nodiscard]] Result<TrainOutcome> run_attempt(const TrainContext& room, const TrainTask& task);

/// Judges an attempt that was finished and stores numbers, page and record. One that failed may be
/// called again: nothing of the outcome is lost. Errors: those of the files and the records.
[[nodiscard]] Result<void> keep_attempt(const TrainContext& room, const TrainTask& task,
                                        TrainOutcome& outcome);

/// A finished attempt as its folder has it: replayed and measured again (the same numbers; those of
/// its pictures are the kept ones), told with what came before it. Errors: those of the files, the
/// replay and the records. Cost: that of its ticks.
[[nodiscard]] Result<TrainOutcome> read_attempt(TrainDesk& desk, const TrainTask& task,
                                                const AttemptRecord& record);

}  // namespace artus
