// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/haptics/needle/laws/force_model.h"

namespace artus {

/// Which law gives the tap of the tip on bone.
enum class HardLaw { decaying_sinusoid, impulse };

/// Fitted on tapping wood. Source [Kuchenbecker2006] by [Alamilla2020] eq. 2.3.
struct DecayingSinusoidParams {
  double amplitude = 19.9;  ///< N s/m, A
  double duration = 0.055;  ///< s, d
  double frequency = 55;    ///< Hz, f
};

/// f(t) / |v_in| of the decaying sinusoid, N s/m; zero outside 0 < t < d. Positive against the
/// incoming motion.
[[nodiscard]] ARTUS_REALTIME double decaying_sinusoid(const DecayingSinusoidParams& params,
                                                      double t) noexcept;

struct ImpulseParams {
  double restitution = 1;  ///< e, 1 for bone
  double mass = 0.1;       ///< kg, apparent mass of the device at the tip; assumed: device table
  double duration = 1e-3;  ///< s, T; the source's one period, kept when the loop is faster so that
                           ///< the momentum does not depend on the rate
};

struct HardContactParams {
  HardLaw law = HardLaw::decaying_sinusoid;
  DecayingSinusoidParams sinusoid;
  ImpulseParams impulse;
  double rearm_distance = 0.5e-3;  ///< m from where the tip was last on bone before it can be hit
                                   ///< again; assumed: above tremor
};

/// The tap: fires once per contact, from the incoming speed, and lasts a fixed time. The source
/// (1.1) lets it replace the soft forces; here it is added, since with nothing else the needle
/// would fall through the bone when the tap is over. Eqs. 2.3, 2.9, 2.10: f = -(e + 1) M v0 / T.
class HardContact {
 public:
  explicit HardContact(const HardContactParams& params = {}) noexcept : params_(params) {}
  ARTUS_REALTIME void reset(double depth) noexcept;
  ARTUS_REALTIME Wrench step(const NeedleTick& tick) noexcept;

  /// The line is taken anew: depths are `by` m more.
  ARTUS_REALTIME void take_line(double by) noexcept;

  [[nodiscard]] bool touching() const noexcept { return touching_; }
  [[nodiscard]] double incoming_speed() const noexcept { return speed_; }  ///< m/s of this contact

 private:
  HardContactParams params_;
  bool touching_ = false;
  double speed_ = 0;
  double time_ = 1e9;  // s since the contact
  double last_x_ = 0;
  double touched_at_ = 0;  // m, the last depth on bone
};

}  // namespace artus
