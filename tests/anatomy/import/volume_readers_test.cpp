// SPDX-License-Identifier: AGPL-3.0-or-later
#include <random>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/import/label_volume.h"
#include "artus/detail/anatomy/import/volumes/image_volume.h"
#include "artus/detail/anatomy/import/volumes/inflate.h"
#include "artus/detail/anatomy/import/volumes/volume_text.h"
#include "tests/anatomy/import/label_samples.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

using testing::HasSubstr;

LabelVolume two_boxes() {
  return test::painted({12, 10, 8}, test::oblique_frame(), {"femur", "patella"},
                       [](const Vec3& p) -> std::uint16_t {
                         if (p.cwiseAbs().maxCoeff() > 1.5e-3) return 0;
                         return p.x() < 0 ? 1 : 2;
                       });
}

void expect_same(const LabelVolume& got, const LabelVolume& wanted) {
  EXPECT_EQ(got.size, wanted.size);
  EXPECT_EQ(got.labels, wanted.labels);
  ASSERT_EQ(got.segments.size(), wanted.segments.size());
  for (std::size_t i = 0; i < got.segments.size(); ++i) {
    EXPECT_EQ(got.segments[i].name, wanted.segments[i].name);
    EXPECT_EQ(got.segments[i].n_voxels, wanted.segments[i].n_voxels);
  }
  // Frames are rounded to what single precision keeps.
  EXPECT_LT((got.X_LI.matrix() - wanted.X_LI.matrix()).cwiseAbs().maxCoeff(), 1e-6);
}

StructureNames user_names() {
  StructureNames names;
  names.labels = {{1, "femur", "bone"}, {2, "patella", ""}};
  return names;
}

std::string refusal(const std::string& bytes, const std::string& name) {
  const auto labels = read_labels(bytes, name, {});
  if (labels) return "none";
  EXPECT_THAT(labels.error().where, HasSubstr(name));
  return labels.error().message;
}

TEST(VolumeReaders, EveryFormatGivesTheSameLabelsAndFrame) {
  const LabelVolume wanted = two_boxes();
  const std::vector<std::pair<std::string, std::string>> files{
      {"a.nii", test::nifti_of(wanted)},
      {"a.nii.gz", deflate_gzip(test::nifti_of(wanted))},
      {"a.seg.nrrd", test::nrrd_of(wanted)},
      {"b.mha", test::mha_of(wanted)}};
  for (const auto& [name, bytes] : files) {
    SCOPED_TRACE(name);
    const auto got = read_labels(bytes, name, user_names());
    ASSERT_TRUE(got) << got.error().to_string();
    expect_same(*got, wanted);
    const auto first = read_labels(files.front().second, "a.nii", {});
    EXPECT_EQ(got->X_LI.matrix(), first->X_LI.matrix());
  }
}

TEST(VolumeReaders, CompressedNrrdIsReadAndRasIsTurned) {
  const LabelVolume wanted = two_boxes();
  const std::string raw(reinterpret_cast<const char*>(wanted.labels.data()),
                        wanted.labels.size() * 2);
  const auto gz = read_labels(test::nrrd_of(wanted, true, deflate_gzip(raw), "gzip"), "a.nrrd", {});
  ASSERT_TRUE(gz) << gz.error().to_string();
  expect_same(*gz, wanted);
  LabelVolume turned = wanted;
  turned.X_LI.matrix().topRows<3>() =
      Vec3(-1, -1, 1).asDiagonal() * wanted.X_LI.matrix().topRows<3>();
  std::string ras = test::nrrd_of(turned);
  ras.replace(ras.find("left-posterior-superior"), 23, "right-anterior-superior");
  const auto got = read_labels(ras, "a.nrrd", {});
  ASSERT_TRUE(got) << got.error().to_string();
  expect_same(*got, wanted);
}

TEST(VolumeReaders, LayersOverlapAndTheFirstSegmentKeepsThat) {
  LabelVolume grid = two_boxes();
  std::string data;  // two layers beside each other: 1 and 1 at the first voxel, 0 and 1 after it
  for (std::size_t i = 0; i < grid.labels.size(); ++i) {
    data += i < 5 ? '\1' : '\0';
    data += i < 9 ? '\1' : '\0';
  }
  std::string text = test::nrrd_of(grid, true, data);
  const auto replace = [&text](const std::string& a, const std::string& b) {
    ASSERT_NE(text.find(a), std::string::npos) << a;
    text.replace(text.find(a), a.size(), b);
  };
  replace("unsigned short", "unsigned char");
  replace("dimension: 3", "dimension: 4");
  replace("sizes: ", "sizes: 2 ");
  replace("space directions: ", "space directions: none ");
  replace("kinds: ", "kinds: list ");
  replace("Segment1_Layer:=0\nSegment1_LabelValue:=2", "Segment1_Layer:=1\nSegment1_LabelValue:=1");
  const auto got = read_labels(text, "a.seg.nrrd", {});
  ASSERT_TRUE(got) << got.error().to_string();
  EXPECT_EQ(got->segments[0].n_voxels, 5U);
  EXPECT_EQ(got->segments[1].n_voxels, 4U);
  EXPECT_EQ(got->segments[1].n_lost, 5U);
  EXPECT_THAT(got->notes, testing::Contains(HasSubstr("'patella' overlaps")));
}

