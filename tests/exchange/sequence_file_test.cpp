// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/sequence_file.h"

#include <string>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/exchange/reference_frame.h"
#include "artus/detail/exchange/sequence_maker.h"

namespace artus {
namespace {

using testing::HasSubstr;

ImageSequence some_sequence() {
  ImageSequence sequence;
  sequence.width = 4;
  sequence.height = 3;
  for (int i = 0; i < 3; ++i) {
    SequenceFrame frame;
    frame.time = 0.04 * i;
    const Pose X_JP = make_pose(Vec3(0.01, 0.002 * i, 0), Vec3::UnitZ(), Vec3::UnitX());
    frame.probe_to_reference = ReferenceFrame().to_reference(X_JP);
    frame.image_to_reference =
        chained(frame.probe_to_reference, image_to_probe(Transducer(), 0.1e-3, 3));
    if (i != 1) frame.needle_to_reference = frame.probe_to_reference;
    for (int k = 0; k < 12; ++k) frame.grey.push_back(static_cast<std::uint8_t>(20 * k + i));
    sequence.frames.push_back(frame);
  }
  return sequence;
}

TEST(SequenceFile, ComesBackAsItWasWritten) {
  const ImageSequence sent = some_sequence();
  const auto got = parse_mha(to_mha(sent), "x.igs.mha");
  ASSERT_TRUE(got) << got.error().to_string();
  ASSERT_EQ(got->frames.size(), 3U);
  EXPECT_EQ(got->width, 4);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(got->frames[i].grey, sent.frames[i].grey);
    EXPECT_EQ(got->frames[i].time, sent.frames[i].time);
    EXPECT_EQ(got->frames[i].image_to_reference, sent.frames[i].image_to_reference);
    EXPECT_EQ(got->frames[i].needle_to_reference.has_value(), i != 1);
  }
}

TEST(SequenceFile, HasTheFieldsThatOthersLookFor) {
  const std::string text = to_mha(some_sequence());
  for (const char* field :
       {"ObjectType = Image\n", "DimSize = 4 3 3\n", "UltrasoundImageOrientation = MFA\n",
        "Seq_Frame0001_NeedleToReferenceTransformStatus = INVALID\n",
        "Seq_Frame0002_ImageToReferenceTransformStatus = OK\n", "Seq_Frame0002_Timestamp = 0.08\n",
        "Seq_Frame0000_ProbeToReferenceTransform = -1 0 0 -10 0 -1 0 0 0 0 1 0 0 0 0 1\n"})
    EXPECT_THAT(text, HasSubstr(field));
  EXPECT_EQ(text.substr(text.find("ElementDataFile")).size(), 24U + 36U);
}

TEST(SequenceFile, IsTheSameCompressedAndSmaller) {
  ImageSequence sent = some_sequence();
  for (SequenceFrame& frame : sent.frames) frame.grey.assign(12, 9);
  const std::string packed = to_mha(sent, PixelCoding::zlib);
  const auto got = parse_mha(packed, "x.igs.mha");
  ASSERT_TRUE(got) << got.error().to_string();
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(got->frames[i].grey, sent.frames[i].grey);
  EXPECT_THAT(packed, HasSubstr("CompressedData = True\nCompressedDataSize = "));
  std::string cut = packed;
  cut.resize(cut.size() - 3);
  EXPECT_THAT(parse_mha(cut, "x").error().message, HasSubstr("damaged"));
}

TEST(SequenceFile, SaysWhatItCannotRead) {
  const std::string good = to_mha(some_sequence());
  const auto refusal = [&](const std::string& from, const std::string& to) {
    std::string bad = good;
    bad.replace(bad.find(from), from.size(), to);
    const auto got = parse_mha(bad, "x.igs.mha");
    return got ? std::string("taken") : got.error().to_string();
  };
  EXPECT_THAT(refusal("MET_UCHAR", "MET_SHORT"), HasSubstr("8-bit"));
  EXPECT_THAT(refusal("CompressedData = False", "CompressedData = True"), HasSubstr("damaged"));
  EXPECT_THAT(refusal("= LOCAL", "= x.raw"), HasSubstr("same file"));
  EXPECT_THAT(refusal("4 3 3", "4 3 4"), HasSubstr("fewer pixels"));
  EXPECT_THAT(refusal("4 3 3", "4 3"), HasSubstr("DimSize"));
  EXPECT_THAT(refusal("4 3 3", "4 -3 3"), HasSubstr("DimSize"));
  EXPECT_THAT(refusal("4 3 3", "1e9 1e9 9"), HasSubstr("DimSize"));
  EXPECT_THAT(refusal("-1 0 0 -10", "x"), HasSubstr("16 numbers"));
  EXPECT_THAT(refusal("NDims = 3", "NDims"), HasSubstr("x.igs.mha:2"));
  std::string two = good;
  two.replace(two.find("MET_UCHAR"), 9, "MET_SHORT");
  two.replace(two.find("= LOCAL"), 7, "= x.raw");
  EXPECT_THAT(parse_mha(two, "x").error().message,
              testing::AllOf(HasSubstr("8-bit"), HasSubstr("same file")));
  EXPECT_FALSE(parse_mha("", "empty"));
  EXPECT_FALSE(parse_mha(good.substr(0, 100), "cut"));
}

TEST(SequenceMaker, TakesPicturesOfOneSizeAlone) {
  const std::vector<std::uint8_t> grey(12, 7);
  PlacedPicture picture;
  picture.pixel = 0.1e-3;
  picture.width = 4;
  picture.height = 3;
  picture.grey = grey;
  picture.X_JP = make_pose(Vec3(0.01, 0, 0), Vec3::UnitZ(), Vec3::UnitX());
  SequenceMaker maker;
  ASSERT_TRUE(maker.add(picture, Transducer()));
  EXPECT_EQ(maker.sequence().frames[0].grey, grey);
  EXPECT_EQ(maker.sequence().frames[0].image_to_reference,
            chained(ReferenceFrame().to_reference(picture.X_JP),
                    image_to_probe(Transducer(), 0.1e-3, 3)));
  picture.width = 3;
  picture.height = 4;
  const auto other = maker.add(picture, Transducer());
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().message, HasSubstr("frame 1 has another size"));
}

}  // namespace
}  // namespace artus
