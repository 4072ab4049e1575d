// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/label_maps/label_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "artus/detail/anatomy/body/tissue.h"
#include "artus/detail/anatomy/import/structure_names.h"
#include "artus/detail/anatomy/import/volumes/inflate.h"
#include "artus/detail/anatomy/label_maps/dicom_seg_writer.h"
#include "artus/detail/core/known_names.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr std::size_t kBytes = 255;  // labels that one byte holds

constexpr std::array<std::pair<std::string_view, LabelFormat>, 6> kEndings{
    {{".nii.gz", LabelFormat::nifti_gz},
     {".nii", LabelFormat::nifti},
     {".seg.nrrd", LabelFormat::seg_nrrd},
     {".nrrd", LabelFormat::nrrd},
     {".mha", LabelFormat::metaimage},
     {".dcm", LabelFormat::dicom}}};

bool is_narrow(const JointLabels& labels) {
  return labels.volume.segments.size() <= kBytes;
}

/// The labels as samples of one or two bytes.
std::string samples_of(const JointLabels& labels) {
  const auto& all = labels.volume.labels;
  std::string bytes;
  if (is_narrow(labels)) {
    bytes.resize(all.size());
    std::transform(all.begin(), all.end(), bytes.begin(),
                   [](std::uint16_t label) { return static_cast<char>(label); });
  } else {
    bytes.assign(reinterpret_cast<const char*>(all.data()), all.size() * sizeof(std::uint16_t));
  }
  return bytes;
}

/// Layer 0 and 1 of each voxel in turn: its structure, and whether it is of the body.
std::string layered_samples(const JointLabels& labels) {
  const auto rest = static_cast<std::uint16_t>(labels.volume.segments.size());
  const std::size_t width = is_narrow(labels) ? 1 : 2;
  std::string bytes(labels.volume.labels.size() * 2 * width, '\0');
  char* at = bytes.data();
  for (const std::uint16_t label : labels.volume.labels) {
    const std::array<std::uint16_t, 2> pair{label == rest ? std::uint16_t{0} : label,
                                            static_cast<std::uint16_t>(label != 0 ? 1 : 0)};
    for (const std::uint16_t& value : pair) {
      std::memcpy(at, &value, width);
      at += width;
    }
  }
  return bytes;
}

