// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/dicom_file.h"

#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/core/text_file.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

class DicomFile : public test::TemporaryFolder {
 protected:
  static ImageSequence some_sequence() {
    ImageSequence sequence;
    sequence.width = 40;
    sequence.height = 30;
    for (int i = 0; i < 5; ++i) {
      SequenceFrame frame;
      for (int k = 0; k < 1200; ++k) frame.grey.push_back(static_cast<std::uint8_t>(7 * k + i));
      sequence.frames.push_back(frame);
    }
    return sequence;
  }
  const DicomSeries series_{"shoulder", "1.0", "right", 0.1e-3, "20260301", "101500"};
};

TEST_F(DicomFile, HasThePixelsTheScaleAndTheWord) {
  const ImageSequence sequence = some_sequence();
  const auto written = write_dicom(in("us.dcm"), sequence, series_);
  ASSERT_TRUE(written) << written.error().to_string();
  DcmFileFormat file;
  ASSERT_TRUE(file.loadFile(in("us.dcm").c_str()).good());
  DcmDataset& dataset = *file.getDataset();
  const Uint8* pixels = nullptr;
  unsigned long count = 0;
  ASSERT_TRUE(dataset.findAndGetUint8Array(DCM_PixelData, pixels, &count).good());
  ASSERT_EQ(count, 5U * 1200U);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_EQ(std::memcmp(pixels + 1200 * i, sequence.frames[i].grey.data(), 1200), 0) << i;
  OFString text;
  ASSERT_TRUE(dataset.findAndGetOFString(DCM_ImageComments, text).good());
  EXPECT_THAT(text.c_str(), testing::HasSubstr("simulated"));
  EXPECT_FALSE(dataset.tagExists(DCM_FrameTime)) << "the frames have no times";
  EXPECT_FALSE(dataset.tagExists(DCM_CineRate));
  ASSERT_TRUE(dataset.findAndGetOFStringArray(DCM_FrameLabelVector, text).good());
  EXPECT_STREQ(text.c_str(), "1\\2\\3\\4\\5");
  ASSERT_TRUE(dataset.findAndGetOFStringArray(DCM_PixelSpacing, text).good());
  EXPECT_STREQ(text.c_str(), "0.1\\0.1");  // mm
  ASSERT_TRUE(dataset.findAndGetOFString(DCM_StudyDate, text).good());
  EXPECT_STREQ(text.c_str(), "20260301");
  DcmItem* region = nullptr;
  ASSERT_TRUE(dataset.findAndGetSequenceItem(DCM_SequenceOfUltrasoundRegions, region).good());
  Float64 delta = 0;
  ASSERT_TRUE(region->findAndGetFloat64(DCM_PhysicalDeltaX, delta).good());
  EXPECT_DOUBLE_EQ(delta, 0.01);  // cm
}

/// The elements that say when frames were; "-" for one that is not there.
struct FrameTimes {
  std::string pointer;
  std::string each;
  std::string vector;
  std::string rate;
};

FrameTimes times_in(const std::filesystem::path& path) {
  DcmFileFormat file;
  EXPECT_TRUE(file.loadFile(path.c_str()).good());
  const auto text = [&](const DcmTagKey& tag) {
    OFString value;
    return file.getDataset()->findAndGetOFStringArray(tag, value).good()
               ? std::string(value.c_str())
               : std::string("-");
  };
  return {text(DCM_FrameIncrementPointer), text(DCM_FrameTime), text(DCM_FrameTimeVector),
          text(DCM_CineRate)};
}

TEST_F(DicomFile, FramesAtUnevenTimesHaveTheListOfThem) {
  ImageSequence sequence = some_sequence();
  const std::vector<double> times{2, 2.05, 2.1, 2.25, 2.4};
  for (std::size_t i = 0; i < 5; ++i) sequence.frames[i].time = times[i];
  ASSERT_TRUE(write_dicom(in("uneven.dcm"), sequence, series_));
  const FrameTimes uneven = times_in(in("uneven.dcm"));
  EXPECT_EQ(uneven.pointer, "(0018,1065)");
  EXPECT_EQ(uneven.vector, "0\\50\\50\\150\\150");
  EXPECT_EQ(uneven.each, "-");
  EXPECT_EQ(uneven.rate, "10");
  for (std::size_t i = 0; i < 5; ++i) sequence.frames[i].time = 0.02 * static_cast<double>(i);
  ASSERT_TRUE(write_dicom(in("even.dcm"), sequence, series_));
  const FrameTimes even = times_in(in("even.dcm"));
  EXPECT_EQ(even.pointer, "(0018,1063)");
  EXPECT_EQ(even.vector, "-");
  EXPECT_EQ(even.each, "20");
  EXPECT_EQ(even.rate, "50");
}

