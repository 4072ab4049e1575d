// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include "artus/detail/anatomy/surfaces/surface_io_formats.h"
#include "artus/detail/core/text_cursor.h"

namespace artus {
namespace {

enum class Encoding { ascii, little, big };
enum class Scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct Property {
  std::string name;
  Scalar type{};
  std::optional<Scalar> list_count;  ///< type of the count when the property is a list
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  Encoding encoding{};
  std::vector<Element> elements;
};

std::size_t size_of(Scalar type) noexcept {
  switch (type) {
    case Scalar::int8:
    case Scalar::uint8:
      return 1;
    case Scalar::int16:
    case Scalar::uint16:
      return 2;
    case Scalar::int32:
    case Scalar::uint32:
    case Scalar::float32:
      return 4;
    case Scalar::float64:
      return 8;
  }
  return 8;
}

std::optional<Scalar> scalar_named(std::string_view name) {
  struct Name {
    std::string_view text;
    Scalar type;
  };
  constexpr std::array<Name, 16> kNames{{{"char", Scalar::int8},
                                         {"int8", Scalar::int8},
                                         {"uchar", Scalar::uint8},
                                         {"uint8", Scalar::uint8},
                                         {"short", Scalar::int16},
                                         {"int16", Scalar::int16},
                                         {"ushort", Scalar::uint16},
                                         {"uint16", Scalar::uint16},
                                         {"int", Scalar::int32},
                                         {"int32", Scalar::int32},
                                         {"uint", Scalar::uint32},
                                         {"uint32", Scalar::uint32},
                                         {"float", Scalar::float32},
                                         {"float32", Scalar::float32},
                                         {"double", Scalar::float64},
                                         {"float64", Scalar::float64}}};
  for (const auto& n : kNames)
    if (n.text == name) return n.type;
  return std::nullopt;
}

template <class T>
double load(const char* p, bool swap) noexcept {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), p, sizeof(T));
  if (swap) std::reverse(raw.begin(), raw.end());
  T value{};
  std::memcpy(&value, raw.data(), sizeof(T));
  return static_cast<double>(value);
}

double load_scalar(Scalar type, const char* p, bool swap) noexcept {
  switch (type) {
    case Scalar::int8:
      return load<std::int8_t>(p, swap);
    case Scalar::uint8:
      return load<std::uint8_t>(p, swap);
    case Scalar::int16:
      return load<std::int16_t>(p, swap);
    case Scalar::uint16:
      return load<std::uint16_t>(p, swap);
    case Scalar::int32:
      return load<std::int32_t>(p, swap);
    case Scalar::uint32:
      return load<std::uint32_t>(p, swap);
    case Scalar::float32:
      return load<float>(p, swap);
    case Scalar::float64:
      return load<double>(p, swap);
  }
  return 0;
}

Result<Encoding> read_encoding(TextCursor& text) {
  const auto word = text.next_in_line();
  if (word == "ascii") return Encoding::ascii;
  if (word == "binary_little_endian") return Encoding::little;
  if (word == "binary_big_endian") return Encoding::big;
  return fail(ErrorCode::unsupported, quoted(word) + " is no PLY encoding", text.where());
}

Result<Element> read_element(TextCursor& text) {
  Element element;
  element.name = text.next_in_line();
  const auto token = text.next_in_line();
  const auto count = parse_integer(token);
  if (!count || *count < 0) return text.malformed(quoted(token) + " is not a number of elements");
  element.count = static_cast<std::size_t>(*count);
  return element;
}

Result<Property> read_property(TextCursor& text) {
  Property property;
  auto word = text.next_in_line();
  const auto type_of = [&text](std::string_view name) -> Result<Scalar> {
    const auto type = scalar_named(name);
    if (!type) return text.malformed(quoted(name) + " is no PLY number type");
    return *type;
  };
  if (word == "list") {
    const auto count = type_of(text.next_in_line());
    ARTUS_TRY(count);
    property.list_count = *count;
    word = text.next_in_line();
  }
  const auto type = type_of(word);
  ARTUS_TRY(type);
  property.type = *type;
  property.name = text.next_in_line();
  return property;
}

