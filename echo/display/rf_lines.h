// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <complex>
#include <cstddef>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "artus/core/result.h"
#include "artus/echo/frame.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/transducer.h"

namespace artus {

/// The beamformed lines of one view before the envelope is taken. The engine forms beams directly:
/// there is no channel data, and echoes that do not overlap have no phase of a carrier to each
/// other. Frame P; time runs from the face, a sample at depth z being heard at 2 z / sound speed.
struct RfLines {
  int n_lines = 0;
  int n_samples = 0;                      ///< of iq
  int n_rf_samples = 0;                   ///< of rf, a multiple of n_samples
  std::vector<std::complex<float>> iq{};  ///< (n_lines, n_samples), sample fastest; mirror = 1
  /// (n_lines, n_rf_samples), sample fastest: the real part of iq on its carrier.
  std::vector<float> rf{};
  std::vector<float> time_gain{};    ///< (n_samples); envelope = time_gain * |iq|
  std::vector<double> origins{};     ///< (n_lines, 3) m, of the lines on the face
  std::vector<double> directions{};  ///< (n_lines, 3), unit
  double sampling_frequency = 0;     ///< Hz, of iq
  double rf_sampling_frequency = 0;  ///< Hz, of rf
  double centre_frequency = 0;       ///< Hz, of pulse and carrier
  double bandwidth = 0;              ///< -6 dB width of the spectrum over the centre frequency
  double start_time = 0;             ///< s after the pulse leaves the face, of the first samples
  double sound_speed = 0;            ///< m/s, that samples are placed with
  double sample_depth = 0;           ///< m between samples of iq
  double face_width = 0;             ///< m, along the row of lines
  double face_radius = 0;            ///< m; 0: straight
  double steering = 0;               ///< rad
  double elevation_height = 0;       ///< m, of the elements
  double elevation_focus = 0;        ///< m, of the lens
  double gain_db = 0;                ///< dB that the picture adds to the envelope
  double dynamic_range_db = 0;       ///< dB between its black and white
};

/// Errors: invalid, where a picture is made of more than one set of lines (compounding) and none of
/// them is its own.
[[nodiscard]] Result<void> check_single_lines(const ImageSettings& settings);

/// The lines of a frame that was drawn with these settings. rf is sampled at the smallest multiple
/// of iq's rate that is four times the centre frequency or more; between samples iq is interpolated
/// by a windowed sinc. Errors: as check_single_lines. Cost: some 20 ms.
[[nodiscard]] Result<RfLines> make_rf_lines(const Frame& frame, const Transducer& transducer,
                                            const ImageSettings& settings);

/// An array as files and Python name it; it looks into what it is of.
struct NamedArray {
  std::string_view name;
  std::vector<std::size_t> shape{};  ///< empty: a number
  std::variant<std::span<const std::complex<float>>, std::span<const float>,
               std::span<const double>>
      values{};
};

/// All arrays and numbers of `lines`.
[[nodiscard]] std::vector<NamedArray> arrays_of(const RfLines& lines);

}  // namespace artus
