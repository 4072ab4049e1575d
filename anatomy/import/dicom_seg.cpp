// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/dicom_seg.h"

#ifdef ARTUS_HAS_DICOM
#include <algorithm>
#include <cmath>
#include <map>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcistrmb.h>
#include <dcmtk/dcmdata/dctk.h>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"
#endif

namespace artus {

#ifndef ARTUS_HAS_DICOM

bool reads_dicom() noexcept {
  return false;
}

Result<LabelVolume> parse_dicom_seg(std::string_view, const std::string& name,
                                    const StructureNames&, double) {
  return fail(ErrorCode::unsupported,
              "this build of artus reads no DICOM (libdcmtk-dev was not there); save the "
              "segmentation as .nii.gz or .seg.nrrd",
              name);
}

#else

bool reads_dicom() noexcept {
  return true;
}

namespace {

constexpr double kOffGrid = 0.1;  // voxel

/// Numbers of an attribute; fewer than `n` when it is not there.
std::vector<double> numbers(DcmItem& item, const DcmTagKey& tag, unsigned long n) {
  std::vector<double> values;
  for (unsigned long i = 0; i < n; ++i) {
    Float64 value = 0;
    if (item.findAndGetFloat64(tag, value, i).bad()) break;
    values.push_back(value);
  }
  return values;
}

std::string text(DcmItem& item, const DcmTagKey& tag) {
  OFString value;
  if (item.findAndGetOFString(tag, value).bad()) return {};
  return {value.c_str(), value.size()};
}

/// An item of a sequence; null when it is not there.
DcmItem* item_of(DcmItem& item, const DcmTagKey& sequence, signed long number = 0) {
  DcmItem* found = nullptr;
  return item.findAndGetSequenceItem(sequence, found, number).good() ? found : nullptr;
}

/// A slice of one segment.
struct Frame {
  std::size_t number = 0;   ///< among the frames of the pixels
  std::size_t segment = 0;  ///< place in the segments
  Vec3 position = Vec3::Zero();
};

class SegReader {
 public:
  SegReader(DcmDataset& data, const std::string& name, double threshold)
      : data_(data), name_(name), threshold_(threshold) {}

  Result<LabelVolume> run(const StructureNames& names) {
    ARTUS_TRY(check_kind());
    ARTUS_TRY(read_segments(names));
    ARTUS_TRY(read_plane());
    ARTUS_TRY(read_frames());
    ARTUS_TRY(place_slices());
    ARTUS_TRY(read_pixels());
    if (std::all_of(out_.segments.begin(), out_.segments.end(),
                    [](const LabelSegment& s) { return s.n_voxels == 0; }))
      return fail(ErrorCode::invalid, "no voxel of it belongs to a segment: it is empty", name_);
    for (const LabelSegment& s : out_.segments)
      if (s.n_lost > 0)
        out_.notes.push_back(
            printed("'%s' overlaps segments before it: %zu voxels of it are theirs", s.name.c_str(),
                    s.n_lost));
    return std::move(out_);
  }

 private:
  tl::unexpected<Error> missing(const char* what) const {
    return fail(ErrorCode::malformed,
                std::string("it has no ") + what + "; export the segmentation again", name_);
  }

  Result<void> check_kind() {
    out_.format = "DICOM segmentation";
    if (text(data_, DCM_SOPClassUID) != UID_SegmentationStorage)
      return fail(ErrorCode::unsupported,
                  "it is a DICOM file but no segmentation (" + text(data_, DCM_Modality) +
                      "); give the segmentation object (SEG), or .nii.gz or .seg.nrrd of it",
                  name_);
    Uint16 rows = 0, columns = 0, bits = 0;
    data_.findAndGetUint16(DCM_Rows, rows);
    data_.findAndGetUint16(DCM_Columns, columns);
    data_.findAndGetUint16(DCM_BitsAllocated, bits);
    out_.size = {columns, rows, 1};
    is_binary_ = bits == 1;
    if (rows == 0 || columns == 0 || (bits != 1 && bits != 8)) return missing("size of its slices");
    if (!is_binary_) {
      Uint16 most = 255;
      data_.findAndGetUint16(DCM_MaximumFractionalValue, most);
      least_ = static_cast<std::uint8_t>(std::clamp(std::ceil(threshold_ * most), 1.0, 255.0));
    }
    return {};
  }

