// SPDX-License-Identifier: AGPL-3.0-or-later
// The first file to read: one joint, what a needle feels in it, what a probe sees of it.
//   hello [joint folder or .artus file] [picture.png]
#include <cstdio>
#include <memory>
#include <utility>

#include "artus/anatomy/compile.h"
#include "artus/echo/image_io.h"
#include "artus/echo/renderer.h"
#include "artus/haptics/needle_renderer.h"
#include "artus/raycast/scene.h"

namespace {

int report(const artus::Error& error) {
  std::fprintf(stderr, "hello: %s\n", error.to_string().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  // A joint is a folder of surfaces with a joint.toml. Loading compiles it once: surfaces are
  // checked and repaired, overlaps resolved, tetrahedra filled in; the result is kept.
  auto loaded = artus::load_joint(argc > 1 ? argv[1] : "meshes/simple-shoulder", {}, {});
  if (!loaded) return report(loaded.error());
  const auto joint = std::make_shared<const artus::CompiledJoint>(std::move(*loaded));

  // The scene answers where lines meet the body. Needle and echo ask the same scene.
  const auto scene = std::make_shared<const artus::Scene>(joint);
  const artus::PlannedInjection& plan = joint->injections.front();
  std::printf("%s, %zu tetrahedra; on the way of '%s':\n", joint->name.c_str(),
              joint->mesh.tetrahedra.size(), plan.name.c_str());
  for (const auto& layer : artus::tissue_intervals(*scene, {plan.entry, plan.target}))
    std::printf("  %6.2f .. %6.2f mm  %s\n", layer.entry * 1e3, layer.exit * 1e3,
                joint->regions[layer.region].name.c_str());

  // The needle goes in at 10 mm/s. Frame N has its origin at the tip and z from hub to tip; a
  // step is one tick of the haptic loop and gives what a Touch device is to be sent.
  auto needle = artus::make_needle_renderer(scene, "touch", 1000);
  if (!needle) return report(needle.error());
  const artus::Vec3 path = (plan.target - plan.entry).normalized();
  const double length = (plan.target - plan.entry).norm();
  artus::TimedPose pose;
  for (int tick = 0; 0.01 * pose.time < length; ++tick) {
    pose.time = tick * 1e-3;
    pose.X_JN = artus::make_pose(plan.entry + 0.01 * pose.time * path, path, path.unitOrthogonal());
    const artus::RenderedNeedle& felt = (*needle)->step(pose);
    if (tick % 250 == 0)
      std::printf("  %6.2f mm  pushes back with %5.2f N\n", 10 * pose.time,
                  -felt.command.force.dot(path));
  }

  // The picture of the joint's default probe, with the needle where it is now.
  artus::NeedleView view;
  view.X_JN = pose.X_JN;
  const artus::Frame frame = artus::render_bmode(scene, joint->X_JP_default, view);
  const char* picture = argc > 2 ? argv[2] : "hello.png";
  if (const auto written = artus::write_image(artus::grey_image(frame), picture); !written)
    return report(written.error());
  std::printf("  %s: %d x %d pixels of %.2f mm\n", picture, frame.width, frame.height,
              frame.pixel * 1e3);
  return 0;
}
