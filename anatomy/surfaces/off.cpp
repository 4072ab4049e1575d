// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>

#include "artus/detail/anatomy/surfaces/surface_io_formats.h"
#include "artus/detail/core/text_cursor.h"

namespace artus {
namespace {

/// The next token that is not in a comment; what stands behind '#' is skipped.
std::string_view next_token(TextCursor& text) {
  auto token = text.next();
  while (!token.empty() && token[0] == '#') {
    text.skip_line();
    token = text.next();
  }
  return token;
}

Result<std::size_t> read_count(TextCursor& text, const char* what, std::size_t bytes_each) {
  const auto token = next_token(text);
  const auto count = parse_integer(token);
  if (!count || *count < 0)
    return text.malformed(quoted(token) + " is not a number of " + std::string(what));
  if (static_cast<std::uint64_t>(*count) > text.remaining() / bytes_each + 1)
    return fail(ErrorCode::corrupt,
                "the header promises " + std::to_string(*count) + " " + what + ", but only " +
                    std::to_string(text.remaining()) + " bytes follow; the file is cut off",
                text.where());
  return static_cast<std::size_t>(*count);
}

/// Three numbers; what else stands on the line (normals, colours) is skipped.
Result<Vec3> read_vertex(TextCursor& text) {
  Vec3 p = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    const auto token = k == 0 ? next_token(text) : text.next_in_line();
    const auto value = parse_number(token);
    if (!value)
      return token.empty() ? text.malformed("the file ends within the vertices")
                           : text.not_a_number(token);
    p[k] = *value;
  }
  text.skip_line();
  return p;
}

Result<void> read_off_face(TextCursor& text, SurfaceMesh& mesh) {
  const auto token = next_token(text);
  const auto corners = parse_integer(token);
  if (!corners || *corners < 0)
    return text.malformed(token.empty() ? "the file ends within the faces"
                                        : quoted(token) + " is not a number of corners");
  std::uint32_t first = 0;
  std::uint32_t previous = 0;
  for (std::int64_t k = 0; k < *corners; ++k) {
    const auto corner = text.next_in_line();
    const auto index = parse_integer(corner);
    if (!index)
      return text.malformed(corner.empty() ? "the face ends before its " +
                                                 std::to_string(*corners) + " corners"
                                           : quoted(corner) + " is not a vertex index");
    if (*index < 0 || static_cast<std::uint64_t>(*index) >= mesh.vertices.size())
      return text.malformed("the face names vertex " + std::to_string(*index) + " of " +
                            std::to_string(mesh.vertices.size()) + " (they start at 0)");
    const auto v = static_cast<std::uint32_t>(*index);
    if (k == 0) first = v;
    if (k >= 2) mesh.triangles.push_back({first, previous, v});
    previous = v;
  }
  text.skip_line();
  return {};
}

Result<void> read_off_header(TextCursor& text) {
  auto word = next_token(text);
  if (word.starts_with("4") || word.starts_with("n") || !word.ends_with("OFF"))
    return fail(ErrorCode::unsupported,
                quoted(word) + " is no OFF artus reads (OFF, COFF, NOFF, STOFF); export as PLY",
                text.where());
  return {};
}

}  // namespace

Result<SurfaceMesh> parse_off(std::string_view bytes, const std::string& name) {
  TextCursor text(bytes, name);
  ARTUS_TRY(read_off_header(text));
  const auto n_vertices = read_count(text, "vertices", 6);
  ARTUS_TRY(n_vertices);
  const auto n_faces = read_count(text, "faces", 2);
  ARTUS_TRY(n_faces);
  text.skip_line();
  if (*n_vertices > 0xffffffffU)
    return fail(ErrorCode::unsupported, "more than 4 billion vertices", name);
  SurfaceMesh mesh;
  mesh.vertices.reserve(*n_vertices);
  mesh.triangles.reserve(*n_faces);
  for (std::size_t i = 0; i < *n_vertices; ++i) {
    const auto p = read_vertex(text);
    ARTUS_TRY(p);
    mesh.vertices.push_back(*p);
  }
  for (std::size_t i = 0; i < *n_faces; ++i) ARTUS_TRY(read_off_face(text, mesh));
  return mesh;
}

std::string format_off(const SurfaceMesh& mesh, double unit) {
  std::string out = "OFF\n" + std::to_string(mesh.vertices.size()) + ' ' +
                    std::to_string(mesh.triangles.size()) + " 0\n";
  for (const Vec3& p : mesh.vertices) {
    for (int k = 0; k < 3; ++k) {
      append_number(out, p[k] / unit);
      out += k == 2 ? '\n' : ' ';
    }
  }
  for (const auto& t : mesh.triangles) {
    out += '3';
    for (const auto v : t) out += ' ' + std::to_string(v);
    out += '\n';
  }
  return out;
}

}  // namespace artus
