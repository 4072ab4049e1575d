// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/import/dicom_seg.h"
#include "artus/detail/anatomy/import/imported_joint.h"
#include "artus/detail/anatomy/import/surface_nets.h"
#include "artus/detail/anatomy/label_maps/dicom_seg_writer.h"
#include "artus/detail/anatomy/label_maps/joint_labels.h"
#include "artus/detail/anatomy/label_maps/label_writer.h"
#include "tests/anatomy/label_maps/region_surfaces.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

using test::compare;
using test::volume_of_region;
using testing::HasSubstr;

/// Six layers around a bone: truth of our own.
class LabelMaps : public testing::Test {
 protected:
  static CompiledJoint shoulder() {
    auto joint = read_compiled_joint(test::source_dir() / "meshes/simple-shoulder.artus");
    EXPECT_TRUE(joint);
    return *joint;
  }
  static JointLabels labels(const CompiledJoint& joint, double scale, bool ras, bool oblique) {
    LabelGrid grid;
    grid.spacing = scale * 1e-3 * Vec3(0.4, 0.4, 0.7);
    grid.is_ras = ras;
    if (oblique) grid.turn = Vec3(0.2, -0.3, 0.15);
    auto made = label_joint(joint, grid);
    EXPECT_TRUE(made) << (made ? "" : made.error().to_string());
    return *made;
  }
  static std::vector<LabelFormat> formats() {
    std::vector<LabelFormat> all{LabelFormat::nifti, LabelFormat::nifti_gz, LabelFormat::nrrd,
                                 LabelFormat::seg_nrrd, LabelFormat::metaimage};
    if (reads_dicom()) all.push_back(LabelFormat::dicom);
    return all;
  }
  static Result<LabelVolume> read_back(const JointLabels& made, LabelFormat format) {
    const auto bytes = to_label_file(made, format, "test");
    ARTUS_TRY(bytes);
    StructureNames names;
    if (!holds_names(format)) {
      const auto toml = to_names_toml(made);
      ARTUS_TRY(toml);
      const auto parsed = parse_structure_names(*toml, "names.toml");
      ARTUS_TRY(parsed);
      names = *parsed;
    }
    return read_labels(*bytes, format == LabelFormat::nifti_gz ? "map.nii.gz" : "map", names);
  }
};

TEST_F(LabelMaps, EachVoxelIsOfTheRegionThatItsCentreLiesIn) {
  const CompiledJoint joint = shoulder();
  const JointLabels made = labels(joint, 2.5, false, true);
  ASSERT_EQ(made.volume.segments.size(), joint.regions.size() - kFirstRegion);
  EXPECT_FALSE(made.is_cut);
  EXPECT_EQ(made.volume.segments.back().name, "body");
  EXPECT_EQ(made.tissues.back(), "body");
  for (std::size_t r = kFirstRegion; r < joint.regions.size(); ++r) {
    const std::size_t k =
        r == kFirstRegion ? made.volume.segments.size() - 1 : r - kFirstRegion - 1;
    const double truth = volume_of_region(joint, static_cast<RegionId>(r));
    const double counted =
        static_cast<double>(made.volume.segments[k].n_voxels) * made.volume.voxel_volume();
    EXPECT_NEAR(counted, truth, 0.01 * truth) << joint.regions[r].name;
  }
  int n_in_rim = 0;  // air is all around
  const auto& size = made.volume.size;
  for (std::size_t i = 0; i < made.volume.labels.size(); ++i) {
    const std::size_t x = i % size[0], y = i / size[0] % size[1], z = i / size[0] / size[1];
    const bool is_rim =
        x < 2 || y < 2 || z < 2 || x + 3 > size[0] || y + 3 > size[1] || z + 3 > size[2];
    n_in_rim += is_rim && made.volume.labels[i] != 0 ? 1 : 0;
  }
  EXPECT_EQ(n_in_rim, 0);
}

