// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "artus/anatomy/joint_file.h"
#include "artus/core/result.h"
#include "artus/detail/anatomy/compile/labels/part_cache.h"
#include "artus/detail/anatomy/surfaces/surface_mesh.h"

namespace artus {

/// A joint file and the surfaces that it names. Each surface file is read, digested and parsed when
/// it is first asked for, and never again: whoever compiles, checks and reports on one joint hands
/// the same sources on. May be asked by many threads. Memory: the surfaces, as long as it lives.
class JointSources {
 public:
  /// Reads nothing yet. Not explicit: a JointFile will do wherever its surfaces are wanted once.
  JointSources(JointFile joint);  // NOLINT(google-explicit-constructor)
  JointSources(const JointSources&) = delete;
  JointSources& operator=(const JointSources&) = delete;
  JointSources(JointSources&&) = delete;
  JointSources& operator=(JointSources&&) = delete;
  ~JointSources();

  [[nodiscard]] const JointFile& joint() const noexcept { return joint_; }

  /// Over the bytes of a surface's file. Errors: not_found, unreadable.
  [[nodiscard]] Result<ContentDigest> digest(const SurfaceFile& surface) const;

  /// The frame that a surface's file says it is in: "RAS" or "LPS" by SPACE= of its header, as 3D
  /// Slicer writes it; empty: it says none. Errors: not_found, unreadable.
  [[nodiscard]] Result<std::string> declared_axes(const SurfaceFile& surface) const;

  /// The surface as its file has it, in metres; never null. Errors: those of read_surface.
  [[nodiscard]] Result<std::shared_ptr<const SurfaceMesh>> mesh(const SurfaceFile& surface) const;

  /// Whether `file` is one of those that the joint is made of: joint.toml, its tissue library, a
  /// surface. Whoever writes there destroys the joint.
  [[nodiscard]] bool contains(const std::filesystem::path& file) const;

 private:
  struct File;
  [[nodiscard]] File& file_of(const SurfaceFile& surface) const;
  void read(const SurfaceFile& surface, File& file) const;

  JointFile joint_;
  mutable std::mutex mutex_;  // of files_; each file has its own
  mutable std::map<std::pair<std::filesystem::path, double>, std::unique_ptr<File>> files_;
};

/// Hex digest of all that shapes the body: surfaces, version of the compiler, and the joint file
/// without what can be changed afterwards (JointFile::shape). Errors: not_found, unreadable.
[[nodiscard]] Result<std::string> compute_source_digest(const JointSources& sources);

}  // namespace artus
