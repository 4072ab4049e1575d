// SPDX-License-Identifier: AGPL-3.0-or-later
// The first file to read: one joint, one needle line, one scanline.
//   hello [joint folder or .artus file]
#include <algorithm>
#include <cstdio>
#include <memory>

#include "artus/anatomy/compile/compile.h"
#include "artus/raycast/scene.h"

int main(int argc, char** argv) {
  // A joint is a folder of surfaces with a joint.toml. Loading compiles it once: surfaces are
  // checked and repaired, overlaps resolved, tetrahedra filled in; the result is kept.
  const char* folder = argc > 1 ? argv[1] : "meshes/simple-shoulder";
  auto loaded = artus::load_joint(folder, {}, {});
  if (!loaded) {
    std::fprintf(stderr, "hello: %s\n", loaded.error().to_string().c_str());
    return 1;
  }
  const auto joint = std::make_shared<const artus::CompiledJoint>(std::move(*loaded));

  // The scene answers where lines meet the body. Needle and echo ask the same scene.
  const artus::Scene scene(joint);
  const auto& injection = joint->injections.front();
  std::printf("needle into %s, %zu tetrahedra\n", joint->name.c_str(),
              joint->mesh.tetrahedra.size());
  for (const auto& layer : artus::tissue_intervals(scene, {injection.entry, injection.target}))
    std::printf("  %6.2f .. %6.2f mm  %-20s cutting force %.1f N\n", layer.entry * 1e3,
                layer.exit * 1e3, joint->regions[layer.region].name.c_str(),
                joint->tissue_of(layer.region).haptic.cutting_force);

  // The middle scanline of the default probe: what reflects, and how strongly. The amplitude
  // reflected between impedances Z1 and Z2 is (Z2 - Z1) / (Z2 + Z1) at normal incidence.
  const artus::Pose& X_JP = joint->X_JP_default;
  const artus::Vec3 start = X_JP.translation();
  const auto beam = artus::tissue_intervals(scene, {start, start + 0.04 * X_JP.linear().col(2)});
  std::printf("middle scanline\n");
  for (std::size_t i = 1; i < beam.size(); ++i) {
    const double z1 = joint->tissue_of(beam[i - 1].region).acoustic.impedance();
    const double z2 = joint->tissue_of(beam[i].region).acoustic.impedance();
    std::printf("  %6.2f mm  %s -> %s  reflects %+.3f\n", beam[i].entry * 1e3,
                joint->regions[beam[i - 1].region].name.c_str(),
                joint->regions[beam[i].region].name.c_str(), (z2 - z1) / (z2 + z1));
  }
  return 0;
}
