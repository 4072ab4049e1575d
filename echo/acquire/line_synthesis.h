// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "artus/detail/echo/acquire/beam_shape.h"
#include "artus/detail/echo/acquire/line_beams.h"
#include "artus/detail/echo/acquire/propagation.h"
#include "artus/detail/echo/medium/region_acoustics.h"
#include "artus/detail/echo/medium/scatter_field.h"
#include "artus/detail/echo/medium/texture.h"
#include "artus/detail/echo/probe/placed_line.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/transducer.h"

namespace artus {

/// What one worker needs to synthesise a line; reused so that rendering does not allocate.
struct LineScratch {
  LineBeams beams;
  BeamTrace between;  // echoes of a plane between two
  ScatterView view;
  std::vector<float> gain;
  std::vector<ScatterPiece> pieces;
  ScatterRoom room;
};

/// Makes the echoes of one scanline before the beam's shape spreads them: every elevation plane is
/// traced and its scatterers and interfaces are added with the plane's weight.
class LineSynthesis {
 public:
  /// Requires: the references outlive this object.
  LineSynthesis(const BeamShape& shape, const ScatterField& scatter, const TissueTexture& texture,
                const Transducer& transducer, const ImageSettings& settings) noexcept;

  /// Fills `echoes`, n_samples long, with those of line `l` of a row of neighbours and leaves its
  /// beams in `scratch`: the lines of a row are asked for in order, see LineBeams. Fills `more`,
  /// where given, with the differences that further sets of scatterers make.
  void synthesise(const BeamTracer& tracer, std::span<const PlacedLine> row, std::size_t l,
                  LineScratch& scratch, EchoSpan echoes,
                  const ScatterField::MoreSets* more = nullptr) const;

 private:
  /// What the runs of one scanline have in common.
  struct Ground {
    std::span<const RegionAcoustics> regions;
    const ScatterView& view;
    std::span<float> gain;              // a plane's gains, and room for nodes and sheets
    std::vector<ScatterPiece>& pieces;  // of the plane at hand, ascending
    ScatterRoom& room;
    const ScatterField::MoreSets* more;  // null: one set of scatterers
    std::span<const BeamKnot> knots;     // of the plane at hand
  };
  /// An elevation plane, as interfaces are seen in it.
  struct PlaneView {
    int plane;
    Vec3 elevation_J;  // unit
    const ScatterView& scatter;
    double cortex_rise;  // samples that bone lies deeper in the next plane
  };
  void add_plane(const PlaneView& view, const BeamTrace& trace, Ground& ground,
                 EchoSpan echoes) const;
  void sample_moved_texture(const BeamRun& run, const RegionAcoustics& region,
                            std::span<const ScatterPiece> pieces,
                            std::span<float> nodes) const noexcept;
  void add_run(const BeamRun& run, const Ground& ground, std::span<const float> weight,
               EchoSpan echoes) const;
  /// A plane at `share` (0..1) of the way from one to another.
  struct Between {
    const BeamTrace& a;
    const BeamTrace& b;
    double share;
  };
  void add_between(const PlaneView& view, const Between& planes, BeamTrace& blended,
                   EchoSpan echoes) const;
  void add_echo(const BeamEcho& echo, const PlaneView& view, EchoSpan echoes) const;
  void add_cortex(const BeamEcho& echo, const PlaneView& view, EchoSpan echoes) const;
  [[nodiscard]] double cortex_rise(const BeamTrace& a, const BeamTrace& b,
                                   int planes_apart) const noexcept;
  [[nodiscard]] double rise_to_next_plane(const BeamEcho& echo,
                                          const PlaneView& view) const noexcept;
  static void add_haze(const BeamTrace& trace, EchoSpan echoes) noexcept;

  const BeamShape* shape_;
  const ScatterField* scatter_;
  const TissueTexture* texture_;
  double speckle_;  // rms of muscle, mirror = 1
  bool has_texture_;
  bool reverberates_;
  bool on_screen_;  // a look other than raw
  int n_planes_;
  double pitch_;             // m between scanlines
  std::size_t cortex_step_;  // samples between the echoes of which bone's line is made
  double cortex_;  // samples along the beam that it is thick where flat, without the pulse
};

}  // namespace artus
