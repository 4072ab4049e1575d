// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/labels/joint_sources.h"

#include <optional>
#include <vector>

#include "artus/detail/anatomy/compile/labels/compiler_version.h"
#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "artus/detail/core/text_file.h"

namespace artus {
namespace {

std::string axes_of_header(std::string_view bytes) {
  constexpr std::size_t kHeader = 256;  // bytes: the 80 of an STL, the comments of others
  constexpr std::string_view kKey = "SPACE=";
  const std::string_view head = bytes.substr(0, kHeader);
  const auto at = head.find(kKey);
  if (at == std::string_view::npos) return {};
  const std::string_view axes = head.substr(at + kKey.size(), 3);
  return axes == "RAS" || axes == "LPS" ? std::string(axes) : std::string();
}

}  // namespace

struct JointSources::File {
  std::mutex mutex;
  bool is_read = false;
  std::string bytes;  // until they are parsed
  std::optional<Error> unreadable;
  ContentDigest digest{0};
  std::string axes;  // that its header names
  std::optional<Result<std::shared_ptr<const SurfaceMesh>>> mesh;
};

JointSources::JointSources(JointFile joint) : joint_(std::move(joint)) {}
JointSources::~JointSources() = default;

JointSources::File& JointSources::file_of(const SurfaceFile& surface) const {
  const std::scoped_lock lock(mutex_);
  auto& file = files_[{surface.file, surface.unit}];
  if (!file) file = std::make_unique<File>();
  return *file;
}

void JointSources::read(const SurfaceFile& surface, File& file) const {
  if (file.is_read) return;
  file.is_read = true;
  auto bytes = read_bytes(joint_.surface_folder / surface.file);
  if (!bytes) {
    file.unreadable = bytes.error();
    return;
  }
  file.bytes = std::move(*bytes);
  file.digest.add(file.bytes);
  file.axes = axes_of_header(file.bytes);
}

Result<std::string> JointSources::declared_axes(const SurfaceFile& surface) const {
  File& file = file_of(surface);
  const std::scoped_lock lock(file.mutex);
  read(surface, file);
  if (file.unreadable) return tl::unexpected(*file.unreadable);
  return file.axes;
}

Result<ContentDigest> JointSources::digest(const SurfaceFile& surface) const {
  File& file = file_of(surface);
  const std::scoped_lock lock(file.mutex);
  read(surface, file);
  if (file.unreadable) return tl::unexpected(*file.unreadable);
  return file.digest;
}

Result<std::shared_ptr<const SurfaceMesh>> JointSources::mesh(const SurfaceFile& surface) const {
  File& file = file_of(surface);
  const std::scoped_lock lock(file.mutex);
  if (file.mesh) return *file.mesh;
  read(surface, file);
  if (file.unreadable) return tl::unexpected(*file.unreadable);
  const std::string bytes = std::exchange(file.bytes, {});
  auto parsed = parse_surface(bytes, (joint_.surface_folder / surface.file).string(), surface.unit);
  if (parsed)
    file.mesh.emplace(std::make_shared<const SurfaceMesh>(std::move(*parsed)));
  else
    file.mesh.emplace(tl::unexpected(parsed.error()));
  return *file.mesh;
}

bool JointSources::contains(const std::filesystem::path& file) const {
  std::vector<std::filesystem::path> all{joint_.folder / "joint.toml"};
  if (!joint_.tissue_library.empty()) all.push_back(joint_.tissue_library);
  const auto add = [&](const Structure& s) {
    if (const auto* surface = std::get_if<SurfaceFile>(&s.shape))
      all.push_back(joint_.surface_folder / surface->file);
  };
  if (const auto& cuts = std::get<SurfaceFile>(joint_.body.shape).cuts; !cuts.empty())
    all.push_back(joint_.surface_folder / cuts);
  add(joint_.body);
  for (const Structure& s : joint_.structures) add(s);
  std::error_code ignored;
  for (const auto& source : all)
    if (std::filesystem::equivalent(source, file, ignored)) return true;
  return false;
}

Result<std::string> compute_source_digest(const JointSources& sources) {
  const JointFile& joint = sources.joint();
  ContentDigest digest(kCompilerVersion);
  digest.add(joint.shape);
  std::vector<const Structure*> all{&joint.body};
  for (const Structure& s : joint.structures) all.push_back(&s);
  for (const Structure* s : all) {
    const auto* surface = std::get_if<SurfaceFile>(&s->shape);
    if (surface == nullptr) continue;
    const auto of_file = sources.digest(*surface);
    ARTUS_TRY(of_file);
    digest.add(*of_file);
    if (surface->cuts.empty()) continue;
    SurfaceFile cuts = *surface;
    cuts.file = surface->cuts;
    const auto of_cuts = sources.digest(cuts);
    ARTUS_TRY(of_cuts);
    digest.add(*of_cuts);
  }
  return digest.hex();
}

}  // namespace artus
