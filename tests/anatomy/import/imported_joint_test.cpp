// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/imported_joint.h"

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/import/body_outline.h"
#include "artus/detail/anatomy/import/import_files.h"
#include "artus/detail/anatomy/import/scene_parts.h"
#include "artus/detail/anatomy/import/scene_reader.h"
#include "artus/detail/anatomy/import/voxel_masks.h"
#include "artus/detail/anatomy/surfaces/foreign_format.h"
#include "tests/anatomy/import/label_samples.h"
#include "tests/anatomy/surfaces/surface_samples.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// Two bones with cartilage between, in a limb that leaves the volume at both ends.
LabelVolume limb(bool with_body) {
  return test::painted({60, 60, 60}, test::oblique_frame({1, 1, 1}),
                       {"femur_left", "tibia_left", "articular cartilage", "body", "blob"},
                       [=](const Vec3& p) -> std::uint16_t {
                         const double r = p.head<2>().norm();
                         if (r < 9e-3) return std::abs(p.z()) < 1e-3 ? 3 : p.z() > 0 ? 1 : 2;
                         if ((p - Vec3(15e-3, 0, 0)).norm() < 4e-3) return 5;
                         return with_body && r < 24e-3 ? 4 : 0;
                       });
}

TEST(ImportedJoint, ALabelledLimbBecomesAJointFileThatIsRead) {
  const auto joint = import_labels(limb(true), {}, "my knee.seg.nrrd");
  ASSERT_TRUE(joint) << joint.error().to_string();
  EXPECT_EQ(joint->side, "left");
  EXPECT_EQ(joint->body_by, "label 'body'");
  EXPECT_FALSE(joint->body_is_assumed);
  EXPECT_THAT(joint->left_out, testing::SizeIs(1));  // the blob
  EXPECT_FALSE(joint->cuts.triangles.empty());
  const std::string toml = to_joint_toml(*joint);
  const auto file = parse_joint(toml, "knee");
  ASSERT_TRUE(file) << file.error().to_string() << "\n" << toml;
  EXPECT_EQ(file->name, "my-knee");
  ASSERT_EQ(file->structures.size(), 4U);  // skin and three labels
  EXPECT_EQ(file->structures[1].name, "articular_cartilage");
  EXPECT_EQ(file->structures[1].partition, "labels");
  EXPECT_NEAR(file->partitions.at(0).film, 0.25e-3, 1e-6);
  // What the labels do not claim is the body's.
  double inside = 0;
  for (const auto& s : joint->structures) inside += signed_volume(s.mesh);
  EXPECT_GT(signed_volume(joint->body), 3 * inside);
}

TEST(ImportedJoint, WithoutALabelOfTheBodyAHullIsMadeAndSaidToBeAssumed) {
  const auto joint = import_labels(limb(false), {}, "knee.nii.gz");
  ASSERT_TRUE(joint) << joint.error().to_string();
  EXPECT_TRUE(joint->body_is_assumed);
  EXPECT_THAT(joint->assumed, Contains(HasSubstr("hull around all labels")));
  EXPECT_THAT(to_joint_toml(*joint), HasSubstr("# assumed: skin"));
}

TEST(ImportedJoint, HullOfABallStandsOffByTheFatAroundIt) {
  const LabelVolume ball =
      test::painted({80, 80, 80}, test::oblique_frame({1, 1, 1}), {"bone"},
                    [](const Vec3& p) -> std::uint16_t { return p.norm() < 20e-3; });
  VoxelMask mask{ball.size, std::vector<std::uint8_t>(ball.labels.begin(), ball.labels.end())};
  const VoxelMask hull = closed_hull(mask, Vec3::Constant(1e-3), 16e-3, 8e-3, 2e-3);
  const double n = static_cast<double>(std::count(hull.is_in.begin(), hull.is_in.end(), 1));
  EXPECT_NEAR(std::cbrt(n * 3 / 4 / 3.14159265), 28, 1.2);  // mm
}