TEST_F(LabelMaps, AxesOfTheJointAndOfTheGridAreHonoured) {
  CompiledJoint joint = shoulder();
  Eigen::AlignedBox3d box;
  for (const Vec3& p : joint.mesh.vertices) box.extend(p);
  const JointLabels lps = labels(joint, 5, false, false);
  EXPECT_GT(lps.volume.X_LI.linear()(0, 0), 0);
  EXPECT_LT((lps.volume.X_LI.translation() - box.min()).cwiseAbs().maxCoeff(), 20e-3);
  const JointLabels ras = labels(joint, 5, true, false);
  EXPECT_LT(ras.volume.X_LI.linear()(0, 0), 0);
  EXPECT_GT(ras.volume.X_LI.linear()(2, 2), 0);
  EXPECT_NEAR(ras.volume.X_LI.translation().x(), box.max().x(), 20e-3);
  // A joint whose frame is RAS lies the other way round in LPS.
  joint.axes = "RAS";
  const JointLabels turned = labels(joint, 5, false, false);
  EXPECT_NEAR(turned.volume.X_LI.translation().x(), -box.max().x(), 20e-3);
}

TEST_F(LabelMaps, EveryFormatHoldsTheSameVoxelsNamesAndFrame) {
  const CompiledJoint joint = shoulder();
  for (const bool ras : {false, true}) {
    const JointLabels made = labels(joint, 2.5, ras, ras);
    for (const LabelFormat format : formats()) {
      const auto read = read_back(made, format);
      ASSERT_TRUE(read) << static_cast<int>(format) << read.error().to_string();
      EXPECT_EQ(read->size, made.volume.size);
      EXPECT_TRUE(read->labels == made.volume.labels) << static_cast<int>(format);
      EXPECT_LT((read->X_LI.matrix() - made.volume.X_LI.matrix()).cwiseAbs().maxCoeff(), 2e-9);
      ASSERT_EQ(read->segments.size(), made.volume.segments.size());
      for (std::size_t k = 0; k < read->segments.size(); ++k) {
        EXPECT_EQ(read->segments[k].name, made.volume.segments[k].name);
        EXPECT_EQ(read->segments[k].n_voxels, made.volume.segments[k].n_voxels);
      }
    }
  }
}

TEST_F(LabelMaps, EveryFormatGivesTheSameSurfacesByteForByte) {
  const CompiledJoint joint = shoulder();
  const JointLabels made = labels(joint, 3, true, true);
  std::optional<ImportedJoint> first;
  for (const LabelFormat format : formats()) {
    auto read = read_back(made, format);
    ASSERT_TRUE(read) << read.error().to_string();
    const auto imported = import_labels(std::move(*read), {}, "shoulder.x");
    ASSERT_TRUE(imported) << imported.error().to_string();
    if (!first) {
      first = *imported;
      continue;
    }
    EXPECT_TRUE(imported->body.vertices == first->body.vertices) << static_cast<int>(format);
    EXPECT_TRUE(imported->cuts.triangles.empty());
    ASSERT_EQ(imported->structures.size(), first->structures.size());
    for (std::size_t k = 0; k < first->structures.size(); ++k) {
      EXPECT_EQ(imported->structures[k].name, first->structures[k].name);
      EXPECT_EQ(imported->structures[k].tissue, first->structures[k].tissue);
      EXPECT_TRUE(imported->structures[k].mesh.vertices == first->structures[k].mesh.vertices);
      EXPECT_TRUE(imported->structures[k].mesh.triangles == first->structures[k].mesh.triangles);
    }
  }
}

// The joint itself is the truth: what is imported from its voxels has its volumes, lies within 0.6
// voxel of it and is as smooth as it.
TEST_F(LabelMaps, AnImportedJointIsTheOneThatWasExported) {
  const CompiledJoint joint = shoulder();
  for (const bool ras : {false, true}) {
    const JointLabels made = labels(joint, 1, ras, ras);
    const double voxel = made.volume.voxel_edge();
    const auto read = read_back(made, LabelFormat::nifti_gz);
    ASSERT_TRUE(read);
    const auto imported = import_labels(*read, {}, "shoulder.nii.gz");
    ASSERT_TRUE(imported) << imported.error().to_string();
    ASSERT_EQ(imported->structures.size(), joint.regions.size() - kFirstRegion - 1);
    for (const ImportedStructure& s : imported->structures) {
      RegionId region = kFirstRegion;
      while (joint.regions[region].name != s.source) ++region;
      const double truth = volume_of_region(joint, region);
      EXPECT_NEAR(signed_volume(s.mesh), truth, 0.01 * truth) << s.name;
      const auto apart = compare(s.mesh, test::surface_of_region(joint, region), 600, voxel);
      EXPECT_LT(apart.p95, 0.6 * voxel) << s.name;
      EXPECT_GT(apart.n_smooth, 350U) << s.name;
      EXPECT_LT(apart.facet_rms, 6) << s.name;
      RecordProperty(
          s.name + (ras ? "_oblique" : "_straight"),
          std::to_string(apart.p95 / voxel) + " voxel " + std::to_string(apart.facet_rms) + " deg");
    }
  }
}

