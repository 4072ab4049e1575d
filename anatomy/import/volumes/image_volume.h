// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/core/result.h"

namespace artus {

/// How a sample of a volume is stored.
enum class SampleType { u8, i8, u16, i16, u32, i32, u64, i64, f32, f64 };
[[nodiscard]] std::size_t bytes_of(SampleType type) noexcept;

/// From indices of a volume (voxel centres at whole numbers) to a frame.
using IndexFrame = Eigen::Affine3d;

/// What a file says of one segment; empty where it says nothing.
struct SegmentName {
  std::string name;
  double value = 0;
  std::size_t layer = 0;
  std::string code;  ///< "SCT 272673000", scheme and code of its type
};

/// A volume of samples as a file has it: labels, or the grey values of an image.
struct ImageVolume {
  std::string format;  ///< "NIfTI-1", "NRRD", "MetaImage", as messages name it
  std::array<std::size_t, 3> size{0, 0, 0};
  std::size_t layers = 1;                    ///< volumes over each other, of one grid
  IndexFrame X_LI = IndexFrame::Identity();  ///< index to LPS, m
  SampleType type = SampleType::u8;
  /// (layers * size[0] * size[1] * size[2]) samples, little endian; the layer is the fastest axis,
  /// then x.
  std::string samples;
  double slope = 1;  ///< a sample is slope * stored + intercept
  double intercept = 0;
  std::vector<SegmentName> segments;
  std::vector<std::string> notes;  ///< what was taken for granted, in words

  [[nodiscard]] std::size_t n_voxels() const noexcept { return size[0] * size[1] * size[2]; }
};

/// Calls `use` with a typed pointer to the samples. Requires: samples as long as size says.
template <class Use>
void with_samples(const ImageVolume& volume, Use&& use) {
  const auto as = [&]<class T>(T) {
    std::vector<T> copy;  // the bytes need not be aligned
    const void* data = volume.samples.data();
    if (reinterpret_cast<std::uintptr_t>(data) % alignof(T) != 0) {
      copy.resize(volume.samples.size() / sizeof(T));
      std::memcpy(copy.data(), data, copy.size() * sizeof(T));
      data = copy.data();
    }
    use(static_cast<const T*>(data));
  };
  switch (volume.type) {
    case SampleType::u8:
      return as(std::uint8_t{});
    case SampleType::i8:
      return as(std::int8_t{});
    case SampleType::u16:
      return as(std::uint16_t{});
    case SampleType::i16:
      return as(std::int16_t{});
    case SampleType::u32:
      return as(std::uint32_t{});
    case SampleType::i32:
      return as(std::int32_t{});
    case SampleType::u64:
      return as(std::uint64_t{});
    case SampleType::i64:
      return as(std::int64_t{});
    case SampleType::f32:
      return as(float{});
    case SampleType::f64:
      return as(double{});
  }
}

/// The product of sizes. Errors: invalid when one is 0 or there are more than 2^31 - 1 voxels,
/// naming `where`.
[[nodiscard]] Result<std::size_t> count_voxels(const std::array<std::size_t, 3>& size,
                                               const std::string& where);

/// Refuses frames that are not finite, singular, or whose voxels are not of a body's scale
/// (1 um to 50 mm). Errors: invalid, naming `where`.
[[nodiscard]] Result<void> check_frame(const IndexFrame& X_LI, const std::string& where);

/// A frame as single precision and decimal texts keep it, too: edges in steps of 1e-6 mm, the
/// origin in steps of 1e-3 mm, so that one segmentation gives the same surfaces from every format.
[[nodiscard]] IndexFrame rounded_frame(const IndexFrame& X_LI) noexcept;

/// Turns samples of another byte order round.
void swap_bytes(std::string& samples, std::size_t width) noexcept;

/// NIfTI-1 and -2, as they are or compressed (.nii, .nii.gz): sform if its code is above 0, else
/// qform. Labels' names from a label table in the header's extensions (LabelTable, as
/// TotalSegmentator writes it). Errors: malformed, corrupt (truncated, more promised than there
/// is), invalid (singular frame, sform and qform more than 0.1 voxel apart, sizes), unsupported
/// (RGB, complex, time series, .hdr/.img pairs). Source: [Cox2004].
[[nodiscard]] Result<ImageVolume> parse_nifti(std::string_view bytes, const std::string& name);

/// NRRD 1 to 5 with attached data, raw or gzip; 3D Slicer's .seg.nrrd with its segments and
/// layers. Space right-, left- or posterior-oriented as named. Errors: as parse_nifti; unsupported
/// (detached data, bzip2, text).
[[nodiscard]] Result<ImageVolume> parse_nrrd(std::string_view bytes, const std::string& name);

/// MetaImage with local data (.mha), raw or zlib-compressed. Errors: as parse_nifti; unsupported
/// (data in another file).
[[nodiscard]] Result<ImageVolume> parse_metaimage(std::string_view bytes, const std::string& name);

}  // namespace artus
