// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "artus/echo/beam_shape.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/needle_echo.h"
#include "artus/echo/propagation.h"
#include "artus/echo/region_acoustics.h"
#include "artus/echo/scatter_field.h"
#include "artus/echo/texture.h"
#include "artus/echo/transducer.h"

namespace artus {

/// What one worker needs to synthesise a line; reused so that rendering does not allocate.
struct LineScratch {
  BeamTrace central;
  BeamTrace side;
  BeamPath bent;
  BeamPath plane;
  ScatterView view;
  std::vector<float> gain;
};

/// Makes the echoes of one scanline before the beam's shape spreads them: every elevation plane is
/// traced and its scatterers and interfaces are added with the plane's weight.
class LineSynthesis {
 public:
  /// Requires: the references outlive this object.
  LineSynthesis(const BeamShape& shape, const ScatterField& scatter, const TissueTexture& texture,
                const Transducer& transducer, const ImageSettings& settings) noexcept;

  /// Fills (re, im), n_samples each, and leaves the central beam in `scratch`.
  void synthesise(const BeamTracer& tracer, std::span<const RegionAcoustics> regions,
                  const Scanline& line, const Pose& X_JP, LineScratch& scratch, std::span<float> re,
                  std::span<float> im) const;

 private:
  void add_plane(int plane, const BeamTrace& trace, std::span<const RegionAcoustics> regions,
                 const ScatterView& view, std::vector<float>& gain, std::span<float> re,
                 std::span<float> im) const;
  void add_run(const BeamRun& run, std::span<const RegionAcoustics> regions,
               const ScatterView& view, std::span<const float> weight, std::span<float> gain,
               std::span<float> re, std::span<float> im) const;

  void add_echo(const BeamEcho& echo, const ScatterView& view, std::span<const float> share,
                std::span<float> re, std::span<float> im) const;

  const BeamShape* shape_;
  const ScatterField* scatter_;
  const TissueTexture* texture_;
  static void add_haze(const BeamTrace& trace, std::span<float> re, std::span<float> im) noexcept;

  double speckle_;  // rms of muscle, mirror = 1
  bool has_texture_;
  bool reverberates_;
  int n_planes_;
  double pitch_;  // m between scanlines
};

}  // namespace artus
