// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/scene_reader.h"

#include "artus/detail/anatomy/import/draco_scene.h"
#include "artus/detail/core/byte_stream.h"

#ifdef ARTUS_HAS_ASSIMP
#include <cerrno>
#include <csignal>
#include <filesystem>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace artus {

std::string pack_parts(const std::vector<ScenePart>& parts) {
  ByteWriter out;
  out.put(static_cast<std::uint32_t>(parts.size()));
  for (const ScenePart& part : parts) {
    out.put(std::string_view(part.name));
    out.put_array(part.mesh.vertices);
    out.put_array(part.mesh.triangles);
  }
  return out.bytes();
}

Result<std::vector<ScenePart>> unpack_parts(std::string_view bytes, const std::string& name) {
  ByteReader in(bytes);
  std::vector<ScenePart> parts;
  const std::uint32_t n = in.get_count(sizeof(std::uint32_t));
  for (std::uint32_t i = 0; i < n && in.ok(); ++i) {
    ScenePart part;
    part.name = in.get_text();
    part.mesh.vertices = in.get_array<Vec3>();
    part.mesh.triangles = in.get_array<Triangle>();
    for (const Triangle& t : part.mesh.triangles)
      for (const auto v : t)
        if (v >= part.mesh.vertices.size()) in.refuse();
    parts.push_back(std::move(part));
  }
  if (!in.ok() || !in.at_end())
    return fail(ErrorCode::corrupt, "its parts did not come through whole", name);
  return parts;
}

#ifdef ARTUS_HAS_ASSIMP

bool reads_scenes() noexcept {
  return true;
}

namespace {

[[maybe_unused]] constexpr rlim_t kMostMemory = rlim_t{4} << 30U;  // bytes
constexpr rlim_t kMostSeconds = 120;

/// What the process that reads says: a byte for yes or no, then parts or the reason.
constexpr char kGood = '+';
constexpr char kBad = '-';

void add_parts(const aiScene& scene, const aiNode& node, const Eigen::Affine3d& above,
               const Eigen::Affine3d& to_lps, std::vector<ScenePart>& parts) {
  const aiMatrix4x4& m = node.mTransformation;
  Eigen::Affine3d own = Eigen::Affine3d::Identity();
  own.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1,
      m.d2, m.d3, m.d4;
  const Eigen::Affine3d here = above * own;
  ScenePart part;
  part.name = node.mName.C_Str();
  const bool turn = here.linear().determinant() < 0;
  for (unsigned k = 0; k < node.mNumMeshes; ++k) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[k]];
    if (part.name.empty()) part.name = mesh.mName.C_Str();
    const auto first = static_cast<std::uint32_t>(part.mesh.vertices.size());
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& v = mesh.mVertices[i];
      part.mesh.vertices.push_back(to_lps * (here * Vec3(v.x, v.y, v.z)));
    }
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& f = mesh.mFaces[i];
      if (f.mNumIndices != 3) continue;
      Triangle t{first + f.mIndices[0], first + f.mIndices[1], first + f.mIndices[2]};
      if (turn) std::swap(t[1], t[2]);
      part.mesh.triangles.push_back(t);
    }
  }
  if (!part.mesh.triangles.empty()) parts.push_back(std::move(part));
  for (unsigned k = 0; k < node.mNumChildren; ++k)
    add_parts(scene, *node.mChildren[k], here, to_lps, parts);
}