  Result<void> read_segments(const StructureNames& names) {
    for (signed long i = 0; auto* item = item_of(data_, DCM_SegmentSequence, i); ++i) {
      Uint16 number = 0;
      item->findAndGetUint16(DCM_SegmentNumber, number);
      LabelSegment segment;
      segment.name = text(*item, DCM_SegmentLabel);
      segment.value = number;
      if (auto* code = item_of(*item, DCM_SegmentedPropertyTypeCodeSequence))
        segment.code = text(*code, DCM_CodingSchemeDesignator) + " " + text(*code, DCM_CodeValue);
      for (const NamedLabel& label : names.labels)
        if (label.value == segment.value) segment.name = label.name;
      place_[number] = out_.segments.size();
      out_.segments.push_back(std::move(segment));
    }
    return out_.segments.empty() ? Result<void>(missing("list of segments")) : Result<void>();
  }

  Result<void> read_plane() {
    DcmItem* shared = item_of(data_, DCM_SharedFunctionalGroupsSequence);
    DcmItem* first = item_of(data_, DCM_PerFrameFunctionalGroupsSequence);
    const auto find = [&](const DcmTagKey& sequence) -> DcmItem* {
      for (DcmItem* group : {shared, first})
        if (group != nullptr)
          if (auto* item = item_of(*group, sequence)) return item;
      return nullptr;
    };
    DcmItem* orientation = find(DCM_PlaneOrientationSequence);
    DcmItem* measures = find(DCM_PixelMeasuresSequence);
    if (orientation == nullptr || measures == nullptr) return missing("orientation or spacing");
    const auto o = numbers(*orientation, DCM_ImageOrientationPatient, 6);
    const auto spacing = numbers(*measures, DCM_PixelSpacing, 2);
    if (o.size() != 6 || spacing.size() != 2) return missing("orientation or spacing");
    x_ = Vec3(o[0], o[1], o[2]);
    y_ = Vec3(o[3], o[4], o[5]);
    out_.X_LI.linear().col(0) = kMillimetre * spacing[1] * x_;
    out_.X_LI.linear().col(1) = kMillimetre * spacing[0] * y_;
    for (const DcmTagKey& key : {DCM_SpacingBetweenSlices, DCM_SliceThickness})
      if (const auto step = numbers(*measures, key, 1); step_ == 0 && step.size() == 1)
        step_ = std::abs(step[0]);
    return {};
  }

  Result<void> read_frames() {
    for (signed long i = 0; auto* item = item_of(data_, DCM_PerFrameFunctionalGroupsSequence, i);
         ++i) {
      Frame frame;
      frame.number = static_cast<std::size_t>(i);
      DcmItem* segment = item_of(*item, DCM_SegmentIdentificationSequence);
      DcmItem* position = item_of(*item, DCM_PlanePositionSequence);
      Uint16 number = 0;
      if (segment != nullptr) segment->findAndGetUint16(DCM_ReferencedSegmentNumber, number);
      const auto p = position != nullptr ? numbers(*position, DCM_ImagePositionPatient, 3)
                                         : std::vector<double>{};
      if (!place_.contains(number) || p.size() != 3) return missing("place of each of its frames");
      frame.segment = place_[number];
      frame.position = Vec3(p[0], p[1], p[2]);
      frames_.push_back(frame);
    }
    if (frames_.empty()) return missing("frames");
    std::stable_sort(frames_.begin(), frames_.end(),
                     [](const Frame& a, const Frame& b) { return a.segment < b.segment; });
    return {};
  }

