// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/core/result.h"

/// What the bodies of OpenIGTLink messages mean, by type. pack_... gives Message::content,
/// parse_... reads it. Lengths are millimetres and directions RAS, as every program of the field
/// takes them. Errors of parse_...: malformed (length), invalid (values that cannot be). Source
/// [OpenIGTLink] message specifications.
namespace artus::igtl {

/// Rotation (or directions) and translation, mm.
using Matrix = Eigen::Matrix<double, 3, 4>;

/// TRANSFORM: a matrix in single precision. invalid: a number that is not finite.
[[nodiscard]] std::string pack_transform(const Matrix& matrix);
[[nodiscard]] Result<Matrix> parse_transform(std::string_view content);

/// POSITION: a place and a quaternion, which may be left out (12 bytes) or packed without its w
/// (24). invalid: a number that is not finite, a quaternion whose norm is not 0.9 to 1.1.
[[nodiscard]] std::string pack_position(const Matrix& matrix);
[[nodiscard]] Result<Matrix> parse_position(std::string_view content);

/// TDATA and QTDATA: the tools of a tracker, each with its name and place. invalid: as above.
struct TrackedTool {
  std::string name;  ///< at most 20 bytes
  Matrix matrix = Matrix::Zero();
};
[[nodiscard]] std::string pack_tdata(const std::vector<TrackedTool>& tools);
[[nodiscard]] Result<std::vector<TrackedTool>> parse_tdata(std::string_view content);
[[nodiscard]] std::string pack_qtdata(const std::vector<TrackedTool>& tools);
[[nodiscard]] Result<std::vector<TrackedTool>> parse_qtdata(std::string_view content);
/// STT_TDATA and STT_QTDATA: "send at most every so many milliseconds". `of`: "TDATA" or "QTDATA";
/// the frame's name has 32 bytes in the first and 128 in the second.
[[nodiscard]] std::string pack_start_tracking(std::string_view of, std::int32_t milliseconds);

/// IMAGE: an 8-bit grey picture and where it lies.
struct Image {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  /// Columns: a pixel to the right, a pixel down, the slice's normal times a pixel, then the place
  /// of pixel (0, 0); mm. The message itself carries the picture's middle.
  Matrix image_to_reference = Matrix::Zero();
  std::string_view grey;  ///< (height, width), x fastest
};
/// Requires: 1 to 65535 pixels a side, as many bytes as pixels.
[[nodiscard]] std::string pack_image(const Image& image);
/// `grey` looks into `content`. unsupported: not one byte a pixel, not one slice, or a part of one.
[[nodiscard]] Result<Image> parse_image(std::string_view content);

/// STRING.
[[nodiscard]] std::string pack_string(std::string_view text);
[[nodiscard]] Result<std::string> parse_string(std::string_view content);

/// SENSOR: at most 255 numbers in one unit.
struct Sensor {
  std::uint64_t unit = 0;  ///< coded, see kNewton
  std::vector<double> values;
};
/// The protocol's code for newton: no prefix, SI unit 0x0B, to the power of one.
/// Source [OpenIGTLink] unit specification.
inline constexpr std::uint64_t kNewton = 0x02C4000000000000;
/// The same for metre, SI unit 0x01.
inline constexpr std::uint64_t kMetre = 0x0044000000000000;
/// Pascal, SI unit 0x0C; cubic metre; cubic metre a second (second: SI unit 0x03).
inline constexpr std::uint64_t kPascal = 0x0304000000000000;
inline constexpr std::uint64_t kCubicMetre = 0x004C000000000000;
inline constexpr std::uint64_t kCubicMetrePerSecond = 0x004C3F0000000000;
[[nodiscard]] std::string pack_sensor(const Sensor& sensor);
[[nodiscard]] Result<Sensor> parse_sensor(std::string_view content);

/// STATUS.
struct Status {
  static constexpr std::uint16_t kOk = 1;
  std::uint16_t code = kOk;
  std::int64_t subcode = 0;
  std::string error;  ///< at most 20 bytes
  std::string message;
};
[[nodiscard]] std::string pack_status(const Status& status);
[[nodiscard]] Result<Status> parse_status(std::string_view content);

/// COMMAND, and RTS_COMMAND that answers it with the same number.
struct CommandText {
  std::uint32_t number = 0;
  std::string name;             ///< at most `name_bytes`
  std::uint16_t encoding = 3;   ///< MIBenum
  std::string content;          ///< XML by custom
  std::size_t name_bytes = 20;  ///< of the field: 20 by the specification, 128 in newer libraries
};
[[nodiscard]] std::string pack_command(const CommandText& command);
[[nodiscard]] Result<CommandText> parse_command(std::string_view content);

/// CAPABILITY: the types that the sender knows.
[[nodiscard]] std::string pack_capability(const std::vector<std::string>& types);
[[nodiscard]] Result<std::vector<std::string>> parse_capability(std::string_view content);

/// Whether a content can be of its type at all. Errors: malformed, as the type's parse_ function;
/// none for types that have no such function.
[[nodiscard]] Result<void> check_form(std::string_view type, std::string_view content);

}  // namespace artus::igtl
