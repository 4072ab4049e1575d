// SPDX-License-Identifier: AGPL-3.0-or-later
#include <bit>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <unordered_map>

#include "artus/detail/anatomy/surfaces/surface_io_formats.h"
#include "artus/detail/core/noise.h"
#include "artus/detail/core/text_cursor.h"

namespace artus {
namespace {

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kFacetBytes = 50;

static_assert(std::endian::native == std::endian::little, "STL is little endian, as is the build");

std::uint32_t load_u32(const char* p) noexcept {
  std::uint32_t value = 0;
  std::memcpy(&value, p, sizeof value);
  return value;
}

/// Coordinates by their bits, with -0 equal to 0, so that welding is exact and NaN finds itself.
using Bits = std::array<std::uint64_t, 3>;

struct BitsHash {
  std::size_t operator()(const Bits& b) const noexcept {
    return mix_bits(mix_bits(mix_bits(b[0]) ^ b[1]) ^ b[2]);
  }
};

/// Collects triangles given by coordinates and shares the vertices that are equal.
class Welder {
 public:
  explicit Welder(std::size_t n_triangles) {
    mesh_.triangles.reserve(n_triangles);
    index_.reserve(n_triangles / 2);
  }
  std::uint32_t vertex(const Vec3& p) {
    const Vec3 q = p + Vec3::Zero();  // -0 becomes 0
    const Bits key{std::bit_cast<std::uint64_t>(q.x()), std::bit_cast<std::uint64_t>(q.y()),
                   std::bit_cast<std::uint64_t>(q.z())};
    const auto next = static_cast<std::uint32_t>(mesh_.vertices.size());
    const auto [it, is_new] = index_.try_emplace(key, next);
    if (is_new) mesh_.vertices.push_back(q);
    return it->second;
  }
  void add(const Triangle& t) { mesh_.triangles.push_back(t); }
  SurfaceMesh take() { return std::move(mesh_); }

 private:
  SurfaceMesh mesh_;
  std::unordered_map<Bits, std::uint32_t, BitsHash> index_;
};

bool same_word(std::string_view token, std::string_view lower) noexcept {
  if (token.size() != lower.size()) return false;
  for (std::size_t i = 0; i < token.size(); ++i)
    if (std::tolower(static_cast<unsigned char>(token[i])) != lower[i]) return false;
  return true;
}

Result<void> expect_word(TextCursor& text, std::string_view word) {
  const auto token = text.next();
  if (same_word(token, word)) return {};
  return text.malformed("expected '" + std::string(word) + "', found " +
                        (token.empty() ? "the end of the file" : quoted(token)) +
                        "; export the surface again, best as binary STL or PLY");
}

Result<Vec3> read_vector(TextCursor& text) {
  Vec3 p = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    const auto token = text.next();
    const auto value = parse_number(token);
    if (!value) return text.not_a_number(token);
    p[k] = *value;
  }
  return p;
}

/// From behind "facet" to behind "endfacet".
Result<void> read_facet(TextCursor& text, Welder& out) {
  ARTUS_TRY(expect_word(text, "normal"));
  ARTUS_TRY(read_vector(text));
  ARTUS_TRY(expect_word(text, "outer"));
  ARTUS_TRY(expect_word(text, "loop"));
  Triangle t{};
  for (auto& v : t) {
    ARTUS_TRY(expect_word(text, "vertex"));
    const auto p = read_vector(text);
    ARTUS_TRY(p);
    v = out.vertex(*p);
  }
  ARTUS_TRY(expect_word(text, "endloop"));
  ARTUS_TRY(expect_word(text, "endfacet"));
  out.add(t);
  return {};
}

}  // namespace

bool is_binary_stl(std::string_view bytes) noexcept {
  return bytes.size() >= kHeaderBytes &&
         (bytes.size() - kHeaderBytes) / kFacetBytes == load_u32(bytes.data() + 80) &&
         (bytes.size() - kHeaderBytes) % kFacetBytes == 0;
}

Result<SurfaceMesh> parse_stl_binary(std::string_view bytes, const std::string& name) {
  if (bytes.size() < kHeaderBytes)
    return fail(ErrorCode::corrupt,
                "the file has " + std::to_string(bytes.size()) +
                    " bytes, a binary STL at least 84; it is cut off or no STL",
                name);
  // A few bytes behind the last facet do no harm; some programs end with a line break.
  const std::size_t n_whole = (bytes.size() - kHeaderBytes) / kFacetBytes;
  if (n_whole != load_u32(bytes.data() + 80))
    return fail(ErrorCode::corrupt,
                "the header promises " + std::to_string(load_u32(bytes.data() + 80)) +
                    " triangles of 50 bytes, but " + std::to_string(bytes.size() - kHeaderBytes) +
                    " bytes follow; the file is cut off or no STL: copy or export it again",
                name + ": byte 80");
  const std::size_t n = load_u32(bytes.data() + 80);
  Welder out(n);
  for (std::size_t i = 0; i < n; ++i) {
    const char* facet = bytes.data() + kHeaderBytes + i * kFacetBytes + 12;  // behind the normal
    Triangle t{};
    for (std::size_t k = 0; k < 3; ++k) {
      const char* p = facet + 12 * k;
      t[k] =
          out.vertex(Vec3(std::bit_cast<float>(load_u32(p)), std::bit_cast<float>(load_u32(p + 4)),
                          std::bit_cast<float>(load_u32(p + 8))));
    }
    out.add(t);
  }
  return out.take();
}

Result<SurfaceMesh> parse_stl_ascii(std::string_view bytes, const std::string& name) {
  TextCursor text(bytes, name);
  constexpr std::size_t kShortestFacet = 80;  // keywords and twelve one-digit numbers
  Welder out(bytes.size() / kShortestFacet);
  ARTUS_TRY(expect_word(text, "solid"));
  text.skip_line();
  for (;;) {
    const auto token = text.next();
    if (same_word(token, "facet")) {
      ARTUS_TRY(read_facet(text, out));
    } else if (same_word(token, "endsolid")) {
      text.skip_line();
      const auto again = text.next();
      if (again.empty()) return out.take();
      if (!same_word(again, "solid"))
        return text.malformed("expected 'solid' or the end of the file, found " + quoted(again));
      text.skip_line();
    } else {
      return text.malformed("expected 'facet' or 'endsolid', found " +
                            (token.empty() ? "the end of the file: it is cut off" : quoted(token)));
    }
  }
}

std::string format_stl(const SurfaceMesh& mesh, double unit) {
  std::string out(80, '\0');
  const std::string_view title = "artus binary STL";
  out.replace(0, title.size(), title);
  const auto append_u32 = [&out](std::uint32_t value) {
    std::array<char, 4> raw{};
    std::memcpy(raw.data(), &value, 4);
    out.append(raw.data(), 4);
  };
  const auto append_vector = [&](const Vec3& v) {
    for (int k = 0; k < 3; ++k) append_u32(std::bit_cast<std::uint32_t>(static_cast<float>(v[k])));
  };
  out.reserve(kHeaderBytes + kFacetBytes * mesh.triangles.size());
  append_u32(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    append_vector((mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).stableNormalized());
    for (const auto v : t) append_vector(mesh.vertices[v] / unit);
    out.append(2, '\0');
  }
  return out;
}

}  // namespace artus
