// SPDX-License-Identifier: AGPL-3.0-or-later
#include <bit>
#include <cmath>
#include <optional>

#include "artus/detail/anatomy/import/volumes/image_volume.h"
#include "artus/detail/anatomy/import/volumes/inflate.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr std::size_t kHeader1 = 348;
constexpr std::size_t kHeader2 = 540;
constexpr std::size_t kMostOffset = std::size_t{1} << 28;  // bytes before the voxels

/// Numbers at places of a header, in its byte order.
class HeaderFields {
 public:
  HeaderFields(std::string_view bytes, bool swapped) : bytes_(bytes), swapped_(swapped) {}
  template <class T>
  [[nodiscard]] T get(std::size_t at) const {
    T value{};
    if (at + sizeof value > bytes_.size()) return value;
    std::string raw(bytes_.substr(at, sizeof value));
    if (swapped_) swap_bytes(raw, sizeof value);
    std::memcpy(&value, raw.data(), sizeof value);
    return value;
  }

 private:
  std::string_view bytes_;
  bool swapped_;
};

/// What both versions of the header say.
struct NiftiHeader {
  bool is_2 = false;
  bool swapped = false;
  std::array<std::int64_t, 8> dim{};
  std::array<double, 8> pixdim{};
  int datatype = 0;
  double slope = 0, intercept = 0;
  std::int64_t offset = 0;
  int xyzt_units = 0;
  int qform_code = 0, sform_code = 0;
  std::array<double, 6> quatern{};
  Eigen::Matrix<double, 3, 4> srow = Eigen::Matrix<double, 3, 4>::Zero();
};

/// Version and byte order by the size that stands first.
std::optional<NiftiHeader> recognise(std::string_view bytes) {
  if (bytes.size() < 4) return std::nullopt;
  for (const bool swapped : {false, true}) {
    const auto size = HeaderFields(bytes, swapped).get<std::int32_t>(0);
    NiftiHeader header;
    header.swapped = swapped;
    header.is_2 = size == static_cast<std::int32_t>(kHeader2);
    if (header.is_2 || size == static_cast<std::int32_t>(kHeader1)) return header;
  }
  return std::nullopt;
}

void fill_1(const HeaderFields& in, NiftiHeader& h) {
  for (std::size_t i = 0; i < 8; ++i) h.dim[i] = in.get<std::int16_t>(40 + 2 * i);
  for (std::size_t i = 0; i < 8; ++i) h.pixdim[i] = in.get<float>(76 + 4 * i);
  h.datatype = in.get<std::int16_t>(70);
  const auto offset = in.get<float>(108);
  h.offset = offset >= 0 && offset < 1e9F ? static_cast<std::int64_t>(offset) : -1;
  h.slope = in.get<float>(112);
  h.intercept = in.get<float>(116);
  h.xyzt_units = static_cast<unsigned char>(in.get<char>(123));
  h.qform_code = in.get<std::int16_t>(252);
  h.sform_code = in.get<std::int16_t>(254);
  for (std::size_t i = 0; i < 6; ++i) h.quatern[i] = in.get<float>(256 + 4 * i);
  for (std::size_t i = 0; i < 12; ++i)
    h.srow(static_cast<int>(i / 4), static_cast<int>(i % 4)) = in.get<float>(280 + 4 * i);
}

void fill_2(const HeaderFields& in, NiftiHeader& h) {
  h.datatype = in.get<std::int16_t>(12);
  for (std::size_t i = 0; i < 8; ++i) h.dim[i] = in.get<std::int64_t>(16 + 8 * i);
  for (std::size_t i = 0; i < 8; ++i) h.pixdim[i] = in.get<double>(104 + 8 * i);
  h.offset = in.get<std::int64_t>(168);
  h.slope = in.get<double>(176);
  h.intercept = in.get<double>(184);
  h.qform_code = in.get<std::int32_t>(344);
  h.sform_code = in.get<std::int32_t>(348);
  for (std::size_t i = 0; i < 6; ++i) h.quatern[i] = in.get<double>(352 + 8 * i);
  for (std::size_t i = 0; i < 12; ++i)
    h.srow(static_cast<int>(i / 4), static_cast<int>(i % 4)) = in.get<double>(400 + 8 * i);
  h.xyzt_units = in.get<std::int32_t>(500);
}