TEST(ImportedJoint, DistancesAreThoseOfBruteForce) {
  VoxelMask mask{{9, 7, 5}, std::vector<std::uint8_t>(9 * 7 * 5, 0)};
  for (const std::size_t i : {3U, 100U, 222U, 300U}) mask.is_in[i] = 1;
  const Vec3 spacing(1, 2, 0.5);
  const auto got = distances_to(mask, true, spacing);
  const auto place = [](std::size_t i) {
    return Vec3(static_cast<double>(i % 9), static_cast<double>(i / 9 % 7),
                static_cast<double>(i / 63));
  };
  for (std::size_t i = 0; i < got.size(); ++i) {
    double least = 1e9;
    for (std::size_t k = 0; k < got.size(); ++k)
      if (mask.is_in[k] != 0)
        least = std::min(least, (place(i) - place(k)).cwiseProduct(spacing).norm());
    EXPECT_NEAR(got[i], least, 1e-5);
  }
}

TEST(ImportedJoint, ATubeOpenAtBothEndsIsFilledAndTheLargestPartKept) {
  LabelVolume tube = test::painted(
      {40, 40, 12}, test::oblique_frame({1, 1, 1}), {"skin"}, [](const Vec3& p) -> std::uint16_t {
        const double r = p.head<2>().norm();
        return (r > 12e-3 && r < 14e-3) || (p - Vec3(18e-3, 18e-3, 0)).norm() < 1.5e-3;
      });
  VoxelMask mask{tube.size, std::vector<std::uint8_t>(tube.labels.begin(), tube.labels.end())};
  keep_largest(mask);
  fill_enclosed(mask);
  const auto n = static_cast<double>(std::count(mask.is_in.begin(), mask.is_in.end(), 1));
  EXPECT_NEAR(n / 12, 3.14159265 * 14 * 14, 25);
}

TEST(ImportedJoint, LabelsThatFillTheVolumeAreRefused) {
  LabelVolume full =
      test::painted({10, 10, 10}, test::oblique_frame(), {"femur", "body"},
                    [](const Vec3& p) -> std::uint16_t { return p.x() > 0 ? 1 : 2; });
  const auto joint = import_labels(std::move(full), {}, "a.nii");
  ASSERT_FALSE(joint);
  EXPECT_THAT(joint.error().message, HasSubstr("cut on all sides"));
}

TEST(ImportedJoint, AnImageGivesTheSkin) {
  LabelVolume volume = limb(false);
  ImageVolume scan;
  scan.size = volume.size;
  scan.X_LI = volume.X_LI;
  scan.type = SampleType::i16;
  const LabelVolume body =
      test::painted(volume.size, volume.X_LI, {"body"},
                    [](const Vec3& p) -> std::uint16_t { return p.head<2>().norm() < 24e-3; });
  for (const auto label : body.labels) {
    const std::int16_t grey = label != 0 ? -100 : -1000;
    scan.samples.append(reinterpret_cast<const char*>(&grey), 2);
  }
  ImportOptions options;
  options.image = scan;
  const auto joint = import_labels(volume, options, "knee.nii");
  ASSERT_TRUE(joint) << joint.error().to_string();
  EXPECT_EQ(joint->body_by, "the image");
  EXPECT_NEAR(signed_volume(joint->body), 3.14159 * 24e-3 * 24e-3 * 60e-3, 2e-6);
  options.image->size[0] = 59;
  EXPECT_FALSE(import_labels(volume, options, "knee.nii"));
}

TEST(ImportedJoint, MasksOfOneGridAreOneVolumeNamedByTheirFiles) {
  const LabelVolume all = limb(false);
  std::vector<ImageVolume> masks;
  for (const int label : {1, 2, 1}) {
    ImageVolume mask;
    mask.size = all.size;
    mask.X_LI = all.X_LI;
    for (const auto l : all.labels) mask.samples += l == label ? '\1' : '\0';
    masks.push_back(std::move(mask));
  }
  const auto joined =
      join_masks(masks, {"d/femur_left.nii.gz", "d/tibia_left.nii.gz", "d/again.nii"});
  ASSERT_TRUE(joined) << joined.error().to_string();
  EXPECT_EQ(joined->segments[0].name, "femur_left");
  EXPECT_EQ(joined->segments[0].n_voxels, all.segments[0].n_voxels);
  EXPECT_EQ(joined->segments[2].n_lost, all.segments[0].n_voxels);
  masks[1].X_LI.translation().x() += 1e-3;
  EXPECT_THAT(join_masks(masks, {"a", "b", "c"}).error().message, HasSubstr("grid"));
}

