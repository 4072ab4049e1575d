// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/anatomy/compiled_joint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include <unistd.h>

#include "artus/detail/anatomy/body/joint_digest.h"
#include "artus/detail/anatomy/body/joint_path.h"
#include "artus/detail/anatomy/body/joint_pose_bytes.h"
#include "artus/detail/anatomy/body/space_bytes.h"
#include "artus/detail/anatomy/body/tissue_bytes.h"
#include "artus/detail/core/byte_stream.h"
#include "artus/detail/core/printed.h"

namespace artus {
namespace {

constexpr std::uint64_t kMagic = 0x0a544e4a53545241ULL;  // "ARTSJNT\n"
constexpr std::uint32_t kVersion = 4;
constexpr std::size_t kHeaderSize = 32;

struct Header {
  std::uint64_t magic;
  std::uint32_t version;
  std::uint32_t reserved;
  std::uint64_t length;
  std::uint64_t checksum;
};
static_assert(sizeof(Header) == kHeaderSize);

void put(ByteWriter& out, const Vec3& v) {
  for (Eigen::Index a = 0; a < 3; ++a) out.put(v[a]);
}

Vec3 get_vec3(ByteReader& in) {
  Vec3 v;
  for (Eigen::Index a = 0; a < 3; ++a) v[a] = in.get<double>();
  return v;
}

void put_regions(ByteWriter& out, const std::vector<Region>& regions) {
  out.put(static_cast<std::uint32_t>(regions.size()));
  for (const Region& r : regions) {
    out.put(std::string_view(r.name));
    out.put(r.tissue);
    put(out, r.fibre_axis);
    out.put(static_cast<std::uint8_t>(r.fibre_course));
  }
}

std::vector<Region> get_regions(ByteReader& in) {
  std::vector<Region> regions(in.get_count(4));
  for (Region& r : regions) {
    r.name = in.get_text();
    r.tissue = in.get<TissueId>();
    r.fibre_axis = get_vec3(in);
    r.fibre_course = in.get<std::uint8_t>() == 0 ? FibreCourse::ends : FibreCourse::layer;
  }
  return regions;
}

void put_scene(ByteWriter& out, const CompiledJoint& joint) {
  out.put(static_cast<std::uint32_t>(joint.landmarks.size()));
  for (const Landmark& l : joint.landmarks) {
    out.put(std::string_view(l.name));
    put(out, l.position);
  }
  put_pose(out, joint.X_JP_default);
  put_pose(out, joint.X_JN_default);
  out.put(static_cast<std::uint32_t>(joint.injections.size()));
  for (const PlannedInjection& i : joint.injections) {
    out.put(std::string_view(i.name));
    put(out, i.entry);
    put(out, i.target);
  }
}

void get_scene(ByteReader& in, CompiledJoint& joint) {
  joint.landmarks.resize(in.get_count(4));
  for (Landmark& l : joint.landmarks) {
    l.name = in.get_text();
    l.position = get_vec3(in);
  }
  joint.X_JP_default = get_pose(in);
  joint.X_JN_default = get_pose(in);
  joint.injections.resize(in.get_count(4));
  for (PlannedInjection& i : joint.injections) {
    i.name = in.get_text();
    i.entry = get_vec3(in);
    i.target = get_vec3(in);
  }
}

void put_mesh(ByteWriter& out, const TetMesh& mesh) {
  out.put_array(mesh.vertices);
  out.put_array(mesh.tetrahedra);
  out.put_array(mesh.regions);
  out.put_array(mesh.interfaces);
}

TetMesh get_mesh(ByteReader& in) {
  static_assert(sizeof(Vec3) == 24 && sizeof(Interface) == 16);
  TetMesh mesh;
  mesh.vertices = in.get_array<Vec3>();
  mesh.tetrahedra = in.get_array<std::array<std::uint32_t, 4>>();
  mesh.regions = in.get_array<RegionId>();
  mesh.interfaces = in.get_array<Interface>();
  return mesh;
}

// Empty when every index and number is usable.
std::string find_mesh_fault(const TetMesh& mesh, std::size_t n_regions) {
  const auto finite = [](const Vec3& v) {
    return v.allFinite();
  };
  if (!std::all_of(mesh.vertices.begin(), mesh.vertices.end(), finite)) {
    return "a vertex is not finite";
  }
  if (mesh.regions.size() != mesh.tetrahedra.size())
    return "regions and tetrahedra differ in number";
  const auto known = [n = mesh.vertices.size()](std::uint32_t v) {
    return v < n;
  };
  for (const auto& t : mesh.tetrahedra) {
    if (!std::all_of(t.begin(), t.end(), known)) return "a tetrahedron's vertex is out of range";
  }
  for (const RegionId r : mesh.regions) {
    if (r >= n_regions) return "a tetrahedron's region is out of range";
  }
  for (const Interface& f : mesh.interfaces) {
    if (!std::all_of(f.vertices.begin(), f.vertices.end(), known)) {
      return "an interface's vertex is out of range";
    }
    if (f.front >= n_regions || f.back >= n_regions) return "an interface's region is out of range";
    if (f.front == f.back) return "an interface has one region on both sides";
  }
  return {};
}

std::string find_fault(const CompiledJoint& joint) {
  if (joint.regions.size() < kFirstRegion) return "the first two regions are missing";
  for (const Region& r : joint.regions) {
    if (r.tissue >= joint.tissues.size()) return "a region's tissue is out of range";
  }
  return find_mesh_fault(joint.mesh, joint.regions.size());
}

std::string to_bytes(const CompiledJoint& joint) {
  ByteWriter out;
  for (const std::string* text : {&joint.name, &joint.side, &joint.axes, &joint.source_digest}) {
    out.put(std::string_view(*text));
  }
  put_tissues(out, joint.tissues);
  put_regions(out, joint.regions);
  put_scene(out, joint);
  put_mesh(out, joint.mesh);
  const bool has_views = !joint.views.empty();
  const bool has_poses = has_views || !joint.poses.empty();
  if (has_poses || !joint.spaces.empty()) put_spaces(out, joint.spaces);
  if (has_poses) put_poses(out, joint.poses);
  if (has_views) put_views(out, joint.views);
  return out.bytes();
}

CompiledJoint from_bytes(ByteReader& in) {
  CompiledJoint joint;
  for (std::string* text : {&joint.name, &joint.side, &joint.axes, &joint.source_digest}) {
    *text = in.get_text();
  }
  joint.tissues = get_tissues(in);
  joint.regions = get_regions(in);
  get_scene(in, joint);
  joint.mesh = get_mesh(in);
  if (!in.at_end()) joint.spaces = get_spaces(in);
  if (!in.at_end()) joint.poses = get_poses(in);
  if (!in.at_end()) joint.views = get_views(in);
  return joint;
}

Result<std::string> read_payload(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    return fail(ErrorCode::not_found, "no such compiled joint", file.string());
  }
  std::ifstream in(file, std::ios::binary);
  Header header{};
  if (!in) return fail(ErrorCode::unreadable, "cannot be opened", file.string());
  const auto size = std::filesystem::file_size(file, error);
  if (error || size < kHeaderSize || !in.read(reinterpret_cast<char*>(&header), kHeaderSize) ||
      header.magic != kMagic) {
    return fail(ErrorCode::corrupt, "is not a compiled joint", file.string());
  }
  if (header.version != kVersion) {
    return fail(ErrorCode::unsupported,
                "was compiled by another version of artus; compile it again", file.string());
  }
  if (header.reserved != 0 || header.length != size - kHeaderSize) {
    return fail(ErrorCode::corrupt, "is truncated or has grown; compile it again", file.string());
  }
  std::string payload(header.length, '\0');
  if (!in.read(payload.data(), static_cast<std::streamsize>(payload.size()))) {
    return fail(ErrorCode::unreadable, "cannot be read to its end", file.string());
  }
  if (hash_bytes(payload) != header.checksum) {
    return fail(ErrorCode::corrupt, "fails its checksum; compile it again", file.string());
  }
  return payload;
}

}  // namespace

