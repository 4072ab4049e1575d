// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/sequence_file.h"

#include <utility>

#include <zlib.h>

#include "artus/detail/core/check.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/exchange/faults.h"
#include "artus/detail/exchange/sequence_header.h"

namespace artus {
namespace {

constexpr int kLargestSide = 16384;          // pixels
constexpr std::size_t kMaxFrames = 1000000;  // that a file is believed to have

using Fields = SequenceHeader::Fields;

std::string frame_key(std::size_t i, const char* what) {
  return printed("Seq_Frame%04zu_%s", i, what);
}

void put(std::string& out, const std::string& key, const std::string& value) {
  out += key + " = " + value + "\n";
}

void put_matrix(std::string& out, std::size_t i, const char* name, const igtl::Matrix* matrix) {
  std::string numbers;
  for (Eigen::Index row = 0; row < 4; ++row)
    for (Eigen::Index column = 0; column < 4; ++column) {
      const double none = row == column ? 1 : 0;
      append_number(numbers, matrix != nullptr && row < 3 ? (*matrix)(row, column) : none);
      numbers += ' ';
    }
  numbers.pop_back();
  const std::string key = std::string(name) + "ToReferenceTransform";
  put(out, frame_key(i, key.c_str()), numbers);
  put(out, frame_key(i, (key + "Status").c_str()), matrix != nullptr ? "OK" : "INVALID");
}

std::vector<double> numbers_of(const Fields& fields, std::string_view key) {
  std::vector<double> numbers;
  const auto found = fields.find(key);
  if (found == fields.end()) return numbers;
  TextCursor cursor(found->second, std::string(key));
  while (const auto number = cursor.next_number()) numbers.push_back(*number);
  return numbers;
}

std::string_view text_of(const Fields& fields, std::string_view key) {
  const auto found = fields.find(key);
  return found == fields.end() ? std::string_view() : std::string_view(found->second);
}

/// nullopt when the tracker did not see it, or it is not there.
std::optional<igtl::Matrix> matrix_of(const Fields& fields, const std::string& name,
                                      const std::string& where, Faults& faults) {
  const std::string key = name + "ToReferenceTransform";
  const std::string_view status = text_of(fields, key + "Status");
  if (fields.count(key) == 0 || (!status.empty() && status != "OK")) return std::nullopt;
  const std::vector<double> numbers = numbers_of(fields, key);
  if (numbers.size() != 16) {
    faults.add(where + key, "a matrix must have 16 numbers");
    return std::nullopt;
  }
  igtl::Matrix matrix;
  for (Eigen::Index row = 0; row < 3; ++row)
    for (Eigen::Index column = 0; column < 4; ++column)
      matrix(row, column) = numbers[static_cast<std::size_t>(4 * row + column)];
  return matrix;
}

/// Width, height and number of frames, when the file is of the kind that is read.
Result<std::vector<std::size_t>> size_of(const Fields& fields, const std::string& name) {
  Faults kind;
  if (text_of(fields, "ElementType") != "MET_UCHAR")
    kind.add("ElementType", "only the pixels of 8-bit grey images can be read");
  if (text_of(fields, "ElementDataFile") != "LOCAL")
    kind.add("ElementDataFile", "only sequences with their data in the same file can be read");
  const std::string_view channels = text_of(fields, "ElementNumberOfChannels");
  if (!channels.empty() && channels != "1")
    kind.add("ElementNumberOfChannels", "only grey images can be read, not colour");
  const std::vector<double> numbers = numbers_of(fields, "DimSize");
  std::vector<std::size_t> size;
  for (const double n : numbers)
    if (n >= 1 && n <= static_cast<double>(kMaxFrames)) size.push_back(static_cast<std::size_t>(n));
  const bool wrong = size.size() != numbers.size() || (size.size() != 3 && size.size() != 4) ||
                     size[0] > kLargestSide || size[1] > kLargestSide ||
                     (size.size() == 4 && size[2] != 1);
  if (wrong) kind.add("DimSize", "it must be width, height and number of frames");
  if (!kind.empty())
    return kind.refusal(wrong ? ErrorCode::malformed : ErrorCode::unsupported, name);
  return std::vector<std::size_t>{size[0], size[1], size.back()};
}

SequenceFrame frame_of(const SequenceHeader& header, std::size_t i, Faults& faults) {
  SequenceFrame frame;
  const auto found = header.frames.find(i);
  if (found == header.frames.end()) return frame;
  const std::string where = frame_key(i, "");
  const Fields& fields = found->second;
  if (const auto image = matrix_of(fields, "Image", where, faults))
    frame.image_to_reference = *image;
  if (const auto probe = matrix_of(fields, "Probe", where, faults))
    frame.probe_to_reference = *probe;
  frame.needle_to_reference = matrix_of(fields, "Needle", where, faults);
  const std::vector<double> time = numbers_of(fields, "Timestamp");
  if (!time.empty()) frame.time = time.front();
  return frame;
}

/// The pixels as one run of bytes, expanded where they are compressed.
Result<std::string> pixels_of(const Fields& fields, std::string_view bytes, std::size_t wanted,
                              const std::string& name) {
  if (text_of(fields, "CompressedData") != "True") {
    if (bytes.size() < wanted)
      return fail(ErrorCode::corrupt, "there are fewer pixels than DimSize says", name);
    return std::string(bytes.substr(0, wanted));
  }
  constexpr std::size_t kMostExpanded = 1032;  // times, the most that deflate can do
  if (wanted / kMostExpanded > bytes.size())
    return fail(ErrorCode::corrupt, "there are fewer pixels than DimSize says", name);
  std::string out(wanted, '\0');
  uLongf size = wanted;
  const int code = uncompress(reinterpret_cast<Bytef*>(out.data()), &size,
                              reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  if (code != Z_OK || size != wanted)
    return fail(ErrorCode::corrupt,
                "the compressed pixels are damaged, or not as many as DimSize says", name);
  return out;
}

std::string compressed(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  const int code = compress(reinterpret_cast<Bytef*>(out.data()), &size,
                            reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  out.resize(code == Z_OK ? size : 0);
  return out;
}

}  // namespace

std::string to_mha(const ImageSequence& sequence, PixelCoding coding) {
  ARTUS_REQUIRE(!sequence.frames.empty(), "the sequence must have frames");
  std::string grey;
  for (const SequenceFrame& frame : sequence.frames)
    grey.append(frame.grey.begin(), frame.grey.end());
  if (coding == PixelCoding::zlib) grey = compressed(grey);
  std::string out =
      "ObjectType = Image\nNDims = 3\nAnatomicalOrientation = RAI\nBinaryData = True\n"
      "BinaryDataByteOrderMSB = False\nCenterOfRotation = 0 0 0\n";
  put(out, "CompressedData", coding == PixelCoding::zlib ? "True" : "False");
  if (coding == PixelCoding::zlib) put(out, "CompressedDataSize", std::to_string(grey.size()));
  put(out, "DimSize",
      std::to_string(sequence.width) + " " + std::to_string(sequence.height) + " " +
          std::to_string(sequence.frames.size()));
  out +=
      "ElementSpacing = 1 1 1\nKinds = domain domain list\nOffset = 0 0 0\n"
      "TransformMatrix = 1 0 0 0 1 0 0 0 1\nUltrasoundImageOrientation = MFA\n"
      "UltrasoundImageType = BRIGHTNESS\nModality = simulated ultrasound\n"
      "ElementType = MET_UCHAR\n";
  const auto pixels =
      static_cast<std::size_t>(sequence.width) * static_cast<std::size_t>(sequence.height);
  for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
    const SequenceFrame& frame = sequence.frames[i];
    ARTUS_REQUIRE(frame.grey.size() == pixels, "every frame must have the size of the sequence");
    std::string time;
    append_number(time, frame.time);
    put(out, frame_key(i, "FrameNumber"), std::to_string(i));
    put(out, frame_key(i, "ImageStatus"), "OK");
    put(out, frame_key(i, "Timestamp"), time);
    put_matrix(out, i, "Image", &frame.image_to_reference);
    put_matrix(out, i, "Probe", &frame.probe_to_reference);
    put_matrix(out, i, "Needle", frame.needle_to_reference ? &*frame.needle_to_reference : nullptr);
  }
  out += "ElementDataFile = LOCAL\n";
  return out + grey;
}

Result<void> write_mha(const std::filesystem::path& file, const ImageSequence& sequence,
                       PixelCoding coding) {
  return write_text(file, to_mha(sequence, coding));
}

Result<ImageSequence> parse_mha(std::string_view bytes, const std::string& name) {
  const auto header = parse_sequence_header(bytes, name);
  ARTUS_TRY(header);
  const auto size = size_of(header->fields, name);
  ARTUS_TRY(size);
  const std::size_t pixels = (*size)[0] * (*size)[1];
  const auto greys =
      pixels_of(header->fields, bytes.substr(header->bytes), pixels * (*size)[2], name);
  ARTUS_TRY(greys);
  ImageSequence sequence;
  sequence.width = static_cast<int>((*size)[0]);
  sequence.height = static_cast<int>((*size)[1]);
  Faults faults;
  for (std::size_t i = 0; i < (*size)[2]; ++i) {
    SequenceFrame frame = frame_of(*header, i, faults);
    const std::string_view grey = std::string_view(*greys).substr(i * pixels, pixels);
    frame.grey.assign(grey.begin(), grey.end());
    sequence.frames.push_back(std::move(frame));
  }
  if (!faults.empty()) return faults.refusal(ErrorCode::malformed, name);
  return sequence;
}

Result<ImageSequence> read_mha(const std::filesystem::path& file) {
  const auto bytes = read_bytes(file);
  ARTUS_TRY(bytes);
  return parse_mha(*bytes, file.string());
}

}  // namespace artus