TEST(VolumeReaders, TerminologyOfSlicerGivesCodes) {
  std::string text = test::nrrd_of(two_boxes());
  const std::string key = "Segment0_LabelValue";
  text.insert(
      text.find(key),
      "Segment0_Tags:=Segmentation.Status:inprogress|TerminologyEntry:Segmentation category "
      "and type - 3D Slicer General Anatomy "
      "list~SCT^123037004^Anatomical Structure~SCT^272673000^Bone~^^~Anatomic "
      "codes~^^~^^|\n");
  const auto got = read_labels(text, "a.seg.nrrd", {});
  ASSERT_TRUE(got) << got.error().to_string();
  EXPECT_EQ(got->segments[0].code, "SCT 272673000");
}

TEST(VolumeReaders, UnnamedLabelsAreListedWithWhatToWrite) {
  const std::string told = refusal(test::nifti_of(two_boxes(), false), "a.nii");
  EXPECT_THAT(told, HasSubstr("does not name its labels: 1 ("));
  EXPECT_THAT(told, HasSubstr("--labels names.toml"));
}

TEST(VolumeReaders, HostileFilesAreRefusedWithWhatIsWrong) {
  const std::string sound = test::nifti_of(two_boxes());
  const auto changed = [&](auto change) {
    std::string bytes = sound;
    change(bytes);
    return refusal(bytes, "a.nii");
  };
  const std::string gz = deflate_gzip(sound);
  EXPECT_THAT(refusal(gz.substr(0, gz.size() - 20), "a.nii.gz"), HasSubstr("break off"));
  EXPECT_THAT(refusal(gz.substr(0, gz.size() - 2), "a.nii.gz"), HasSubstr("break off"));
  std::string damaged = gz;
  damaged[gz.size() / 2] = static_cast<char>(damaged[gz.size() / 2] ^ 0x55);
  EXPECT_NE(refusal(damaged, "a.nii.gz"), "none");
  EXPECT_THAT(changed([](auto& b) { b.resize(b.size() - 1); }), HasSubstr("promises"));
  EXPECT_THAT(changed([](auto& b) { test::put<std::int16_t>(b, 42, 30000); }),
              HasSubstr("promises"));
  EXPECT_THAT(changed([](auto& b) {
                for (std::size_t i = 0; i < 3; ++i) test::put<std::int16_t>(b, 42 + 2 * i, 30000);
              }),
              HasSubstr("more than any scan"));
  EXPECT_THAT(changed([](auto& b) { test::put<std::int16_t>(b, 42, 0); }), HasSubstr("0 or neg"));
  EXPECT_THAT(changed([](auto& b) { b.replace(280, 16, std::string(16, '\0')); }),
              HasSubstr("singular"));
  EXPECT_THAT(changed([](auto& b) { test::put<float>(b, 280, NAN); }), HasSubstr("not finite"));
  EXPECT_THAT(changed([](auto& b) { test::put<std::int16_t>(b, 252, 1); }),
              HasSubstr("contradict each other"));
  EXPECT_THAT(changed([](auto& b) { test::put<std::int16_t>(b, 254, 0); }),
              HasSubstr("where it lies"));
  EXPECT_THAT(changed([](auto& b) { test::put<std::int16_t>(b, 70, 128); }), HasSubstr("RGB"));
  EXPECT_THAT(changed([](auto& b) { test::put<std::int16_t>(b, 70, 32); }),
              HasSubstr("whole numbers"));
  EXPECT_THAT(changed([](auto& b) {
                test::put<std::int16_t>(b, 40, 4);
                test::put<std::int16_t>(b, 48, 12);
              }),
              HasSubstr("series of 12"));
  EXPECT_THAT(changed([](auto& b) { test::put<float>(b, 112, 0.5F); }), HasSubstr("whole numbers"));
  EXPECT_THAT(changed([](auto& b) { b[123] = 1; }), HasSubstr("not those of a body"));
  EXPECT_THAT(changed([](auto& b) { b.replace(344, 3, "ni1"); }), HasSubstr("second file"));
  EXPECT_THAT(changed([](auto& b) { test::put<float>(b, 108, 1e8F); }), HasSubstr("promises"));
  EXPECT_THAT(changed([](auto& b) { std::fill(b.end() - 1920, b.end(), '\0'); }),
              HasSubstr("empty"));
  EXPECT_THAT(refusal("$MeshFormat\n4.1 0 8\n", "a.msh"), HasSubstr("volume mesh"));
  EXPECT_THAT(refusal("hello", "a.txt"), HasSubstr("no NIfTI, NRRD or MetaImage"));
}