Result<CompiledJoint> parse_compiled_joint(const std::string& payload, const std::string& where) {
  ByteReader in(payload);
  CompiledJoint joint = from_bytes(in);
  if (!in.ok() || !in.at_end()) {
    return fail(ErrorCode::corrupt, "its sections do not add up; compile it again", where);
  }
  const std::string fault = find_fault(joint);
  if (!fault.empty()) return fail(ErrorCode::corrupt, fault + "; compile it again", where);
  return joint;
}

Result<void> write_compiled_joint(const CompiledJoint& joint, const std::filesystem::path& file) {
  std::error_code ignored_status;
  const auto status = std::filesystem::status(file, ignored_status);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    return fail(ErrorCode::unreadable, "cannot be written: this is a folder or a device",
                file.string());
  const std::string payload = to_bytes(joint);
  const Header header{kMagic, kVersion, 0, payload.size(), hash_bytes(payload)};
  std::filesystem::path temporary = file;
  temporary += "." + std::to_string(::getpid()) + ".tmp";
  {
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    out.write(reinterpret_cast<const char*>(&header), kHeaderSize);
    out.write(payload.data(), static_cast<std::streamsize>(payload.size()));
    out.flush();
    if (!out) {
      std::error_code ignored;
      std::filesystem::remove(temporary, ignored);
      return fail(ErrorCode::unreadable, "cannot be written", file.string());
    }
  }
  std::error_code error;
  std::filesystem::rename(temporary, file, error);
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    return fail(ErrorCode::unreadable, "cannot be written: " + error.message(), file.string());
  }
  return {};
}

Result<CompiledJoint> read_compiled_joint(const std::filesystem::path& name) {
  const std::filesystem::path file = find_joint(name);
  const Result<std::string> payload = read_payload(file);
  ARTUS_TRY(payload);
  return parse_compiled_joint(*payload, file.string());
}

std::string compute_joint_digest(const CompiledJoint& joint) {
  CompiledJoint body = joint;
  body.source_digest.clear();  // the same body may come of other sources
  body.poses.clear();          // and be held in other ways
  body.views.clear();          // and be looked at from elsewhere
  return in_hexadecimal(hash_bytes(to_bytes(body)));
}

}  // namespace artus
