// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "artus/detail/echo/medium/material_map.h"
#include "artus/detail/raycast/plane_cache.h"
#include "artus/detail/soft/solver/rest_path.h"
#include "artus/raycast/scene.h"

namespace artus {

/// A straight stretch of a beam inside one region, in displayed samples.
struct BeamRun {
  double begin = 0;                  ///< sample (time of flight shown at the display's speed)
  double end = 0;                    ///< sample
  Vec3 p_J = Vec3::Zero();           ///< m, where the beam is at `begin`
  Vec3 step_J = Vec3::Zero();        ///< m per sample
  Vec3 direction_J = Vec3::UnitZ();  ///< unit, of the wave (without the elevation tilt)
  RegionId region = kOutside;
  std::uint16_t n_pieces = 1;         ///< that the way through the region was cut into
  double log_gain_begin = 0;          ///< ln of the two-way amplitude at `begin`
  double log_gain_end = 0;            ///< at `end`
  double path_begin = 0;              ///< m along the beam from the face to `begin`
  double path_end = 0;                ///< m, to `end`
  double lifted = 0;                  ///< m deeper in the body than shown, at `begin`: a flat skin
  Vec3 material = Vec3::Zero();       ///< m, the region's own coordinates at `begin`
  Vec3 material_step = Vec3::Zero();  ///< m per sample
  double along = 0;                   ///< |cosine| between wave and fibres
  double across = 1;                  ///< |cosine| between wave and the normal of sheets
  Vec3 rest_middle_J = Vec3::Zero();  ///< m, the run's middle, where its tissue was at rest
  MaterialPoint middle;               ///< the region's own coordinates there
  bool has_middle = false;            ///< whether it was asked for
  std::size_t first_knot = 0;         ///< of BeamTrace::knots, the last one before the run
  std::size_t n_knots = 0;            ///< to the first behind it; 0: the tissue is at rest
};

/// Where a piece of tissue on a beam was at rest; between knots the path is straight there, too.
struct BeamKnot {
  double path = 0;             ///< m along the beam from the face
  Vec3 rest_J = Vec3::Zero();  ///< m
  double moved = 0;            ///< m, how far it is from there
  std::size_t frame = 0;       ///< of BeamTrace::frames, its own or its guide's
};

/// What the tissue around a knot does; knots of beams near by are made of it.
struct KnotFrame {
  RestKnot rest;
  Eigen::Matrix3d gradient_J = Eigen::Matrix3d::Identity();  ///< of deformation, smooth
};

/// An echo of an interface.
struct BeamEcho {
  double sample = 0;
  double amplitude = 0;          ///< mirror = 1
  double diffuse_share = 0;      ///< 0..1 of it comes from roughness and glitters
  double cosine = 1;             ///< of the incidence angle
  bool is_cortex = false;        ///< shown as thick as scanners show bone, see BeamTracer
  Vec3 p_J = Vec3::Zero();       ///< m
  Vec3 normal_J = Vec3::Zero();  ///< unit, against the wave
  Vec3 rest_J = Vec3::Zero();    ///< m, where the tissue there was at rest
  Vec3 step_J = Vec3::Zero();    ///< m per sample, onward, at rest
};

/// Everything one beam meets on its path.
struct BeamTrace {
  static constexpr std::size_t kMax = 192;
  static constexpr std::size_t kMaxIntervals = 128;
  static constexpr std::size_t kMaxKnots = 512;
  std::array<BeamRun, kMax> runs;
  std::array<BeamKnot, kMaxKnots> knots;
  std::vector<KnotFrame> frames;     ///< (kMaxKnots) of the knots, where there is no guide
  const BeamTrace* guide = nullptr;  ///< beam near by of whose frames the knots are made
  bool outran = false;               ///< its guide ended before
  std::array<BeamEcho, kMax> echoes;
  std::size_t n_runs = 0;
  std::size_t n_echoes = 0;
  std::size_t n_knots = 0;
  std::size_t n_first = 0;   ///< of the echoes that are no repeats; those come first
  double shadow_from = 0;    ///< sample behind which nothing returns; large when there is none
  double end_sample = 0;     ///< where bone or gas ended the beam
  double end_amplitude = 0;  ///< of its echo there; 0: nothing did
  bool is_beside = false;    ///< of another plane than the middle one
  bool contact = true;       ///< false: air between face and skin
  /// Room for one query, kept with the trace because clearing it would cost as much as the query.
  std::array<TissueInterval, kMaxIntervals> intervals;
  PlaneCache planes;  ///< left by the beams before; to be forgotten with their scene

  /// Forgets the last beam.
  void clear() noexcept {
    n_runs = 0;
    n_echoes = 0;
    n_knots = 0;
    n_first = 0;
    guide = nullptr;
    outran = false;
    end_amplitude = 0;
    contact = true;
    is_beside = false;
  }

  /// Displayed sample and ln gain at a distance along the beam; false behind the end of the sound.
  [[nodiscard]] bool find_sample(double path, double& sample, double& log_gain) const noexcept;
};

/// A path through the body: points at increasing path length, straight in between.
struct BeamPath {
  static constexpr std::size_t kMax = 48;
  std::array<Vec3, kMax> p_J;
  std::array<double, kMax> length{};  ///< m from the face
  std::size_t size = 0;

  /// The point at `length`, on the last straight piece when it is beyond the end.
  [[nodiscard]] Vec3 at(double length_m) const noexcept;
};

}  // namespace artus
