// SPDX-License-Identifier: AGPL-3.0-or-later
#include <limits>

#include "artus/detail/anatomy/surfaces/surface_io_formats.h"
#include "artus/detail/core/text_cursor.h"

namespace artus {
namespace {

Result<void> read_vertex(TextCursor& text, SurfaceMesh& mesh) {
  Vec3 p = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    const auto token = text.next_in_line();
    const auto value = parse_number(token);
    if (!value)
      return token.empty() ? text.malformed("a vertex needs three numbers")
                           : text.not_a_number(token);
    p[k] = *value;
  }
  mesh.vertices.push_back(p);
  return {};
}

/// One corner, "7", "7/1", "7//3" or "7/1/3"; negative counts back from the last vertex so far.
Result<std::uint32_t> read_corner(const TextCursor& text, std::string_view token,
                                  std::size_t n_vertices) {
  const auto index = parse_integer(token.substr(0, token.find('/')));
  if (!index || *index == 0)
    return text.malformed(quoted(token) + " is not a vertex index (they start at 1)");
  const auto n = static_cast<std::int64_t>(n_vertices);
  const std::int64_t zero_based = *index > 0 ? *index - 1 : n + *index;
  if (*index > n || *index < -n)
    return text.malformed("the face names vertex " + std::to_string(*index) + ", but only " +
                          std::to_string(n_vertices) + " vertices stand above it");
  return static_cast<std::uint32_t>(zero_based);
}

Result<void> read_obj_face(TextCursor& text, SurfaceMesh& mesh) {
  std::uint32_t first = 0;
  std::uint32_t previous = 0;
  std::size_t corners = 0;
  for (auto token = text.next_in_line(); !token.empty() && token[0] != '#';
       token = text.next_in_line()) {
    if (token == "\\") {  // the face goes on in the next line
      text.skip_line();
      continue;
    }
    const auto corner = read_corner(text, token, mesh.vertices.size());
    ARTUS_TRY(corner);
    if (corners == 0) first = *corner;
    if (corners >= 2) mesh.triangles.push_back({first, previous, *corner});
    previous = *corner;
    ++corners;
  }
  if (corners < 3)
    return text.malformed("a face needs three vertices, this one has " + std::to_string(corners));
  return {};
}

}  // namespace

Result<SurfaceMesh> parse_obj(std::string_view bytes, const std::string& name) {
  TextCursor text(bytes, name);
  SurfaceMesh mesh;
  while (!text.at_end()) {
    const auto word = text.next_in_line();
    Result<void> ok;
    if (word == "v") ok = read_vertex(text, mesh);
    if (word == "f") ok = read_obj_face(text, mesh);
    ARTUS_TRY(ok);
    if (mesh.vertices.size() >= std::numeric_limits<std::uint32_t>::max())
      return fail(ErrorCode::unsupported, "more than 4 billion vertices", name);
    text.skip_line();
  }
  if (mesh.vertices.empty())
    return fail(ErrorCode::malformed, "no vertex line ('v x y z') in the file; is it an OBJ?",
                name);
  return mesh;
}

std::string format_obj(const SurfaceMesh& mesh, double unit) {
  std::string out;
  for (const Vec3& p : mesh.vertices) {
    out += 'v';
    for (int k = 0; k < 3; ++k) {
      out += ' ';
      append_number(out, p[k] / unit);
    }
    out += '\n';
  }
  for (const auto& t : mesh.triangles) {
    out += 'f';
    for (const auto v : t) out += ' ' + std::to_string(std::uint64_t{v} + 1);
    out += '\n';
  }
  return out;
}

}  // namespace artus
