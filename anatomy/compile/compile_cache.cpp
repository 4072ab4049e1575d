// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <cstdio>
#include <cstdlib>

#include "artus/anatomy/body/tissue_bytes.h"
#include "artus/anatomy/compile/compile.h"
#include "artus/anatomy/compile/compiler_version.h"
#include "artus/anatomy/surfaces/surface_io.h"
#include "artus/core/byte_stream.h"
#include "artus/core/text_file.h"

namespace artus {
namespace {

std::string to_hex(std::uint64_t value) {
  std::array<char, 17> text{};
  static_cast<void>(
      std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(value)));
  return text.data();
}

/// Nothing in artus changes the environment while threads run.
std::filesystem::path folder_from_environment(const char* name) {
  const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): see above
  return value != nullptr ? value : "";
}

std::filesystem::path default_cache() {
  if (const auto cache = folder_from_environment("XDG_CACHE_HOME"); !cache.empty()) {
    return cache / "artus";
  }
  if (const auto home = folder_from_environment("HOME"); !home.empty()) {
    return home / ".cache" / "artus";
  }
  return std::filesystem::temp_directory_path() / "artus-cache";
}

Result<CompiledJoint> load_folder(const std::filesystem::path& folder, const LoadOptions& options,
                                  const Progress& progress) {
  const Result<JointFile> file = read_joint(folder, options.surfaces);
  if (!file) return tl::unexpected(file.error());
  const Result<std::string> digest = compute_source_digest(*file);
  if (!digest) return tl::unexpected(digest.error());
  const auto cache = options.cache.empty() ? default_cache() : options.cache;
  const std::string suffix = options.compile.skip_refused ? "-partial.artus" : ".artus";
  const auto cached = cache / (file->name + "-" + *digest + suffix);
  if (auto joint = read_compiled_joint(cached); joint && joint->source_digest == *digest) {
    return joint;
  }
  Result<CompileOutcome> outcome = compile_joint(*file, options.compile, progress);
  if (!outcome) return tl::unexpected(outcome.error());
  std::error_code ignored;
  std::filesystem::create_directories(cache, ignored);
  static_cast<void>(write_compiled_joint(outcome->joint, cached));
  return std::move(outcome->joint);
}

}  // namespace

Result<std::string> compute_source_digest(const JointFile& file) {
  std::uint64_t low = kCompilerVersion;
  std::uint64_t high = ~kCompilerVersion;
  const auto add = [&](std::string_view bytes) {
    low = hash_bytes(bytes, low);
    high = hash_bytes(bytes, high);
  };
  const auto add_file = [&](const std::filesystem::path& path) -> Result<void> {
    const Result<std::string> bytes = read_bytes(path);
    if (!bytes) return tl::unexpected(bytes.error());
    add(*bytes);
    return {};
  };
  if (auto done = add_file(file.folder / "joint.toml"); !done) return tl::unexpected(done.error());
  ByteWriter tissues;
  put_tissues(tissues, file.tissues);
  add(tissues.bytes());
  std::vector<const Structure*> all{&file.body};
  for (const Structure& s : file.structures) all.push_back(&s);
  for (const Structure* s : all) {
    const auto* surface = std::get_if<SurfaceFile>(&s->shape);
    if (surface == nullptr) continue;
    if (auto done = add_file(file.surface_folder / surface->file); !done) {
      return tl::unexpected(done.error());
    }
  }
  return to_hex(low) + to_hex(high);
}

Result<CompiledJoint> load_joint(const std::filesystem::path& path, const LoadOptions& options,
                                 const Progress& progress) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return load_folder(path, options, progress);
  return read_compiled_joint(path);
}

}  // namespace artus
