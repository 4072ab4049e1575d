// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/label_maps/dicom_seg_writer.h"

#ifdef ARTUS_HAS_DICOM
#include <array>
#include <vector>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcostrmb.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmdata/dcwcache.h>

#include "artus/detail/core/byte_stream.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"
#endif

namespace artus {

#ifndef ARTUS_HAS_DICOM

Result<std::string> to_dicom_seg(const JointLabels&, const std::string&) {
  return fail(ErrorCode::unsupported,
              "this build of artus writes no DICOM (libdcmtk-dev was not there); take .nii.gz or "
              ".seg.nrrd");
}

#else

namespace {

constexpr long kAppend = -2;
constexpr long kFirst = 0;

/// Puts elements into an item and keeps the first refusal.
class SegElements {
 public:
  SegElements(DcmItem& item, OFCondition& condition) : item_(item), condition_(condition) {}
  void text(const DcmTagKey& tag, const std::string& value) {
    note(item_.putAndInsertString(tag, value.c_str()));
  }
  void number(const DcmTagKey& tag, std::size_t value) {
    note(item_.putAndInsertUint16(tag, static_cast<Uint16>(value)));
  }
  /// An item of a sequence within: the first, or a new one at its end.
  SegElements item(const DcmTagKey& sequence, long which = kFirst) {
    DcmItem* found = nullptr;
    note(item_.findOrCreateSequenceItem(sequence, found, which));
    return {found != nullptr ? *found : item_, condition_};
  }
  void code(const DcmTagKey& sequence, const std::string& scheme, const std::string& value,
            const std::string& meaning) {
    SegElements coded = item(sequence);
    coded.text(DCM_CodeValue, value);
    coded.text(DCM_CodingSchemeDesignator, scheme);
    coded.text(DCM_CodeMeaning, meaning);
  }
  void note(const OFCondition& done) {
    if (condition_.good()) condition_ = done;
  }
  DcmItem& operator*() { return item_; }

 private:
  DcmItem& item_;
  OFCondition& condition_;
};

/// A slice of a segment.
struct SegSlice {
  std::size_t segment = 0;
  std::size_t z = 0;
};

std::string identifier(std::uint64_t number) {
  return "2.25." + std::to_string(number);
}

/// Numbers as DICOM's decimal strings: at most 16 characters each.
std::string decimals(std::initializer_list<double> values) {
  std::string out;
  for (const double v : values) {
    constexpr std::size_t kLongest = 16;
    out += (out.empty() ? "" : "\\") + printed("%.12f", v).substr(0, kLongest);
  }
  return out;
}

class SegWriter {
 public:
  SegWriter(const JointLabels& labels, std::string comment)
      : labels_(labels),
        volume_(labels.volume),
        comment_(std::move(comment)),
        out_(*file_.getDataset(), condition_),
        digest_(hash_bytes({reinterpret_cast<const char*>(volume_.labels.data()),
                            volume_.labels.size() * sizeof(std::uint16_t)})) {
    find_slices();
  }

  Result<std::string> run() {
    put_object();
    put_raster();
    put_segments();
    put_shared();
    put_frames();
    put_pixels();
    if (condition_.bad())
      return fail(ErrorCode::unsupported,
                  std::string("DICOM cannot hold it: ") + condition_.text());
    return to_bytes();
  }

 private:
  void find_slices() {
    const std::size_t plane = volume_.size[0] * volume_.size[1];
    const std::size_t n = volume_.segments.size();
    std::vector<bool> is_there(n * volume_.size[2], false);
    for (std::size_t i = 0; i < volume_.labels.size(); ++i)
      if (volume_.labels[i] != 0)
        is_there[(volume_.labels[i] - 1U) * volume_.size[2] + i / plane] = true;
    for (std::size_t s = 0; s < n; ++s)
      for (std::size_t z = 0; z < volume_.size[2]; ++z)
        if (s + 1 == n || is_there[s * volume_.size[2] + z]) slices_.push_back({s, z});
  }

