// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/core/result.h"

namespace artus {

/// What the scanner's back end makes of the echoes.
enum class Look : std::uint8_t {
  raw,       ///< the echoes as physics has them, log-compressed, linear in grey
  clinical,  ///< as a scanner shows them: clutter, grey curve, speckle reduction, grain; bone and
             ///< needle as measured on screens
  compound,  ///< clinical, of several sets of speckle on one course of the sound, averaged
};

/// "raw", "clinical", "compound": as the tool, Python and metadata call them.
inline constexpr std::array<const char*, 3> kLookNames{"raw", "clinical", "compound"};
[[nodiscard]] constexpr const char* look_name(Look look) noexcept {
  return kLookNames[static_cast<std::size_t>(look)];
}

/// What of motion is laid over the grey.
enum class MotionShown : std::uint32_t {
  none,
  velocity,  ///< colour Doppler: toward the probe or away, and how fast
  power,     ///< power Doppler: how strong the echo of what moves is, whichever way
};

/// Grey over the level of an echo, of any look but raw: one value for each eighth of the dynamic
/// range, 0 black .. 1 white, straight in between. Values of `devices/grey-curves/clinical.toml`;
/// see grey_curve_file.h.
struct GreyCurve {
  static constexpr std::size_t kKnots = 9;
  std::array<double, kKnots> grey{0.02, 0.075, 0.175, 0.335, 0.565, 0.785, 0.885, 0.955, 1.0};
  friend bool operator==(const GreyCurve&, const GreyCurve&) = default;
};

/// The settings that a running renderer takes in its next frame: they need no new table.
struct LiveSettings {
  double gain_db = 9;            ///< dB
  double dynamic_range_db = 60;  ///< dB shown between black and white
  /// dB per cm of depth and MHz that time gain compensation adds, one way (doubled inside).
  double tgc_db_cm_mhz = 0.7;
  double tgc_limit_db = 70;  ///< dB, the receiver's largest compensation
  double smoothing = 0;      ///< 0 none .. 1: share of a 3 x 3 mean in the compressed lines
  double persistence = 0;    ///< 0 none .. <1 share of the previous image kept
  // stages of a look other than raw; raw has none of them
  bool clutter = true;            ///< side lobes, reverberation haze, the receiver's noise
  bool speckle_reduction = true;  ///< smoothing that keeps edges and fills the dark of speckle
  bool grain = true;              ///< of the scan converter's pixels
  GreyCurve grey_curve;
  friend bool operator==(const LiveSettings&, const LiveSettings&) = default;
};

/// The settings that a renderer's tables and buffers are made for; see EchoPipeline.
struct TableSettings {
  Look look = Look::clinical;
  double depth = 40e-3;  ///< m, of the image at the display's speed of sound
  int n_samples = 1024;  ///< along a scanline
  int n_planes = 5;      ///< elevation planes that make up the slice's thickness
  /// rms speckle of muscle in dB. assumed: puts muscle at the grey of the reference images.
  double speckle_db = -40;
  double noise_db = -150;           ///< electronic noise before compensation, dB. assumed
  double gel_limit = 5e-3;          ///< m, a wider gap between face and skin is air
  double pixel = 0.1e-3;            ///< m, of the scan-converted image, square
  int compound_angles = 1;          ///< odd; frames steered apart whose envelopes are averaged
  double compound_spread = 0.14;    ///< rad between the outermost steerings
  bool doppler = false;             ///< also find what moves; see Frame::velocity
  double doppler_limit = 0.1;       ///< m/s along the beam where the velocity wraps round
  bool refraction = true;           ///< bend scanlines by Snell's law
  bool reverberation = true;        ///< first repeat between strong interfaces and the face
  bool frequency_downshift = true;  ///< attenuation takes the pulse's high frequencies first
  bool texture = true;              ///< septa, fascicles and fibres in the scattering
  std::uint64_t seed = 1;           ///< of scatterers and noise
  int n_threads = 0;  ///< 0: as many as the machine has; the image does not depend on it
  friend bool operator==(const TableSettings&, const TableSettings&) = default;
};

/// What the person at the scanner sets, and how finely artus computes. Echo amplitudes are relative
/// to a perfect mirror at the face, which is 0 dB; they never depend on the frame's own maximum.
struct ImageSettings : LiveSettings, TableSettings {
  friend bool operator==(const ImageSettings&, const ImageSettings&) = default;
};

/// The name of a knot of the grey curve in messages and recordings.
[[nodiscard]] std::string grey_knot_name(std::size_t knot);

/// Errors: invalid, naming the value and its range; a grey curve that falls.
[[nodiscard]] Result<void> validate(const ImageSettings& settings);

/// A small reflector fixed in the body (wire phantoms, calcifications).
struct PointReflector {
  Vec3 p_J = Vec3::Zero();  ///< m
  double amplitude = 1;     ///< echo of an unresolved point on the beam's axis, mirror = 1
};

}  // namespace artus