Result<void> read_ply_header_line(TextCursor& text, std::string_view word, Header& header) {
  if (word == "format") {
    const auto encoding = read_encoding(text);
    ARTUS_TRY(encoding);
    header.encoding = *encoding;
  } else if (word == "element") {
    auto element = read_element(text);
    ARTUS_TRY(element);
    header.elements.push_back(std::move(*element));
  } else if (word == "property") {
    auto property = read_property(text);
    ARTUS_TRY(property);
    if (header.elements.empty()) return text.malformed("a property stands before its element");
    header.elements.back().properties.push_back(std::move(*property));
  } else if (word != "comment" && word != "obj_info" && !word.empty()) {
    return text.malformed(quoted(word) + " is no line of a PLY header");
  }
  return {};
}

/// Reads up to and including the line "end_header".
Result<Header> read_ply_header(TextCursor& text) {
  Header header;
  text.skip_line();  // "ply"
  while (!text.at_end()) {
    const auto word = text.next_in_line();
    const bool is_last = word == "end_header";
    if (!is_last) ARTUS_TRY(read_ply_header_line(text, word, header));
    text.skip_line();
    if (is_last) return header;
  }
  return text.malformed("the PLY header has no 'end_header'; the file is cut off");
}

/// Gives out the numbers of the body, whatever its encoding.
class Body {
 public:
  Body(std::string_view bytes, const TextCursor& text, Encoding encoding, std::string name)
      : bytes_(bytes),
        name_(std::move(name)),
        encoding_(encoding),
        position_(text.position()),
        text_(bytes.substr(text.position()), name_, text.line()) {}

  Result<double> next(Scalar type) {
    if (encoding_ == Encoding::ascii) {
      const auto token = text_.next();
      const auto value = parse_number(token);
      if (!value)
        return token.empty() ? text_.malformed("the file ends too early; it is cut off")
                             : text_.not_a_number(token);
      return *value;
    }
    const std::size_t size = size_of(type);
    if (bytes_.size() - position_ < size)
      return fail(ErrorCode::corrupt, "the file ends too early; it is cut off", where());
    const double value = load_scalar(type, bytes_.data() + position_, encoding_ == Encoding::big);
    position_ += size;
    return value;
  }

  /// The fewest bytes a row of `element` takes.
  [[nodiscard]] std::size_t shortest_row(const Element& element) const {
    std::size_t bytes = 0;
    for (const auto& p : element.properties)
      bytes += encoding_ == Encoding::ascii ? 2 : size_of(p.list_count.value_or(p.type));
    return bytes;
  }
  [[nodiscard]] std::size_t remaining() const {
    return encoding_ == Encoding::ascii ? text_.remaining() + 1 : bytes_.size() - position_;
  }
  [[nodiscard]] std::string where() const {
    return encoding_ == Encoding::ascii ? text_.where()
                                        : name_ + ": byte " + std::to_string(position_);
  }

 private:
  std::string_view bytes_;
  std::string name_;
  Encoding encoding_;
  std::size_t position_;
  TextCursor text_;
};

/// Takes what a mesh needs out of the rows and skips the rest.
class MeshReader {
 public:
  explicit MeshReader(Body& body) : body_(body) {}

  Result<void> read(const Element& element) {
    const std::size_t row = body_.shortest_row(element);
    if (row == 0) return {};
    if (element.count > body_.remaining() / row)
      return fail(ErrorCode::corrupt,
                  "the header promises " + std::to_string(element.count) + " rows of '" +
                      element.name + "', but only " + std::to_string(body_.remaining()) +
                      " bytes follow; the file is cut off",
                  body_.where());
    if (element.count >= std::numeric_limits<std::uint32_t>::max())
      return fail(ErrorCode::unsupported, "more than 4 billion rows", body_.where());
    const bool is_vertex = element.name == "vertex";
    if (is_vertex) mesh_.vertices.reserve(mesh_.vertices.size() + element.count);
    if (element.name == "face") mesh_.triangles.reserve(element.count);
    for (std::size_t i = 0; i < element.count; ++i)
      ARTUS_TRY(is_vertex ? read_vertex(element) : read_row(element));
    return {};
  }

