// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/igtl/contents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "artus/detail/core/check.h"
#include "artus/detail/exchange/igtl/big_endian.h"

namespace artus::igtl {
namespace {

constexpr std::array<std::size_t, 2> kCommandNameSizes{20, 128};  // bytes, see CommandText
constexpr std::size_t kErrorNameSize = 20;                        // bytes
constexpr std::size_t kTypeNameSize = 12;                         // bytes of a type in a CAPABILITY

tl::unexpected<Error> wrong_length(const char* type) {
  return fail(ErrorCode::malformed, std::string(type) + ": its length does not match its content");
}

/// Twelve single-precision numbers, column by column.
void put_matrix(BigEndianWriter& out, const Matrix& matrix) {
  for (Eigen::Index j = 0; j < 4; ++j)
    for (Eigen::Index i = 0; i < 3; ++i) out.put(static_cast<float>(matrix(i, j)));
}

Matrix get_matrix(BigEndianReader& in) {
  Matrix matrix;
  for (Eigen::Index j = 0; j < 4; ++j)
    for (Eigen::Index i = 0; i < 3; ++i) matrix(i, j) = static_cast<double>(in.get<float>());
  return matrix;
}

constexpr std::size_t kToolNameSize = 20;  // bytes of a tool in TDATA and QTDATA

/// The rest of a quaternion that is sent without its w has a positive one.
Result<Matrix> placed(const std::array<double, 3>& p, double x, double y, double z, double w,
                      const char* type) {
  Matrix matrix;
  const Eigen::Quaterniond q(w, x, y, z);
  const double norm = q.norm();
  if (!(norm >= 0.9 && norm <= 1.1))
    return fail(ErrorCode::invalid, std::string(type) + ": a quaternion's norm is not 1");
  matrix.leftCols<3>() = q.normalized().toRotationMatrix();
  matrix.col(3) = Vec3(p[0], p[1], p[2]);
  if (!matrix.allFinite())
    return fail(ErrorCode::invalid, std::string(type) + ": a number is not finite");
  return matrix;
}

std::array<double, 3> get_place(BigEndianReader& in) {
  std::array<double, 3> p{};
  for (double& value : p) value = static_cast<double>(in.get<float>());
  return p;
}

void put_quaternion(BigEndianWriter& out, const Matrix& matrix) {
  for (Eigen::Index i = 0; i < 3; ++i) out.put(static_cast<float>(matrix(i, 3)));
  const Eigen::Quaterniond q(Eigen::Matrix3d(matrix.leftCols<3>()));
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) out.put(static_cast<float>(value));
}

/// Tools with their poses as `put` writes one.
template <class Put>
std::string pack_tools(const std::vector<TrackedTool>& tools, const Put& put) {
  BigEndianWriter out;
  for (const TrackedTool& tool : tools) {
    out.put_padded(tool.name, kToolNameSize);
    out.put(std::uint8_t{2});  // a tool with six degrees of freedom
    out.put(std::uint8_t{0});
    put(out, tool.matrix);
  }
  return std::move(out.bytes());
}

/// Its inverse; `get` reads a pose, or says what is wrong with it.
template <class Get>
Result<std::vector<TrackedTool>> parse_tools(std::string_view content, const Get& get) {
  BigEndianReader in(content);
  std::vector<TrackedTool> tools;
  while (!in.at_end()) {
    TrackedTool tool;
    tool.name = in.get_padded(kToolNameSize);
    static_cast<void>(in.get_bytes(2));
    const Result<Matrix> matrix = get(in);
    ARTUS_TRY(matrix);
    tool.matrix = *matrix;
    tools.push_back(std::move(tool));
  }
  return tools;
}

/// From the corner pixel to the picture's middle, in the matrix's own lengths.
Vec3 corner_to_middle(const Matrix& m, int width, int height) {
  return 0.5 * (width - 1) * m.col(0) + 0.5 * (height - 1) * m.col(1);
}

}  // namespace

std::string pack_transform(const Matrix& matrix) {
  BigEndianWriter out;
  put_matrix(out, matrix);
  return std::move(out.bytes());
}

Result<Matrix> parse_transform(std::string_view content) {
  BigEndianReader in(content);
  const Matrix matrix = get_matrix(in);
  if (!in.ok() || !in.at_end()) return wrong_length("TRANSFORM");
  if (!matrix.allFinite()) return fail(ErrorCode::invalid, "TRANSFORM: a number is not finite");
  return matrix;
}

std::string pack_position(const Matrix& matrix) {
  BigEndianWriter out;
  put_quaternion(out, matrix);
  return std::move(out.bytes());
}

