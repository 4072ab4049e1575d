// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "artus/detail/apps/options/hand_options.h"
#include "artus/detail/apps/options/plan_options.h"
#include "artus/detail/apps/options/press_options.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/evidence/runs/run_images.h"
#include "artus/detail/evidence/runs/three_injections.h"

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

/// What came of it: the run in tissue that gives way with the rigid one beside it, or the rigid one
/// alone.
struct Runs {
  ThreeInjections run;
  RunImages images;
  std::optional<ThreeInjections> rigid;  // beside
};

const Claim* find_claim(const ThreeInjections& run, const std::string& text) {
  const auto claim = std::find_if(run.claims.begin(), run.claims.end(),
                                  [&text](const Claim& c) { return c.text == text; });
  return claim == run.claims.end() ? nullptr : &*claim;
}

void print_claims(const Runs& runs) {
  for (const auto& claim : runs.run.claims) {
    const Claim* rigid = runs.rigid ? find_claim(*runs.rigid, claim.text) : nullptr;
    std::printf("%s", to_line(claim).c_str());
    if (rigid != nullptr)
      std::printf("; rigid: %.4g%s", rigid->value, rigid->pass ? "" : ", FAILS");
    std::printf("\n");
  }
}

void print_summary(const Runs& runs, const std::filesystem::path& out) {
  const ThreeInjections& run = runs.run;
  const RunImages& images = runs.images;
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
  print_claims(runs);
  for (const GivenTo& to : run.given)
    std::printf("%-28s %9.4f ml%s\n", to.place.c_str(), to.volume / kCubicCentimetre,
                to.target ? "  target" : "");
  std::printf("%zu ticks, %zu images%s in %s\n", run.rows.size(), images.moments.size(),
              images.video.empty() ? "" : " and a video", out.c_str());
  std::printf("%s\n", count_claims(run.claims).c_str());
  if (const std::string lack = tell_lack_of_evidence(run.claims); !lack.empty())
    std::printf("%s\n", lack.c_str());
}

/// summary.json: what the run measured, the images, and the rigid run's claims beside it.
Result<nlohmann::json> write_summary(const Runs& runs, const std::string& joint,
                                     const std::filesystem::path& out) {
  nlohmann::json summary = summarize(runs.run);
  summary["joint"] = joint;
  summary["deforms"] = runs.rigid.has_value();
  if (runs.rigid) summary["rigid"] = verdict(runs.rigid->claims);
  summary.update(summarize(runs.images));
  ARTUS_TRY(write_text(out / "summary.json", summary.dump(2) + "\n"));
  return summary;
}

ThreeInjectionsOptions make_run_options(const RunOptions& options, const LoadedHand& loaded) {
  const HandOptions& hand = options.hand;
  const View& view = loaded.at.view;
  ThreeInjectionsOptions run;
  run.rate_hz = hand.rate_hz;
  run.seed = hand.view.seed;
  run.device = hand.device;
  run.feel = loaded.feel;
  run.probe.contact.footprint.length = view.transducer.width;
  run.probe.contact.footprint.width = view.transducer.elevation_height;
  if (options.dry) return run;
  run.dose.volume = options.give_ml * kCubicCentimetre;
  run.dose.rate = options.give_ml_s * kCubicCentimetre;
  run.dose.syringe.gauge = hand.view.gauge;
  run.dose.syringe.liquid = hand.liquid;
  return run;
}

/// The rigid run, and its pictures unless it is there for comparison alone.
Result<Runs> run_rigid(const RunOptions& options, const LoadedHand& loaded,
                       const std::vector<PlannedInjection>& plan, const Progress& progress) {
  auto run =
      run_three_injections(*loaded.at.scene, plan, make_run_options(options, loaded), progress);
  ARTUS_TRY(run);
  const bool alone = options.rigid;
  const std::filesystem::path out = alone ? options.hand.out : options.hand.out / "rigid";
  ARTUS_TRY(write_three_injections(*run, out));
  Runs runs{std::move(*run), {}, {}};
  if (!alone || options.hand.no_images) return runs;
  const View& view = loaded.at.view;
  const RunImagesOptions pictures{view.transducer, view.settings, view.needle_shape,
                                  !options.hand.no_video};
  auto drawn = write_run_images(loaded.at.scene, runs.run, out, pictures, progress);
  ARTUS_TRY(drawn);
  runs.images = std::move(*drawn);
  return runs;
}

