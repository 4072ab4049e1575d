// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>

#include "artus/detail/apps/options/arguments.h"
#include "artus/detail/apps/options/command.h"
#include "artus/detail/apps/options/press_options.h"
#include "artus/detail/apps/options/view_options.h"
#include "artus/detail/core/units.h"
#include "artus/detail/raycast/layers_below.h"
#include "artus/detail/raycast/moving_scene.h"
#include "artus/detail/soft/solver/cage_vtu.h"
#include "artus/detail/soft/solver/press.h"
#include "artus/echo/image_io.h"
#include "artus/echo/labels.h"
#include "artus/echo/transducer_file.h"

namespace artus {
namespace {

struct DeformOptions {
  JointOptions joint;
  std::string probe;
  std::string transducer = "linear-6-18";
  PressOptions press;  ///< neither: 3 N
  std::string needle;
  int gauge = 22;
  double cell_mm = SoftBodyParams{}.fine_cell / kMillimetre;
  double poisson_ratio = SoftBodyParams{}.poisson_ratio;
  std::filesystem::path out;
  std::filesystem::path slice;
  bool json = false;
};

nlohmann::json to_json(const std::vector<LayerBelow>& layers, const CompiledJoint& joint) {
  auto report = nlohmann::json::array();
  for (const LayerBelow& layer : layers)
    report.push_back({{"region", joint.regions[layer.region].name},
                      {"tissue", joint.tissue_of(layer.region).name},
                      {"before_mm", layer.rest / kMillimetre},
                      {"after_mm", layer.now / kMillimetre},
                      {"thinned_percent", 100 * layer.thinned()}});
  return report;
}

nlohmann::json volume_of(const DeformedBody& body) {
  const SoftModel& model = *body.map().model;
  double rest = 0;
  double now = 0;
  const auto cells = model.cage().cells();
  for (std::size_t c = 0; c < cells.size(); ++c) {
    CellVector u;
    for (std::size_t a = 0; a < 8; ++a)
      u.segment<3>(static_cast<Eigen::Index>(3 * a)) = body.node_displacements()[cells[c].nodes[a]];
    const CellMaterial& m = model.materials()[c];
    double share = 0;
    for (const double w : m.weight) share += w / 8;
    const double volume = share * std::pow(model.cage().edge(cells[c]), 3);
    rest += volume;
    now += volume * cell_dilatation(m, model.cage().edge(cells[c]), u);
  }
  return {{"rest_cm3", rest * 1e6}, {"change_percent", 100 * (now / rest - 1)}};
}

nlohmann::json to_json(const Press& press, const SoftBody& body) {
  const SoftModel& model = body.solver().model();
  const Vec3 reaction = body.cage_pose().linear() * body.solver().reaction();
  nlohmann::json report = to_json(press);
  report["reaction_n"] = {reaction.x(), reaction.y(), reaction.z()};
  report["min_volume_ratio"] = body.solver().forces().min_volume;
  report["stored_mj"] = body.solver().forces().energy * 1e3;
  report["cells"] = model.cage().cells().size();
  report["unknowns"] = 3 * model.n_unknowns();
  return report;
}

/// The regions in the probe's plane before the face touched and as they then lie, side by side.
Result<void> write_slices(const std::shared_ptr<const DeformedBody>& tissue,
                          const Pose& X_JP_before, const Pose& X_JP, const Transducer& transducer,
                          const std::filesystem::path& file) {
  ImageSettings settings;
  settings.depth = depth_for(tissue->joint());
  const auto draw = [&](const Scene& scene, const Pose& pose) {
    return colour_labels(render_labels(scene, pose, transducer, settings), tissue->joint());
  };
  const cv::Mat before = draw(Scene(tissue->shared_joint()), X_JP_before);
  const cv::Mat after = draw(*make_scene(tissue), X_JP);
  cv::Mat both;
  cv::hconcat(
      std::vector<cv::Mat>{before, cv::Mat(before.rows, 8, before.type(), cv::Scalar::all(0)),
                           after},
      both);
  return write_image(both, file);
}

void print(const nlohmann::json& report) {
  print_press(report);
  if (report.contains("needle")) {
    const auto& needle = report["needle"];
    std::printf("needle going %s: %.2f N, tissue at its tip moved %.2f mm",
                needle["direction"].get<std::string>().c_str(), needle["force_n"].get<double>(),
                needle["tissue_moved_mm"].get<double>());
    if (needle.contains("tented"))
      std::printf(", %s tented", needle["tented"].get<std::string>().c_str());
    std::printf("\n");
  }
  std::printf("%-28s %-14s %9s %9s %8s\n", "region", "tissue", "before mm", "after mm", "thinned");
  for (const auto& layer : report["layers"])
    std::printf("%-28s %-14s %9.2f %9.2f %6.1f %%\n", layer["region"].get<std::string>().c_str(),
                layer["tissue"].get<std::string>().c_str(), layer["before_mm"].get<double>(),
                layer["after_mm"].get<double>(), layer["thinned_percent"].get<double>());
}

/// The needle of the flags, by default one that went in; empty: none.
Result<std::optional<NeedleView>> needle_of(const DeformOptions& options,
                                            const CompiledJoint& joint) {
  if (options.needle.empty() && !options.press.needle_direction.empty())
    return fail(ErrorCode::malformed, "needs a needle (--needle)", "--needle-direction");
  if (options.needle.empty()) return std::optional<NeedleView>();
  const SoftBodyParams own;
  if (options.cell_mm != own.fine_cell / kMillimetre || options.poisson_ratio != own.poisson_ratio)
    return fail(ErrorCode::malformed,
                "cubes and Poisson's ratio are a session's where there is a needle", "--needle");
  NeedleView needle;
  const auto shape = needle_of_flag(options.gauge);
  ARTUS_TRY(shape);
  needle.shape = *shape;
  needle.X_JN = joint.X_JN_default;
  if (options.needle != "default") {
    const auto pose = parse_needle_pose(options.needle, "--needle");
    ARTUS_TRY(pose);
    needle.X_JN = *pose;
  }
  return std::optional<NeedleView>(needle);
}

ExitCode run_deform(const DeformOptions& options) {
  const auto joint = load(options.joint, make_progress_printer(options.json));
  if (!joint) return report_error(joint.error(), options.json);
  Pose X_JP = (*joint)->X_JP_default;
  if (!options.probe.empty()) {
    const auto pose = parse_probe_pose(options.probe, "--probe");
    if (!pose) return report_error(pose.error(), options.json);
    X_JP = *pose;
  }
  SoftBodyParams params;
  params.fine_cell = options.cell_mm * kMillimetre;
  params.poisson_ratio = options.poisson_ratio;
  auto probe = find_transducer(options.transducer);
  if (!probe) {
    if (probe.error().where.empty()) probe.error().where = "--transducer";
    return report_error(probe.error(), options.json);
  }
  const auto needle = needle_of(options, **joint);
  if (!needle) return report_error(needle.error(), options.json);
  const auto face = pressing_face_at(probe->transducer, "--transducer");
  if (!face) return report_error(face.error(), options.json);
  params.face = *face;
  auto body = SoftBody::make(*joint, X_JP, params);
  if (!body) return report_error(body.error(), options.json);
  auto pressed = press(*body, X_JP, options.press);
  if (!pressed) return report_error(pressed.error(), options.json);
  auto report = to_json(pressed->press, *body);
  if (*needle) {
    auto dragged =
        drag(*joint, probe->transducer, **needle, options.press.needle_direction, *pressed);
    if (!dragged) return report_error(dragged.error(), options.json);
    report["needle"] = std::move(*dragged);
  }
  const std::shared_ptr<const DeformedBody>& snapshot = pressed->tissue;
  report["joint"] = (*joint)->name;
  report["layers"] = to_json(layers_below(*snapshot, X_JP), **joint);
  report["volume"] = volume_of(*snapshot);
  if (!options.out.empty()) {
    if (const auto written = write_vtu(*snapshot, options.out); !written)
      return report_error(written.error(), options.json);
    report["vtu"] = options.out.string();
  }
  if (!options.slice.empty()) {
    if (const auto written =
            write_slices(snapshot, X_JP, pressed->press.X_JP, probe->transducer, options.slice);
        !written)
      return report_error(written.error(), options.json);
    report["slice"] = options.slice.string();
  }
  if (options.json) {
    std::cout << report.dump(2) << '\n';
  } else {
    print(report);
  }
  return ExitCode::ok;
}

}  // namespace

void add_deform_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<DeformOptions>();
  Command* command =
      add_command(app, "deform",
                  "Press a probe on a joint's soft tissue: forces, layer thicknesses, strain field",
                  "Examples:\n"
                  "  artus deform -j meshes/simple-shoulder --press-n 3 -o pressed.vtu\n"
                  "  artus deform -j shoulder.artus --press-mm 5 --json\n"
                  "  artus deform -j meshes/shoulder --pose internal_40 --press-n 3 -o turned.vtu\n"
                  "  artus deform -j meshes/shoulder --press-n 2 --needle default -o tent.vtu");
  add_joint_options(command, options->joint);
  command->add_option(
      "--probe", options->probe,
      "x,y,z/dx,dy,dz/lx,ly,lz in mm: footprint, direction, lateral (default: the joint's)");
  command
      ->add_option("--transducer", options->transducer,
                   "the probe whose face presses: name of a preset or file (.toml)")
      ->capture_default_str();
  add_press_options(command, options->press);
  command->add_option("--needle", options->needle,
                      "entry/tip, each x,y,z in mm, or 'default' for the joint's; the tissue gives "
                      "way to it, too (default: none)");
  add_gauge_option(command, options->gauge);
  command
      ->add_option("--needle-direction,--needle-way", options->press.needle_direction,
                   "direction in which the needle was last moved (default: in)")
      ->one_of({"in", "out"});
  command->add_option("--cell-mm", options->cell_mm, "edge of the cubes under the face (default 3)")
      ->check(number_in(0.75, 6));
  command->add_option("--poisson", options->poisson_ratio, "numerical Poisson ratio (default 0.47)")
      ->check(number_in(0.3, 0.495));
  command->add_option("--slice", options->slice,
                      "the regions in the probe's plane before and after, side by side (.png)");
  command->add_option("-o,--out", options->out, "the cage as VTK unstructured grid (.vtu)");
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_deform(*options); });
}

}  // namespace artus
