// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>

#include "artus/detail/echo/acquire/beam_trace.h"
#include "artus/detail/echo/medium/region_acoustics.h"
#include "artus/detail/soft/solver/smooth_gradient.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/transducer.h"
#include "artus/raycast/scene.h"

namespace artus {

/// Follows beams through the tissue intervals of a scene: time of flight, two-way loss, echoes.
/// Where the scene's tissue gives way, lengths, angles and interfaces are the present ones;
/// scatterers, texture and fibres belong to the material and are found where it was at rest. How
/// surfaces and fibres lie is what the smooth gradient makes of them at rest: the moved facets'
/// own normals jump from cube to cube, and so would echoes, refraction and brightness.
/// In looks other than raw bone's surface is as scanners show it: a line of a millimetre that is
/// even at any slope, and nothing repeats but what the back end's haze stands for.
class BeamTracer {
 public:
  /// `tissue`: how the scene's gives way; null: it is at rest.
  BeamTracer(const Scene& scene, const SmoothGradient* tissue,
             std::span<const RegionAcoustics> regions, const Transducer& transducer,
             const ImageSettings& settings) noexcept;

  /// Notes whether a probe at `X_JP` touches the skin. Where it does and tissue that gives way
  /// would lie flat under the face, tissue at rest is shown so, too, in looks other than raw: up to
  /// 3 mm of gap go, and the tissue behind is stretched by a fifth over five times as much. Needles
  /// and distances along a line stay as they are. Before lines are followed. Cost: a query every
  /// eighth line.
  void lay_on_skin(const Transducer& transducer, const Pose& X_JP) noexcept;

  [[nodiscard]] std::span<const RegionAcoustics> regions() const noexcept { return regions_; }
  [[nodiscard]] bool gives_way() const noexcept { return tissue_ != nullptr; }

  /// The beam from `origin_J` along `direction_J` (unit), bent at the interfaces when refraction is
  /// on. Fills `trace`, and `path` with the course it took. Where the tissue was it takes from
  /// `guide`, a beam less than a millimetre beside it, or finds it itself. Runs are cut as those of
  /// `like`, so that the two can be blended. Cost: one query per bend.
  void trace_bent(const Vec3& origin_J, const Vec3& direction_J, BeamTrace& trace, BeamPath& path,
                  const BeamTrace* guide = nullptr, const BeamTrace* like = nullptr) const noexcept;

  /// The beam of another elevation plane: along the straight pieces of `path`, whose lengths (not
  /// the geometric ones) tell the time. How fibres run it takes from `central`, the beam of the
  /// middle plane, where that is in the same region; where the tissue was, from its guide or from
  /// itself. Cost: one query per piece.
  void trace_along(const BeamPath& path, const Vec3& elevation_axis_J, const BeamTrace& central,
                   BeamTrace& trace, const BeamTrace* like = nullptr) const noexcept;

  /// The beam between two neighbours less than a millimetre apart, at `share` (0..1) of the way
  /// from `a` to `b`, of what they met: where both met the same in the same order, and surfaces so
  /// flat that nothing lies more than 40 um off. False, and nothing to be used, where not. `trace`
  /// is guided by `a`, or by its guide. Cost: a tenth of following it.
  [[nodiscard]] bool blend(const BeamTrace& a, const BeamTrace& b, double share,
                           BeamTrace& trace) const noexcept;

  /// The echoes alone, of a beam between two that met the same; false where they did not.
  [[nodiscard]] static bool blend_echoes(const BeamTrace& a, const BeamTrace& b, double share,
                                         BeamTrace& trace) noexcept;

 private:
  struct Walk;
  bool start(Walk& walk, RegionId region, double length) const noexcept;
  bool go(Walk& walk, const Vec3& point, const Vec3& direction, double thickness,
          double time_scale) const noexcept;
  bool cross(Walk& walk, const Vec3& point, const Vec3& direction, double length,
             double time_scale) const noexcept;
  static int cut(const Walk& walk, double length) noexcept;
  bool enter(Walk& walk, const TissueInterval& interval, const Vec3& point) const noexcept;
  bool pass(Walk& walk, const Vec3& from, const Vec3& direction, double length,
            double time_scale) const noexcept;
  static MaterialPoint find_material(Walk& walk, const RegionAcoustics& region,
                                     const BeamRun& run) noexcept;
  double follow_fibres(Walk& walk, const RegionAcoustics& region, BeamRun& run,
                       const Vec3& half_displacement) const noexcept;
  bool place_knots(Walk& walk, double path) const noexcept;
  void begin_knots(Walk& walk) const noexcept;
  void add_knot(Walk& walk, double path) const noexcept;
  [[nodiscard]] Vec3 find_normal(Walk& walk, const TissueInterval& interval) const noexcept;
  void find_rest(Walk& walk, BeamRun& run) const noexcept;
  void add_repeats(BeamTrace& trace) const noexcept;

  const Scene* scene_;
  const SmoothGradient* tissue_;  // null: at rest
  std::span<const RegionAcoustics> regions_;
  double sample_depth_;  // m of displayed depth
  double n_samples_;
  double spectrum_sigma_;  // Hz
  double gel_limit_;       // m
  double max_path_;        // m, longest path a beam can go within the displayed time
  bool refraction_;
  bool reverberation_;
  bool on_screen_;       // a look other than raw
  double flattens_ = 0;  // 0..1, how much of a gap between face and skin goes
};

}  // namespace artus