template <class T>
void put_at(std::string& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

/// sform and qform of a header. Source: [Cox2004].
void put_frames(std::string& header, const IndexFrame& X_LI) {
  const Eigen::Matrix<double, 3, 4> ras =
      Vec3(-1, -1, 1).asDiagonal() * X_LI.matrix().topRows<3>() / kMillimetre;
  const Vec3 edges = ras.leftCols<3>().colwise().norm();
  Eigen::Matrix3d turned = ras.leftCols<3>() * edges.cwiseInverse().asDiagonal();
  const float qfac = turned.determinant() < 0 ? -1.0F : 1.0F;
  if (qfac < 0) turned.col(2) *= -1;
  Eigen::Quaterniond q(turned);
  if (q.w() < 0) q.coeffs() *= -1;
  put_at<float>(header, 76, qfac);
  for (std::size_t k = 0; k < 3; ++k)
    put_at<float>(header, 80 + 4 * k, static_cast<float>(edges[static_cast<int>(k)]));
  put_at<std::int16_t>(header, 252, 1);
  put_at<std::int16_t>(header, 254, 1);
  const std::array<double, 6> quatern{q.x(), q.y(), q.z(), ras(0, 3), ras(1, 3), ras(2, 3)};
  for (std::size_t k = 0; k < 6; ++k)
    put_at<float>(header, 256 + 4 * k, static_cast<float>(quatern[k]));
  for (std::size_t k = 0; k < 12; ++k)
    put_at<float>(header, 280 + 4 * k,
                  static_cast<float>(ras(static_cast<int>(k / 4), static_cast<int>(k % 4))));
}

std::string escaped(const std::string& name) {
  std::string out;
  for (const char c : name) out += c == ']' ? ')' : c;  // no end of a CDATA
  return out;
}

Result<std::string> to_nifti(const JointLabels& labels, const std::string& comment) {
  constexpr std::size_t kHeader = 352;
  constexpr std::size_t kLargest = 32767;
  const LabelVolume& volume = labels.volume;
  if (*std::max_element(volume.size.begin(), volume.size.end()) > kLargest)
    return fail(ErrorCode::unsupported,
                "NIfTI-1 holds at most 32767 voxels along an axis; take "
                "a larger --spacing");
  std::string table =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?><CaretExtension><VolumeInformation "
      "Index=\"0\"><LabelTable>";
  for (const LabelSegment& s : volume.segments)
    table += printed("<Label Key=\"%.0f\" Red=\"1\" Green=\"1\" Blue=\"1\" Alpha=\"1\"><![CDATA[",
                     s.value) +
             escaped(s.name) + "]]></Label>";
  table += "</LabelTable></VolumeInformation></CaretExtension>";
  const std::size_t extension = (8 + table.size() + 15) / 16 * 16;
  std::string bytes(kHeader + extension, '\0');
  put_at<std::int32_t>(bytes, 0, 348);
  put_at<std::int16_t>(bytes, 40, 3);
  for (std::size_t k = 0; k < 7; ++k)
    put_at<std::int16_t>(bytes, 42 + 2 * k,
                         k < 3 ? static_cast<std::int16_t>(volume.size.at(k)) : std::int16_t{1});
  put_at<std::int16_t>(bytes, 70, is_narrow(labels) ? std::int16_t{2} : std::int16_t{512});
  put_at<std::int16_t>(bytes, 72, is_narrow(labels) ? std::int16_t{8} : std::int16_t{16});
  put_at<float>(bytes, 108, static_cast<float>(bytes.size()));
  put_at<float>(bytes, 112, 1);
  bytes[123] = 2;  // millimetres
  bytes.replace(148, std::min<std::size_t>(comment.size(), 79), comment, 0, 79);
  put_frames(bytes, volume.X_LI);
  bytes.replace(344, 3, "n+1");
  bytes[348] = 1;
  put_at<std::int32_t>(bytes, kHeader, static_cast<std::int32_t>(extension));
  bytes.replace(kHeader + 8, table.size(), table);
  return bytes + samples_of(labels);
}

std::string in_brackets(const Vec3& v) {
  return printed("(%.9g,%.9g,%.9g)", v.x(), v.y(), v.z());
}

/// A segment as 3D Slicer writes it; its colour follows from its number.
std::string segment_lines(const LabelSegment& s, std::size_t number, std::size_t layer,
                          double value, const LabelVolume& volume) {
  const std::string key = printed("Segment%zu_", number);
  constexpr double kGolden = 0.618034;
  const double hue = 6.2831853 * std::fmod(static_cast<double>(number) * kGolden, 1.0);
  std::string out =
      key + printed("Color:=%.3f %.3f %.3f\n", 0.6 + 0.4 * std::cos(hue),
                    0.6 + 0.4 * std::cos(hue - 2.094), 0.6 + 0.4 * std::cos(hue + 2.094));
  out += key + printed("Extent:=0 %zu 0 %zu 0 %zu\n", volume.size[0] - 1, volume.size[1] - 1,
                       volume.size[2] - 1);
  out += key + "ID:=" + printed("Segment_%zu", number + 1) + "\n";
  out += key + printed("LabelValue:=%.0f\n", value);
  out += key + printed("Layer:=%zu\n", layer);
  out += key + "Name:=" + s.name + "\n";
  out += key + "NameAutoGenerated:=0\n";
  const auto space = s.code.find(' ');
  if (space == std::string::npos) return out;
  return out + key +
         "Tags:=TerminologyEntry:Segmentation category and type - 3D Slicer General "
         "Anatomy list~SCT^85756007^Tissue~" +
         s.code.substr(0, space) + "^" + s.code.substr(space + 1) + "^" + s.name +
         "~^^~Anatomic codes - DICOM master "
         "list~^^~^^|\n";
}

Result<std::string> to_nrrd(const JointLabels& labels, bool layered, const std::string& comment) {
  const LabelVolume& volume = labels.volume;
  const Vec3 signs = labels.is_ras ? Vec3(-1, -1, 1) : Vec3(1, 1, 1);
  const Eigen::Matrix<double, 3, 4> m =
      signs.asDiagonal() * volume.X_LI.matrix().topRows<3>() / kMillimetre;
  std::string text = "NRRD0004\n# " + comment + "\ntype: ";
  text += is_narrow(labels) ? "unsigned char" : "unsigned short";
  text += printed("\ndimension: %d\nspace: ", layered ? 4 : 3);
  text += labels.is_ras ? "right-anterior-superior" : "left-posterior-superior";
  text += printed("\nsizes: %s%zu %zu %zu", layered ? "2 " : "", volume.size[0], volume.size[1],
                  volume.size[2]);
  text += std::string("\nspace directions: ") + (layered ? "none " : "") + in_brackets(m.col(0)) +
          " " + in_brackets(m.col(1)) + " " + in_brackets(m.col(2));
  text += std::string("\nkinds: ") + (layered ? "list " : "") + "domain domain domain";
  text += "\nendian: little\nencoding: gzip\nspace origin: " + in_brackets(m.col(3)) + "\n";
  text += printed("Segmentation_ReferenceImageExtentOffset:=0 0 0\n");
  for (std::size_t k = 0; k < volume.segments.size(); ++k) {
    const bool is_body = layered && k + 1 == volume.segments.size();
    text += segment_lines(volume.segments[k], k, is_body ? 1 : 0,
                          is_body ? 1.0 : volume.segments[k].value, volume);
  }
  return text + "\n" + deflate_gzip(layered ? layered_samples(labels) : samples_of(labels));
}

Result<std::string> to_metaimage(const JointLabels& labels, const std::string& comment) {
  const LabelVolume& volume = labels.volume;
  const Vec3 edges = volume.X_LI.linear().colwise().norm() / kMillimetre;
  const std::string data = deflate_gzip(samples_of(labels));
  std::string text =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "CompressedData = True\n" +
      printed("CompressedDataSize = %zu\nTransformMatrix =", data.size());
  for (int k = 0; k < 9; ++k)
    text += printed(" %.17g", volume.X_LI.linear()(k % 3, k / 3) / kMillimetre / edges[k / 3]);
  const Vec3 origin = volume.X_LI.translation() / kMillimetre;
  text += printed("\nOffset = %.9g %.9g %.9g\nCenterOfRotation = 0 0 0\n", origin.x(), origin.y(),
                  origin.z());
  text += printed("ElementSpacing = %.17g %.17g %.17g\nDimSize = %zu %zu %zu\n", edges.x(),
                  edges.y(), edges.z(), volume.size[0], volume.size[1], volume.size[2]);
  text += "Comment = " + comment + "\nElementType = ";
  text += is_narrow(labels) ? "MET_UCHAR" : "MET_USHORT";
  return text + "\nElementDataFile = LOCAL\n" + data;
}

}  // namespace

