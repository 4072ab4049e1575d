// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/surfaces/surface_io.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <optional>

#include "artus/detail/anatomy/surfaces/foreign_format.h"
#include "artus/detail/anatomy/surfaces/surface_io_formats.h"
#include "artus/detail/core/check.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_file.h"

namespace artus {
namespace {

std::string lower_extension(const std::filesystem::path& file) {
  std::string ext = file.extension().string();
  std::transform(ext.begin(), ext.end(), ext.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ext;
}

std::optional<SurfaceFormat> format_of_extension(const std::filesystem::path& file) {
  const std::string ext = lower_extension(file);
  if (ext == ".stl") return SurfaceFormat::stl;
  if (ext == ".ply") return SurfaceFormat::ply;
  if (ext == ".obj") return SurfaceFormat::obj;
  if (ext == ".off") return SurfaceFormat::off;
  return std::nullopt;
}

/// The first word that is not in a comment.
std::string_view first_word(std::string_view bytes) {
  TextCursor text(bytes, {});
  auto word = text.next();
  while (!word.empty() && word[0] == '#') {
    text.skip_line();
    word = text.next();
  }
  return word;
}

bool is_obj_word(std::string_view word) {
  constexpr std::array<std::string_view, 10> kWords{"v", "vn",     "vt",     "vp", "f",
                                                    "o", "mtllib", "usemtl", "g",  "s"};
  return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

bool starts_like_ascii_stl(std::string_view bytes) {
  constexpr std::string_view kSolid = "solid";
  const auto word = first_word(bytes.substr(0, 4096));
  return word.size() == kSolid.size() &&
         std::equal(word.begin(), word.end(), kSolid.begin(),
                    [](unsigned char a, char b) { return std::tolower(a) == b; });
}

Result<SurfaceMesh> parse_any(std::string_view bytes, const std::string& name) {
  if (bytes.empty())
    return fail(ErrorCode::malformed, "the file is empty; export the surface again", name);
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // before text, of some editors
  if (bytes.starts_with(kByteOrderMark)) bytes.remove_prefix(kByteOrderMark.size());
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return parse_ply(bytes, name);
  if (std::string advice = advice_for_format(bytes, name); !advice.empty())
    return fail(ErrorCode::unsupported, std::move(advice), name);
  if (is_binary_stl(bytes)) return parse_stl_binary(bytes, name);
  const auto extension = format_of_extension(name);
  const bool is_text = bytes.substr(0, 1024).find('\0') == std::string_view::npos;
  if (is_text && starts_like_ascii_stl(bytes)) return parse_stl_ascii(bytes, name);
  const auto word = is_text ? first_word(bytes) : std::string_view{};
  if (word.ends_with("OFF") || extension == SurfaceFormat::off) return parse_off(bytes, name);
  if (is_obj_word(word) || extension == SurfaceFormat::obj) return parse_obj(bytes, name);
  if (extension == SurfaceFormat::stl) return parse_stl_binary(bytes, name);
  if (extension == SurfaceFormat::ply)
    return fail(ErrorCode::malformed, "a PLY file starts with the line 'ply', this one does not",
                name + ":1");
  return fail(ErrorCode::unsupported,
              "neither content nor extension is that of an STL, PLY, OBJ or OFF surface", name);
}

}  // namespace

Result<SurfaceMesh> parse_surface(std::string_view bytes, const std::string& name, double unit) {
  ARTUS_REQUIRE(unit > 0, "unit must be positive");
  auto mesh = parse_any(bytes, name);
  ARTUS_TRY(mesh);
  for (Vec3& p : mesh->vertices) p *= unit;
  return mesh;
}

Result<SurfaceMesh> read_surface(const std::filesystem::path& file, double unit) {
  ARTUS_REQUIRE(unit > 0, "unit must be positive");
  const auto bytes = read_bytes(file);
  ARTUS_TRY(bytes);
  return parse_surface(*bytes, file.string(), unit);
}

Result<void> write_surface(const SurfaceMesh& mesh, const std::filesystem::path& file,
                           double unit) {
  ARTUS_REQUIRE(unit > 0, "unit must be positive");
  const auto format = format_of_extension(file);
  if (!format)
    return fail(ErrorCode::unsupported, "the name must end in .stl, .ply, .obj or .off",
                file.string());
  std::string bytes;
  switch (*format) {
    case SurfaceFormat::stl:
      bytes = format_stl(mesh, unit);
      break;
    case SurfaceFormat::ply:
      bytes = format_ply(mesh, unit);
      break;
    case SurfaceFormat::obj:
      bytes = format_obj(mesh, unit);
      break;
    case SurfaceFormat::off:
      bytes = format_off(mesh, unit);
      break;
  }
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out)
    return fail(ErrorCode::unreadable, "the file cannot be written; check folder and free space",
                file.string());
  return {};
}

}  // namespace artus
