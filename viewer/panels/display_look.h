// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "artus/session/session.h"

namespace artus {

/// Where in the picture colour Doppler is shown, shares of its width and height.
struct ColourBox {
  double x = 0.5;  ///< its middle
  double y = 0.5;
  double width = 0.55;
  double height = 0.5;
  /// Moves the middle; the box stays within the picture.
  void move(double dx, double dy) noexcept;
  [[nodiscard]] bool contains(double u, double v) const noexcept;
  friend bool operator==(const ColourBox&, const ColourBox&) = default;
};

/// What the scanner's display does to a finished image: eight sliders of time gain, from shallow to
/// deep, and a flip. They show at once and in every saved picture, and change no recording.
struct DisplayLook {
  static constexpr double kMaxDb = 20;  ///< either way of a slider's middle
  std::array<double, 8> tgc_db{};       ///< dB, linear between the middles of eight equal strips
  bool flipped = false;                 ///< left to right
  bool colour = false;                  ///< Doppler, in its box
  bool power = false;                   ///< Doppler of power, not of velocity
  ColourBox box;
  [[nodiscard]] MotionShown motion() const noexcept {
    if (!colour) return MotionShown::none;
    return power ? MotionShown::power : MotionShown::velocity;
  }
  friend bool operator==(const DisplayLook&, const DisplayLook&) = default;
};

/// dB that the sliders add at a share of the depth, 0 to 1.
[[nodiscard]] double slider_gain(const DisplayLook& look, double depth_share) noexcept;
/// The image's grey, (height, width), x fastest, with the sliders' gain; not flipped. What is black
/// stays black: the log compression has cut it off.
[[nodiscard]] std::vector<std::uint8_t> displayed_grey(const ImageSnapshot& image,
                                                       const DisplayLook& look);
/// The same as red, green, blue, (height, width, 3), with what moves in the colour box.
[[nodiscard]] std::vector<std::uint8_t> displayed_colour(const ImageSnapshot& image,
                                                         const DisplayLook& look);

}  // namespace artus
