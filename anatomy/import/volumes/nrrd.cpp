// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <map>

#include "artus/detail/anatomy/import/volumes/image_volume.h"
#include "artus/detail/anatomy/import/volumes/volume_text.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_lines.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

/// The header's fields and key/value pairs, and what follows it.
struct NrrdText {
  HeaderText fields;
  std::map<std::string, std::string, std::less<>> pairs;  ///< "Segment0_Name" in its own case
  std::string_view data;
};

Result<NrrdText> split_header(std::string_view bytes, const std::string& name) {
  NrrdText text;
  for (std::size_t number = 1;; ++number) {
    const auto line = take_line(bytes);
    if (!line)  // a header without data ends with the file
      return fail(ErrorCode::corrupt,
                  "no voxels follow its header; it is not complete, or its voxels are in another "
                  "file: save it as one .nrrd",
                  name);
    if (line->empty()) break;
    if (number == 1 || line->front() == '#') continue;
    const auto parts = key_and_value(*line, ':', "an NRRD header is 'field: value'",
                                     name + ":" + std::to_string(number));
    ARTUS_TRY(parts);
    const auto& [key, value] = *parts;
    if (value.starts_with('=') && line->find(":=") == line->find(':'))
      text.pairs[std::string(key)] = trimmed(value.substr(1));
    else
      text.fields[to_lower(key)] = value;
  }
  text.data = bytes;
  return text;
}

Result<SampleType> nrrd_type(const std::string& word, const std::string& name) {
  constexpr std::array<std::pair<std::string_view, SampleType>, 40> kTypes{
      {{"signed char", SampleType::i8},
       {"int8", SampleType::i8},
       {"int8_t", SampleType::i8},
       {"uchar", SampleType::u8},
       {"unsigned char", SampleType::u8},
       {"uint8", SampleType::u8},
       {"uint8_t", SampleType::u8},
       {"short", SampleType::i16},
       {"short int", SampleType::i16},
       {"signed short", SampleType::i16},
       {"signed short int", SampleType::i16},
       {"int16", SampleType::i16},
       {"int16_t", SampleType::i16},
       {"ushort", SampleType::u16},
       {"unsigned short", SampleType::u16},
       {"unsigned short int", SampleType::u16},
       {"uint16", SampleType::u16},
       {"uint16_t", SampleType::u16},
       {"int", SampleType::i32},
       {"signed int", SampleType::i32},
       {"int32", SampleType::i32},
       {"int32_t", SampleType::i32},
       {"uint", SampleType::u32},
       {"unsigned int", SampleType::u32},
       {"uint32", SampleType::u32},
       {"uint32_t", SampleType::u32},
       {"longlong", SampleType::i64},
       {"long long", SampleType::i64},
       {"long long int", SampleType::i64},
       {"signed long long", SampleType::i64},
       {"signed long long int", SampleType::i64},
       {"int64", SampleType::i64},
       {"int64_t", SampleType::i64},
       {"ulonglong", SampleType::u64},
       {"unsigned long long", SampleType::u64},
       {"unsigned long long int", SampleType::u64},
       {"uint64", SampleType::u64},
       {"uint64_t", SampleType::u64},
       {"float", SampleType::f32},
       {"double", SampleType::f64}}};
  return sample_type_of(word, kTypes, name);
}

/// Axes of space as the file has them; the list axis, if any, is its place among all axes.
struct NrrdAxes {
  std::vector<std::size_t> sizes;
  std::optional<std::size_t> list;
};

Result<NrrdAxes> read_axes(const NrrdText& text, const std::string& name) {
  NrrdAxes axes;
  const auto sizes = numbers_of(text_of(text.fields, "sizes"));
  const auto dimension = numbers_of(text_of(text.fields, "dimension"));
  if (!sizes || !dimension || dimension->size() != 1 ||
      static_cast<double>(sizes->size()) != dimension->front())
    return fail(ErrorCode::malformed, "'dimension' and 'sizes' of its header do not agree", name);
  for (const double size : *sizes) {
    axes.sizes.push_back(whole_of(size));
    if (axes.sizes.back() == 0)
      return fail(ErrorCode::invalid, "a size of the volume is 0 or no whole number", name);
  }
  if (axes.sizes.size() == 3) return axes;
  const auto kinds = words_of_line(to_lower(text_of(text.fields, "kinds")));
  const bool is_colour = std::any_of(kinds.begin(), kinds.end(), [](const std::string& k) {
    return k.find("color") != std::string::npos || k.find("vector") != std::string::npos;
  });
  if (is_colour)
    return fail(ErrorCode::unsupported,
                "it holds colours or vectors, not labels; save the label map itself", name);
  if (axes.sizes.size() != 4 || kinds.size() != 4 || kinds[0] != "list")
    return fail(ErrorCode::unsupported,
                printed("it has %zu axes; a label map has three, and a .seg.nrrd of 3D Slicer one "
                        "of layers (kind 'list') before them: save one volume",
                        axes.sizes.size()),
                name);
  axes.list = 0;
  return axes;
}

/// One vector in brackets for each axis; "none" is skipped.
std::optional<Eigen::Matrix3d> directions_of(std::string text) {
  for (auto at = text.find("none"); at != std::string::npos; at = text.find("none"))
    text.replace(at, 4, "    ");
  const auto numbers = numbers_of(text);
  if (!numbers || numbers->size() != 9) return std::nullopt;
  Eigen::Matrix3d m;
  for (int i = 0; i < 9; ++i) m(i % 3, i / 3) = (*numbers)[static_cast<std::size_t>(i)];
  return m;
}

