// SPDX-License-Identifier: AGPL-3.0-or-later
// Exported, imported and compiled, a joint is the one that it was. ARTUS_TRUTH_JOINT names another
// compiled joint than the bundled one.
#include <cstdlib>

#include <gtest/gtest.h>

#include "artus/anatomy/compile.h"
#include "artus/detail/anatomy/import/imported_joint.h"
#include "artus/detail/anatomy/label_maps/label_writer.h"
#include "tests/anatomy/label_maps/region_surfaces.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

class ImportedTruth : public test::TemporaryFolder {
 protected:
  static CompiledJoint truth() {
    const char* named = std::getenv("ARTUS_TRUTH_JOINT");
    auto joint =
        read_compiled_joint(named != nullptr ? std::filesystem::path(named)
                                             : test::source_dir() / "meshes/simple-shoulder.artus");
    EXPECT_TRUE(joint) << joint.error().to_string();
    return *joint;
  }
  /// The joint again, by its voxels.
  Result<CompiledJoint> again(const CompiledJoint& joint, const LabelGrid& grid, double& voxel) {
    const auto labels = label_joint(joint, grid);
    ARTUS_TRY(labels);
    voxel = labels->volume.voxel_edge();
    const auto bytes = to_label_file(*labels, LabelFormat::seg_nrrd, "test");
    ARTUS_TRY(bytes);
    const auto toml = to_names_toml(*labels);
    ARTUS_TRY(toml);
    ImportOptions options;
    const auto names = parse_structure_names(*toml, "names.toml");
    ARTUS_TRY(names);
    options.names = *names;
    auto read = read_labels(*bytes, "joint.seg.nrrd", {});
    ARTUS_TRY(read);
    const auto imported = import_labels(std::move(*read), options, "joint.seg.nrrd");
    ARTUS_TRY(imported);
    ARTUS_TRY(write_imported_joint(*imported, folder_, true));
    const auto file = read_joint(folder_);
    ARTUS_TRY(file);
    auto compiled = compile_joint(*file);
    ARTUS_TRY(compiled);
    return std::move(compiled->joint);
  }
};

TEST_F(ImportedTruth, VolumesSurfacesAndNormalsAreThoseOfTheJoint) {
  const CompiledJoint joint = truth();
  LabelGrid grid;
  grid.is_ras = true;
  grid.turn = Vec3(0.2, -0.3, 0.15);
  double voxel = 0;
  const auto made = again(joint, grid, voxel);
  ASSERT_TRUE(made) << made.error().to_string();
  std::size_t n = 0;
  for (std::size_t r = kFirstRegion + 1U; r < joint.regions.size(); ++r) {
    const std::string& name = joint.regions[r].name;
    const auto same = std::find_if(made->regions.begin(), made->regions.end(),
                                   [&](const Region& region) { return region.name == name; });
    if (same == made->regions.end()) continue;  // fat is the rest
    ++n;
    const auto mine = static_cast<RegionId>(same - made->regions.begin());
    const auto region = static_cast<RegionId>(r);
    const double volume = test::volume_of_region(joint, region);
    const double got = test::volume_of_region(*made, mine);
    EXPECT_NEAR(got, volume, 0.02 * volume) << name;
    const auto apart = test::compare(test::surface_of_region(*made, mine),
                                     test::surface_of_region(joint, region), 600, voxel);
    EXPECT_LT(apart.p95, 0.6 * voxel) << name;
    EXPECT_LT(apart.facet_rms, 6) << name;
    std::printf("%-32s %9.3f cm3 %+6.2f %%  p95 %.3f voxel  normals %.2f deg rms\n", name.c_str(),
                volume * 1e6, 100 * (got / volume - 1), apart.p95 / voxel, apart.facet_rms);
  }
  EXPECT_GT(n, 4U);
}

}  // namespace
}  // namespace artus
