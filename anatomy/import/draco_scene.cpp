// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/draco_scene.h"

#ifdef ARTUS_HAS_DRACO
#include <cstdint>
#include <cstring>
#include <optional>

#include <draco/compression/decode.h>

#include <nlohmann/json.hpp>
#endif

namespace artus {

#ifndef ARTUS_HAS_DRACO

bool expands_draco() noexcept {
  return false;
}

Result<std::string> expand_draco(std::string_view bytes, const std::string&) {
  return std::string(bytes);
}

#else

bool expands_draco() noexcept {
  return true;
}

namespace {

constexpr std::string_view kExtension = "KHR_draco_mesh_compression";
constexpr std::size_t kHead = 12;   // bytes of a binary glTF before its chunks
constexpr std::size_t kChunk = 8;   // bytes of a chunk before its content
constexpr int kUnsignedInt = 5125;  // componentType
constexpr int kFloat = 5126;

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  if (at + sizeof word <= bytes.size()) std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

void append_word(std::string& out, std::size_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  out.append(reinterpret_cast<const char*>(&word), sizeof word);
}

/// A binary glTF taken apart.
struct Glb {
  nlohmann::json json;
  std::string binary;
};

std::optional<Glb> take_apart(std::string_view bytes) {
  if (!bytes.starts_with("glTF") || bytes.size() < kHead + kChunk) return std::nullopt;
  const std::size_t text = word_at(bytes, kHead);
  if (text > bytes.size() - kHead - kChunk) return std::nullopt;
  const std::string_view json = bytes.substr(kHead + kChunk, text);
  if (json.find(kExtension) == std::string_view::npos) return std::nullopt;
  Glb glb{nlohmann::json::parse(json, nullptr, false), {}};
  const std::string_view rest = bytes.substr(kHead + kChunk + text);
  if (glb.json.is_discarded() || rest.size() < kChunk) return std::nullopt;
  glb.binary = rest.substr(kChunk, word_at(rest, 0));
  return glb;
}

std::string put_together(const Glb& glb) {
  std::string json = glb.json.dump();
  while (json.size() % 4 != 0) json += ' ';
  std::string out = "glTF";
  append_word(out, 2);
  append_word(out, kHead + 2 * kChunk + json.size() + glb.binary.size());
  append_word(out, json.size());
  out += "JSON" + json;
  append_word(out, glb.binary.size());
  return out + std::string("BIN\0", 4) + glb.binary;
}

class Expander {
 public:
  Expander(Glb& glb, const std::string& name) : glb_(glb), name_(name) {}

  Result<void> run() {
    for (auto& mesh : glb_.json.at("meshes"))
      for (auto& primitive : mesh.at("primitives")) {
        const auto extensions = primitive.find("extensions");
        if (extensions == primitive.end() || !extensions->contains(kExtension)) continue;
        ARTUS_TRY(expand(primitive, extensions->at(std::string(kExtension))));
      }
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) glb_.json.erase(list);
    glb_.json["buffers"] = {{{"byteLength", glb_.binary.size()}}};
    return {};
  }

 private:
  tl::unexpected<Error> broken(const char* why) const {
    return fail(ErrorCode::corrupt,
                std::string("a mesh of it that is compressed by Draco cannot be expanded (") + why +
                    "); export it without compression",
                name_);
  }

  /// The compressed bytes of a view; empty where it lies outside of the file.
  [[nodiscard]] std::string_view bytes_of(std::size_t view) const {
    const auto& v = glb_.json.at("bufferViews").at(view);
    const auto from = v.value("byteOffset", std::size_t{0});
    const auto size = v.at("byteLength").get<std::size_t>();
    if (v.at("buffer").get<std::size_t>() != 0 || from > glb_.binary.size() ||
        size > glb_.binary.size() - from)
      return {};
    return std::string_view(glb_.binary).substr(from, size);
  }

  /// Appends data with a view and an accessor; the accessor's number.
  std::size_t add(const std::string& data, int component, std::size_t count, const char* type) {
    auto& views = glb_.json["bufferViews"];
    auto& accessors = glb_.json["accessors"];
    views.push_back(
        {{"buffer", 0}, {"byteOffset", glb_.binary.size()}, {"byteLength", data.size()}});
    accessors.push_back({{"bufferView", views.size() - 1},
                         {"componentType", component},
                         {"count", count},
                         {"type", type}});
    glb_.binary += data;
    return accessors.size() - 1;
  }

  Result<void> expand(nlohmann::json& primitive, const nlohmann::json& compressed) {
    const std::string_view data = bytes_of(compressed.at("bufferView").get<std::size_t>());
    if (data.empty()) return broken("its view lies outside of the file");
    draco::DecoderBuffer buffer;
    buffer.Init(data.data(), data.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) return broken(decoded.status().error_msg());
    const draco::Mesh& mesh = *decoded.value();
    const auto id = compressed.at("attributes").at("POSITION").get<std::uint32_t>();
    const auto* places = mesh.GetAttributeByUniqueId(id);
    if (places == nullptr || places->num_components() != 3) return broken("it has no places");
    std::string indices, positions;
    for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
      for (const auto& corner : mesh.face(f)) append_word(indices, corner.value());
    for (draco::PointIndex i(0); i < mesh.num_points(); ++i) {
      std::array<float, 3> p{};
      if (!places->ConvertValue<float, 3>(places->mapped_index(i), p.data()))
        return broken("its places are no numbers");
      positions.append(reinterpret_cast<const char*>(p.data()), sizeof p);
    }
    primitive["indices"] = add(indices, kUnsignedInt, indices.size() / 4, "SCALAR");
    primitive["attributes"] = {{"POSITION", add(positions, kFloat, mesh.num_points(), "VEC3")}};
    primitive.erase("extensions");
    primitive.erase("material");
    return {};
  }

  Glb& glb_;
  const std::string& name_;
};

}  // namespace

Result<std::string> expand_draco(std::string_view bytes, const std::string& name) {
  auto glb = take_apart(bytes);
  if (!glb) return std::string(bytes);
  try {
    ARTUS_TRY(Expander(*glb, name).run());
    return put_together(*glb);
  } catch (const nlohmann::json::exception& e) {
    return fail(ErrorCode::malformed,
                std::string("its description is not that of a glTF: ") + e.what(), name);
  }
}

#endif

}  // namespace artus
