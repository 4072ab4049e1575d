// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/dicom_file.h"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <vector>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include "artus/detail/core/byte_stream.h"
#include "artus/detail/core/check.h"
#include "artus/detail/core/printed.h"

namespace artus {
namespace {

/// Puts elements into a data set and keeps the first refusal.
class ElementWriter {
 public:
  explicit ElementWriter(DcmItem& item) : item_(item) {}
  void text(const DcmTagKey& tag, const std::string& value) {
    note(item_.putAndInsertString(tag, value.c_str()));
  }
  void number(const DcmTagKey& tag, Uint16 value) { note(item_.putAndInsertUint16(tag, value)); }
  void long_number(const DcmTagKey& tag, Uint32 value) {
    note(item_.putAndInsertUint32(tag, value));
  }
  void real(const DcmTagKey& tag, double value) { note(item_.putAndInsertFloat64(tag, value)); }
  void note(const OFCondition& done) {
    if (condition_.good()) condition_ = done;
  }
  [[nodiscard]] const OFCondition& condition() const noexcept { return condition_; }

 private:
  DcmItem& item_;
  OFCondition condition_ = EC_Normal;
};

/// An identifier out of a number, in the branch that needs no registration.
std::string identifier(std::uint64_t number) {
  return "2.25." + std::to_string(number);
}

std::string decimal(double value) {
  return printed("%.6g", value);
}

/// What one object of a study is; `digest` is the study's.
struct ObjectKind {
  const char* sop_class;
  const char* image_type;
  const char* modality;
  const char* description;
  std::uint64_t digest;
  int series_number;
};

void put_people_and_series(ElementWriter& out, const DicomSeries& series, const ObjectKind& kind) {
  const std::string made_by = "artus " + series.engine;
  const std::uint64_t number = 4 * static_cast<std::uint64_t>(kind.series_number - 1);
  out.text(DCM_SpecificCharacterSet, "ISO_IR 192");
  out.text(DCM_ImageType, kind.image_type);
  out.text(DCM_SOPClassUID, kind.sop_class);
  out.text(DCM_SOPInstanceUID, identifier(kind.digest ^ number));
  out.text(DCM_StudyInstanceUID, identifier(kind.digest ^ 1U));
  out.text(DCM_SeriesInstanceUID, identifier(kind.digest ^ 2U ^ number));
  for (const DcmTagKey& empty : {DCM_AccessionNumber, DCM_ReferringPhysicianName,
                                 DCM_PatientBirthDate, DCM_PatientSex, DCM_PatientOrientation})
    out.text(empty, "");
  for (const DcmTagKey& date : {DCM_StudyDate, DCM_ContentDate}) out.text(date, series.date);
  for (const DcmTagKey& time : {DCM_StudyTime, DCM_ContentTime}) out.text(time, series.time);
  out.text(DCM_Modality, kind.modality);
  out.text(DCM_Manufacturer, "artus");
  out.text(DCM_ManufacturerModelName, "simulated ultrasound");
  out.text(DCM_SoftwareVersions, made_by);
  out.text(DCM_SeriesDescription, kind.description);
  out.text(DCM_Laterality, series.side == "left" ? "L" : series.side == "right" ? "R" : "");
  out.text(DCM_PatientName, "Simulated^Joint");
  out.text(DCM_PatientID, "SIMULATED");
  out.text(DCM_StudyID, "1");
  out.text(DCM_SeriesNumber, std::to_string(kind.series_number));
  out.text(DCM_InstanceNumber, "1");
  out.text(DCM_DerivationDescription, "simulated by " + made_by + ", not of a patient");
  out.text(DCM_ImageComments, std::string(kind.description) + " of the joint " + series.joint);
}

std::uint64_t study_of(const ImageSequence& sequence, const DicomSeries& series) {
  return hash_bytes(to_mha(sequence), hash_bytes(series.joint));
}

void put_raster(ElementWriter& out, int width, int height, int samples) {
  out.number(DCM_SamplesPerPixel, static_cast<Uint16>(samples));
  out.text(DCM_PhotometricInterpretation, samples == 1 ? "MONOCHROME2" : "RGB");
  if (samples > 1) out.number(DCM_PlanarConfiguration, 0);
  out.number(DCM_Rows, static_cast<Uint16>(height));
  out.number(DCM_Columns, static_cast<Uint16>(width));
  out.number(DCM_BitsAllocated, 8);
  out.number(DCM_BitsStored, 8);
  out.number(DCM_HighBit, 7);
  out.number(DCM_PixelRepresentation, 0);
}

/// Frames that have no times: their numbers.
void put_labels(ElementWriter& out, DcmItem& dataset, std::size_t n_frames) {
  std::string labels = "1";
  for (std::size_t i = 2; i <= n_frames; ++i) labels += "\\" + std::to_string(i);
  out.note(dataset.putAndInsertTagKey(DCM_FrameIncrementPointer, DCM_FrameLabelVector));
  out.text(DCM_FrameLabelVector, labels);
}

/// When the frames were: one time apart, or the list of them where they differ.
void put_times(ElementWriter& out, DcmItem& dataset, const ImageSequence& sequence) {
  const std::vector<SequenceFrame>& frames = sequence.frames;
  const double whole = frames.back().time - frames.front().time;
  if (!(whole > 0)) return put_labels(out, dataset, frames.size());
  const double frame_time = whole / static_cast<double>(frames.size() - 1);
  bool even = true;
  std::string vector = "0";
  for (std::size_t i = 1; i < frames.size(); ++i) {
    constexpr double kNoticed = 0.5e-6;  // s, below the six digits that are written
    const double apart = frames[i].time - frames[i - 1].time;
    even = even && std::abs(apart - frame_time) < kNoticed;
    vector += "\\" + decimal(1e3 * apart);
  }
  out.note(dataset.putAndInsertTagKey(DCM_FrameIncrementPointer,
                                      even ? DCM_FrameTime : DCM_FrameTimeVector));
  if (even)
    out.text(DCM_FrameTime, decimal(1e3 * frame_time));
  else
    out.text(DCM_FrameTimeVector, vector);
  out.text(DCM_CineRate, std::to_string(std::max(1L, std::lround(1 / frame_time))));
}

void put_pixels(ElementWriter& out, DcmItem& dataset, const ImageSequence& sequence, double pixel) {
  put_raster(out, sequence.width, sequence.height, 1);
  out.text(DCM_BurnedInAnnotation, "NO");
  out.text(DCM_LossyImageCompression, "00");
  out.text(DCM_NumberOfFrames, std::to_string(sequence.frames.size()));
  const std::string spacing = decimal(1e3 * pixel);
  out.text(DCM_PixelSpacing, spacing + "\\" + spacing);
  put_times(out, dataset, sequence);
  std::vector<Uint8> pixels;
  for (const SequenceFrame& frame : sequence.frames)
    pixels.insert(pixels.end(), frame.grey.begin(), frame.grey.end());
  out.note(dataset.putAndInsertUint8Array(DCM_PixelData, pixels.data(), pixels.size()));
}

/// The whole picture is one region of tissue, in centimetres.
void put_region(ElementWriter& out, DcmItem& dataset, const ImageSequence& sequence, double pixel) {
  DcmItem* item = nullptr;
  constexpr long kAppend = -2;
  out.note(dataset.findOrCreateSequenceItem(DCM_SequenceOfUltrasoundRegions, item, kAppend));
  if (item == nullptr) return;
  ElementWriter region(*item);
  constexpr Uint16 kTissue = 1;
  constexpr Uint16 kTwoDimensional = 1;
  constexpr Uint16 kCentimetre = 3;
  region.number(DCM_RegionSpatialFormat, kTwoDimensional);
  region.number(DCM_RegionDataType, kTissue);
  region.long_number(DCM_RegionFlags, 0);
  region.long_number(DCM_RegionLocationMinX0, 0);
  region.long_number(DCM_RegionLocationMinY0, 0);
  region.long_number(DCM_RegionLocationMaxX1, static_cast<Uint32>(sequence.width - 1));
  region.long_number(DCM_RegionLocationMaxY1, static_cast<Uint32>(sequence.height - 1));
  region.number(DCM_PhysicalUnitsXDirection, kCentimetre);
  region.number(DCM_PhysicalUnitsYDirection, kCentimetre);
  region.real(DCM_PhysicalDeltaX, 100 * pixel);
  region.real(DCM_PhysicalDeltaY, 100 * pixel);
  out.note(region.condition());
}

Result<void> save(DcmFileFormat& out, const OFCondition& filled,
                  const std::filesystem::path& file) {
  if (filled.bad()) return fail(ErrorCode::failed, filled.text(), file.string());
  const std::filesystem::path part = file.parent_path() / ("part-" + file.filename().string());
  const OFCondition saved =
      out.saveFile(part.c_str(), EXS_LittleEndianExplicit, EET_ExplicitLength);
  if (saved.bad()) return fail(ErrorCode::unreadable, saved.text(), file.string());
  std::error_code error;
  std::filesystem::rename(part, file, error);
  if (error) return fail(ErrorCode::unreadable, error.message(), file.string());
  return {};
}

}  // namespace

Result<void> write_dicom(const std::filesystem::path& file, const ImageSequence& sequence,
                         const DicomSeries& series) {
  ARTUS_REQUIRE(!sequence.frames.empty(), "the sequence must have frames");
  ARTUS_REQUIRE(series.pixel > 0, "the pixel's size must be above 0");
  DcmFileFormat out;
  DcmDataset& dataset = *out.getDataset();
  ElementWriter writer(dataset);
  put_people_and_series(
      writer, series,
      {UID_UltrasoundMultiframeImageStorage, "DERIVED\\PRIMARY\\MUSCULOSKELETAL\\0001", "US",
       "simulated ultrasound", study_of(sequence, series), 1});
  put_pixels(writer, dataset, sequence, series.pixel);
  put_region(writer, dataset, sequence, series.pixel);
  return save(out, writer.condition(), file);
}

Result<void> write_dicom_report(const std::filesystem::path& file, const ReportPage& page,
                                const ImageSequence& sequence, const DicomSeries& series) {
  ARTUS_REQUIRE(page.colours.size() == static_cast<std::size_t>(3 * page.width * page.height),
                "the page must have three bytes for each pixel");
  DcmFileFormat out;
  DcmDataset& dataset = *out.getDataset();
  ElementWriter writer(dataset);
  put_people_and_series(writer, series,
                        {UID_SecondaryCaptureImageStorage, "DERIVED\\SECONDARY", "OT",
                         "report of a simulated session", study_of(sequence, series), 2});
  writer.text(DCM_ConversionType, "WSD");
  writer.text(DCM_BurnedInAnnotation, "YES");
  writer.text(DCM_LossyImageCompression, "00");
  put_raster(writer, page.width, page.height, 3);
  writer.note(
      dataset.putAndInsertUint8Array(DCM_PixelData, page.colours.data(), page.colours.size()));
  return save(out, writer.condition(), file);
}

}  // namespace artus
