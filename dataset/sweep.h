// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/dataset/pose_list.h"
#include "artus/detail/core/progress.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/needle_view.h"
#include "artus/echo/transducer.h"
#include "artus/echo/transducer_file.h"
#include "artus/raycast/scene.h"

namespace artus {

/// Which truth goes with a frame: where the picture shows things, where they are, or both.
enum class SweepTruth : std::uint8_t { shown, real, both };
inline constexpr std::array<std::string_view, 3> kSweepTruthNames{"shown", "true", "both"};

struct RfLines;

/// Files of lines before the envelope.
struct LineFile {
  std::string ending;                                         ///< without the dot
  std::function<Result<std::string>(const RfLines&)> encode;  ///< their bytes
};

struct SweepOptions {
  Transducer transducer;
  ImageSettings settings;  ///< without persistence: a frame must not depend on the one before
  NeedleShape needle;
  std::vector<std::shared_ptr<const Scene>> patients{};  ///< further joints that frames may name
  std::vector<TransducerPreset> transducers{};           ///< further probes that frames may name
  SweepTruth truth = SweepTruth::shown;
  std::optional<LineFile> rf{};  ///< also write each frame's lines; not of compound pictures
  bool restart = false;          ///< throw away what an earlier sweep left in the folder
  std::function<bool()> stop{};  ///< asked before each frame; true ends the sweep, to be continued
};

struct SweepResult {
  std::size_t poses = 0;       ///< in the list
  std::size_t found = 0;       ///< finished by earlier runs
  std::size_t drawn = 0;       ///< by this one
  std::size_t off_skin = 0;    ///< of those drawn: no part of the probe's face touches skin
  std::size_t partly_off = 0;  ///< of those drawn: some of it does not, and is black
  [[nodiscard]] bool complete() const noexcept { return found + drawn == poses; }
};

/// Draws a list of poses into `folder`:
///   sweep.json            what was asked for; another sweep is not mixed into the same folder
///   truth.jsonl           a line for each finished frame, in the order of the list
///   frames/NNNNNN.png     B-mode, 8 bit
///   frames/NNNNNN-labels_shown.png, -shadow_shown.png, -needle_shown.png   region ids (16 bit) and
///                         masks where the picture shows things; -labels_true.png ... where they
///                         are
///   frames/NNNNNN-rf.npz  lines before the envelope, where they are asked for
/// A sweep that was stopped, killed even, continues where it was: a frame counts when its line and
/// all its pictures are there. The files are the same bytes at any number of threads and stops.
/// Errors: invalid (persistence; lines of compound pictures; the folder holds another sweep;
/// another process draws there), unreadable.
[[nodiscard]] Result<SweepResult> run_sweep(const std::shared_ptr<const Scene>& scene,
                                            const std::vector<ListedPose>& poses,
                                            const std::filesystem::path& folder,
                                            const SweepOptions& options,
                                            const Progress& progress = {});

}  // namespace artus