  /// The grid from the lowest slice to the highest.
  Result<void> place_slices() {
    const Vec3 n = x_.cross(y_);
    std::vector<double> heights;
    for (const Frame& f : frames_) heights.push_back(f.position.dot(n));
    std::sort(heights.begin(), heights.end());
    double least = 0;
    for (std::size_t i = 1; i < heights.size(); ++i) {
      const double apart = heights[i] - heights[i - 1];
      if (apart > 1e-3 && (least == 0 || apart < least)) least = apart;
    }
    if (least > 0) step_ = least;
    if (!(step_ > 0)) return missing("distance of its slices");
    const auto low = std::min_element(
        frames_.begin(), frames_.end(),
        [&](const Frame& a, const Frame& b) { return a.position.dot(n) < b.position.dot(n); });
    const double slices = std::round((heights.back() - heights.front()) / step_) + 1;
    if (!(slices < 1e5)) return missing("sound positions");
    out_.size[2] = static_cast<std::size_t>(slices);
    // From the lowest slice to the highest, which is finer than the distance of two of them.
    const auto high = std::max_element(
        frames_.begin(), frames_.end(),
        [&](const Frame& a, const Frame& b) { return a.position.dot(n) < b.position.dot(n); });
    const Vec3 up =
        slices > 1 ? Vec3((high->position - low->position) / (slices - 1)) : Vec3(step_ * n);
    out_.X_LI.linear().col(2) = kMillimetre * up;
    out_.X_LI.translation() = kMillimetre * low->position;
    ARTUS_TRY(count_voxels(out_.size, name_));
    ARTUS_TRY(check_frame(out_.X_LI, name_));
    const IndexFrame to_index = out_.X_LI.inverse();
    for (const Frame& f : frames_) {
      const Vec3 at = to_index * (kMillimetre * f.position);
      const double slice = std::round(at.z());
      if (std::max({std::abs(at.x()), std::abs(at.y()), std::abs(at.z() - slice)}) > kOffGrid)
        return fail(
            ErrorCode::invalid,
            printed("its frames are no slices of one grid (frame %zu is off by %.2f voxel); "
                    "resample it to the scan",
                    f.number + 1, (at - Vec3(0, 0, slice)).cwiseAbs().maxCoeff()),
            name_);
      slices_.push_back(static_cast<std::size_t>(slice));
    }
    out_.X_LI = rounded_frame(out_.X_LI);
    return {};
  }

  Result<void> read_pixels() {
    const Uint8* pixels = nullptr;
    unsigned long n = 0;
    if (data_.findAndGetUint8Array(DCM_PixelData, pixels, &n).bad() || pixels == nullptr)
      return fail(ErrorCode::unsupported,
                  "its pixels are compressed or missing; save it uncompressed (dcmdjpeg, dcmdrle), "
                  "or as .nii.gz or .seg.nrrd",
                  name_);
    const std::size_t plane = out_.size[0] * out_.size[1];
    const std::size_t wanted =
        is_binary_ ? (plane * frames_.size() + 7) / 8 : plane * frames_.size();
    if (n < wanted)
      return fail(ErrorCode::corrupt,
                  printed("its %zu frames need %zu bytes of pixels and there are %lu; it is not "
                          "complete",
                          frames_.size(), wanted, n),
                  name_);
    out_.labels.assign(plane * out_.size[2], 0);
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      const Frame& f = frames_[k];
      LabelSegment& segment = out_.segments[f.segment];
      for (std::size_t i = 0; i < plane; ++i) {
        const std::size_t at = f.number * plane + i;
        const bool is_in =
            is_binary_ ? (pixels[at / 8] >> (at % 8) & 1) != 0 : pixels[at] >= least_;
        if (!is_in) continue;
        std::uint16_t& label = out_.labels[slices_[k] * plane + i];
        ++(label == 0 ? segment.n_voxels : segment.n_lost);
        if (label == 0) label = static_cast<std::uint16_t>(f.segment + 1);
      }
    }
    return {};
  }

  DcmDataset& data_;
  const std::string& name_;
  double threshold_;
  LabelVolume out_;
  std::map<unsigned, std::size_t> place_;  // of a segment's number
  std::vector<Frame> frames_;
  std::vector<std::size_t> slices_;  // of each frame
  Vec3 x_ = Vec3::Zero(), y_ = Vec3::Zero();
  double step_ = 0;  // mm
  bool is_binary_ = true;
  std::uint8_t least_ = 1;
};

}  // namespace

Result<LabelVolume> parse_dicom_seg(std::string_view bytes, const std::string& name,
                                    const StructureNames& names, double threshold) {
  DcmInputBufferStream stream;
  stream.setBuffer(bytes.data(), static_cast<offile_off_t>(bytes.size()));
  stream.setEos();
  DcmFileFormat file;
  file.transferInit();
  const OFCondition read = file.read(stream);
  file.transferEnd();
  if (read.bad())
    return fail(ErrorCode::corrupt,
                std::string("it cannot be read as DICOM: ") + read.text() + "; copy it again",
                name);
  return SegReader(*file.getDataset(), name, threshold).run(names);
}

#endif

}  // namespace artus