Result<IndexFrame> nrrd_frame(const NrrdText& text, ImageVolume& volume, const std::string& name) {
  const std::string space = text_of(text.fields, "space");
  const auto signs = signs_of_space(space);
  if (!signs)
    return fail(ErrorCode::invalid,
                "it does not say where it lies in the body (space: " +
                    (space.empty() ? std::string("not there") : quoted(std::string_view(space))) +
                    "); save it with a space as left-posterior-superior",
                name);
  const auto directions = directions_of(text_of(text.fields, "space directions"));
  if (!directions)
    return fail(ErrorCode::malformed, "'space directions' of its header are not three vectors",
                name);
  const auto origin = numbers_of(text_of(text.fields, "space origin"));
  IndexFrame frame = IndexFrame::Identity();
  double unit = kMillimetre;
  const std::string units = to_lower(text_of(text.fields, "space units"));
  if (units.find("\"cm\"") != std::string::npos) unit = 1e-2;
  if (units.find("\"m\"") != std::string::npos) unit = 1;
  frame.linear() = unit * (signs->asDiagonal() * *directions);
  if (origin && origin->size() == 3)
    frame.translation() =
        unit * signs->cwiseProduct(Vec3((*origin)[0], (*origin)[1], (*origin)[2]));
  else
    volume.notes.push_back("the header has no 'space origin': the first voxel is the origin");
  ARTUS_TRY(check_frame(frame, name));
  return frame;
}

/// "Segmentation category...~SCT^85756007^Tissue~SCT^272673000^Bone~^^~..." or the tag's whole
/// text: scheme and code of the type, the third entry.
std::string code_of_tags(std::string_view tags) {
  constexpr std::string_view kKey = "TerminologyEntry:";
  const auto at = tags.find(kKey);
  if (at == std::string_view::npos) return {};
  tags.remove_prefix(at + kKey.size());
  tags = tags.substr(0, tags.find('|'));
  for (int skip = 0; skip < 2; ++skip) {
    const auto tilde = tags.find('~');
    if (tilde == std::string_view::npos) return {};
    tags.remove_prefix(tilde + 1);
  }
  tags = tags.substr(0, tags.find('~'));
  const auto first = tags.find('^');
  if (first == std::string_view::npos || first == 0) return {};
  const auto second = tags.find('^', first + 1);
  return std::string(tags.substr(0, first)) + " " +
         std::string(tags.substr(first + 1, second == std::string_view::npos
                                                ? std::string_view::npos
                                                : second - first - 1));
}

void read_segments(const NrrdText& text, ImageVolume& volume) {
  constexpr std::size_t kMost = 65535;
  for (std::size_t i = 0; i < kMost; ++i) {
    const std::string prefix = "Segment" + std::to_string(i) + "_";
    const auto named = text.pairs.find(prefix + "Name");
    if (named == text.pairs.end()) return;
    const auto number = [&](const char* key, double other) {
      return parse_number(text_of(text.pairs, prefix + key)).value_or(other);
    };
    SegmentName segment;
    segment.name = named->second;
    const double layer = number("Layer", 0);
    segment.layer = layer > 0 ? whole_of(layer) : 0;
    segment.value = number("LabelValue", volume.layers > 1 ? 1 : static_cast<double>(i + 1));
    segment.code = code_of_tags(text_of(text.pairs, prefix + "Tags"));
    volume.segments.push_back(std::move(segment));
  }
}

}  // namespace

Result<ImageVolume> parse_nrrd(std::string_view bytes, const std::string& name) {
  const auto text = split_header(bytes, name);
  ARTUS_TRY(text);
  const HeaderText& fields = text->fields;
  ImageVolume volume;
  volume.format = text->pairs.contains("Segment0_Name") ? "segmentation of 3D Slicer" : "NRRD";
  if (fields.contains("data file") || fields.contains("datafile"))
    return fail(ErrorCode::unsupported,
                "its voxels are in another file; save it as one .nrrd (attached header)", name);
  const auto type = nrrd_type(to_lower(text_of(fields, "type")), name);
  ARTUS_TRY(type);
  volume.type = *type;
  const auto axes = read_axes(*text, name);
  ARTUS_TRY(axes);
  const std::size_t first = axes->list ? 1 : 0;
  if (axes->list) volume.layers = axes->sizes[0];
  constexpr std::size_t kMostLayers = 256;
  if (volume.layers > kMostLayers)
    return fail(ErrorCode::unsupported,
                printed("%zu layers are more than are read (%zu); export the segments as one label "
                        "map",
                        volume.layers, kMostLayers),
                name);
  for (std::size_t i = 0; i < 3; ++i) volume.size[i] = axes->sizes[first + i];
  ARTUS_TRY(count_voxels(volume.size, name));
  const auto frame = nrrd_frame(*text, volume, name);
  ARTUS_TRY(frame);
  volume.X_LI = *frame;
  const std::string encoding = to_lower(text_of(fields, "encoding"));
  const bool compressed = encoding == "gzip" || encoding == "gz";
  if (!compressed && encoding != "raw")
    return fail(ErrorCode::unsupported,
                "data in encoding " + quoted(std::string_view(encoding)) +
                    " are not read; save it as raw or gzip",
                name);
  if (fields.contains("line skip") || fields.contains("byte skip"))
    return fail(ErrorCode::unsupported, "'line skip' and 'byte skip' are not read; save it anew",
                name);
  const bool big = to_lower(text_of(fields, "endian")) == "big";
  ARTUS_TRY(take_samples(text->data, compressed, big, volume, name));
  read_segments(*text, volume);
  return volume;
}

}  // namespace artus