/// A ball of 10 mm in facets of some 2 mm, turned about its axis.
SurfaceMesh faceted_ball(double turn) {
  constexpr double kPi = 3.14159265358979;
  constexpr std::uint32_t kRings = 15, kSectors = 30;
  SurfaceMesh ball;
  for (std::uint32_t i = 0; i <= kRings; ++i)
    for (std::uint32_t k = 0; k < kSectors; ++k) {
      const double down = kPi * i / kRings, around = turn + 2 * kPi * k / kSectors;
      ball.vertices.push_back(10e-3 * Vec3(std::sin(down) * std::cos(around),
                                           std::sin(down) * std::sin(around), std::cos(down)));
      const std::uint32_t a = i * kSectors + k, b = i * kSectors + (k + 1) % kSectors;
      if (i < kRings && i > 0) ball.triangles.push_back({a, b + kSectors, b});
      if (i + 1 < kRings) ball.triangles.push_back({a, a + kSectors, b + kSectors});
    }
  return ball;
}

TEST(CompareSurfaces, NormalsBetweenCornersForgiveFacetsAndNotSteps) {
  const auto other = compare(faceted_ball(0.1), faceted_ball(0), 600, 0.5e-3);
  EXPECT_GT(other.n_smooth, 350U);
  EXPECT_GT(other.facet_rms, 4) << "the same ball, in other facets";
  EXPECT_LT(other.normal_rms, 2);
  // The same ball as voxels of 0.5 mm: steps count, and smoothed they do not.
  constexpr std::size_t kEdge = 48;
  std::vector<std::uint16_t> labels;
  IndexFrame X_LI = IndexFrame::Identity();
  X_LI.linear() *= 0.5e-3;
  X_LI.translation() = Vec3::Constant(-23.5 * 0.5e-3);
  for (std::size_t i = 0; i < kEdge * kEdge * kEdge; ++i) {
    const Vec3 index(static_cast<double>(i % kEdge), static_cast<double>(i / kEdge % kEdge),
                     static_cast<double>(i / kEdge / kEdge));
    labels.push_back((X_LI * index).norm() < 10e-3 ? 1 : 0);
  }
  SurfaceNet net = make_surface_net(labels, {kEdge, kEdge, kEdge});
  const auto steps =
      compare(make_label_surfaces(net, 1, X_LI)[0].mesh, faceted_ball(0), 600, 0.5e-3);
  EXPECT_GT(steps.normal_rms, 12);
  smooth(net);
  const auto smoothed =
      compare(make_label_surfaces(net, 1, X_LI)[0].mesh, faceted_ball(0), 600, 0.5e-3);
  EXPECT_LT(smoothed.normal_rms, 6);
}

TEST_F(LabelMaps, WhatCannotBeWrittenIsSaid) {
  const CompiledJoint joint = shoulder();
  LabelGrid grid;
  grid.spacing = Vec3::Constant(0.01e-3);
  EXPECT_THAT(label_joint(joint, grid).error().message, HasSubstr("0.05 to 20 mm"));
  grid.spacing = Vec3::Constant(0.05e-3);
  EXPECT_THAT(label_joint(joint, grid).error().message, HasSubstr("take --spacing 0.1"));
  EXPECT_THAT(label_format_of("a.vtk").error().message, HasSubstr(".seg.nrrd"));
  EXPECT_FALSE(label_format_of(".mha"));
  EXPECT_EQ(*label_format_of("a/b.seg.nrrd"), LabelFormat::seg_nrrd);
  EXPECT_EQ(*label_format_of("b.nii.gz"), LabelFormat::nifti_gz);
  if (!reads_dicom()) return;
  const auto twice = labels(joint, 5, false, false);
  EXPECT_EQ(*to_dicom_seg(twice, "x"), *to_dicom_seg(twice, "x"));
}

}  // namespace
}  // namespace artus
