// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "artus/detail/echo/acquire/acquisition.h"
#include "artus/detail/echo/acquire/beam_shape.h"
#include "artus/detail/echo/acquire/block_workers.h"
#include "artus/echo/frame.h"
#include "artus/echo/image_settings.h"

namespace artus {

/// Time gain compensation: the factor on the envelope at each sample, (n_samples).
[[nodiscard]] std::vector<float> make_time_gain(const Transducer& transducer,
                                                const ImageSettings& settings);

/// The second stage: beam and pulse spread the echoes, electronic noise joins, and the envelope is
/// what is left of them; of several sets of scatterers, the mean of their envelopes.
class LineShaping {
 public:
  /// Requires: valid transducer and settings; `shape` outlives this object.
  LineShaping(const Transducer& transducer, const ImageSettings& settings, const BeamShape& shape);

  /// The time gain of later frames. Cost: some 10 us.
  void set_time_gain(const LiveSettings& live);

  /// (n_samples), of the last frame.
  [[nodiscard]] std::span<const float> time_gain() const noexcept { return time_gain_; }

  /// Fills in_phase, quadrature and envelope of the frame.
  void run(const Acquisition& acquired, const EchoBody& body, BlockWorkers& workers, Frame& frame);

  /// Fills velocity and motion_db of the frame for a needle that moves at `v_P` (m/s, frame P);
  /// nothing moves without one. Requires: Doppler is on.
  void find_motion(const Acquisition& acquired, const std::optional<Vec3>& v_P,
                   BlockWorkers& workers, Frame& frame);

 private:
  void average(const Acquisition& acquired, int l, Frame& frame);

  Transducer transducer_;
  ImageSettings settings_;
  const BeamShape* shape_;
  std::vector<float> time_gain_;   // (n_samples)
  std::vector<float> noise_gain_;  // (n_samples)
  std::vector<float> wide_;        // (n_lines, n_samples), spread sideways
  std::vector<float> set_re_;      // the same, of a further set of scatterers; only of compounds
  std::vector<float> set_im_;
  std::vector<float> motion_;  // the same, quadrature of what moves; empty without Doppler
};

}  // namespace artus