Result<Matrix> parse_position(std::string_view content) {
  constexpr std::size_t kPlace = 12;   // bytes
  constexpr std::size_t kPacked = 24;  // with x, y, z of the quaternion
  constexpr std::size_t kWhole = 28;
  BigEndianReader in(content);
  const auto p = get_place(in);
  std::array<double, 4> q{0, 0, 0, 1};
  if (content.size() == kPacked || content.size() == kWhole)
    for (std::size_t i = 0; i < (content.size() - kPlace) / 4; ++i)
      q[i] = static_cast<double>(in.get<float>());
  if (content.size() == kPacked)
    q[3] = std::sqrt(std::max(0.0, 1 - q[0] * q[0] - q[1] * q[1] - q[2] * q[2]));
  if (!in.ok() || !in.at_end()) return wrong_length("POSITION");
  return placed(p, q[0], q[1], q[2], q[3], "POSITION");
}

std::string pack_tdata(const std::vector<TrackedTool>& tools) {
  return pack_tools(tools, put_matrix);
}

Result<std::vector<TrackedTool>> parse_tdata(std::string_view content) {
  return parse_tools(content, [](BigEndianReader& in) -> Result<Matrix> {
    const Matrix matrix = get_matrix(in);
    if (!in.ok()) return wrong_length("TDATA");
    if (!matrix.allFinite()) return fail(ErrorCode::invalid, "TDATA: a number is not finite");
    return matrix;
  });
}

std::string pack_qtdata(const std::vector<TrackedTool>& tools) {
  return pack_tools(tools, put_quaternion);
}

Result<std::vector<TrackedTool>> parse_qtdata(std::string_view content) {
  return parse_tools(content, [](BigEndianReader& in) -> Result<Matrix> {
    const auto p = get_place(in);
    std::array<double, 4> q{};
    for (double& value : q) value = static_cast<double>(in.get<float>());
    if (!in.ok()) return wrong_length("QTDATA");
    return placed(p, q[0], q[1], q[2], q[3], "QTDATA");
  });
}

std::string pack_start_tracking(std::string_view of, std::int32_t milliseconds) {
  BigEndianWriter out;
  out.put(milliseconds);
  out.put_padded("", of == "QTDATA" ? 128 : 32);
  return std::move(out.bytes());
}

std::string pack_image(const Image& image) {
  ARTUS_REQUIRE(
      image.width > 0 && image.width <= 0xFFFF && image.height > 0 && image.height <= 0xFFFF,
      "an image must have 1 to 65535 pixels on each side");
  const auto pixels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  ARTUS_REQUIRE(image.grey.size() == pixels, "the image must have one byte for each pixel");
  BigEndianWriter out;
  out.bytes().reserve(72 + pixels);
  out.put(std::uint16_t{1});           // version
  for (const int byte : {1, 3, 1, 1})  // components, unsigned 8 bit, big endian, RAS
    out.put(static_cast<std::uint8_t>(byte));
  const std::array<int, 3> size{image.width, image.height, 1};
  for (const int n : size) out.put(static_cast<std::uint16_t>(n));
  Matrix placed = image.image_to_reference;
  placed.col(3) += corner_to_middle(placed, image.width, image.height);
  put_matrix(out, placed);
  for (int i = 0; i < 3; ++i) out.put(std::uint16_t{0});  // the whole picture from its corner
  for (const int n : size) out.put(static_cast<std::uint16_t>(n));
  out.put_bytes(image.grey);
  return std::move(out.bytes());
}

