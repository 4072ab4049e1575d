// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "artus/echo/frame.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/transducer.h"

namespace artus {

/// Maps scanlines to pixels by bilinear interpolation of the decibel image, then to grey.
class ScanConverter {
 public:
  /// Requires: valid transducer and settings.
  ScanConverter(const Transducer& transducer, const ImageSettings& settings);

  /// dB between black and white of later images. Requires: positive.
  void set_dynamic_range(double decibel) noexcept;

  /// Later images are as grey as `curve` says, not as their decibels; with the `grain` of pixels,
  /// which stands still, or without.
  void set_curve(const GreyCurve& curve, bool grain);

  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }

  /// Grey of every pixel: black at -dynamic range, white at 0 dB, black off the sector; in between
  /// straight in decibels, or by the curve.
  /// `rows` picks pixel rows [first, last), so that threads may share the work.
  void convert(std::span<const float> decibel, int first_row, int last_row,
               std::span<std::uint8_t> image) const noexcept;

  /// The same of every row, straight in decibels whatever the curve is: of what is no echo.
  void convert_straight(std::span<const float> decibel,
                        std::span<std::uint8_t> image) const noexcept;

  /// Pixel of a point in frame P (its elevation does not matter); geometric, without the
  /// displacement that the tissues' speeds of sound cause.
  [[nodiscard]] PixelPoint pixel_of(const Vec3& p_P) const noexcept;
  /// The point in frame P at a pixel's centre.
  [[nodiscard]] Vec3 point_of(int x, int y) const noexcept;
  /// Where a pixel lies among lines and samples. Requires: inside(x, y).
  struct LinePlace {
    int line = 0;
    double share = 0;  ///< 0..1 of the way to the next line
    double sample = 0;
  };
  [[nodiscard]] LinePlace line_at(int x, int y) const noexcept;
  /// Whether a pixel lies between the outermost scanlines.
  [[nodiscard]] bool inside(int x, int y) const noexcept;
  /// Whether a place does, anywhere at all.
  [[nodiscard]] bool inside(const PixelPoint& place) const noexcept;

 private:
  struct Sample {
    std::int32_t index = -1;  // into (n_lines, n_samples); -1 off the sector
    float line = 0;           // weight of the next line
    float sample = 0;         // weight of the next sample
  };
  [[nodiscard]] Sample find_sample(const Transducer& transducer, double sample_depth,
                                   const Vec3& p) const noexcept;

  void convert_straight(std::span<const float> decibel, std::size_t begin, std::size_t end,
                        std::span<std::uint8_t> image) const noexcept;
  void convert_by_curve(std::span<const float> decibel, std::size_t begin, std::size_t end,
                        std::span<std::uint8_t> image) const noexcept;

  static constexpr int kLevels = 1024;
  int width_ = 0;
  int height_ = 0;
  double pixel_ = 0;  // m
  double left_ = 0;   // m, x of the image's left edge
  double top_ = 0;    // m, z of the image's upper edge
  int n_samples_ = 0;
  float grey_per_db_ = 0;
  float dynamic_range_ = 0;
  bool single_line_ = false;
  bool has_curve_ = false;
  std::array<std::uint8_t, kLevels> grey_{};  // of the levels of the dynamic range
  std::vector<std::int8_t> grain_;            // (height, width), levels; empty: none
  std::vector<Sample> samples_;               // (height, width)
};

}  // namespace artus
