// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>

#include "artus/apps/feel_options.h"
#include "artus/apps/plan_options.h"
#include "artus/apps/view_options.h"
#include "artus/core/text_file.h"
#include "artus/core/units.h"
#include "artus/evidence/medical/run_images.h"
#include "artus/evidence/medical/three_injections.h"

namespace artus {
namespace {

struct RunOptions {
  std::string scenario;
  JointOptions joint;
  ViewOptions view;
  FeelOptions feel;
  PlanOptions plan;
  std::filesystem::path out;
  double rate_hz = 1000;
  std::string device = "virtuose_6d_desktop";
  bool no_images = false;
  bool no_video = false;
  bool rigid = false;
  bool dry = false;
  double give_ml = 0.5;
  double give_ml_s = 0.25;
  std::string liquid = "lidocaine";
  bool json = false;
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
  auto view = make_view(options.view);
  if (!view) return report_error(view.error(), options.json);
  const Progress progress = make_progress_printer(options.json);
  const auto joint = load(options.joint, progress);
  if (!joint) return report_error(joint.error(), options.json);
  take_depth(options.view, **joint, *view);
  const auto plan = make_plan(options.plan, **joint);
  if (!plan) return report_error(plan.error(), options.json);
  const auto scene = std::make_shared<const Scene>(*joint);

  ThreeInjectionsOptions run_options;
  run_options.rate_hz = options.rate_hz;
  run_options.seed = options.view.seed;
  run_options.device = options.device;
  FeelOptions feel_options = options.feel;
  feel_options.needle_length_mm = options.view.needle_length_mm;
  const auto feel = make_feel(feel_options, **joint);
  if (!feel) return report_error(feel.error(), options.json);
  run_options.feel = *feel;
  run_options.probe.contact.footprint.length = view->transducer.width;
  run_options.probe.contact.footprint.width = view->transducer.elevation_height;
  if (!options.dry) {
    run_options.dose.volume = options.give_ml * kCubicCentimetre;
    run_options.dose.rate = options.give_ml_s * kCubicCentimetre;
    run_options.dose.syringe.gauge = options.view.gauge;
    run_options.dose.syringe.liquid = options.liquid;
  }
  const auto run = run_three_injections(*scene, *plan, run_options, progress);
  if (!run) return report_error(run.error(), options.json);
  if (const auto written = write_three_injections(*run, options.out); !written)
    return report_error(written.error(), options.json);

  RunImages images;
  if (!options.no_images) {
    RunImagesOptions image_options{view->transducer, view->settings, view->needle_shape,
                                   !options.no_video, !options.rigid};
    auto drawn = write_run_images(scene, *run, options.out, image_options, progress);
    if (!drawn) return report_error(drawn.error(), options.json);
    images = std::move(*drawn);
  }
  const auto summary = write_summary(*run, images, (*joint)->name, options.out);
  if (!summary) return report_error(summary.error(), options.json);
  if (options.json)
    std::cout << summary->dump(2) << '\n';
  else
    print_summary(*run, images, options.out);
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
  add_joint_options(command, options->joint);
  add_view_options(command, options->view);
  add_feel_options(command, options->feel);
  add_plan_options(command, options->plan);
  command->add_option("-o,--out", options->out, "folder for the results")->required();
  command->add_option("--rate", options->rate_hz, "haptic rate, Hz")
      ->check(number_in(100, 20000))
      ->capture_default_str();
  command->add_option("--device", options->device, "device whose force limits apply")
      ->capture_default_str();
  command->add_flag("--dry", options->dry, "the published runs: nothing is injected");
  command->add_option("--give-ml", options->give_ml, "ml at each target")
      ->check(number_in(0.01, 10))
      ->capture_default_str();
  command->add_option("--give-rate", options->give_ml_s, "ml/s")
      ->check(number_in(0.001, 5))
      ->capture_default_str();
  command->add_option("--liquid", options->liquid, "of meshes/liquids.toml")->capture_default_str();
  command->add_flag("--rigid", options->rigid,
                    "draw the body as it lies at rest; by default it gives way to the probe");
  command->add_flag("--no-images", options->no_images, "forces alone");
  command->add_flag("--no-video", options->no_video, "images of the named moments, but no video");
  command->add_flag("--json", options->json, "print the summary as JSON");
  on_run(command, code, [options] { return run_scenario(*options); });
}

}  // namespace artus
