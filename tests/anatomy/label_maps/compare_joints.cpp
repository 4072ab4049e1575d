// SPDX-License-Identifier: AGPL-3.0-or-later
// How far an imported joint is from the one whose label map it was made of, as rows of a table:
//   compare_joints TRUTH.artus MADE.artus VOXEL_MM
// Run by scripts/import-truth. Bars: volumes within 2 %, surfaces within 0.6 voxel (95 %), normals
// within 6 degrees rms where the truth is smooth. The last line counts the rows that hold.
#include <cstdio>
#include <cstdlib>

#include "tests/anatomy/label_maps/region_surfaces.h"

namespace {

using artus::CompiledJoint;
using artus::RegionId;

constexpr std::size_t kSamples = 1500;

struct Tally {
  int n = 0, volumes = 0, surfaces = 0, normals = 0, smooth = 0, lost = 0;
};

/// How thick a structure is, m: that of a plate of its volume and area.
double thickness_of(double volume, const artus::SurfaceMesh& surface) {
  return 2 * volume / artus::surface_area(surface);
}

void compare_region(const CompiledJoint& truth, const CompiledJoint& made, RegionId region,
                    double voxel, Tally& tally) {
  const std::string& name = truth.regions[region].name;
  const double volume = artus::test::volume_of_region(truth, region);
  const auto surface = artus::test::surface_of_region(truth, region);
  const double thick = thickness_of(volume, surface) / voxel;
  ++tally.n;
  RegionId mine = 0;
  while (mine < made.regions.size() && made.regions[mine].name != name) ++mine;
  if (mine == made.regions.size()) {
    ++tally.lost;
    std::printf("| %s | %.3f | %.1f | not there | | | |\n", name.c_str(), volume * 1e6, thick);
    return;
  }
  const double change = 100 * (artus::test::volume_of_region(made, mine) / volume - 1);
  const auto apart =
      artus::test::compare(artus::test::surface_of_region(made, mine), surface, kSamples, voxel);
  const bool is_volume = std::abs(change) <= 2;
  const bool is_surface = apart.p95 <= 0.6 * voxel;
  const bool is_normal = apart.n_smooth > 0 && apart.normal_rms <= 6;
  tally.volumes += is_volume ? 1 : 0;
  tally.surfaces += is_surface ? 1 : 0;
  tally.normals += is_normal ? 1 : 0;
  tally.smooth += apart.n_smooth > 0 ? 1 : 0;
  std::printf("| %s | %.3f | %.1f | %+.2f%s | %.2f%s |", name.c_str(), volume * 1e6, thick, change,
              is_volume ? "" : " !", apart.p95 / voxel, is_surface ? "" : " !");
  if (apart.n_smooth == 0)
    std::printf(" - | - |\n");
  else
    std::printf(" %.1f%s | %.1f |\n", apart.normal_rms, is_normal ? "" : " !", apart.facet_rms);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "compare_joints TRUTH.artus MADE.artus VOXEL_MM\n");
    return 2;
  }
  const auto truth = artus::read_compiled_joint(argv[1]);
  const auto made = artus::read_compiled_joint(argv[2]);
  for (const auto* joint : {&truth, &made})
    if (!*joint) {
      std::fprintf(stderr, "%s\n", joint->error().to_string().c_str());
      return 1;
    }
  Tally tally;
  for (std::size_t r = artus::kFirstRegion + 1U; r < truth->regions.size(); ++r)
    compare_region(*truth, *made, static_cast<RegionId>(r), std::atof(argv[3]) * 1e-3, tally);
  std::printf(
      "of %d structures: volume %d, surface %d, normals %d of %d that are smooth somewhere, "
      "not there %d\n",
      tally.n, tally.volumes, tally.surfaces, tally.normals, tally.smooth, tally.lost);
  return 0;
}