  void put_object() {
    out_.text(DCM_SpecificCharacterSet, "ISO_IR 192");
    out_.text(DCM_ImageType, "DERIVED\\PRIMARY");
    out_.text(DCM_SOPClassUID, UID_SegmentationStorage);
    out_.text(DCM_SOPInstanceUID, identifier(digest_));
    out_.text(DCM_StudyInstanceUID, identifier(digest_ ^ 1U));
    out_.text(DCM_SeriesInstanceUID, identifier(digest_ ^ 2U));
    out_.text(DCM_FrameOfReferenceUID, identifier(digest_ ^ 3U));
    for (const DcmTagKey& empty : {DCM_StudyDate, DCM_StudyTime, DCM_AccessionNumber,
                                   DCM_ReferringPhysicianName, DCM_PatientBirthDate, DCM_PatientSex,
                                   DCM_PositionReferenceIndicator, DCM_ContentCreatorName})
      out_.text(empty, "");
    out_.text(DCM_ContentDate, "20000101");
    out_.text(DCM_ContentTime, "000000");
    out_.text(DCM_Modality, "SEG");
    out_.text(DCM_Manufacturer, "artus");
    out_.text(DCM_ManufacturerModelName, "artus");
    out_.text(DCM_DeviceSerialNumber, "1");
    out_.text(DCM_SoftwareVersions, comment_);
    out_.text(DCM_PatientName, "Simulated^Joint");
    out_.text(DCM_PatientID, "SIMULATED");
    out_.text(DCM_StudyID, "1");
    out_.text(DCM_SeriesNumber, "1");
    out_.text(DCM_InstanceNumber, "1");
    out_.text(DCM_ContentLabel, "JOINT");
    out_.text(DCM_ContentDescription, "regions of a joint");
    out_.text(DCM_SegmentationType, "BINARY");
    out_.text(DCM_LossyImageCompression, "00");
  }

  void put_raster() {
    out_.number(DCM_SamplesPerPixel, 1);
    out_.text(DCM_PhotometricInterpretation, "MONOCHROME2");
    out_.text(DCM_NumberOfFrames, std::to_string(slices_.size()));
    out_.number(DCM_Rows, volume_.size[1]);
    out_.number(DCM_Columns, volume_.size[0]);
    out_.number(DCM_BitsAllocated, 1);
    out_.number(DCM_BitsStored, 1);
    out_.number(DCM_HighBit, 0);
    out_.number(DCM_PixelRepresentation, 0);
  }

  void put_segments() {
    for (std::size_t s = 0; s < volume_.segments.size(); ++s) {
      const LabelSegment& segment = volume_.segments[s];
      SegElements item = out_.item(DCM_SegmentSequence, kAppend);
      item.number(DCM_SegmentNumber, s + 1);
      item.text(DCM_SegmentLabel, segment.name);
      item.text(DCM_SegmentAlgorithmType, "AUTOMATIC");
      item.text(DCM_SegmentAlgorithmName, comment_);
      item.code(DCM_SegmentedPropertyCategoryCodeSequence, "SCT", "85756007", "Tissue");
      const auto space = segment.code.find(' ');
      if (space == std::string::npos)
        item.code(DCM_SegmentedPropertyTypeCodeSequence, "SCT", "85756007", "Tissue");
      else
        item.code(DCM_SegmentedPropertyTypeCodeSequence, segment.code.substr(0, space),
                  segment.code.substr(space + 1), labels_.tissues[s]);
    }
  }

  void put_shared() {
    const Eigen::Matrix3d edges = volume_.X_LI.linear() / kMillimetre;
    const Vec3 spacing = edges.colwise().norm();
    const Vec3 x = edges.col(0) / spacing.x();
    const Vec3 y = edges.col(1) / spacing.y();
    SegElements shared = out_.item(DCM_SharedFunctionalGroupsSequence);
    shared.item(DCM_PlaneOrientationSequence)
        .text(DCM_ImageOrientationPatient, decimals({x.x(), x.y(), x.z(), y.x(), y.y(), y.z()}));
    SegElements measures = shared.item(DCM_PixelMeasuresSequence);
    measures.text(DCM_SliceThickness, decimals({spacing.z()}));
    measures.text(DCM_SpacingBetweenSlices, decimals({spacing.z()}));
    measures.text(DCM_PixelSpacing, decimals({spacing.y(), spacing.x()}));
    const std::string organization = identifier(digest_ ^ 4U);
    out_.item(DCM_DimensionOrganizationSequence).text(DCM_DimensionOrganizationUID, organization);
    const auto add_index = [&](const DcmTagKey& pointer, const DcmTagKey& group) {
      SegElements index = out_.item(DCM_DimensionIndexSequence, kAppend);
      index.text(DCM_DimensionOrganizationUID, organization);
      index.note((*index).putAndInsertTagKey(DCM_DimensionIndexPointer, pointer));
      index.note((*index).putAndInsertTagKey(DCM_FunctionalGroupPointer, group));
    };
    add_index(DCM_ReferencedSegmentNumber, DCM_SegmentIdentificationSequence);
    add_index(DCM_ImagePositionPatient, DCM_PlanePositionSequence);
  }