TEST(ImportedJoint, OutlineLabelsAndLeftOutOnesBecomeTheRest) {
  LabelVolume volume = limb(true);
  SegmentRoles roles{{false, false, false, true, false},
                     std::vector<bool>(5, false),
                     {false, false, false, false, true}};
  const std::size_t n = volume.segments[3].n_voxels + volume.segments[4].n_voxels;
  const auto outline = outline_body(volume, roles, std::nullopt, "a");
  ASSERT_TRUE(outline);
  EXPECT_EQ(outline->rest, 6);
  EXPECT_EQ(volume.segments.back().n_voxels, n);
}

TEST(ImportedJoint, NamesAreOneOfTheirOwnEach) {
  ImportedJoint joint;
  joint.side.clear();
  for (const char* name : {"humerus_left", "humerus_right", "Body", "skin", "skin!", "???"}) {
    ImportedStructure s;
    s.source = name;
    s.value = 7;
    joint.structures.push_back(s);
  }
  name_structures(joint);
  std::vector<std::string> names;
  for (const auto& s : joint.structures) names.push_back(s.name);
  EXPECT_THAT(names, testing::ElementsAre("humerus_left", "humerus_right", "body_2", "skin_2",
                                          "skin_3", "label_7"));
  EXPECT_EQ(joint.side, "none");
  EXPECT_EQ(joint_name_of("a/KNEE dess.label.nrrd"), "knee-dess");
}

class ImportedFolder : public test::TemporaryFolder {};

TEST_F(ImportedFolder, AFolderWithAJointIsNotWrittenOverUnasked) {
  const auto joint = import_labels(limb(true), {}, "knee.nii");
  ASSERT_TRUE(joint);
  ASSERT_TRUE(write_imported_joint(*joint, folder_ / "knee", false));
  EXPECT_FALSE(write_imported_joint(*joint, folder_ / "knee", false));
  EXPECT_TRUE(write_imported_joint(*joint, folder_ / "knee", true));
  const auto read = read_joint(folder_ / "knee");
  EXPECT_TRUE(read) << (read ? "" : read.error().to_string());
}

TEST(SceneParts, PartsComeBackFromTheirBytes) {
  const std::vector<ScenePart> parts{{"a", {{Vec3(1, 2, 3)}, {}}, {}}};
  const auto back = unpack_parts(pack_parts(parts), "a");
  ASSERT_TRUE(back);
  EXPECT_EQ(back->front().mesh.vertices.front(), Vec3(1, 2, 3));
  const std::string bytes = pack_parts(parts);
  EXPECT_FALSE(unpack_parts(bytes.substr(0, bytes.size() - 1), "a"));
}

TEST(SceneParts, ALegacyVtkSurfaceIsReadAndTurned) {
  const std::string text =
      "# vtk DataFile Version 3.0\nsurface SPACE=RAS\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n"
      "0 0 0 10 0 0 10 20 0 0 20 5\nPOLYGONS 1 5\n4 0 1 2 3\n";
  const auto parts = read_scene_parts(text, "d/femur.vtk", 1e-3);
  ASSERT_TRUE(parts) << parts.error().to_string();
  EXPECT_EQ(parts->front().name, "femur");
  EXPECT_EQ(parts->front().mesh.triangles.size(), 2U);
  EXPECT_LT((parts->front().mesh.vertices[3] - Vec3(0, -0.020, 0.005)).norm(), 1e-12);
  for (std::size_t n = 0; n < text.size() - 2; n += 3)
    EXPECT_FALSE(read_scene_parts(text.substr(0, n), "femur.vtk", 1e-3));
}

TEST(SceneParts, VolumeMeshesAreNamedAsSuch) {
  const auto vtk =
      parse_vtk("# vtk DataFile Version 3.0\na\nASCII\nDATASET UNSTRUCTURED_GRID\n", "a.vtk", 1e-3);
  EXPECT_THAT(vtk.error().message, HasSubstr("volume mesh"));
  EXPECT_EQ(foreign_format("<?xml?><VTKFile type=\"UnstructuredGrid\">", "a.vtu"), "VTK XML");
  EXPECT_THAT(advice_for_format("$MeshFormat\n", "a.msh"), HasSubstr("volume mesh"));
  EXPECT_THAT(advice_for_format("NRRD0004\n", "a.nrrd"), HasSubstr("artus import"));
}

}  // namespace
}  // namespace artus
