// SPDX-License-Identifier: AGPL-3.0-or-later
// The first file to read: one joint, what a needle feels in it, what a probe sees of it.
//   hello [joint.artus] [picture.png]
#include <cstdio>

#include "artus/anatomy/compiled_joint.h"
#include "artus/echo/image_io.h"
#include "artus/simulation/simulation.h"

namespace {

int report(const artus::Error& error) {
  std::fprintf(stderr, "hello: %s\n", error.to_string().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  // A compiled joint is one file: the layered body, its tissues, planned injections, default poses.
  const auto joint = artus::read_compiled_joint(argc > 1 ? argv[1] : "simple-shoulder.artus");
  if (!joint) return report(joint.error());
  const artus::PlannedInjection& plan = joint->injections.front();
  const artus::Vec3 path = (plan.target - plan.entry).normalized();
  std::printf("%s, %zu tetrahedra; the way of '%s':\n", joint->name.c_str(),
              joint->mesh.tetrahedra.size(), plan.name.c_str());

  // One simulation has both hands in one body whose tissue gives way. A step is one tick of the
  // haptic loop: poses of needle and probe go in, the force for a Touch device comes out.
  artus::Simulation sim(*joint, {.device = "touch"});
  artus::Hands hands;
  hands.X_WP = joint->X_JP_default;  // frame P: origin on the probe's face, z into the body
  const double end = (plan.target - plan.entry).norm();
  for (int tick = 0;; ++tick) {
    const double depth = -0.005 + 0.010 * tick * 1e-3;  // m; 10 mm/s at 1000 ticks a second
    if (depth > end) break;
    const artus::Vec3 tip = plan.entry + depth * path;
    hands.X_WN = artus::make_pose(tip, path, path.unitOrthogonal());  // N: z from hub to tip
    const artus::Felt& felt = sim.step(hands);
    if (tick % 250 == 0)
      std::printf("  %6.2f mm  pushes back with %5.2f N\n", 1e3 * depth, -felt.force.dot(path));
  }

  // The picture of the same instant: the probe's, with the needle and what it drags.
  const artus::Frame& frame = sim.render();
  const char* picture = argc > 2 ? argv[2] : "hello.png";
  if (const auto written = artus::write_image(artus::grey_image(frame), picture); !written)
    return report(written.error());
  std::printf("  %s: %d x %d pixels of %.2f mm\n", picture, frame.width, frame.height,
              frame.pixel * 1e3);
  return 0;
}
