// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/import_files.h"

#include <algorithm>

#include "artus/detail/anatomy/import/assumed_structures.h"
#include "artus/detail/anatomy/import/import_cells.h"
#include "artus/detail/anatomy/import/scene_parts.h"
#include "artus/detail/anatomy/import/swept_tube.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_file.h"

namespace artus {
namespace {

/// A file's name without folder and endings: "femur_left.nii.gz" is "femur_left".
std::string stem_of(const std::string& file) {
  const std::string name = std::filesystem::path(file).filename().string();
  return name.substr(0, name.find('.'));
}

bool is_same_grid(const ImageVolume& a, const ImageVolume& b) {
  constexpr double kApart = 1e-3;  // voxel
  return a.size == b.size && (a.X_LI.matrix() - b.X_LI.matrix()).cwiseAbs().maxCoeff() <=
                                 kApart * a.X_LI.linear().colwise().norm().minCoeff();
}

Result<ImportedJoint> import_volume(const std::string& bytes, const std::string& name,
                                    const ImportOptions& options, const Progress& progress) {
  auto labels = read_labels(bytes, name, options.names, options.threshold);
  ARTUS_TRY(labels);
  return import_labels(std::move(*labels), options, name, progress);
}

Result<ImportedJoint> import_masks(const std::vector<std::string>& contents,
                                   const std::vector<std::string>& names,
                                   const ImportOptions& options, const Progress& progress) {
  std::vector<ImageVolume> masks;
  for (std::size_t i = 0; i < names.size(); ++i) {
    auto mask = parse_volume(contents[i], names[i]);
    ARTUS_TRY(mask);
    masks.push_back(std::move(*mask));
  }
  auto labels = join_masks(masks, names);
  ARTUS_TRY(labels);
  const std::string folder = std::filesystem::path(names.front()).parent_path().filename().string();
  return import_labels(std::move(*labels), options, folder.empty() ? names.front() : folder,
                       progress);
}

}  // namespace

Result<LabelVolume> join_masks(const std::vector<ImageVolume>& masks,
                               const std::vector<std::string>& names) {
  LabelVolume out;
  out.format = masks.front().format + " masks";
  out.size = masks.front().size;
  out.X_LI = masks.front().X_LI;
  out.notes = masks.front().notes;
  out.labels.assign(masks.front().n_voxels(), 0);
  for (std::size_t i = 0; i < masks.size(); ++i) {
    if (!is_same_grid(masks[i], masks.front()))
      return fail(ErrorCode::invalid,
                  "its grid is not that of " + names.front() + "; export all masks of one scan",
                  names[i]);
    StructureNames named;
    named.labels = {{1, stem_of(names[i]), {}}};
    const auto one = make_label_volume(masks[i], named, names[i]);
    if (!one && one.error().message.find("it is empty") != std::string::npos) {
      out.notes.push_back("'" + stem_of(names[i]) + "' has no voxels and is left out");
      continue;
    }
    ARTUS_TRY(one);
    if (one->segments.size() != 1)
      return fail(
          ErrorCode::invalid,
          "it has more than one label, so that it is no mask beside others; import it alone",
          names[i]);
    LabelSegment segment = one->segments.front();
    segment.n_voxels = 0;
    const auto label = static_cast<std::uint16_t>(out.segments.size() + 1);
    for (std::size_t k = 0; k < out.labels.size(); ++k) {
      if (one->labels[k] == 0) continue;
      ++(out.labels[k] == 0 ? segment.n_voxels : segment.n_lost);
      if (out.labels[k] == 0) out.labels[k] = label;
    }
    if (segment.n_lost > 0)
      out.notes.push_back(printed("'%s' overlaps masks before it: %zu voxels of it are theirs",
                                  segment.name.c_str(), segment.n_lost));
    out.segments.push_back(std::move(segment));
  }
  if (out.segments.empty())
    return fail(ErrorCode::invalid, "no voxel of any mask is set", names.front());
  return out;
}

namespace {

/// The joint without what was typed.
Result<ImportedJoint> import_structures(const std::vector<std::filesystem::path>& files,
                                        const ImportOptions& options, const Progress& progress) {
  std::vector<std::string> contents;
  std::vector<std::string> names;
  std::size_t n_volumes = 0;
  for (const auto& file : files) {
    if (progress) progress("reading", 0);
    auto bytes = read_bytes(file);
    ARTUS_TRY(bytes);
    names.push_back(file.string());
    n_volumes += is_volume(kind_of_source(*bytes, names.back())) ? 1U : 0U;
    contents.push_back(std::move(*bytes));
  }
  if (files.empty()) return fail(ErrorCode::invalid, "no file is named");
  if (n_volumes > 0 && n_volumes < files.size())
    return fail(ErrorCode::invalid,
                "label volumes and surfaces are not imported together; import the segmentation, "
                "and add surfaces to its joint.toml",
                names.front());
  if (n_volumes == 1) return import_volume(contents.front(), names.front(), options, progress);
  if (n_volumes > 1) return import_masks(contents, names, options, progress);
  if (names.size() == 1) {
    const auto cells = read_cells(contents.front(), names.front());
    ARTUS_TRY(cells);
    if (*cells && (*cells)->has_volume())
      return import_cells(**cells, options, names.front(), progress);
  }
  std::vector<ScenePart> parts;
  for (std::size_t i = 0; i < names.size(); ++i) {
    auto more = read_scene_parts(contents[i], names[i], options.surface_unit.value_or(1e-3));
    ARTUS_TRY(more);
    for (ScenePart& part : *more) parts.push_back(std::move(part));
  }
  return import_parts(std::move(parts), options, names.front(), progress);
}

}  // namespace

Result<ImportedJoint> import_files(const std::vector<std::filesystem::path>& files,
                                   const ImportOptions& options, const Progress& progress) {
  auto joint = import_structures(files, options, progress);
  ARTUS_TRY(joint);
  ARTUS_TRY(add_tubes(*joint, options.names.tubes));
  ARTUS_TRY(add_assumed(*joint, options));
  return joint;
}

}  // namespace artus
