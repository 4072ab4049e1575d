// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/display_look.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/echo/display/motion_picture.h"

namespace artus {

double slider_gain(const DisplayLook& look, double depth_share) noexcept {
  constexpr auto kLast = static_cast<double>(std::tuple_size_v<decltype(look.tgc_db)> - 1);
  const double at = std::clamp(depth_share * (kLast + 1) - 0.5, 0.0, kLast);
  const auto i = static_cast<std::size_t>(std::min(at, kLast - 1));
  const double share = at - static_cast<double>(i);
  return (1 - share) * look.tgc_db[i] + share * look.tgc_db[i + 1];
}

std::vector<std::uint8_t> displayed_grey(const ImageSnapshot& image, const DisplayLook& look) {
  std::vector<std::uint8_t> grey = image.grey;
  const bool plain =
      std::all_of(look.tgc_db.begin(), look.tgc_db.end(), [](double db) { return db == 0; });
  if (plain) return grey;
  const double per_db = 255 / std::max(1.0, image.input.controls.dynamic_range_db);
  const auto width = static_cast<std::size_t>(image.width);
  for (int y = 0; y < image.height; ++y) {
    const double added = per_db * slider_gain(look, (y + 0.5) / image.height);
    std::array<std::uint8_t, 256> shown{};
    for (std::size_t g = 1; g < shown.size(); ++g)
      shown[g] = static_cast<std::uint8_t>(
          std::lround(std::clamp(static_cast<double>(g) + added, 0.0, 255.0)));
    auto* row = grey.data() + static_cast<std::size_t>(y) * width;
    std::transform(row, row + width, row, [&shown](std::uint8_t g) { return shown[g]; });
  }
  return grey;
}

void ColourBox::move(double dx, double dy) noexcept {
  x = std::clamp(x + dx, width / 2, 1 - width / 2);
  y = std::clamp(y + dy, height / 2, 1 - height / 2);
}

bool ColourBox::contains(double u, double v) const noexcept {
  return std::abs(u - x) <= width / 2 && std::abs(v - y) <= height / 2;
}

std::vector<std::uint8_t> displayed_colour(const ImageSnapshot& image, const DisplayLook& look) {
  const std::vector<std::uint8_t> grey = displayed_grey(image, look);
  const bool moves = look.colour && image.motion.size() == grey.size();
  const auto width = static_cast<std::size_t>(image.width);
  std::vector<std::uint8_t> shown(3 * grey.size());
  for (std::size_t i = 0; i < grey.size(); ++i) {
    std::array<std::uint8_t, 3> rgb{grey[i], grey[i], grey[i]};
    if (moves && image.motion[i] != 0) {
      const double u = (static_cast<double>(i % width) + 0.5) / image.width;
      const double v = (static_cast<double>(i / width) + 0.5) / image.height;
      if (look.box.contains(u, v))
        rgb = motion_colour(image.motion[i], image.input.controls.motion);
    }
    std::copy(rgb.begin(), rgb.end(), shown.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  return shown;
}

}  // namespace artus
