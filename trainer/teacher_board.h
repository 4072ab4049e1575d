// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "artus/detail/training/metrics/attempt_meter.h"
#include "artus/detail/training/scenario.h"
#include "artus/detail/viewer/panels/lesson.h"

namespace artus {

/// What a teacher who looks on does.
struct TeacherCommand {
  enum class Kind { freeze, point, aid, remark } kind = Kind::remark;
  std::string text;                             ///< the remark, or the aid's name
  double value = 0;                             ///< of the aid, or 1: frozen
  std::optional<std::pair<double, double>> at;  ///< of point: 0 to 1 across and down; empty: away
};

/// A command as a page sends it: {"do": "freeze", "on": true}, {"do": "point", "x": 0.4, "y": 0.5}
/// (without place: no longer), {"do": "aid", "name": "tip_marker", "on": true}, {"do": "remark",
/// "text": ".."}. Errors: malformed, saying what is not as it should be.
[[nodiscard]] Result<TeacherCommand> parse_teacher_command(const std::string& text);

/// Between a session's threads and those who look on: the newest picture and state, and what they
/// ask for. For any threads.
class TeacherBoard {
 public:
  void take_image(const ImageSnapshot& image);
  void tell(nlohmann::json state);
  void ask(TeacherCommand command);

  /// What is asked since the last call.
  [[nodiscard]] std::vector<TeacherCommand> take();
  /// The last told state with the picture's number.
  [[nodiscard]] nlohmann::json state() const;
  /// The newest picture as PNG; empty: there was none.
  [[nodiscard]] std::string picture() const;

 private:
  struct Picture {
    int width = 0;   // pixels
    int height = 0;  // pixels
    std::uint64_t number = 0;
    std::vector<std::uint8_t> grey;
  };
  mutable std::mutex mutex_;  // of all below
  nlohmann::json state_;
  Picture picture_;
  std::vector<TeacherCommand> asked_;
};

/// One attempt that is looked on: tells the board what the window tells, does on it what is asked,
/// and keeps that for the record.
class TeacherFollow {
 public:
  /// `rate`: Hz, of the ticks. The board outlives it.
  TeacherFollow(TeacherBoard& board, const Scenario& scenario, const LessonAids& aids, double rate,
                Language language);

  /// To be called with each lesson that a window shows; changes it as it is asked.
  void lead(const LessonView& view, Lesson& lesson);

  /// What the teacher did, at its moments: "remark", "teacher:freeze", "teacher:point",
  /// "teacher:aid:NAME".
  [[nodiscard]] const std::vector<AttemptEvent>& events() const noexcept { return events_; }
  /// Whether an aid was switched on: then nobody passes.
  [[nodiscard]] bool aided() const noexcept { return aided_; }

 private:
  void obey(const TeacherCommand& command, double time);
  [[nodiscard]] nlohmann::json state_of(const LessonView& view, const Lesson& lesson) const;

  TeacherBoard* board_;
  Scenario scenario_;
  LessonAids aids_;
  double period_;  // s
  Language language_;
  double told_ = -1;      // s, when the state was told last
  bool changed_ = false;  // the aids are not those of the task
  bool aided_ = false;
  std::optional<bool> frozen_;
  std::optional<std::pair<double, double>> point_;
  std::string remark_;
  double remarked_ = 0;  // s
  std::vector<AttemptEvent> events_;
};

}  // namespace artus
