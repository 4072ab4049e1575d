// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>
#include <utility>

#include "artus/detail/apps/commands.h"
#include "artus/detail/apps/options/scenario_options.h"
#include "artus/detail/apps/options/session_options.h"
#include "artus/detail/apps/options/window_options.h"
#include "artus/detail/evidence/runs/body_pictures.h"
#include "artus/detail/reports/attempt_files.h"
#include "artus/detail/reports/attempt_page.h"
#include "artus/detail/training/norms.h"
#include "artus/detail/training/past_attempts.h"
#include "artus/detail/training/patient_plans.h"
#include "artus/detail/training/player.h"

namespace artus {
namespace {

struct PlayCommandOptions {
  std::string scenario;
  std::filesystem::path joint;
  std::string patient;
  std::string hands = "expert";
  std::int64_t seed = 1;
  std::filesystem::path record;
  std::filesystem::path report;
  std::filesystem::path records;
  std::string person;
  std::string language;  // of the report
  double picture_rate = 0;
  bool rigid = false;
  bool json = false;
};

Result<OperatorSkill> skill_of(const std::string& text) {
  if (text == "expert") return expert_skill();
  if (text == "novice") return novice_skill();
  if (text.rfind("novice:", 0) == 0) {
    const std::string trials = text.substr(7);
    if (whole_number_in(0, 100000).problem(trials).empty()) return novice_skill(std::stoi(trials));
  }
  return fail(ErrorCode::malformed, "'" + text + "' is none of expert, novice and novice:N",
              "--operator");
}

void print(const PlayedAttempt& attempt) {
  const Judgement& j = attempt.judgement;
  std::printf("%s, score %d, %.1f s\n", j.passed ? "passed" : "not passed", whole_points(j.score),
              attempt.duration);
  for (const JudgedMark& m : j.marks)
    std::printf("  %-20s %-8s %10.3f  %s\n", m.mark.metric.c_str(), m.mark.text.c_str(),
                m.value.value_or(0), m.held ? "held" : (m.value ? "missed" : "not known"));
  for (const AttemptEvent& e : attempt.measures.events)
    std::printf("%9.2f s  %-10s %s\n", e.time, e.kind.c_str(), e.text.c_str());
  if (attempt.health) std::printf("the body in the end:\n%s", to_text(*attempt.health).c_str());
}

/// The attempt in a folder.
Result<void> write_folder(const Scenario& scenario, const PlayedAttempt& attempt,
                          const std::filesystem::path& folder) {
  ARTUS_TRY(write_recording(attempt.recording, folder / "session.rec"));
  if (attempt.body) ARTUS_TRY(write_body_pictures(*attempt.body, folder, "body"));
  return write_attempt_files(scenario, attempt, folder);
}

/// Where the attempt is noted before it is played, so that one that is cut off shows.
class Note {
 public:
  [[nodiscard]] static Result<Note> begin(const PlayCommandOptions& options,
                                          const Scenario& scenario) {
    Note note;
    if (options.records.empty()) return note;
    auto records = Records::open(options.records);
    ARTUS_TRY(records);
    note.records_ = std::make_unique<Records>(std::move(*records));
    AttemptRecord& a = note.attempt_;
    a.id = make_random_id();
    a.person = options.person;
    a.scenario = scenario.name;
    a.scenario_hash = text_hash(scenario.text);
    a.level = scenario.level;
    a.started = utc_now();
    a.mode = "demo";
    a.device = "simulated " + options.hands;
    a.seed = static_cast<std::uint64_t>(options.seed);
    a.folder = options.record.empty() ? "" : std::filesystem::absolute(options.record).string();
    ARTUS_TRY(note.records_->begin(a, scenario.text));
    return note;
  }

  /// What the same person did before; nothing where no records are kept.
  [[nodiscard]] Result<std::vector<PastAttempt>> before() {
    if (records_ == nullptr) return std::vector<PastAttempt>{};
    return read_past_attempts(*records_, attempt_);
  }

  /// What experts do; nothing where no records are kept.
  [[nodiscard]] Result<std::vector<Norm>> norms() {
    if (records_ == nullptr) return std::vector<Norm>{};
    return records_->norms(attempt_.scenario_hash, kExperts);
  }