Result<LabelFormat> label_format_of(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  for (const auto& [ending, format] : kEndings)
    if (name.size() > ending.size() && name.ends_with(ending)) return format;
  return fail(ErrorCode::unsupported,
              "a label map's file ends in .nii, .nii.gz, .nrrd, .seg.nrrd, .mha or .dcm",
              file.string());
}

Result<std::string> to_label_file(const JointLabels& labels, LabelFormat format,
                                  const std::string& comment) {
  switch (format) {
    case LabelFormat::nifti:
      return to_nifti(labels, comment);
    case LabelFormat::nifti_gz: {
      const auto plain = to_nifti(labels, comment);
      ARTUS_TRY(plain);
      return deflate_gzip(*plain);
    }
    case LabelFormat::nrrd:
      return to_nrrd(labels, false, comment);
    case LabelFormat::seg_nrrd:
      return to_nrrd(labels, true, comment);
    case LabelFormat::metaimage:
      return to_metaimage(labels, comment);
    case LabelFormat::dicom:
      return to_dicom_seg(labels, comment);
  }
  return fail(ErrorCode::unsupported, "no such format");
}

Result<std::string> to_names_toml(const JointLabels& labels) {
  const auto tissues = read_bundled_tissues();
  ARTUS_TRY(tissues);
  const auto known = item_names(*tissues);
  std::string out = "# Labels of a label map, for `artus import --labels`.\nformat = 1\n";
  for (std::size_t k = 0; k < labels.volume.segments.size(); ++k) {
    const std::string& tissue = labels.tissues[k];
    out += printed("\n[[label]]\nvalue = %.0f\nname = \"", labels.volume.segments[k].value) +
           labels.volume.segments[k].name + "\"\n";
    if (tissue == kBodyOutline || std::find(known.begin(), known.end(), tissue) != known.end())
      out += "tissue = \"" + tissue + "\"\n";
  }
  return out;
}

}  // namespace artus
