// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>

#include "artus/detail/anatomy/import/volumes/image_volume.h"
#include "artus/detail/anatomy/import/volumes/volume_text.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_lines.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

/// "Key = value" lines up to ElementDataFile, and what follows it.
struct MetaText {
  HeaderText fields;
  std::string_view data;
};

Result<MetaText> split_meta(std::string_view bytes, const std::string& name) {
  MetaText text;
  std::size_t number = 0;
  while (const auto line = take_line(bytes)) {
    const auto parts = key_and_value(*line, '=', "a MetaImage header is 'Key = value'",
                                     name + ":" + std::to_string(++number));
    ARTUS_TRY(parts);
    const std::string key = to_lower(parts->first);
    text.fields[key] = parts->second;
    if (key == "elementdatafile") break;
  }
  text.data = bytes;
  return text;
}

Result<SampleType> meta_type(const std::string& word, const std::string& name) {
  constexpr std::array<std::pair<std::string_view, SampleType>, 10> kTypes{
      {{"met_uchar", SampleType::u8},
       {"met_char", SampleType::i8},
       {"met_ushort", SampleType::u16},
       {"met_short", SampleType::i16},
       {"met_uint", SampleType::u32},
       {"met_int", SampleType::i32},
       {"met_ulong_long", SampleType::u64},
       {"met_long_long", SampleType::i64},
       {"met_float", SampleType::f32},
       {"met_double", SampleType::f64}}};
  return sample_type_of(word, kTypes, name);
}

bool is_true(const HeaderText& fields, std::string_view key) {
  return to_lower(text_of(fields, key)) == "true";
}

std::vector<double> numbers_at(const HeaderText& fields,
                               std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys)
    if (fields.contains(key))
      return numbers_of(text_of(fields, key)).value_or(std::vector<double>());
  return {};
}

/// MetaImage's frame is LPS whatever AnatomicalOrientation names: ITK writes RAI for it.
Result<IndexFrame> meta_frame(const HeaderText& fields, ImageVolume& volume,
                              const std::string& name) {
  const auto spacing = numbers_at(fields, {"elementspacing", "elementsize"});
  const auto matrix = numbers_at(fields, {"transformmatrix", "rotation", "orientation"});
  const auto offset = numbers_at(fields, {"offset", "position", "origin"});
  if (spacing.size() != 3)
    return fail(ErrorCode::malformed, "its header has no three numbers of ElementSpacing", name);
  if (matrix.empty())
    volume.notes.push_back("the header names no directions: the axes are those of LPS");
  else if (matrix.size() != 9)
    return fail(ErrorCode::malformed, "its TransformMatrix has no nine numbers", name);
  IndexFrame frame = IndexFrame::Identity();
  for (int i = 0; i < 9 && !matrix.empty(); ++i)
    frame.linear()(i % 3, i / 3) = matrix[static_cast<std::size_t>(i)];
  frame.linear() =
      frame.linear() * (kMillimetre * Vec3(spacing[0], spacing[1], spacing[2])).asDiagonal();
  if (offset.size() == 3)
    frame.translation() = kMillimetre * Vec3(offset[0], offset[1], offset[2]);
  else
    volume.notes.push_back("the header has no Offset: the first voxel is the origin");
  ARTUS_TRY(check_frame(frame, name));
  return frame;
}

}  // namespace

Result<ImageVolume> parse_metaimage(std::string_view bytes, const std::string& name) {
  const auto text = split_meta(bytes, name);
  ARTUS_TRY(text);
  const HeaderText& fields = text->fields;
  ImageVolume volume;
  volume.format = "MetaImage";
  if (to_lower(text_of(fields, "elementdatafile")) != "local")
    return fail(ErrorCode::unsupported,
                "its voxels are in another file; save it as one .mha (ElementDataFile = LOCAL)",
                name);
  const auto sizes = numbers_at(fields, {"dimsize"});
  if (sizes.size() != 3 || text_of(fields, "ndims") != "3")
    return fail(ErrorCode::unsupported,
                "it is no volume of three axes (NDims, DimSize); save one label map", name);
  const std::string channels = text_of(fields, "elementnumberofchannels");
  if (!channels.empty() && channels != "1")
    return fail(ErrorCode::unsupported,
                "it holds colours or vectors, not labels; save the label map itself", name);
  for (std::size_t i = 0; i < 3; ++i) volume.size[i] = whole_of(sizes[i]);
  ARTUS_TRY(count_voxels(volume.size, name));
  const auto type = meta_type(to_lower(text_of(fields, "elementtype")), name);
  ARTUS_TRY(type);
  volume.type = *type;
  const auto frame = meta_frame(fields, volume, name);
  ARTUS_TRY(frame);
  volume.X_LI = *frame;
  const bool big =
      is_true(fields, "elementbyteordermsb") || is_true(fields, "binarydatabyteordermsb");
  ARTUS_TRY(take_samples(text->data, is_true(fields, "compresseddata"), big, volume, name));
  return volume;
}

}  // namespace artus
