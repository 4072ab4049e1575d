// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "artus/detail/echo/acquire/aperture_coupling.h"
#include "artus/detail/echo/acquire/aperture_light.h"
#include "artus/detail/echo/acquire/beam_shape.h"
#include "artus/detail/echo/acquire/beam_spread.h"
#include "artus/detail/echo/acquire/block_workers.h"
#include "artus/detail/echo/acquire/drifting_echo.h"
#include "artus/detail/echo/acquire/flow_detector.h"
#include "artus/detail/echo/acquire/line_synthesis.h"
#include "artus/detail/echo/acquire/needle_echo.h"
#include "artus/detail/echo/medium/region_acoustics.h"
#include "artus/detail/echo/medium/scatter_field.h"
#include "artus/detail/echo/medium/texture.h"
#include "artus/detail/echo/probe/placed_line.h"
#include "artus/echo/frame.h"
#include "artus/raycast/scene.h"

namespace artus {

/// What there is to be seen, whatever looks at it.
struct EchoBody {
  std::shared_ptr<const Scene> scene;
  std::optional<SmoothGradient> tissue;  ///< of the scene's; none: it is at rest
  std::vector<RegionAcoustics> regions;  ///< of the scene's joint, at the transducer's frequency
  std::vector<PointReflector> reflectors;
  std::vector<NeedleTrack> tracks;
  std::vector<DriftingPoint> drifting;
  std::optional<double> flow_time;  ///< s; colour Doppler then looks for blood and moving tissue
};

/// From where: `probe` is the transducer, steered as one view of a compound image is.
struct EchoView {
  const Transducer& probe;
  Pose X_JP = Pose::Identity();
  std::optional<NeedleView> needle;
};

/// The first stage: every scanline listens into the body. Its echoes are those before the beam
/// spreads them sideways and the pulse along the line.
class Acquisition {
 public:
  /// Requires: valid transducer and settings; `shape` outlives this object.
  Acquisition(const Transducer& transducer, const ImageSettings& settings, const BeamShape& shape);

  /// See Renderer::set_contact.
  void set_contact(std::span<const float> coverage) { coupling_.set(coverage); }

  /// Before the first run of a frame.
  void begin_frame(const EchoBody& body) noexcept { flow_.begin_frame(body.flow_time); }
  /// Listens; fills contact, shadow_from and needle_light of the frame. Requires: rigid poses.
  void run(const EchoBody& body, const EchoView& view, BlockWorkers& workers, Frame& frame);

  [[nodiscard]] int n_lines() const noexcept { return n_lines_; }
  /// (n_lines, n_samples), sample fastest, of the last run; valid until the next.
  [[nodiscard]] std::span<const float> in_phase() const noexcept { return re_; }
  [[nodiscard]] std::span<const float> quadrature() const noexcept { return im_; }
  /// The needle's own share of them; empty unless Doppler is on.
  [[nodiscard]] std::span<const float> moving_in_phase() const noexcept { return moving_re_; }
  [[nodiscard]] std::span<const float> moving_quadrature() const noexcept { return moving_im_; }
  /// What further sets of scatterers, all alike but for that, make different in each sample, as
  /// in_phase; none but in the compound look.
  [[nodiscard]] std::span<const std::vector<float>> more_in_phase() const noexcept {
    return std::span(more_re_).first(n_more_);
  }
  [[nodiscard]] std::span<const std::vector<float>> more_quadrature() const noexcept {
    return std::span(more_im_).first(n_more_);
  }
  /// (n_lines) as the last run placed them.
  [[nodiscard]] std::span<const PlacedLine> lines() const noexcept { return lines_; }

  /// Adds the body's point reflectors to scanline `l` once it is spread sideways.
  void add_reflectors(const EchoBody& body, int l, std::span<float> re) const noexcept;

  /// Colours the drifting points that move fast, see DriftingEcho. Requires: a frame of Doppler.
  void colour_drifting(Frame& frame) const noexcept;
  /// Colours blood and tissue, see FlowDetector. Requires: a frame of Doppler.
  void colour_flow(std::span<const float> time_gain, BlockWorkers& workers, Frame& frame) const {
    flow_.colour(time_gain, workers, frame);
  }

  /// Where the lines that see the needle's tip show it, frame P; empty when none does.
  [[nodiscard]] std::optional<Vec3> find_shown_tip() const noexcept;

 private:
  struct Pass;
  struct Track {
    NeedleEcho echo;
    double amplitude;
  };
  void place_tracks(const EchoBody& body, const EchoView& view);
  void listen(const Pass& pass, std::span<const PlacedLine> row, std::size_t of_row,
              LineScratch& scratch);
  void add_needle(const Pass& pass, const SoundedLine& sounded);
  template <class Change>
  void for_more(int l, const Change& change);
  [[nodiscard]] EchoSpan line_of(std::vector<float>& re, std::vector<float>& im, int l) const;

  int n_lines_;
  std::size_t n_samples_;
  const BeamShape* shape_;
  ImageSettings settings_;
  ScatterField scatter_;
  TissueTexture texture_;
  LineSynthesis synthesis_;
  ApertureCoupling coupling_;
  BeamSpread spread_;
  ApertureLight light_;  // looks other than raw
  DriftingEcho drifting_;
  FlowDetector flow_;
  Pose X_PJ_ = Pose::Identity();
  std::vector<PlacedLine> lines_;     // (n_lines)
  std::vector<LineScratch> scratch_;  // (workers)
  std::vector<Track> tracks_;
  std::vector<NeedleEcho::Tip> tips_;  // (n_lines)
  std::vector<float> re_;              // (n_lines, n_samples), as the next three
  std::vector<float> im_;
  std::size_t n_more_;  // 0, or all of the next two
  std::array<std::vector<float>, ScatterField::kMoreSets> more_re_;
  std::array<std::vector<float>, ScatterField::kMoreSets> more_im_;
  std::vector<float> moving_re_;
  std::vector<float> moving_im_;
};

}  // namespace artus