  [[nodiscard]] Result<void> finish(const PlayedAttempt& played) {
    if (records_ == nullptr) return {};
    attempt_.ended = utc_now();
    attempt_.duration = played.duration;
    attempt_.passed = played.judgement.passed;
    attempt_.score = played.judgement.score;
    return records_->finish(attempt_, played.measures.metrics, played.measures.events);
  }

 private:
  std::unique_ptr<Records> records_;
  AttemptRecord attempt_;
};

ExitCode run_play(const PlayCommandOptions& options) {
  const auto skill = skill_of(options.hands);
  if (!skill) return report_error(skill.error(), options.json);
  auto scenario = find_scenario(options.scenario);
  if (scenario && !options.patient.empty()) scenario = of_patient(*scenario, options.patient);
  if (!scenario) return report_error(scenario.error(), options.json);
  auto note = Note::begin(options, *scenario);
  if (!note) return report_error(note.error(), options.json);
  const auto scene = load_scene(*scenario, options.joint, make_progress_printer(options.json));
  if (!scene) return report_error(scene.error(), options.json);
  follow_patient(*scenario, **scene);
  PlayOptions play_options;
  play_options.seed = static_cast<std::uint64_t>(options.seed);
  play_options.rigid = options.rigid;
  play_options.picture_rate = options.picture_rate;
  const auto attempt = play(*scenario, *scene, *skill, play_options);
  if (!attempt) return report_error(attempt.error(), options.json);
  Result<void> kept;
  if (!options.record.empty()) kept = write_folder(*scenario, *attempt, options.record);
  if (kept && !options.report.empty()) {
    auto before = note->before();
    if (!before) return report_error(before.error(), options.json);
    const Feedback feedback =
        make_feedback(attempt->measures, attempt->judgement, {scenario->level, std::move(*before)});
    const auto norms = note->norms();
    if (!norms) return report_error(norms.error(), options.json);
    kept = write_attempt_page(
        {*scenario, *scene, *attempt, feedback, *norms, language_of(options.language)},
        options.report);
  }
  if (kept) kept = note->finish(*attempt);
  if (!kept) return report_error(kept.error(), options.json);
  if (options.json)
    std::cout << to_json(*scenario, *attempt).dump(2) << '\n';
  else
    print(*attempt);
  const bool whole = !attempt->health || attempt->health->sound();
  return whole ? ExitCode::ok : ExitCode::failed;
}

}  // namespace

void add_play_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<PlayCommandOptions>();
  Command* command = add_command(
      app, "play", "Let simulated hands do a scenario, without a window",
      "The same scenario, operator and seed give the same bytes. It tells whether liquid left the\n"
      "body whole. Exit code 0 whether the attempt is passed or not; 1 when the body is not whole."
      "\n"
      "Examples:\n"
      "  artus play gel-align --operator expert --seed 3 --record out/attempt\n"
      "  artus play gel-align --operator novice:20 --json\n"
      "  artus play gel-steep --operator novice --report attempt.html\n"
      "  artus play sasd-lateral-2 --patient obese_m_bmi38 --record out/attempt\n"
      "  artus play mine.toml --joint shoulder.artus --pictures 10 --record out/attempt");
  command->add_option("scenario", options->scenario, "a file, or the name of a bundled one")
      ->required();
  command->add_option("--operator", options->hands, "expert, novice, or novice:N after N trials")
      ->capture_default_str();
  command->add_option("--seed", options->seed, "seed of the hands' tremor and errors")
      ->check(whole_number_in(0, 1000000000))
      ->capture_default_str();
  command->add_option("--joint,-j", options->joint, "in place of the scenario's");
  add_patient_option(command, options->patient);
  command->add_option("--record", options->record, "folder for recording, scenario and numbers");
  command->add_option("--report", options->report, "page with verdict, faults and plots (.html)");
  add_language_option(command, options->language);
  Option* records = command->add_option("--records", options->records,
                                        "file of records that the attempt goes into");
  Option* person = command->add_option("--person", options->person, "who, of those records");
  person->needs(records);
  records->needs(person);
  command->add_option("--pictures", options->picture_rate, "pictures a second in the recording")
      ->check(number_in(0, 60))
      ->capture_default_str();
  add_rigid_option(command, options->rigid);
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_play(*options); });
}

}  // namespace artus