Result<Image> parse_image(std::string_view content) {
  BigEndianReader in(content);
  static_cast<void>(in.get<std::uint16_t>());  // 1 and 2 are laid out alike
  const int components = in.get<std::uint8_t>();
  const int scalar = in.get<std::uint8_t>();
  static_cast<void>(in.get_bytes(2));  // bytes have no order, and programs take RAS anyway
  std::array<int, 3> size{};
  for (int& n : size) n = in.get<std::uint16_t>();
  Image image;
  image.image_to_reference = get_matrix(in);
  std::array<int, 6> part{};
  for (int& n : part) n = in.get<std::uint16_t>();
  if (!in.ok()) return wrong_length("IMAGE");
  image.width = size[0];
  image.height = size[1];
  if (components != 1 || (scalar != 2 && scalar != 3) || size[2] != 1 ||
      part != std::array<int, 6>{0, 0, 0, size[0], size[1], 1})
    return fail(ErrorCode::unsupported, "IMAGE: only one whole slice of 8-bit greys can be read");
  if (image.width == 0 || image.height == 0 || !image.image_to_reference.allFinite())
    return fail(ErrorCode::invalid, "IMAGE: it has no pixels or no position");
  image.grey = in.rest();
  if (image.grey.size() !=
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
    return wrong_length("IMAGE");
  image.image_to_reference.col(3) -=
      corner_to_middle(image.image_to_reference, image.width, image.height);
  return image;
}

std::string pack_string(std::string_view text) {
  constexpr std::size_t kMax = 0xFFFF;  // bytes that the length can say
  text = text.substr(0, kMax);
  BigEndianWriter out;
  out.put(std::uint16_t{3});  // US-ASCII
  out.put(static_cast<std::uint16_t>(text.size()));
  out.put_bytes(text);
  return std::move(out.bytes());
}

Result<std::string> parse_string(std::string_view content) {
  BigEndianReader in(content);
  static_cast<void>(in.get<std::uint16_t>());
  const auto size = in.get<std::uint16_t>();
  const std::string_view text = in.get_bytes(size);
  if (!in.ok() || !in.at_end()) return wrong_length("STRING");
  return std::string(text);
}

std::string pack_sensor(const Sensor& sensor) {
  ARTUS_REQUIRE(sensor.values.size() <= 255, "a SENSOR can hold at most 255 values");
  BigEndianWriter out;
  out.put(static_cast<std::uint8_t>(sensor.values.size()));
  out.put(std::uint8_t{0});  // status, reserved
  out.put(sensor.unit);
  for (const double value : sensor.values) out.put(value);
  return std::move(out.bytes());
}

Result<Sensor> parse_sensor(std::string_view content) {
  BigEndianReader in(content);
  const auto n = in.get<std::uint8_t>();
  static_cast<void>(in.get<std::uint8_t>());
  Sensor sensor;
  sensor.unit = in.get<std::uint64_t>();
  if (!in.ok() || in.rest().size() != n * sizeof(double)) return wrong_length("SENSOR");
  for (int i = 0; i < n; ++i) sensor.values.push_back(in.get<double>());
  return sensor;
}

std::string pack_status(const Status& status) {
  BigEndianWriter out;
  out.put(status.code);
  out.put(status.subcode);
  out.put_padded(status.error, kErrorNameSize);
  out.put_bytes(status.message);
  out.put(char{0});
  return std::move(out.bytes());
}

Result<Status> parse_status(std::string_view content) {
  BigEndianReader in(content);
  Status status;
  status.code = in.get<std::uint16_t>();
  status.subcode = in.get<std::int64_t>();
  status.error = in.get_padded(kErrorNameSize);
  if (!in.ok()) return wrong_length("STATUS");
  status.message = std::string(in.rest().substr(0, in.rest().find('\0')));
  return status;
}

std::string pack_command(const CommandText& command) {
  BigEndianWriter out;
  out.put(command.number);
  out.put_padded(command.name, command.name_bytes);
  out.put(command.encoding);
  out.put(static_cast<std::uint32_t>(command.content.size()));
  out.put_bytes(command.content);
  return std::move(out.bytes());
}

Result<CommandText> parse_command(std::string_view content) {
  for (const std::size_t name_bytes : kCommandNameSizes) {  // the one whose length is right
    BigEndianReader in(content);
    CommandText command;
    command.name_bytes = name_bytes;
    command.number = in.get<std::uint32_t>();
    command.name = in.get_padded(name_bytes);
    command.encoding = in.get<std::uint16_t>();
    const auto size = in.get<std::uint32_t>();
    command.content = std::string(in.get_bytes(size));
    if (in.ok() && in.at_end()) return command;
  }
  return wrong_length("COMMAND");
}

std::string pack_capability(const std::vector<std::string>& types) {
  BigEndianWriter out;
  for (const std::string& type : types) out.put_padded(type, kTypeNameSize);
  return std::move(out.bytes());
}

Result<std::vector<std::string>> parse_capability(std::string_view content) {
  if (content.size() % kTypeNameSize != 0) return wrong_length("CAPABILITY");
  BigEndianReader in(content);
  std::vector<std::string> types;
  while (!in.at_end()) types.push_back(in.get_padded(kTypeNameSize));
  return types;
}

Result<void> check_form(std::string_view type, std::string_view content) {
  const auto form = [](const auto& parsed) -> Result<void> {
    if (parsed || parsed.error().code != ErrorCode::malformed) return {};
    return tl::unexpected<Error>(parsed.error());
  };
  if (type == "TRANSFORM") return form(parse_transform(content));
  if (type == "POSITION") return form(parse_position(content));
  if (type == "TDATA") return form(parse_tdata(content));
  if (type == "QTDATA") return form(parse_qtdata(content));
  if (type == "STRING") return form(parse_string(content));
  if (type == "SENSOR") return form(parse_sensor(content));
  if (type == "STATUS") return form(parse_status(content));
  if (type == "COMMAND") return form(parse_command(content));
  return {};
}

}  // namespace artus::igtl