Result<SampleType> type_of(int datatype, const std::string& name) {
  switch (datatype) {
    case 2:
      return SampleType::u8;
    case 4:
      return SampleType::i16;
    case 8:
      return SampleType::i32;
    case 16:
      return SampleType::f32;
    case 64:
      return SampleType::f64;
    case 256:
      return SampleType::i8;
    case 512:
      return SampleType::u16;
    case 768:
      return SampleType::u32;
    case 1024:
      return SampleType::i64;
    case 1280:
      return SampleType::u64;
    case 128:
    case 2304:
      return fail(ErrorCode::unsupported,
                  "it holds colours (RGB), not labels; save the label map itself", name);
    default:
      return fail(
          ErrorCode::unsupported,
          printed("samples of NIfTI's datatype %d are no labels; save it with whole numbers",
                  datatype),
          name);
  }
}

/// The quaternion's frame, in mm of RAS.
Eigen::Matrix<double, 3, 4> qform(const NiftiHeader& h) {
  const double b = h.quatern[0], c = h.quatern[1], d = h.quatern[2];
  const double rest = 1 - b * b - c * c - d * d;
  Eigen::Quaterniond q(rest > 0 ? std::sqrt(rest) : 0, b, c, d);
  q.normalize();
  Eigen::Matrix<double, 3, 4> m;
  const double qfac = h.pixdim[0] < 0 ? -1 : 1;
  m.leftCols<3>() =
      q.toRotationMatrix() * Vec3(h.pixdim[1], h.pixdim[2], qfac * h.pixdim[3]).asDiagonal();
  m.col(3) = Vec3(h.quatern[3], h.quatern[4], h.quatern[5]);
  return m;
}

/// The farthest that a corner of the grid lies apart in two frames, in voxels of the first.
double frames_apart(const Eigen::Matrix<double, 3, 4>& a, const Eigen::Matrix<double, 3, 4>& b,
                    const std::array<std::size_t, 3>& size) {
  double most = 0;
  for (int k = 0; k < 8; ++k) {
    Eigen::Vector4d corner(0, 0, 0, 1);
    for (std::size_t axis = 0; axis < 3; ++axis)
      if ((k >> axis & 1) != 0)
        corner[static_cast<Eigen::Index>(axis)] = static_cast<double>(size.at(axis) - 1);
    most = std::max(most, (a * corner - b * corner).norm());
  }
  return most / a.leftCols<3>().colwise().norm().minCoeff();
}

Result<IndexFrame> frame_of(const NiftiHeader& h, ImageVolume& volume, const std::string& name) {
  constexpr double kApart = 0.1;  // voxel
  const auto q = qform(h);
  Eigen::Matrix<double, 3, 4> ras;
  if (h.sform_code > 0) {
    ras = h.srow;
    const double apart = frames_apart(h.srow, q, volume.size);
    if (h.qform_code > 0 && !(apart <= kApart))
      return fail(ErrorCode::invalid,
                  printed("its two frames contradict each other: sform and qform put a corner %.3g "
                          "voxels apart; set both to the right one in the program that made it",
                          apart),
                  name);
  } else if (h.qform_code > 0) {
    ras = q;
  } else {
    return fail(ErrorCode::invalid,
                "it does not say where it lies in the body (sform and qform have code 0); save it "
                "with its frame",
                name);
  }
  double unit = kMillimetre;
  if ((h.xyzt_units & 7) == 1) unit = 1;
  if ((h.xyzt_units & 7) == 3) unit = 1e-6;
  if ((h.xyzt_units & 7) == 0)
    volume.notes.push_back("the header names no unit of length: taken for millimetres");
  IndexFrame frame = IndexFrame::Identity();
  frame.affine() = Vec3(-unit, -unit, unit).asDiagonal() * ras;
  if (const auto sound = check_frame(frame, name); !sound) return tl::unexpected(sound.error());
  return frame;
}

Result<void> read_sizes(const NiftiHeader& h, ImageVolume& volume, const std::string& name) {
  if (h.dim[0] < 1 || h.dim[0] > 7)
    return fail(ErrorCode::malformed, "its header is damaged: it has no number of axes from 1 to 7",
                name);
  for (std::size_t i = 1; i <= static_cast<std::size_t>(h.dim[0]); ++i) {
    if (h.dim[i] < 1)
      return fail(ErrorCode::invalid, "a size of the volume is 0 or negative", name);
    if (i > 3 && h.dim[i] > 1)
      return fail(ErrorCode::unsupported,
                  printed("it is a series of %lld volumes, not one label map; save the one that is "
                          "meant",
                          static_cast<long long>(h.dim[i])),
                  name);
  }
  for (std::size_t i = 0; i < 3; ++i)
    volume.size[i] =
        i + 1 > static_cast<std::size_t>(h.dim[0]) ? 1 : static_cast<std::size_t>(h.dim[i + 1]);
  ARTUS_TRY(count_voxels(volume.size, name));
  return {};
}

