// SPDX-License-Identifier: AGPL-3.0-or-later
// Scenes as atlases publish them, written for tests: binary glTF, plain and compressed by Draco.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "artus/detail/anatomy/surfaces/surface_mesh.h"
#include "artus/detail/core/printed.h"
#ifdef ARTUS_HAS_DRACO
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#endif

namespace artus::test {

inline std::string raw(const void* data, std::size_t n) {
  return {static_cast<const char*>(data), n};
}

inline std::string size_word(std::size_t n) {
  const auto word = static_cast<std::uint32_t>(n);
  return raw(&word, sizeof word);
}

/// Indices, then places, as glTF keeps them.
inline std::string plain_buffer(const SurfaceMesh& mesh) {
  std::string bytes;
  for (const Triangle& t : mesh.triangles) bytes += raw(t.data(), sizeof t);
  for (const Vec3& p : mesh.vertices) {
    const Eigen::Vector3f f = p.cast<float>();
    bytes += raw(f.data(), 12);
  }
  return bytes;
}

#ifdef ARTUS_HAS_DRACO
inline std::string draco_buffer(const SurfaceMesh& mesh) {
  draco::Mesh encoded;
  encoded.set_num_points(static_cast<std::uint32_t>(mesh.vertices.size()));
  draco::GeometryAttribute places;
  places.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
  const int id = encoded.AddAttribute(places, true, encoded.num_points());
  for (std::uint32_t i = 0; i < encoded.num_points(); ++i) {
    const Eigen::Vector3f f = mesh.vertices[i].cast<float>();
    encoded.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), f.data());
  }
  for (const Triangle& t : mesh.triangles)
    encoded.AddFace({draco::PointIndex(t[0]), draco::PointIndex(t[1]), draco::PointIndex(t[2])});
  draco::ExpertEncoder encoder(encoded);
  encoder.SetAttributeQuantization(id, 18);
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeToBuffer(&buffer).ok()) return {};
  return raw(buffer.data(), buffer.size());
}
#endif

struct GlbNode {
  std::string name;
  SurfaceMesh mesh;  ///< m, in the node's own frame
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  Vec3 shift = Vec3::Zero();
  double scale = 1;
};

/// What a file says of a mesh's indices and places.
inline std::string accessor_pair(const SurfaceMesh& mesh, const std::string& index_view,
                                 const std::string& place_view) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.vertices) box.extend(p);
  return "{" + index_view +
         printed("\"componentType\":5125,\"count\":%zu,\"type\":\"SCALAR\"},{",
                 3 * mesh.triangles.size()) +
         place_view +
         printed(
             "\"componentType\":5126,\"count\":%zu,\"type\":\"VEC3\",\"min\":[%.9g,%.9g,"
             "%.9g],\"max\":[%.9g,%.9g,%.9g]}",
             mesh.vertices.size(), box.min().x(), box.min().y(), box.min().z(), box.max().x(),
             box.max().y(), box.max().z());
}

/// A binary glTF: one root node, which is turned and scaled, too, over nodes of a mesh each.
inline std::string to_glb(const GlbNode& root, const std::vector<GlbNode>& nodes, bool draco) {
  std::string views, accessors, meshes, list, children, binary;
  const auto place = [](const GlbNode& n) {
    return printed(
        "\"rotation\":[%.9g,%.9g,%.9g,%.9g],\"translation\":[%.9g,%.9g,%.9g],"
        "\"scale\":[%.9g,%.9g,%.9g]",
        n.turn.x(), n.turn.y(), n.turn.z(), n.turn.w(), n.shift.x(), n.shift.y(), n.shift.z(),
        n.scale, n.scale, n.scale);
  };
  const auto add_view = [&](std::size_t from, std::size_t size) {
    views += printed("%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}",
                     views.empty() ? "" : ",", from, size);
  };
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const SurfaceMesh& mesh = nodes[k].mesh;
    const std::size_t start = binary.size();
    const std::size_t indices = 12 * mesh.triangles.size();
    std::string extension;
#ifdef ARTUS_HAS_DRACO
    if (draco) {
      binary += draco_buffer(mesh);
      add_view(start, binary.size() - start);
      extension = printed(
          ",\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":%zu,"
          "\"attributes\":{\"POSITION\":0}}}",
          k);
    }
#endif
    if (!draco) {
      binary += plain_buffer(mesh);
      add_view(start, indices);
      add_view(start + indices, binary.size() - start - indices);
    }
    while (binary.size() % 4 != 0) binary += '\0';
    accessors +=
        (k > 0 ? "," : "") + accessor_pair(mesh, draco ? "" : printed("\"bufferView\":%zu,", 2 * k),
                                           draco ? "" : printed("\"bufferView\":%zu,", 2 * k + 1));
    meshes += printed("%s{\"primitives\":[{\"attributes\":{\"POSITION\":%zu},\"indices\":%zu%s}]}",
                      k > 0 ? "," : "", 2 * k + 1, 2 * k, extension.c_str());
    children += printed("%s%zu", k > 0 ? "," : "", k + 1);
    list += printed(",{\"name\":\"%s\",\"mesh\":%zu,", nodes[k].name.c_str(), k) + place(nodes[k]) +
            "}";
  }
  std::string json = "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],";
  if (draco)
    json +=
        "\"extensionsUsed\":[\"KHR_draco_mesh_compression\"],"
        "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],";
  json += "\"nodes\":[{\"name\":\"" + root.name + "\"," + place(root) + ",\"children\":[" +
          children + "]}" + list + "],\"meshes\":[" + meshes +
          "],\"buffers\":[{\"byteLength\":" + std::to_string(binary.size()) +
          "}],\"bufferViews\":[" + views + "],\"accessors\":[" + accessors + "]}";
  while (json.size() % 4 != 0) json += ' ';
  return "glTF" + size_word(2) + size_word(28 + json.size() + binary.size()) +
         size_word(json.size()) + "JSON" + json + size_word(binary.size()) +
         std::string("BIN\0", 4) + binary;
}

}  // namespace artus::test
