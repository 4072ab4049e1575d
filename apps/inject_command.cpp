// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>

#include "artus/detail/apps/options/arguments.h"
#include "artus/detail/apps/options/hand_options.h"
#include "artus/detail/apps/options/press_options.h"
#include "artus/detail/apps/options/session_options.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/evidence/picture_plate.h"
#include "artus/detail/evidence/runs/body_pictures.h"
#include "artus/detail/evidence/runs/injection_pictures.h"
#include "artus/detail/evidence/runs/injection_report.h"
#include "artus/detail/evidence/runs/injection_request.h"
#include "artus/detail/training/health/body_health.h"

namespace artus {
namespace {

constexpr double kUsualLength = 50;  // mm of the needle

struct InjectOptions {
  HandOptions hand;
  std::string injection;
  std::string entry;
  std::string target;
  std::vector<std::string> into;
  double volume_ml = 5;
  double rate_ml_s = 0.1;
  double syringe_ml = 0;
  double air_ml = 0;
  double aspirate_s = 3;
  double press_n = 3;
  std::string technique = "direct";
  bool rigid = false;
};

/// What the flags ask for; the structure is left open.
Result<InjectionRequest> request_of(const InjectOptions& options, const NeedleFeel& feel) {
  const HandOptions& hand = options.hand;
  InjectionRequest request;
  request.injection = options.injection;
  if (!options.entry.empty()) {
    const auto entry = parse_point_mm(options.entry, "--entry");
    ARTUS_TRY(entry);
    const auto target = parse_point_mm(options.target, "--target");
    ARTUS_TRY(target);
    request.line = {*entry, *target};
  }
  request.volume = options.volume_ml * kCubicCentimetre;
  request.rate = options.rate_ml_s * kCubicCentimetre;
  request.liquid = hand.liquid;
  request.gauge = hand.view.gauge;
  request.needle_length = hand.view.needle_length_mm.value_or(kUsualLength) * kMillimetre;
  request.syringe = options.syringe_ml * kCubicCentimetre;
  request.air = options.air_ml * kCubicCentimetre;
  request.aspirate = options.aspirate_s;
  if (options.technique == "through-and-back") request.technique = Technique::through_and_back;
  request.rigid = options.rigid;
  request.press = options.press_n;
  request.rate_hz = hand.rate_hz;
  request.device = hand.device;
  request.seed = hand.view.seed;
  request.feel = feel;
  return request;
}

void print_report(const nlohmann::json& report) {
  std::printf("%s: %.3f of %.3f ml of %s given, %.1f %% in %s\n",
              report["injection"].get<std::string>().c_str(), report["given_ml"].get<double>(),
              report["meant_ml"].get<double>(), report["liquid"].get<std::string>().c_str(),
              report["in_target_percent"].get<double>(),
              report["target"].get<std::string>().c_str());
  for (const auto& [place, volume] : report["volumes_ml"].items())
    std::printf("  %-28s %9.4f ml\n", place.c_str(), volume.get<double>());
  std::printf("needle of %.1f mm, thumb at most %.1f N, tip at most %.1f kPa, tip walked %.2f mm\n",
              report["needle_mm"].get<double>(), report["highest_thumb_n"].get<double>(),
              report["highest_tip_kpa"].get<double>(), report["tip_walk_mm"].get<double>());
  for (const auto& note : report["notes"]) std::printf("! %s\n", note.get<std::string>().c_str());
  for (const auto& line : report["patient"])
    std::printf("%6.1f s  \"%s\"\n", line["time_s"].get<double>(),
                line["text"].get<std::string>().c_str());
}

struct Outcome {
  nlohmann::json report;
  std::vector<Claim> claims;
  std::vector<Claim> beside;  // published figures, which fail nothing
  std::string broken;         // what of the body is not whole, a line each; empty: it is
};

/// Whether a body is whole: into the report, as `state`.
void examine(const HealthQuestion& question, const std::string& state, Outcome& outcome) {
  const BodyHealth health = measure_body_health(question);
  outcome.report["body"][state] = to_json(health);
  if (!health.sound()) outcome.broken += "the body " + state + ":\n" + to_text(health);
}

/// The body as it is pressed in the end. Errors: those of files.
Result<void> examine_pressed(const InjectionRun& run, const View& view, bool pictures,
                             const std::filesystem::path& folder, Outcome& outcome) {
  if (!run.pressed) return {};
  HealthQuestion question = *run.pressed;
  question.transducer = view.transducer;
  question.settings = view.settings;
  question.pictures = pictures;
  examine(question, "pressed", outcome);
  if (!pictures) return {};
  return write_body_pictures(question, folder, "pressed");
}

/// One run's files. Errors: those of files.
Result<Outcome> write_run(const std::shared_ptr<const Scene>& scene, const InjectionRun& run,
                          const View& view, const InjectOptions& options,
                          const std::filesystem::path& folder, const Progress& progress) {
  const auto tell = [&progress](std::string_view step, double done) {
    if (progress) progress(step, done);
  };
  Outcome outcome;
  ARTUS_TRY(write_injection(run, folder));
  outcome.report = summarize(run);
  outcome.claims = claims_of(run);
  if (!options.hand.no_images && run.given > 0) {
    InjectionPictureOptions looks{view.transducer, view.settings, view.needle_shape};
    looks.needle.length = run.plunger.needle.length;
    tell("pictures", 0.5);
    const auto pictures = write_injection_pictures(scene, run, looks, folder);
    ARTUS_TRY(pictures);
    if (!options.hand.no_video) {
      tell("video", 0.6);
      const auto video = write_injection_video(scene, run, looks, folder);
      ARTUS_TRY(video);
      outcome.report["video"] = *video;
    }
    for (Claim& claim : claims_of(*pictures)) outcome.claims.push_back(std::move(claim));
    outcome.beside = compare_with_published(run, *pictures);
    outcome.report["pictures"] = pictures->files;
    for (const std::string& line : pictures->overflow) outcome.report["notes"].push_back(line);
    outcome.report["opening_mm"] = pictures->opening / kMillimetre;
    outcome.report["opening_length_mm"] = pictures->length / kMillimetre;
    outcome.report["opening_width_mm"] = pictures->width / kMillimetre;
    outcome.report["beam_opening_mm"] = pictures->beam_opening / kMillimetre;
    outcome.report["seen_opening_mm"] = pictures->seen_opening / kMillimetre;
    outcome.report["seen_width_mm"] = pictures->seen_width / kMillimetre;
    outcome.report["label_area_mm2"] = pictures->label_area / (kMillimetre * kMillimetre);
    outcome.report["label_volume_ml"] = pictures->label_volume / kCubicCentimetre;
    outcome.report["ray_volume_ml"] = pictures->ray_volume / kCubicCentimetre;
    examine(pictures->at_rest, "at rest", outcome);
  }
  tell("the body in the end", 0.8);
  ARTUS_TRY(examine_pressed(run, view, !options.hand.no_images, folder, outcome));
  outcome.report["verdict"] = verdict(outcome.claims);
  if (!outcome.beside.empty()) outcome.report["published"] = verdict(outcome.beside);
  ARTUS_TRY(write_text(folder / "summary.json", outcome.report.dump(2) + "\n"));
  tell("done", 1);
  return outcome;
}

void print_outcome(const Outcome& outcome) {
  print_report(outcome.report);
  for (const Claim& claim : outcome.claims) std::printf("%s\n", to_line(claim).c_str());
  if (!outcome.beside.empty()) std::puts("beside published figures (not of the verdict):");
  for (const Claim& claim : outcome.beside) std::printf("  %s\n", to_line(claim).c_str());
  std::fputs(outcome.broken.c_str(), stdout);
}

/// Plots and pictures of several runs beside each other.
Result<void> write_comparison(std::span<const InjectionRun> runs, const InjectOptions& options) {
  std::vector<std::filesystem::path> pictures;
  std::vector<std::string> names;
  for (const InjectionRun& run : runs) {
    const auto file = options.hand.out / run.target / "after.png";
    if (!std::filesystem::exists(file)) continue;
    pictures.push_back(file);
    names.push_back(run.target);
  }
  if (!pictures.empty()) ARTUS_TRY(write_plate(pictures, names, options.hand.out / "pictures.png"));
  return write_plot(options.hand.out / "compared.svg", plot_of(runs));
}

Result<ExitCode> inject(const InjectOptions& options) {
  ARTUS_TRY(make_folder(options.hand.out));
  const auto loaded = load_hand(options.hand);
  ARTUS_TRY(loaded);
  const auto& scene = loaded->at.scene;
  auto request = request_of(options, loaded->feel);
  ARTUS_TRY(request);
  request->transducer = loaded->at.view.transducer;
  if (!options.rigid)
    ARTUS_TRY(pressing_face_at(request->transducer,
                               "--transducer without --rigid, which keeps the tissue at rest"));
  std::vector<std::string> into = options.into;
  if (into.empty()) into.emplace_back();
  std::vector<InjectionRun> runs;
  auto reports = nlohmann::json::array();
  bool holds = true;
  const Progress progress = make_progress_printer(options.hand.json);
  for (const std::string& name : into) {
    request->into = name;
    if (progress) progress(name.empty() ? "injection" : "injection into " + name, 0);
    const auto run = run_injection(*scene, *request);
    ARTUS_TRY(run);
    const auto folder = into.size() > 1 ? options.hand.out / run->target : options.hand.out;
    const auto outcome = write_run(scene, *run, loaded->at.view, options, folder, progress);
    ARTUS_TRY(outcome);
    if (!options.hand.json) print_outcome(*outcome);
    holds = holds && all_hold(outcome->claims) && outcome->broken.empty();
    reports.push_back(outcome->report);
    runs.push_back(*run);
  }
  if (runs.size() > 1) ARTUS_TRY(write_comparison(runs, options));
  if (options.hand.json) std::cout << (reports.size() == 1 ? reports[0] : reports).dump(2) << '\n';
  return holds ? ExitCode::ok : ExitCode::failed;
}

}  // namespace

void add_inject_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<InjectOptions>();
  Command* command = add_command(
      app, "inject",
      "Inject with a simulated hand and thumb: where the liquid goes, how it feels and looks",
      "Writes trace.csv, injection.svg, summary.json, the pictures before, during and after, and\n"
      "injection.mp4; with several --into also compared.svg and pictures.png. The other hand\n"
      "presses the probe on the skin, and tissue gives way to both; the pictures show it at rest,\n"
      "with what was injected, pressed-before.png and pressed-after.png as it is pressed in the "
      "end.\n"
      "Exit code 1 when a claim does not hold, or the body is not whole afterwards; how a bursa\n"
      "after 5 ml compares with published ones is told, and fails nothing.\n"
      "Examples:\n"
      "  artus inject -j meshes/shoulder --volume-ml 5 --rate 0.1 --gauge 22 -o out/bursa\n"
      "  artus inject -j shoulder.artus --technique through-and-back --volume-ml 5 -o out/back\n"
      "  artus inject -j shoulder.artus --volume-ml 1 --into deltoid --into supraspinatus_tendon\n"
      "    --into subcutaneous_fat --into joint_fluid -o out/cases");
  add_hand_options(command, options->hand);
  add_haptic_rate_option(command, options->hand.rate_hz);
  command->get_option("--needle-length-mm")
      ->description(
          "hub to tip; refused where the line needs a longer one (default: 50, longer "
          "where the target is deep)");
  command
      ->add_option("--length-mm", options->hand.view.needle_length_mm,
                   "older name of --needle-length-mm")
      ->check(number_in(10, 300));
  command->add_option("--injection", options->injection, "the joint's, by name (default: first)");
  Option* entry = command->add_option("--entry", options->entry, "x,y,z in mm, in its place");
  Option* target = command->add_option("--target", options->target, "x,y,z in mm, of the tip");
  entry->needs(target);
  target->needs(entry);
  command->add_option("--into", options->into,
                      "structure to inject: on that line, or on one that is found; repeatable");
  command->add_option("--volume-ml", options->volume_ml, "ml to give")
      ->check(number_in(0.01, 50))
      ->capture_default_str();
  command->add_option("--rate", options->rate_ml_s, "ml/s")
      ->check(number_in(0.001, 5))
      ->capture_default_str();
  command->add_option("--syringe-ml", options->syringe_ml, "barrel (default: the least that holds)")
      ->check(number_in(0.1, 50));
  command->add_option("--air-ml", options->air_ml, "air trapped behind the liquid")
      ->check(number_in(0, 5));
  command->add_option("--aspirate", options->aspirate_s, "s of pulling before; 0: none")
      ->check(number_in(0, 60))
      ->capture_default_str();
  command->add_option("--technique", options->technique, "direct or through-and-back")
      ->one_of({"direct", "through-and-back"})
      ->capture_default_str();
  command->add_option("--press-n", options->press_n, "N of the probe on the skin")
      ->check(number_in(0, 20))
      ->capture_default_str();
  add_rigid_option(command, options->rigid);
  on_run(command, code, [options] {
    const auto done = inject(*options);
    return done ? *done : report_error(done.error(), options->hand.json);
  });
}

}  // namespace artus
