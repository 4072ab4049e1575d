// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/label_volume.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "artus/detail/anatomy/import/volumes/inflate.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_cursor.h"

namespace artus {
namespace {

constexpr std::size_t kValues = 65536;

/// Which segment a value of a layer is; 0: none.
using ValueTable = std::vector<std::uint16_t>;

/// The segments of file and user by layer and value.
class Segments {
 public:
  Segments(const ImageVolume& volume, const StructureNames& names)
      : tables_(volume.layers, ValueTable(kValues, 0)), is_named_(!volume.segments.empty()) {
    for (const SegmentName& s : volume.segments) {
      if (s.layer >= volume.layers || !(s.value >= 1 && s.value < kValues)) continue;
      add(s.layer, s.value, s.name, s.code);
    }
    for (const NamedLabel& label : names.labels) {
      const auto at = tables_.front()[static_cast<std::size_t>(label.value)];
      if (at != 0)
        segments[at - 1U].name = label.name;
      else
        add(0, label.value, label.name, {});
    }
  }
  /// The segment of a value, which is made where the file does not name it.
  std::uint16_t of(std::size_t layer, std::size_t value) {
    std::uint16_t& at = tables_[layer][value];
    if (at == 0 && segments.size() < kValues - 1) {
      add(layer, static_cast<double>(value), {}, {});
      unnamed.push_back(segments.size() - 1);
    }
    return at;
  }

  std::vector<LabelSegment> segments;
  std::vector<std::size_t> unnamed;  ///< places in segments

 private:
  void add(std::size_t layer, double value, std::string name, std::string code) {
    segments.push_back({std::move(name), value, std::move(code), 0, 0});
    tables_[layer][static_cast<std::size_t>(value)] = static_cast<std::uint16_t>(segments.size());
  }
  std::vector<ValueTable> tables_;
  bool is_named_;
};

std::string describe_no_label(double value) {
  if (!std::isfinite(value)) return "a voxel that is no number";
  return printed("a voxel of %.6g", value);
}

/// Labels of all voxels. Errors: invalid.
Result<void> fill_labels(const ImageVolume& volume, Segments& segments, LabelVolume& out,
                         const std::string& name) {
  double wrong = 0;
  bool ok = true;
  with_samples(volume, [&](const auto* samples) {
    const std::size_t n = volume.n_voxels();
    for (std::size_t i = 0; i < n && ok; ++i) {
      std::uint16_t label = 0;
      for (std::size_t layer = 0; layer < volume.layers; ++layer) {
        const auto stored = samples[i * volume.layers + layer];
        if (stored == 0 && volume.intercept == 0) continue;
        const double value = volume.slope * static_cast<double>(stored) + volume.intercept;
        if (value == 0) continue;
        if (!(value > 0 && value < kValues && value == std::floor(value))) {
          wrong = value;
          ok = false;
          break;
        }
        const std::uint16_t other = segments.of(layer, static_cast<std::size_t>(value));
        if (label == 0) {
          label = other;
        } else {
          ++segments.segments[std::max(label, other) - 1U].n_lost;
          label = std::min(label, other);
        }
      }
      if (label == 0) continue;
      ++segments.segments[label - 1U].n_voxels;
      out.labels[i] = label;
    }
  });
  if (ok) return {};
  return fail(ErrorCode::invalid,
              "it has " + describe_no_label(wrong) +
                  "; labels are whole numbers from 0 to 65535: is it the scan and not its "
                  "segmentation?",
              name);
}

/// What to write so that labels have names.
tl::unexpected<Error> ask_for_names(Segments& segments, const std::string& name) {
  constexpr std::size_t kMost = 12;
  std::sort(segments.unnamed.begin(), segments.unnamed.end(), [&](std::size_t a, std::size_t b) {
    return segments.segments[a].value < segments.segments[b].value;
  });
  std::string list;
  std::string first;
  for (std::size_t k = 0; k < segments.unnamed.size(); ++k) {
    const LabelSegment& s = segments.segments[segments.unnamed[k]];
    if (k < kMost) list += printed("%s%.0f (%zu voxels)", k > 0 ? ", " : "", s.value, s.n_voxels);
    if (k == 0) first = printed("%.0f", s.value);
  }
  if (segments.unnamed.size() > kMost)
    list += printed(" and %zu more", segments.unnamed.size() - kMost);
  return fail(
      ErrorCode::invalid,
      "the file does not name its labels: " + list +
          ". Write a file names.toml with, for each, the lines '[[label]]', 'value = " + first +
          "', 'name = \"femur\"', and give it with --labels names.toml (a colour "
          "table .ctbl of 3D Slicer will do, too)",
      name);
}

/// Takes the segments without voxels out and numbers the rest anew.
void drop_empty(LabelVolume& out) {
  constexpr std::size_t kNone = 1;  // voxel: how 3D Slicer writes an empty segment
  std::vector<std::uint16_t> to(out.segments.size() + 1, 0);
  std::vector<LabelSegment> kept;
  std::string empty;
  for (std::size_t i = 0; i < out.segments.size(); ++i) {
    LabelSegment& s = out.segments[i];
    if (s.n_voxels > kNone) {
      kept.push_back(std::move(s));
      to[i + 1] = static_cast<std::uint16_t>(kept.size());
    } else if (s.n_voxels > 0 || s.n_lost > 0 || !s.name.empty()) {
      empty += (empty.empty() ? "" : ", ") + s.name;
    }
  }
  if (kept.size() != out.segments.size())
    for (std::uint16_t& label : out.labels) label = to[label];
  out.segments = std::move(kept);
  if (!empty.empty() && empty.size() < 500)
    out.notes.push_back("segments without voxels are left out: " + empty);
  else if (!empty.empty())
    out.notes.push_back("many segments of the file's list have no voxels and are left out");
}

}  // namespace

double LabelVolume::voxel_volume() const noexcept {
  return std::abs(X_LI.linear().determinant());
}
double LabelVolume::voxel_edge() const noexcept {
  return std::cbrt(voxel_volume());
}

Result<LabelVolume> make_label_volume(const ImageVolume& volume, const StructureNames& names,
                                      const std::string& name) {
  LabelVolume out;
  out.format = volume.format;
  out.size = volume.size;
  out.X_LI = rounded_frame(volume.X_LI);
  out.notes = volume.notes;
  out.labels.assign(volume.n_voxels(), 0);
  Segments segments(volume, names);
  ARTUS_TRY(fill_labels(volume, segments, out, name));
  if (!segments.unnamed.empty()) return ask_for_names(segments, name);
  out.segments = std::move(segments.segments);
  drop_empty(out);
  if (out.segments.empty())
    return fail(ErrorCode::invalid, "no voxel of it has a label: it is empty", name);
  for (const LabelSegment& s : out.segments)
    if (s.n_lost > 0)
      out.notes.push_back(
          printed("'%s' overlaps segments before it in the file: %zu voxels of it "
                  "are theirs",
                  s.name.c_str(), s.n_lost));
  return out;
}

}  // namespace artus