std::string read_here(std::string_view bytes, const std::string& name, double unit) {
  Assimp::Importer importer;
  const std::string extension = std::filesystem::path(name).extension().string();
  const bool is_gltf = extension == ".glb" || extension == ".gltf" || bytes.starts_with("glTF");
  const std::string hint =
      bytes.starts_with("glTF") ? "glb" : extension.substr(extension.empty() ? 0 : 1);
  // Text formats and glTF split vertices by their normals: joined again where places are equal.
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                              aiComponent_NORMALS | aiComponent_TEXCOORDS | aiComponent_COLORS |
                                  aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_MATERIALS |
                                  aiComponent_TEXTURES | aiComponent_ANIMATIONS |
                                  aiComponent_BONEWEIGHTS);
  const aiScene* scene = importer.ReadFileFromMemory(
      bytes.data(), bytes.size(),
      aiProcess_RemoveComponent | aiProcess_JoinIdenticalVertices | aiProcess_Triangulate,
      hint.c_str());
  if (scene == nullptr || scene->mRootNode == nullptr)
    return kBad + std::string(importer.GetErrorString());
  Eigen::Affine3d to_lps = Eigen::Affine3d::Identity();
  if (is_gltf)
    to_lps.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;  // metres, y up
  else
    to_lps.linear() *= unit;
  std::vector<ScenePart> parts;
  add_parts(*scene, *scene->mRootNode, Eigen::Affine3d::Identity(), to_lps, parts);
  return kGood + pack_parts(parts);
}

/// In the process that was made for it: reads, writes what came out, ends.
[[noreturn]] void read_and_end(int out, std::string_view bytes, const std::string& name,
                               double unit) {
#ifndef ARTUS_SANITIZED
  const rlimit memory{kMostMemory, kMostMemory};
  setrlimit(RLIMIT_AS, &memory);
#endif
  const rlimit seconds{kMostSeconds, kMostSeconds};
  setrlimit(RLIMIT_CPU, &seconds);
  std::string answer;
  try {
    const auto plain = expand_draco(bytes, name);
    answer = plain ? read_here(*plain, name, unit) : kBad + plain.error().message;
  } catch (const std::exception& e) {
    answer = kBad + std::string(e.what());
  }
  std::string_view rest = answer;
  while (!rest.empty()) {
    const ssize_t n = write(out, rest.data(), rest.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    rest.remove_prefix(static_cast<std::size_t>(n));
  }
  _exit(rest.empty() ? 0 : 1);
}

std::string read_all(int in) {
  std::string all;
  std::array<char, 65536> buffer;
  while (true) {
    const ssize_t n = read(in, buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return all;
    all.append(buffer.data(), static_cast<std::size_t>(n));
  }
}

}  // namespace

Result<std::vector<ScenePart>> read_scene(std::string_view bytes, const std::string& name,
                                          double unit) {
  std::array<int, 2> pipe_ends{};
  if (pipe(pipe_ends.data()) != 0)
    return fail(ErrorCode::failed, "no process can be started to read it", name);
  const pid_t process = fork();
  if (process == 0) {
    close(pipe_ends[0]);
    read_and_end(pipe_ends[1], bytes, name, unit);
  }
  close(pipe_ends[1]);
  const std::string answer = process > 0 ? read_all(pipe_ends[0]) : std::string();
  close(pipe_ends[0]);
  int status = 0;
  while (process > 0 && waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (process < 0 || !WIFEXITED(status) || WEXITSTATUS(status) != 0 || answer.empty())
    return fail(
        ErrorCode::failed,
        "the reader of scenes did not finish: the file is damaged or far too large; open it "
        "in Blender and export it again",
        name);
  if (answer.front() == kBad)
    return fail(ErrorCode::malformed,
                "it cannot be read: " + answer.substr(1, 300) +
                    "; open it in Blender and export it as one .glb",
                name);
  auto parts = unpack_parts(std::string_view(answer).substr(1), name);
  ARTUS_TRY(parts);
  if (parts->empty()) return fail(ErrorCode::invalid, "there is no surface in this scene", name);
  return parts;
}

#else

bool reads_scenes() noexcept {
  return false;
}

Result<std::vector<ScenePart>> read_scene(std::string_view, const std::string& name, double) {
  return fail(ErrorCode::unsupported,
              "this build of artus reads no scenes (libassimp-dev was not there); export each part "
              "as STL or PLY",
              name);
}

#endif

}  // namespace artus