TEST(VolumeReaders, HeadersOfTextAreRefusedWithWhatIsWrong) {
  const auto nrrd = [](const std::string& a, const std::string& b) {
    std::string text = test::nrrd_of(two_boxes());
    text.replace(text.find(a), a.size(), b);
    return refusal(text, "a.nrrd");
  };
  EXPECT_THAT(nrrd("encoding: raw", "encoding: bzip2"), HasSubstr("bzip2"));
  EXPECT_THAT(nrrd("kinds:", "data file: a.raw\nkinds:"), HasSubstr("another file"));
  EXPECT_THAT(nrrd("space: left-posterior-superior\n", ""), HasSubstr("where it lies"));
  EXPECT_THAT(nrrd("dimension: 3", "dimension: 4"), HasSubstr("do not agree"));
  EXPECT_THAT(nrrd("sizes: 12", "sizes: 1200"), HasSubstr("promises"));
  EXPECT_THAT(nrrd("type: unsigned short", "type: block"), HasSubstr("no labels"));
  const auto mha = [](const std::string& a, const std::string& b) {
    std::string text = test::mha_of(two_boxes());
    text.replace(text.find(a), a.size(), b);
    return refusal(text, "a.mha");
  };
  EXPECT_THAT(mha("LOCAL", "a.raw"), HasSubstr("another file"));
  EXPECT_THAT(mha("NDims = 3", "NDims = 2"), HasSubstr("three axes"));
  EXPECT_THAT(mha("MET_USHORT", "MET_OTHER"), HasSubstr("no labels"));
}

TEST(VolumeReaders, NoCutOrGarbledFileIsTakenForMoreThanItIs) {
  const LabelVolume volume = two_boxes();
  const std::vector<std::pair<std::string, std::string>> files{
      {"a.nii", test::nifti_of(volume)},
      {"a.nii.gz", deflate_gzip(test::nifti_of(volume))},
      {"a.nrrd", test::nrrd_of(volume)},
      {"a.mha", test::mha_of(volume)}};
  std::mt19937 random(7);
  for (const auto& [name, bytes] : files) {
    for (std::size_t n = 0; n < bytes.size(); n += 1 + bytes.size() / 200)
      EXPECT_FALSE(read_labels(bytes.substr(0, n), name, user_names())) << name << " " << n;
    for (int k = 0; k < 2000; ++k) {
      std::string garbled = bytes;
      for (int flips = 0; flips < 4; ++flips)
        garbled[random() % std::min<std::size_t>(garbled.size(), 900)] =
            static_cast<char>(random());
      const auto got = read_labels(garbled, name, user_names());
      if (!got) continue;
      EXPECT_EQ(got->labels.size(), got->size[0] * got->size[1] * got->size[2]);
      for (const std::uint16_t label : got->labels) ASSERT_LE(label, got->segments.size());
    }
  }
}

TEST(VolumeReaders, SpacesLeadToLps) {
  EXPECT_EQ(*signs_of_space("right-anterior-superior"), Vec3(-1, -1, 1));
  EXPECT_EQ(*signs_of_space("LPS"), Vec3(1, 1, 1));
  EXPECT_EQ(*signs_of_space("left-anterior-superior-time"), Vec3(1, -1, 1));
  EXPECT_FALSE(signs_of_space("scanner-xyz"));
  EXPECT_FALSE(signs_of_space(""));
}

TEST(VolumeReaders, CompressingComesBackAndKeepsToItsLimit) {
  std::string text;
  for (int i = 0; i < 300000; ++i) text += static_cast<char>(i * i % 251);
  const std::string packed = deflate_gzip(text);
  EXPECT_EQ(*inflate_exactly(packed, text.size(), "a"), text);
  EXPECT_FALSE(inflate_exactly(packed, text.size() - 1, "a"));
  EXPECT_FALSE(inflate_exactly(packed, text.size() + 1, "a"));
  EXPECT_EQ(inflate(packed, 1000, "a")->bytes.size(), 1000U);
  EXPECT_EQ(*inflate_exactly(packed + packed, 2 * text.size(), "a"), text + text);
}

TEST(VolumeReaders, FilesOfACaseAreNamedOrRead) {
  const auto folder = test::source_dir() / "../shared/cases/06-volume-meshes-and-label-maps";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared cases here";
  for (const char* name : {"labels.nii.gz", "labels.nrrd"}) {
    const auto file = folder / name;
    std::string bytes;
    if (FILE* in = std::fopen(file.c_str(), "rb")) {
      std::array<char, 65536> buffer;
      for (std::size_t n = 1; n > 0;) {
        n = std::fread(buffer.data(), 1, buffer.size(), in);
        bytes.append(buffer.data(), n);
      }
      std::fclose(in);
    }
    const auto volume = parse_volume(bytes, name);
    EXPECT_TRUE(volume) << (volume ? "" : volume.error().to_string());
  }
}

}  // namespace
}  // namespace artus
