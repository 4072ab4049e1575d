// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>

#include "artus/apps/hand_options.h"
#include "artus/apps/plan_options.h"
#include "artus/apps/press_options.h"
#include "artus/core/text_file.h"
#include "artus/core/units.h"
#include "artus/evidence/medical/run_images.h"
#include "artus/evidence/medical/three_injections.h"

namespace artus {
namespace {

struct RunOptions {
  std::string scenario;
  HandOptions hand;
  PlanOptions plan;
  bool rigid = false;
  bool dry = false;
  double give_ml = 0.5;
  double give_ml_s = 0.25;
};

void print_summary(const ThreeInjections& run, const RunImages& images,
                   const std::filesystem::path& out) {
  std::printf("%-14s %9s %9s %9s %9s %8s\n", "layer", "expected", "mean N", "least N", "most N",
              "rise mm");
  for (const auto& p : run.plateaus) {
    if (p.rows == 0)
      std::printf("%-14s %9.3f  no plateau: not crossed, or thinner than the force's rise\n",
                  p.tissue.c_str(), p.expected);
    else
      std::printf("%-14s %9.3f %9.3f %9.3f %9.3f %8.2f\n", p.tissue.c_str(), p.expected, p.mean,
                  p.least, p.most, p.rise * 1e3);
  }
  for (const auto& claim : run.claims) std::printf("%s\n", to_line(claim).c_str());
  for (const GivenTo& to : run.given)
    std::printf("%-28s %9.4f ml%s\n", to.place.c_str(), to.volume / kCubicCentimetre,
                to.target ? "  target" : "");
  std::printf("%zu ticks, %zu images%s in %s\n", run.rows.size(), images.moments.size(),
              images.video.empty() ? "" : " and a video", out.c_str());
  std::printf("%s\n", count_claims(run.claims).c_str());
  if (const std::string lack = tell_lack_of_evidence(run.claims); !lack.empty())
    std::printf("%s\n", lack.c_str());
}

/// summary.json: what the run measured, and the images.
Result<nlohmann::json> write_summary(const ThreeInjections& run, const RunImages& images,
                                     const std::string& joint, const std::filesystem::path& out) {
  nlohmann::json summary = summarize(run);
  summary["joint"] = joint;
  summary.update(summarize(images));
  ARTUS_TRY(write_text(out / "summary.json", summary.dump(2) + "\n"));
  return summary;
}

ExitCode run_scenario(const RunOptions& options) {
  const HandOptions& hand = options.hand;
  const auto loaded = load_hand(hand);
  if (!loaded) return report_error(loaded.error(), hand.json);
  const View& view = loaded->at.view;
  const CompiledJoint& joint = loaded->at.joint();
  const auto face = pressing_face_at(
      view.transducer, "--transducer without --rigid, which draws the tissue at rest");
  if (!face && !hand.no_images && !options.rigid) return report_error(face.error(), hand.json);
  const auto plan = make_plan(options.plan, joint);
  if (!plan) return report_error(plan.error(), hand.json);
  const Progress progress = make_progress_printer(hand.json);

  ThreeInjectionsOptions run_options;
  run_options.rate_hz = hand.rate_hz;
  run_options.seed = hand.view.seed;
  run_options.device = hand.device;
  run_options.feel = loaded->feel;
  run_options.probe.contact.footprint.length = view.transducer.width;
  run_options.probe.contact.footprint.width = view.transducer.elevation_height;
  if (!options.dry) {
    run_options.dose.volume = options.give_ml * kCubicCentimetre;
    run_options.dose.rate = options.give_ml_s * kCubicCentimetre;
    run_options.dose.syringe.gauge = hand.view.gauge;
    run_options.dose.syringe.liquid = hand.liquid;
  }
  const auto run = run_three_injections(*loaded->at.scene, *plan, run_options, progress);
  if (!run) return report_error(run.error(), hand.json);
  if (const auto written = write_three_injections(*run, hand.out); !written)
    return report_error(written.error(), hand.json);

  RunImages images;
  if (!hand.no_images) {
    RunImagesOptions image_options{view.transducer, view.settings, view.needle_shape,
                                   !hand.no_video, !options.rigid};
    auto drawn = write_run_images(loaded->at.scene, *run, hand.out, image_options, progress);
    if (!drawn) return report_error(drawn.error(), hand.json);
    images = std::move(*drawn);
  }
  const auto summary = write_summary(*run, images, joint.name, hand.out);
  if (!summary) return report_error(summary.error(), hand.json);
  if (hand.json)
    std::cout << summary->dump(2) << '\n';
  else
    print_summary(*run, images, hand.out);
  return all_hold(run->claims) ? ExitCode::ok : ExitCode::failed;
}

}  // namespace

void add_run_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<RunOptions>();
  Command* command = add_command(
      app, "run",
      "Replay the published medical test with a simulated hand: forces, images, video, verdicts",
      "three-injections: two slow injections to the bursa with a change of direction and a touch\n"
      "of bone, then a fast straight one. At each target the thumb gives a dose; --dry gives "
      "none,\n"
      "as in the published runs. Writes trace.csv, forces.png, summary.json, a B-mode "
      "and\n"
      "a label image for each named moment, and a video. Exit code 1 when a claim does not hold.\n"
      "Examples:\n"
      "  artus run three-injections -j meshes/simple-shoulder --out out/run\n"
      "  artus run three-injections -j meshes/simple-shoulder --out out/dry --dry\n"
      "  artus run three-injections -j meshes/shoulder --out out/run --rate 10000 --no-video "
      "--json\n"
      "  artus run three-injections -j meshes/shoulder --out out/run --target=-24.6,-9,18");
  command->add_option("scenario", options->scenario, "three-injections")
      ->required()
      ->one_of({"three-injections"});
  add_hand_options(command, options->hand);
  add_haptic_rate_option(command, options->hand.rate_hz, "--rate,--haptic-rate");
  add_plan_options(command, options->plan);
  command->add_flag("--dry", options->dry, "the published runs: nothing is injected");
  command->add_option("--give-ml", options->give_ml, "ml at each target")
      ->check(number_in(0.01, 10))
      ->capture_default_str();
  command->add_option("--give-rate", options->give_ml_s, "ml/s")
      ->check(number_in(0.001, 5))
      ->capture_default_str();
  command->add_flag("--rigid", options->rigid,
                    "draw the body as it lies at rest; by default it gives way to the probe");
  on_run(command, code, [options] { return run_scenario(*options); });
}

}  // namespace artus