TEST_F(DicomFile, IsTheSameBytesAgain) {
  ASSERT_TRUE(write_dicom(in("a.dcm"), some_sequence(), series_));
  ASSERT_TRUE(write_dicom(in("b.dcm"), some_sequence(), series_));
  EXPECT_EQ(*read_bytes(in("a.dcm")), *read_bytes(in("b.dcm")));
}

/// A page with a red corner.
ReportPage some_page() {
  ReportPage page{30, 20, std::vector<std::uint8_t>(1800, 255)};
  page.colours[1] = page.colours[2] = 0;
  return page;
}

TEST_F(DicomFile, AReportIsOfTheSameStudyInItsColours) {
  ASSERT_TRUE(write_dicom(in("us.dcm"), some_sequence(), series_));
  const auto written = write_dicom_report(in("report.dcm"), some_page(), some_sequence(), series_);
  ASSERT_TRUE(written) << written.error().to_string();
  DcmFileFormat images;
  DcmFileFormat report;
  ASSERT_TRUE(images.loadFile(in("us.dcm").c_str()).good());
  ASSERT_TRUE(report.loadFile(in("report.dcm").c_str()).good());
  const auto text = [](DcmFileFormat& file, const DcmTagKey& tag) {
    OFString value;
    EXPECT_TRUE(file.getDataset()->findAndGetOFString(tag, value).good());
    return std::string(value.c_str());
  };
  EXPECT_EQ(text(report, DCM_SOPClassUID), UID_SecondaryCaptureImageStorage);
  for (const DcmTagKey& same : {DCM_StudyInstanceUID, DCM_PatientID, DCM_PatientName})
    EXPECT_EQ(text(report, same), text(images, same));
  for (const DcmTagKey& other : {DCM_SeriesInstanceUID, DCM_SOPInstanceUID, DCM_SeriesNumber})
    EXPECT_NE(text(report, other), text(images, other));
  EXPECT_THAT(text(report, DCM_SeriesDescription), testing::HasSubstr("simulated"));
  const Uint8* pixels = nullptr;
  unsigned long count = 0;
  ASSERT_TRUE(report.getDataset()->findAndGetUint8Array(DCM_PixelData, pixels, &count).good());
  ASSERT_EQ(count, 1800U);
  EXPECT_EQ(std::memcmp(pixels, some_page().colours.data(), 1800), 0);
}

TEST_F(DicomFile, TheValidatorOfOthersHasNoError) {
  if (test::run_process({"sh", "-c", "command -v dciodvfy"}).exit_code != 0)
    GTEST_SKIP() << "dciodvfy is not there (dicom3tools)";
  ASSERT_TRUE(write_dicom(in("us.dcm"), some_sequence(), series_));
  ImageSequence uneven = some_sequence();
  for (std::size_t i = 0; i < 5; ++i) uneven.frames[i].time = 0.01 * static_cast<double>(i * i);
  ASSERT_TRUE(write_dicom(in("uneven.dcm"), uneven, series_));
  ASSERT_TRUE(write_dicom_report(in("report.dcm"), some_page(), some_sequence(), series_));
  for (const auto& [file, kind] :
       {std::pair{"us.dcm", "USMultiFrameImage"}, std::pair{"uneven.dcm", "USMultiFrameImage"},
        std::pair{"report.dcm", "SCImage"}}) {
    const auto said = test::run_process({"dciodvfy", in(file)});
    const std::string all = said.out + said.err;
    EXPECT_THAT(all, testing::HasSubstr(kind));
    EXPECT_THAT(all, testing::Not(testing::HasSubstr("Error"))) << all;
  }
}

TEST_F(DicomFile, SaysWhereItCannotWrite) {
  const auto written = write_dicom(in("nowhere/us.dcm"), some_sequence(), series_);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::unreadable);
}

}  // namespace
}  // namespace artus
