// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/sequence_file.h"

#include <algorithm>
#include <map>
#include <utility>

#include "artus/detail/core/check.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/text_lines.h"
#include "artus/detail/exchange/reference_frame.h"

namespace artus {
namespace {

constexpr int kLargestSide = 16384;          // pixels
constexpr std::size_t kMaxFrames = 1000000;  // that a file is believed to have

using Fields = std::map<std::string, std::string, std::less<>>;

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

/// The header's fields; `bytes` goes on behind it.
Result<Fields> take_fields(std::string_view& bytes, const std::string& name) {
  Fields fields;
  for (std::size_t line = 1;; ++line) {
    const std::size_t end = bytes.find('\n');
    const std::string_view text = bytes.substr(0, end);
    const std::size_t equals = text.find('=');
    if (end == std::string_view::npos || equals == std::string_view::npos)
      return fail(ErrorCode::malformed, "a header line must be 'key = value'",
                  name + ":" + std::to_string(line));
    bytes.remove_prefix(end + 1);
    const std::string key(trimmed(text.substr(0, equals)));
    fields[key] = std::string(trimmed(text.substr(equals + 1)));
    if (key == "ElementDataFile") return fields;
  }
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
Result<std::optional<igtl::Matrix>> matrix_of(const Fields& fields, std::size_t i,
                                              const std::string& name) {
  const std::string key = frame_key(i, (name + "ToReferenceTransform").c_str());
  const std::string_view status = text_of(fields, key + "Status");
  if (fields.count(key) == 0 || (!status.empty() && status != "OK")) return std::nullopt;
  const std::vector<double> numbers = numbers_of(fields, key);
  if (numbers.size() != 16) return fail(ErrorCode::malformed, "a matrix must have 16 numbers", key);
  igtl::Matrix matrix;
  for (Eigen::Index row = 0; row < 3; ++row)
    for (Eigen::Index column = 0; column < 4; ++column)
      matrix(row, column) = numbers[static_cast<std::size_t>(4 * row + column)];
  return matrix;
}

/// Width, height and number of frames, when the file is of the kind that is read.
Result<std::vector<std::size_t>> size_of(const Fields& fields, const std::string& name) {
  const auto refuse = [&](const char* why) {
    return fail(ErrorCode::unsupported, why, name);
  };
  if (text_of(fields, "ElementType") != "MET_UCHAR")
    return refuse("only 8-bit grey images can be read");
  if (text_of(fields, "CompressedData") == "True") return refuse("compressed data cannot be read");
  if (text_of(fields, "ElementDataFile") != "LOCAL")
    return refuse("only sequences with their data in the same file can be read");
  const std::string_view channels = text_of(fields, "ElementNumberOfChannels");
  if (!channels.empty() && channels != "1")
    return refuse("only grey images can be read, not colour");
  const std::vector<double> numbers = numbers_of(fields, "DimSize");
  std::vector<std::size_t> size;
  for (const double n : numbers)
    if (n >= 1 && n <= static_cast<double>(kMaxFrames)) size.push_back(static_cast<std::size_t>(n));
  if (size.size() != numbers.size() || (size.size() != 3 && size.size() != 4) ||
      size[0] > kLargestSide || size[1] > kLargestSide || (size.size() == 4 && size[2] != 1))
    return fail(ErrorCode::malformed, "DimSize must be width, height and number of frames", name);
  return std::vector<std::size_t>{size[0], size[1], size.back()};
}

Result<SequenceFrame> frame_of(const Fields& fields, std::size_t i) {
  SequenceFrame frame;
  const auto image = matrix_of(fields, i, "Image");
  ARTUS_TRY(image);
  const auto probe = matrix_of(fields, i, "Probe");
  ARTUS_TRY(probe);
  const auto needle = matrix_of(fields, i, "Needle");
  ARTUS_TRY(needle);
  if (*image) frame.image_to_reference = **image;
  if (*probe) frame.probe_to_reference = **probe;
  frame.needle_to_reference = *needle;
  const std::vector<double> time = numbers_of(fields, frame_key(i, "Timestamp"));
  if (!time.empty()) frame.time = time.front();
  return frame;
}

}  // namespace

std::string to_mha(const ImageSequence& sequence) {
  ARTUS_REQUIRE(!sequence.frames.empty(), "the sequence must have frames");
  std::string out =
      "ObjectType = Image\nNDims = 3\nAnatomicalOrientation = RAI\nBinaryData = True\n"
      "BinaryDataByteOrderMSB = False\nCenterOfRotation = 0 0 0\nCompressedData = False\n";
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
  for (const SequenceFrame& frame : sequence.frames)
    out.append(frame.grey.begin(), frame.grey.end());
  return out;
}

Result<void> write_mha(const std::filesystem::path& file, const ImageSequence& sequence) {
  return write_text(file, to_mha(sequence));
}

Result<ImageSequence> parse_mha(std::string_view bytes, const std::string& name) {
  const auto fields = take_fields(bytes, name);
  ARTUS_TRY(fields);
  const auto size = size_of(*fields, name);
  ARTUS_TRY(size);
  const std::size_t pixels = (*size)[0] * (*size)[1];
  if (bytes.size() / pixels < (*size)[2])
    return fail(ErrorCode::corrupt, "there are fewer pixels than DimSize says", name);
  ImageSequence sequence;
  sequence.width = static_cast<int>((*size)[0]);
  sequence.height = static_cast<int>((*size)[1]);
  for (std::size_t i = 0; i < (*size)[2]; ++i) {
    auto frame = frame_of(*fields, i);
    ARTUS_TRY(frame);
    const std::string_view grey = bytes.substr(i * pixels, pixels);
    frame->grey.assign(grey.begin(), grey.end());
    sequence.frames.push_back(std::move(*frame));
  }
  return sequence;
}

Result<ImageSequence> read_mha(const std::filesystem::path& file) {
  const auto bytes = read_bytes(file);
  ARTUS_TRY(bytes);
  return parse_mha(*bytes, file.string());
}

Result<std::vector<ListedPose>> poses_of(const ImageSequence& sequence) {
  const ReferenceFrame reference;
  std::vector<ListedPose> poses;
  for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
    const SequenceFrame& frame = sequence.frames[i];
    if (frame.probe_to_reference.isZero()) continue;  // not seen
    const std::string where = "frame " + std::to_string(i);
    const auto probe = reference.from_reference(frame.probe_to_reference);
    if (!probe) return fail(ErrorCode::invalid, probe.error().message, where);
    ListedPose pose;
    pose.X_JP = *probe;
    pose.time = frame.time;
    if (poses.size() > 0 && *poses.back().time >= frame.time)
      return fail(ErrorCode::invalid, "the time must rise from frame to frame", where);
    if (frame.needle_to_reference) {
      const auto needle = reference.from_reference(*frame.needle_to_reference);
      if (!needle) return fail(ErrorCode::invalid, needle.error().message, where);
      pose.X_JN = *needle;
    }
    poses.push_back(std::move(pose));
  }
  if (poses.empty())
    return fail(ErrorCode::invalid, "no frame has a ProbeToReferenceTransform that is OK");
  return poses;
}

}  // namespace artus