/// Value of an attribute in a tag of XML.
std::string attribute(std::string_view tag, std::string_view key) {
  const auto at = tag.find(std::string(key) + "=\"");
  if (at == std::string_view::npos) return {};
  const auto begin = at + key.size() + 2;
  return std::string(tag.substr(begin, tag.find('"', begin) - begin));
}

/// <Label Key="5" ...>liver</Label> of the extensions that follow the header.
void read_label_table(std::string_view extensions, ImageVolume& volume) {
  std::size_t at = 0;
  while ((at = extensions.find("<Label ", at)) != std::string_view::npos) {
    const auto open_end = extensions.find('>', at);
    if (open_end == std::string_view::npos) return;
    const auto close = extensions.find("</Label>", open_end);
    if (close == std::string_view::npos) return;
    const std::string key = attribute(extensions.substr(at, open_end - at), "Key");
    std::string text(extensions.substr(open_end + 1, close - open_end - 1));
    constexpr std::string_view kData = "<![CDATA[";
    if (text.starts_with(kData) && text.ends_with("]]>"))
      text = text.substr(kData.size(), text.size() - kData.size() - 3);
    at = close;
    char* end = nullptr;
    const long value = std::strtol(key.c_str(), &end, 10);
    if (key.empty() || *end != '\0' || value <= 0) continue;
    volume.segments.push_back({text, static_cast<double>(value), 0, {}});
  }
}

}  // namespace

Result<ImageVolume> parse_nifti(std::string_view bytes, const std::string& name) {
  std::string head(bytes.substr(0, kHeader2));
  const bool compressed = is_gzip(bytes);
  if (compressed) {
    auto begin = inflate(bytes, kHeader2, name);
    ARTUS_TRY(begin);
    head = std::move(begin->bytes);
  }
  auto header = recognise(head);
  if (!header)
    return fail(ErrorCode::malformed, "it does not begin with the header of NIfTI", name);
  const std::size_t head_size = header->is_2 ? kHeader2 : kHeader1;
  if (head.size() < head_size)
    return fail(ErrorCode::corrupt, "it ends within its header; copy or download it again", name);
  if (head.compare(header->is_2 ? 4 : 344, 2, "n+") != 0)
    return fail(ErrorCode::unsupported,
                "its voxels are in a second file (.hdr and .img); save it as one .nii.gz", name);
  ImageVolume volume;
  volume.format = header->is_2 ? "NIfTI-2" : "NIfTI-1";
  const HeaderFields fields(head, header->swapped);
  if (header->is_2)
    fill_2(fields, *header);
  else
    fill_1(fields, *header);
  if (const auto sized = read_sizes(*header, volume, name); !sized)
    return tl::unexpected(sized.error());
  const auto type = type_of(header->datatype, name);
  ARTUS_TRY(type);
  volume.type = *type;
  auto frame = frame_of(*header, volume, name);
  ARTUS_TRY(frame);
  volume.X_LI = *frame;
  if (std::isfinite(header->slope) && header->slope != 0) {
    volume.slope = header->slope;
    volume.intercept = std::isfinite(header->intercept) ? header->intercept : 0;
  }
  if (header->offset < static_cast<std::int64_t>(head_size) ||
      header->offset > static_cast<std::int64_t>(kMostOffset))
    return fail(ErrorCode::malformed, "its header says no place where the voxels begin", name);
  const auto offset = static_cast<std::size_t>(header->offset);
  const std::size_t wanted = offset + volume.n_voxels() * bytes_of(volume.type);
  std::string expanded;
  if (compressed) {
    auto all = inflate_exactly(bytes, wanted, name);
    ARTUS_TRY(all);
    expanded = std::move(*all);
    bytes = expanded;
  }
  if (bytes.size() < wanted)
    return fail(ErrorCode::corrupt,
                printed("its header promises %zu bytes and there are %zu; it is not complete: copy "
                        "or download it again",
                        wanted, bytes.size()),
                name);
  read_label_table(bytes.substr(head_size, offset - head_size), volume);
  volume.samples = bytes.substr(offset, wanted - offset);
  if (header->swapped) swap_bytes(volume.samples, bytes_of(volume.type));
  return volume;
}

}  // namespace artus