/// The run in tissue that gives way, drawn while it goes on.
Result<Runs> run_in_tissue(const RunOptions& options, const LoadedHand& loaded,
                           const std::vector<PlannedInjection>& plan, const Progress& progress) {
  const HandOptions& hand = options.hand;
  const View& view = loaded.at.view;
  auto rigid = run_rigid(options, loaded, plan, {});
  ARTUS_TRY(rigid);
  RunTissueOptions tissue;
  tissue.transducer = view.transducer;
  std::unique_ptr<LiveRunImages> pictures;
  if (!hand.no_images) {
    const RunImagesOptions picture{view.transducer, view.settings, view.needle_shape,
                                   !hand.no_video};
    pictures =
        std::make_unique<LiveRunImages>(loaded.at.scene, hand.out, picture, tissue.image_rate);
    tissue.on_image = [&pictures](const ThreeInjections& run,
                                  const std::shared_ptr<const Scene>& body,
                                  const FluidState& fluid) {
      pictures->see(run, body, fluid);
    };
  }
  auto run = run_three_injections(*loaded.at.scene, plan, make_run_options(options, loaded),
                                  progress, &tissue);
  ARTUS_TRY(run);
  ARTUS_TRY(write_three_injections(*run, hand.out));
  Runs runs{std::move(*run), {}, std::move(rigid->run)};
  if (!pictures) return runs;
  auto drawn = pictures->finish();
  ARTUS_TRY(drawn);
  runs.images = std::move(*drawn);
  return runs;
}

ExitCode run_scenario(const RunOptions& options) {
  const HandOptions& hand = options.hand;
  const auto loaded = load_hand(hand);
  if (!loaded) return report_error(loaded.error(), hand.json);
  const CompiledJoint& joint = loaded->at.joint();
  const auto face = pressing_face_at(
      loaded->at.view.transducer, "--transducer without --rigid, which keeps the tissue at rest");
  if (!face && !options.rigid) return report_error(face.error(), hand.json);
  const auto plan = make_plan(options.plan, joint);
  if (!plan) return report_error(plan.error(), hand.json);
  const Progress progress = make_progress_printer(hand.json);
  const auto runs = options.rigid ? run_rigid(options, *loaded, *plan, progress)
                                  : run_in_tissue(options, *loaded, *plan, progress);
  if (!runs) return report_error(runs.error(), hand.json);
  const auto summary = write_summary(*runs, joint.name, hand.out);
  if (!summary) return report_error(summary.error(), hand.json);
  if (hand.json)
    std::cout << summary->dump(2) << '\n';
  else
    print_summary(*runs, hand.out);
  const bool hold = all_hold(runs->run.claims) && (!runs->rigid || all_hold(runs->rigid->claims));
  return hold ? ExitCode::ok : ExitCode::failed;
}

}  // namespace

void add_run_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<RunOptions>();
  Command* command = add_command(
      app, "run",
      "Replay the published medical test with a simulated hand: forces, images, video, verdicts",
      "three-injections: two slow injections to the bursa with a change of direction and a touch\n"
      "of bone, then a fast straight one. At each target the thumb gives a dose. Tissue gives way "
      "to\n"
      "both hands, in forces and pictures alike; what a rigid body claims is reported beside, its\n"
      "trace in the folder rigid/. --dry --rigid is the published test. Writes trace.csv,\n"
      "forces.svg, summary.json, a B-mode and a label image for each named moment, and a video.\n"
      "Exit code 1 when a claim does not hold.\n"
      "Examples:\n"
      "  artus run three-injections -j meshes/simple-shoulder --out out/run\n"
      "  artus run three-injections -j meshes/simple-shoulder --out out/dry --dry --rigid\n"
      "  artus run three-injections -j meshes/shoulder --out out/run --rate 10000 --no-video "
      "--json\n"
      "  artus run three-injections -j meshes/shoulder --out out/run --target=-24.6,-9,18");
  command->add_option("scenario", options->scenario, "three-injections")
      ->required()
      ->one_of({"three-injections"});
  add_hand_options(command, options->hand);
  add_haptic_rate_option(command, options->hand.rate_hz, "--rate,--haptic-rate");
  add_plan_options(command, options->plan);
  command->add_flag("--dry", options->dry, "nothing is injected, as in the published test");
  command->add_option("--give-ml", options->give_ml, "ml at each target")
      ->check(number_in(0.01, 10))
      ->capture_default_str();
  command->add_option("--give-rate", options->give_ml_s, "ml/s")
      ->check(number_in(0.001, 5))
      ->capture_default_str();
  command->add_flag("--rigid", options->rigid,
                    "the body stays at rest; by default it gives way to probe and needle");
  on_run(command, code, [options] { return run_scenario(*options); });
}

}  // namespace artus
