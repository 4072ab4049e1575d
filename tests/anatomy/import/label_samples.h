// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "artus/detail/anatomy/import/label_volume.h"
#include "artus/detail/anatomy/import/volumes/image_volume.h"

namespace artus::test {

/// The grid of a knee's scan: 0.365 x 0.365 x 0.7 mm, oblique.
inline IndexFrame oblique_frame(const Vec3& spacing_mm = {0.365, 0.365, 0.7}) {
  IndexFrame frame = IndexFrame::Identity();
  const Eigen::Matrix3d turned =
      (Eigen::AngleAxisd(0.3, Vec3::UnitX()) * Eigen::AngleAxisd(-0.2, Vec3::UnitZ()))
          .toRotationMatrix();
  frame.linear() = turned * (1e-3 * spacing_mm).asDiagonal();
  frame.translation() = Vec3(-0.02, 0.03, 0.9);
  return frame;
}

/// Labels by a function of the place (m from the grid's middle, along its axes).
inline LabelVolume painted(const std::array<std::size_t, 3>& size, const IndexFrame& frame,
                           const std::vector<std::string>& names,
                           const std::function<std::uint16_t(const Vec3&)>& label) {
  LabelVolume volume;
  volume.format = "test";
  volume.size = size;
  volume.X_LI = frame;
  for (std::size_t i = 0; i < names.size(); ++i)
    volume.segments.push_back({names[i], static_cast<double>(i + 1), {}, 0, 0});
  const Vec3 spacing = frame.linear().colwise().norm();
  const Vec3 middle(static_cast<double>(size[0] - 1) / 2, static_cast<double>(size[1] - 1) / 2,
                    static_cast<double>(size[2] - 1) / 2);
  for (std::size_t z = 0; z < size[2]; ++z)
    for (std::size_t y = 0; y < size[1]; ++y)
      for (std::size_t x = 0; x < size[0]; ++x) {
        const Vec3 index(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
        volume.labels.push_back(label((index - middle).cwiseProduct(spacing)));
        if (volume.labels.back() != 0) ++volume.segments[volume.labels.back() - 1U].n_voxels;
      }
  return volume;
}

/// Place of a point of the frame, m from the grid's middle along its axes.
inline Vec3 from_middle(const LabelVolume& volume, const Vec3& p) {
  const Vec3 spacing = volume.X_LI.linear().colwise().norm();
  const Vec3 middle(static_cast<double>(volume.size[0] - 1) / 2,
                    static_cast<double>(volume.size[1] - 1) / 2,
                    static_cast<double>(volume.size[2] - 1) / 2);
  return (volume.X_LI.inverse() * p - middle).cwiseProduct(spacing);
}

template <class T>
void put(std::string& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

/// The affine of a volume in mm of RAS, row by row.
inline Eigen::Matrix<double, 3, 4> ras_mm(const IndexFrame& X_LI) {
  return 1e3 * (Vec3(-1, -1, 1).asDiagonal() * X_LI.matrix().topRows<3>());
}

/// A NIfTI-1 of labels as bytes, with a label table unless there are no names.
inline std::string nifti_of(const LabelVolume& volume, bool named = true) {
  std::string table;
  if (named) {
    table = "<LabelTable>";
    for (std::size_t i = 0; i < volume.segments.size(); ++i)
      table += "<Label Key=\"" + std::to_string(i + 1) + "\"><![CDATA[" + volume.segments[i].name +
               "]]></Label>";
    table += "</LabelTable>";
  }
  const std::size_t extension = named ? (8 + table.size() + 15) / 16 * 16 : 0;
  const std::size_t offset = 352 + extension;
  std::string bytes(offset, '\0');
  put<std::int32_t>(bytes, 0, 348);
  put<std::int16_t>(bytes, 40, 3);
  for (std::size_t i = 0; i < 7; ++i)
    put<std::int16_t>(bytes, 42 + 2 * i,
                      i < 3 ? static_cast<std::int16_t>(volume.size.at(i)) : std::int16_t{1});
  put<std::int16_t>(bytes, 70, 512);
  put<std::int16_t>(bytes, 72, 16);
  put<float>(bytes, 76, 1);
  for (std::size_t i = 0; i < 3; ++i)
    put<float>(bytes, 80 + 4 * i,
               static_cast<float>(1e3 * volume.X_LI.linear().col(static_cast<int>(i)).norm()));
  put<float>(bytes, 108, static_cast<float>(offset));
  bytes[123] = 2;
  put<std::int16_t>(bytes, 254, 1);
  const auto ras = ras_mm(volume.X_LI);
  for (std::size_t i = 0; i < 12; ++i)
    put<float>(bytes, 280 + 4 * i,
               static_cast<float>(ras(static_cast<int>(i / 4), static_cast<int>(i % 4))));
  bytes.replace(344, 3, "n+1");
  if (named) {
    bytes[348] = 1;
    put<std::int32_t>(bytes, 352, static_cast<std::int32_t>(extension));
    bytes.replace(360, table.size(), table);
  }
  return bytes +
         std::string(reinterpret_cast<const char*>(volume.labels.data()), volume.labels.size() * 2);
}

inline std::string number_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// "(x,y,z)" of a column in mm.
inline std::string vector_text(const Vec3& v, const char* open = "(", const char* between = ",",
                               const char* close = ")") {
  return open + number_text(v.x()) + between + number_text(v.y()) + between + number_text(v.z()) +
         close;
}

/// An NRRD of labels; with names a .seg.nrrd of one layer.
inline std::string nrrd_of(const LabelVolume& volume, bool named = true,
                           const std::string& data = {}, const std::string& encoding = "raw") {
  const Eigen::Matrix3d m = 1e3 * volume.X_LI.linear();
  std::string text =
      "NRRD0004\ntype: unsigned short\ndimension: 3\nspace: left-posterior-superior\nsizes: " +
      std::to_string(volume.size[0]) + " " + std::to_string(volume.size[1]) + " " +
      std::to_string(volume.size[2]) + "\nspace directions: " + vector_text(m.col(0)) + " " +
      vector_text(m.col(1)) + " " + vector_text(m.col(2)) +
      "\nkinds: domain domain domain\nendian: little\nencoding: " + encoding +
      "\nspace origin: " + vector_text(1e3 * volume.X_LI.translation()) + "\n";
  for (std::size_t i = 0; named && i < volume.segments.size(); ++i) {
    const std::string prefix = "Segment" + std::to_string(i) + "_";
    text += prefix + "Name:=" + volume.segments[i].name + "\n" + prefix + "Layer:=0\n" + prefix +
            "LabelValue:=" + std::to_string(i + 1) + "\n";
  }
  return text + "\n" +
         (data.empty() ? std::string(reinterpret_cast<const char*>(volume.labels.data()),
                                     volume.labels.size() * 2)
                       : data);
}

/// A MetaImage of labels.
inline std::string mha_of(const LabelVolume& volume) {
  const Eigen::Matrix3d m = volume.X_LI.linear();
  const Vec3 spacing = m.colwise().norm();
  std::string matrix;
  for (int i = 0; i < 9; ++i) matrix += number_text(m(i % 3, i / 3) / spacing[i / 3]) + " ";
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = "
         "False\nCompressedData = False\nTransformMatrix = " +
         matrix + "\nOffset = " + vector_text(1e3 * volume.X_LI.translation(), "", " ", "") +
         "\nElementSpacing = " + vector_text(1e3 * spacing, "", " ", "") +
         "\nDimSize = " + std::to_string(volume.size[0]) + " " + std::to_string(volume.size[1]) +
         " " + std::to_string(volume.size[2]) +
         "\nElementType = MET_USHORT\nElementDataFile = LOCAL\n" +
         std::string(reinterpret_cast<const char*>(volume.labels.data()), volume.labels.size() * 2);
}

}  // namespace artus::test