  void put_frames() {
    for (const SegSlice& slice : slices_) {
      SegElements frame = out_.item(DCM_PerFrameFunctionalGroupsSequence, kAppend);
      frame.item(DCM_SegmentIdentificationSequence)
          .number(DCM_ReferencedSegmentNumber, slice.segment + 1);
      const Vec3 p = volume_.X_LI * Vec3(0, 0, static_cast<double>(slice.z)) / kMillimetre;
      frame.item(DCM_PlanePositionSequence)
          .text(DCM_ImagePositionPatient, decimals({p.x(), p.y(), p.z()}));
      const std::array<Uint32, 2> indices{static_cast<Uint32>(slice.segment + 1),
                                          static_cast<Uint32>(slice.z + 1)};
      SegElements content = frame.item(DCM_FrameContentSequence);
      auto* values = new DcmUnsignedLong(DCM_DimensionIndexValues);  // the item's, once inserted
      content.note(values->putUint32Array(indices.data(), indices.size()));
      content.note((*content).insert(values, true));
    }
  }

  /// One bit a voxel, the first in the lowest bit, frames without a gap between them.
  void put_pixels() {
    const std::size_t plane = volume_.size[0] * volume_.size[1];
    std::vector<Uint8> bits((plane * slices_.size() + 15) / 16 * 2, 0);
    std::size_t at = 0;
    for (const SegSlice& slice : slices_)
      for (std::size_t i = 0; i < plane; ++i, ++at)
        if (volume_.labels[slice.z * plane + i] == slice.segment + 1)
          bits[at / 8] = static_cast<Uint8>(bits[at / 8] | (1U << (at % 8)));
    out_.note((*out_).putAndInsertUint8Array(DCM_PixelData, bits.data(),
                                             static_cast<unsigned long>(bits.size())));
  }

  Result<std::string> to_bytes() {
    constexpr std::size_t kRoom = std::size_t{1} << 20;
    const std::size_t size = file_.calcElementLength(EXS_LittleEndianExplicit, EET_ExplicitLength) +
                             slices_.size() * 256 + kRoom;
    std::string bytes(size, '\0');
    DcmOutputBufferStream stream(bytes.data(), static_cast<offile_off_t>(bytes.size()));
    file_.transferInit();
    DcmWriteCache cache;
    condition_ = file_.write(stream, EXS_LittleEndianExplicit, EET_ExplicitLength, &cache);
    file_.transferEnd();
    if (condition_.bad())
      return fail(ErrorCode::unsupported,
                  std::string("DICOM cannot hold it: ") + condition_.text());
    void* start = nullptr;
    offile_off_t written = 0;
    stream.flushBuffer(start, written);
    bytes.resize(static_cast<std::size_t>(written));
    return bytes;
  }

  const JointLabels& labels_;
  const LabelVolume& volume_;
  std::string comment_;
  OFCondition condition_ = EC_Normal;
  DcmFileFormat file_;
  SegElements out_;
  std::uint64_t digest_;
  std::vector<SegSlice> slices_;
};

}  // namespace

Result<std::string> to_dicom_seg(const JointLabels& labels, const std::string& comment) {
  constexpr std::size_t kMost = 65535;
  if (labels.volume.size[0] > kMost || labels.volume.size[1] > kMost)
    return fail(ErrorCode::unsupported,
                "DICOM holds at most 65535 rows and columns; take a larger --spacing");
  return SegWriter(labels, comment).run();
}

#endif

}  // namespace artus
