// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/attempt.h"

#include <algorithm>
#include <utility>

#include "artus/detail/core/text_file.h"
#include "artus/detail/reports/attempt_files.h"
#include "artus/detail/reports/attempt_page.h"
#include "artus/detail/trainer/lesson.h"
#include "artus/detail/training/live_attempt.h"
#include "artus/detail/training/session_meter.h"

namespace artus {
namespace {

/// The scenario's session with the hand's device and link.
Result<SessionParams> params_of(const TrainContext& room, const TrainTask& task) {
  auto params = make_session_params(task.scenario);
  ARTUS_TRY(params);
  const AttemptSetup& setup = *room.setup;
  params->device = setup.device;
  params->image.n_threads = setup.image_threads;
  params->deform = !setup.rigid && gives_way(task.scene->joint());
  if (setup.insertion) params->gesture = *setup.insertion;
  if (setup.pose_hold > 0) {
    constexpr double kMargin = 5e-3;  // s
    params->guard.stale_after = std::max(params->guard.stale_after, setup.pose_hold + kMargin);
  }
  ARTUS_TRY(validate(*params));
  return params;
}

/// The window while someone works; true: they said that they are done.
Result<bool> show(const TrainContext& room, const TrainTask& task, TrainLesson& lesson,
                  Session& session, HandDevice* hand, TrainOutcome& out) {
  WindowOptions window = *room.window;
  auto steps = room.script->take("attempt");
  ARTUS_TRY(steps);
  window.script = std::move(*steps);
  window.quit_after_script = room.script->given();
  window.lesson = lesson.options();
  std::optional<TeacherFollow> teacher;
  if (room.teacher != nullptr) {
    teacher.emplace(*room.teacher, task.scenario, window.lesson->aids, session.params().haptic_rate,
                    window.language);
    window.lesson->lead = [&teacher, lead = window.lesson->lead](const LessonView& view) {
      Lesson told = lead(view);
      teacher->lead(view, told);
      return told;
    };
  }
  window.patient = "";
  window.outside = task.outside;
  window.turn_knobs = [&room](ImageControls& controls) {
    room.turns->take(controls);
  };
  WindowReport report;
  const auto shown =
      run_window(*room.screen, session, hand, first_hands(task.scenario), window, report);
  if (teacher) {
    room.teacher->tell({});
    out.seen_by_teacher = teacher->events();
    out.record.aided = out.record.aided || teacher->aided();
  }
  ARTUS_TRY(shown);
  return report.finished;
}

/// The session from its start to its end; what was measured rests then. Notes why its recording is
/// not whole, and what a teacher did.
Result<bool> work(const TrainContext& room, const TrainTask& task, const SessionParams& params,
                  LiveAttempt& meter, TrainOutcome& out) {
  HandDevice* hand = nullptr;
  std::unique_ptr<InputDevice> device;
  if (room.setup->make_device) {
    auto other = room.setup->make_device(params, task.scene->joint());
    ARTUS_TRY(other);
    device = std::move(*other);
  } else {
    auto own = std::make_unique<HandDevice>(first_hands(task.scenario), 1 / params.haptic_rate);
    hand = own.get();
    device = std::move(own);
  }
  if (task.led != LedHand::none)
    device =
        std::make_unique<LedHands>(std::move(device), task.led, task.way, 1 / params.haptic_rate);
  Session::Options options;
  options.haptic_options.cpu = room.setup->haptic_cpu;
  options.recording = std::filesystem::path(out.record.folder) / "session.rec";
  options.share_images = room.setup->share_images;
  options.image_segment_prefix = room.setup->prefix;
  options.observer = &meter;
  options.extra_scene_holders = 1;
  if (room.link != nullptr || room.teacher != nullptr)
    options.on_image = [&room](const ImageSnapshot& image) {
      if (room.link != nullptr) room.link->take_image(image);
      if (room.teacher != nullptr) room.teacher->take_image(image);
    };
  TrainLesson lesson(task.scenario, task.scene, params, task.asked, room.window->language);
  lesson.name_keys(task.keys);
  lesson.leave_hand(task.led);
  lesson.look_at_pictures([&meter] { return meter.shown_db(); });
  auto session = Session::start(task.scene, params, std::move(device), options);
  ARTUS_TRY(session);
  if (room.link != nullptr) room.link->attach(session->get());
  auto finished = show(room, task, lesson, **session, hand, out);
  if (room.link != nullptr) room.link->attach(nullptr);
  (*session)->stop();
  if (const auto recorded = (*session)->recorded(); !recorded)
    out.unrecorded = recorded.error().message;
  return finished;
}

/// Judges what was measured and says what the person is told of it.
Result<void> judge_outcome(TrainDesk& desk, const Scenario& scenario, TrainOutcome& out) {
  PlayedAttempt& played = out.played;
  played.judgement = judge(played.measures.metrics, scenario.pass, scenario.score, out.record.aided,
                           out.record.device != kPaperHands);
  const auto& ticks = played.recording.ticks;
  const auto& needle = played.measures.needle;
  if (ticks.empty() && !needle.empty()) played.duration = needle.back().time - needle.front().time;
  if (!ticks.empty())
    played.duration = static_cast<double>(ticks.back().input.tick - ticks.front().input.tick) /
                      played.recording.head.params.haptic_rate;
  auto before = desk.before(out.record);
  ARTUS_TRY(before);
  out.feedback =
      make_feedback(played.measures, played.judgement, {scenario.level, std::move(*before)});
  out.report = std::filesystem::path(out.record.folder) / "report.html";
  return {};
}

}  // namespace

Result<TrainOutcome> run_attempt(const TrainContext& room, const TrainTask& task) {
  const auto params = params_of(room, task);
  ARTUS_TRY(params);
  auto options = make_meter_options(task.scenario, task.scene->joint(), *params);
  ARTUS_TRY(options);
  LiveAttempt meter(task.scene, std::move(*options), params->haptic_rate);
  TrainOutcome out;
  if (room.setup->before_attempt) room.setup->before_attempt(task.scenario);
  auto record = room.desk->begin(task.person, task.scenario, room.setup->input);
  ARTUS_TRY(record);
  out.record = *record;
  const std::filesystem::path folder = out.record.folder;
  const auto finished = work(room, task, *params, meter, out);
  ARTUS_TRY(finished);
  out.finished = *finished;
  if (!out.finished) return out;
  if (auto recording = read_recording(folder / "session.rec")) {
    out.played.recording = std::move(*recording);
  } else {
    out.played.recording.head = make_head(task.scene->joint(), *params);
    if (out.unrecorded.empty()) out.unrecorded = recording.error().message;
  }
  out.played.measures = meter.measure();
  add_asked(task.scenario, task.asked, out.played.measures.metrics);
  auto& events = out.played.measures.events;
  events.insert(events.end(), out.seen_by_teacher.begin(), out.seen_by_teacher.end());
  for (const std::string& step : task.asked)
    out.played.measures.events.push_back({0, step, "", 0, "answered before the attempt"});
  return out;
}

Result<void> keep_attempt(const TrainContext& room, const TrainTask& task, TrainOutcome& out) {
  const std::filesystem::path folder = out.record.folder;
  ARTUS_TRY(judge_outcome(*room.desk, task.scenario, out));
  ARTUS_TRY(write_attempt_files(task.scenario, out.played, folder));
  const auto norms = room.desk->norms(out.record);
  ARTUS_TRY(norms);
  ARTUS_TRY(write_attempt_page(
      {task.scenario, task.scene, out.played, out.feedback, *norms, room.window->language},
      out.report));
  return room.desk->finish(out.record, out.played);
}

Result<TrainOutcome> read_attempt(TrainDesk& desk, const TrainTask& task,
                                  const AttemptRecord& record) {
  const std::filesystem::path folder = record.folder;
  TrainOutcome out;
  out.finished = true;
  out.record = record;
  auto recording = read_recording(folder / "session.rec");
  ARTUS_TRY(recording);
  out.played.recording = std::move(*recording);
  auto options =
      make_meter_options(task.scenario, task.scene->joint(), out.played.recording.head.params);
  ARTUS_TRY(options);
  auto measures =
      assess(out.played.recording, task.scene, std::move(*options), SightSource::recorded);
  ARTUS_TRY(measures);
  out.played.measures = std::move(*measures);
  auto events = desk.events(record);
  ARTUS_TRY(events);
  std::set<std::string> asked;
  for (AttemptEvent& event : *events) {
    if (event.kind.rfind("ask:", 0) == 0) asked.insert(event.kind);
    if (event.kind == "remark" || event.kind.rfind("teacher:", 0) == 0)
      out.seen_by_teacher.push_back(std::move(event));
  }
  add_asked(task.scenario, asked, out.played.measures.metrics);
  ARTUS_TRY(judge_outcome(desk, task.scenario, out));
  return out;
}

}  // namespace artus