  SurfaceMesh take() { return std::move(mesh_); }

 private:
  Result<void> read_vertex(const Element& element) {
    Vec3 p = Vec3::Zero();
    for (const auto& property : element.properties) {
      if (property.list_count) {
        ARTUS_TRY(read_list(property, false));
        continue;
      }
      const auto value = body_.next(property.type);
      ARTUS_TRY(value);
      if (property.name == "x") p.x() = *value;
      if (property.name == "y") p.y() = *value;
      if (property.name == "z") p.z() = *value;
    }
    mesh_.vertices.push_back(p);
    return {};
  }

  Result<void> read_row(const Element& element) {
    for (const auto& property : element.properties) {
      const bool is_face = element.name == "face" &&
                           (property.name == "vertex_indices" || property.name == "vertex_index");
      if (property.list_count) {
        ARTUS_TRY(read_list(property, is_face));
      } else
        ARTUS_TRY(body_.next(property.type));
    }
    return {};
  }

  Result<void> read_list(const Property& property, bool is_face) {
    const auto count = body_.next(*property.list_count);
    ARTUS_TRY(count);
    const double min = static_cast<double>(body_.remaining());
    if (!(*count >= 0) || *count > min || *count != std::floor(*count))
      return fail(ErrorCode::corrupt, "a list of impossible length; the file is damaged",
                  body_.where());
    std::uint32_t first = 0;
    std::uint32_t previous = 0;
    const auto n = static_cast<std::size_t>(*count);
    for (std::size_t k = 0; k < n; ++k) {
      const auto value = body_.next(property.type);
      ARTUS_TRY(value);
      if (!is_face) continue;
      const auto v = vertex_index(*value);
      ARTUS_TRY(v);
      if (k == 0) first = *v;
      if (k >= 2) mesh_.triangles.push_back({first, previous, *v});
      previous = *v;
    }
    return {};
  }

  Result<std::uint32_t> vertex_index(double value) const {
    if (value >= 0 && value < static_cast<double>(mesh_.vertices.size()) &&
        value == std::floor(value))
      return static_cast<std::uint32_t>(value);
    std::string text;
    append_number(text, value);
    return fail(ErrorCode::malformed,
                "the face names vertex " + text + " of " + std::to_string(mesh_.vertices.size()) +
                    " (they start at 0)",
                body_.where());
  }

  Body& body_;
  SurfaceMesh mesh_;
};

bool has_coordinates(const Header& header) {
  for (const auto& e : header.elements) {
    if (e.name != "vertex") continue;
    const auto has = [&e](std::string_view name) {
      return std::any_of(e.properties.begin(), e.properties.end(),
                         [&](const Property& p) { return p.name == name && !p.list_count; });
    };
    return has("x") && has("y") && has("z");
  }
  return false;
}

}  // namespace

Result<SurfaceMesh> parse_ply(std::string_view bytes, const std::string& name) {
  TextCursor text(bytes, name);
  const auto header = read_ply_header(text);
  ARTUS_TRY(header);
  if (!has_coordinates(*header))
    return fail(ErrorCode::malformed, "the PLY header has no vertices with x, y and z", name);
  Body body(bytes, text, header->encoding, name);
  MeshReader reader(body);
  for (const auto& element : header->elements) ARTUS_TRY(reader.read(element));
  return reader.take();
}

std::string format_ply(const SurfaceMesh& mesh, double unit) {
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                    std::to_string(mesh.vertices.size()) +
                    "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                    std::to_string(mesh.triangles.size()) +
                    "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto append = [&out](const auto& value) {
    std::array<char, sizeof value> raw{};
    std::memcpy(raw.data(), &value, sizeof value);
    out.append(raw.data(), raw.size());
  };
  for (const Vec3& p : mesh.vertices)
    for (int k = 0; k < 3; ++k) append(double{p[k] / unit});
  for (const auto& t : mesh.triangles) {
    append(std::uint8_t{3});
    for (const auto v : t) append(v);
  }
  return out;
}

}  // namespace artus
