// SPDX-License-Identifier: AGPL-3.0-or-later
// Files that libraries of others read: DICOM segmentations and scenes, written here byte by byte.
#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/import/dicom_seg.h"
#include "artus/detail/anatomy/import/import_files.h"
#include "artus/detail/anatomy/import/scene_parts.h"
#include "artus/detail/anatomy/import/scene_reader.h"
#include "tests/anatomy/import/label_samples.h"
#include "tests/anatomy/surfaces/surface_samples.h"

namespace artus {
namespace {

using testing::HasSubstr;

std::string little(std::uint32_t value, std::size_t n) {
  std::string bytes;
  for (std::size_t i = 0; i < n; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xffU);
  return bytes;
}

/// An element of explicit VR, little endian.
std::string element(std::uint32_t group, std::uint32_t tag, const std::string& vr,
                    std::string value) {
  if (value.size() % 2 != 0) value += vr == "UI" || vr == "OB" ? '\0' : ' ';
  const auto n = static_cast<std::uint32_t>(value.size());
  const bool is_long = vr == "OB" || vr == "SQ" || vr == "OW";
  return little(group, 2) + little(tag, 2) + vr +
         (is_long ? little(0, 2) + little(n, 4) : little(n, 2)) + value;
}

std::string item(const std::string& content) {
  return little(0xfffe, 2) + little(0xe000, 2) +
         little(static_cast<std::uint32_t>(content.size()), 4) + content;
}

/// 8 x 6 pixels of 1 x 2 mm, slices 3 mm apart; frames of two segments at heights 0, 9 and 12 mm.
std::string dicom_seg(bool fractional = false) {
  struct Place {
    int segment;
    const char* position;
  };
  const std::array<Place, 4> places{
      {{1, "5\\6\\0"}, {1, "5\\6\\9"}, {2, "5\\6\\9"}, {2, "5\\6\\12"}}};
  std::string segments, frames, pixels;
  for (int s = 1; s <= 2; ++s)
    segments += item(element(0x62, 0x4, "US", little(static_cast<std::uint32_t>(s), 2)) +
                     element(0x62, 0x5, "LO", s == 1 ? "Femur" : "Thing") +
                     element(0x62, 0xf, "SQ",
                             item(element(0x8, 0x100, "SH", s == 1 ? "71341001" : "272673000") +
                                  element(0x8, 0x102, "SH", "SCT"))));
  for (const Place& p : places) {
    frames += item(
        element(0x20, 0x9113, "SQ", item(element(0x20, 0x32, "DS", p.position))) +
        element(0x62, 0xa, "SQ",
                item(element(0x62, 0xb, "US", little(static_cast<std::uint32_t>(p.segment), 2)))));
    // The first two rows of each frame; a fractional one has 200 of 255 in the first, 100 after.
    if (fractional)
      pixels += std::string(8, '\xc8') + std::string(8, 'd') + std::string(32, '\0');
    else
      pixels += std::string(2, '\xff') + std::string(4, '\0');
  }
  const std::string meta_body = element(0x2, 0x2, "UI", "1.2.840.10008.5.1.4.1.1.66.4") +
                                element(0x2, 0x3, "UI", "1.2.3") +
                                element(0x2, 0x10, "UI", "1.2.840.10008.1.2.1");
  return std::string(128, '\0') + "DICM" +
         element(0x2, 0x0, "UL", little(static_cast<std::uint32_t>(meta_body.size()), 4)) +
         meta_body + element(0x8, 0x16, "UI", "1.2.840.10008.5.1.4.1.1.66.4") +
         element(0x8, 0x60, "CS", "SEG") + element(0x28, 0x8, "IS", "4") +
         element(0x28, 0x10, "US", little(6, 2)) + element(0x28, 0x11, "US", little(8, 2)) +
         element(0x28, 0x100, "US", little(fractional ? 8 : 1, 2)) +
         element(0x62, 0x2, "SQ", segments) + element(0x62, 0xe, "US", little(255, 2)) +
         element(
             0x5200, 0x9229, "SQ",
             item(element(0x20, 0x9116, "SQ", item(element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0"))) +
                  element(0x28, 0x9110, "SQ", item(element(0x28, 0x30, "DS", "2\\1"))))) +
         element(0x5200, 0x9230, "SQ", frames) + element(0x7fe0, 0x10, "OB", pixels);
}

TEST(DicomSeg, FramesStandWhereTheirPositionsSay) {
  if (!reads_dicom()) GTEST_SKIP() << "built without DCMTK";
  const auto got = parse_dicom_seg(dicom_seg(), "a.dcm", {});
  ASSERT_TRUE(got) << got.error().to_string();
  EXPECT_EQ(got->size, (std::array<std::size_t, 3>{8, 6, 5}));
  EXPECT_EQ(got->segments[0].n_voxels, 32U);
  EXPECT_EQ(got->segments[1].n_voxels, 16U);
  EXPECT_EQ(got->segments[1].n_lost, 16U);  // where both are at 9 mm
  EXPECT_EQ(got->segments[1].code, "SCT 272673000");
  EXPECT_EQ(got->labels[3 * 48], 1);
  EXPECT_EQ(got->labels[4 * 48], 2);
  EXPECT_EQ(got->labels[1 * 48], 0);  // no frame is there
  EXPECT_LT((got->X_LI * Vec3(1, 1, 4) - Vec3(6e-3, 8e-3, 12e-3)).norm(), 1e-12);
}

TEST(DicomSeg, AFractionalOneIsCutAtItsThreshold) {
  if (!reads_dicom()) GTEST_SKIP() << "built without DCMTK";
  EXPECT_EQ(parse_dicom_seg(dicom_seg(true), "a.dcm", {}, 0.5)->segments[0].n_voxels, 16U);
  EXPECT_EQ(parse_dicom_seg(dicom_seg(true), "a.dcm", {}, 0.2)->segments[0].n_voxels, 32U);
}

TEST(DicomSeg, CutFilesAreRefused) {
  if (!reads_dicom()) GTEST_SKIP() << "built without DCMTK";
  const std::string bytes = dicom_seg();
  for (std::size_t n = 0; n < bytes.size(); n += 7)
    EXPECT_FALSE(parse_dicom_seg(bytes.substr(0, n), "a.dcm", {})) << n;
  std::string scan = bytes;
  for (auto at = scan.find("1.66.4"); at != std::string::npos; at = scan.find("1.66.4"))
    scan.replace(at, 6, "1.2.00");
  EXPECT_THAT(parse_dicom_seg(scan, "a.dcm", {}).error().message, HasSubstr("no segmentation"));
}

/// A GLB of one cube of 20 mm, in a node turned by 90 degrees about x and 0.1 m along y.
std::string glb_of_cube() {
  const SurfaceMesh cube = make_cube(Vec3::Zero(), 0.01);
  std::string binary;
  for (const Triangle& t : cube.triangles)
    for (const auto v : t) binary += little(v, 4);
  const std::size_t indices = binary.size();
  for (const Vec3& p : cube.vertices)
    for (int k = 0; k < 3; ++k) {
      const auto x = static_cast<float>(p[k]);
      std::uint32_t bits = 0;
      std::memcpy(&bits, &x, 4);
      binary += little(bits, 4);
    }
  std::string json =
      "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
      "\"nodes\":[{\"name\":\"Humerus.r\",\"mesh\":0,\"translation\":[0.05,0.1,0],"
      "\"rotation\":[0.70710678,0,0,0.70710678]}],"
      "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":1},\"indices\":0}]}],"
      "\"buffers\":[{\"byteLength\":" +
      std::to_string(binary.size()) +
      "}],\"bufferViews\":["
      "{\"buffer\":0,\"byteLength\":" +
      std::to_string(indices) +
      "},"
      "{\"buffer\":0,\"byteOffset\":" +
      std::to_string(indices) +
      ",\"byteLength\":96}],"
      "\"accessors\":[{\"bufferView\":0,\"componentType\":5125,\"count\":36,\"type\":\"SCALAR\"},"
      "{\"bufferView\":1,\"componentType\":5126,\"count\":8,\"type\":\"VEC3\","
      "\"min\":[-0.01,-0.01,-0.01],\"max\":[0.01,0.01,0.01]}]}";
  while (json.size() % 4 != 0) json += ' ';
  const auto n = static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + binary.size());
  return "glTF" + little(2, 4) + little(n, 4) + little(static_cast<std::uint32_t>(json.size()), 4) +
         "JSON" + json + little(static_cast<std::uint32_t>(binary.size()), 4) + "BIN" +
         std::string(1, '\0') + binary;
}

TEST(Scenes, ANodeOfAGlbLandsInLpsWithItsTransform) {
  if (!reads_scenes()) GTEST_SKIP() << "built without libassimp";
  const auto parts = read_scene(glb_of_cube(), "a.glb", 1e-3);
  ASSERT_TRUE(parts) << parts.error().to_string();
  ASSERT_EQ(parts->size(), 1U);
  EXPECT_EQ(parts->front().name, "Humerus.r");
  EXPECT_NEAR(signed_volume(parts->front().mesh), 8e-6, 1e-10);
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : parts->front().mesh.vertices) middle += p;
  middle /= static_cast<double>(parts->front().mesh.vertices.size());
  EXPECT_LT((middle - Vec3(0.05, 0, 0.1)).norm(), 1e-5);  // (x, -z, y)
}

TEST(Scenes, CutAndGarbledScenesEndInARefusal) {
  if (!reads_scenes()) GTEST_SKIP() << "built without libassimp";
  const std::string bytes = glb_of_cube();
  for (std::size_t n = 5; n < bytes.size(); n += 1 + bytes.size() / 12)
    EXPECT_FALSE(read_scene(bytes.substr(0, n), "a.glb", 1e-3)) << n;
}

TEST(Scenes, PartsBecomeAJointWithASkinThatIsAssumed) {
  std::vector<ScenePart> parts{{"Humerus.r", make_cube(Vec3::Zero(), 0.01), {}},
                               {"Scapula.r", make_cube(Vec3(0.03, 0, 0), 0.012), {}},
                               {"Mark", make_cube(Vec3(0, 0.02, 0), 0.001), {}}};
  SurfaceMesh sheet = make_cube(Vec3(0, 0, 0.03), 0.01);
  sheet.triangles.resize(4);
  parts.push_back({"Coracoacromial ligament.r", sheet, {}});
  const auto joint = import_parts(std::move(parts), {}, "atlas.glb", {});
  ASSERT_TRUE(joint) << joint.error().to_string();
  EXPECT_EQ(joint->side, "right");
  EXPECT_EQ(joint->structures.size(), 2U);
  EXPECT_EQ(joint->left_out.size(), 2U);
  EXPECT_TRUE(joint->body_is_assumed);
  EXPECT_GT(signed_volume(joint->body), 8e-6 + 13.8e-6);
}

}  // namespace
}  // namespace artus
