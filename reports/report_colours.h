// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <opencv2/core.hpp>

namespace artus {

/// A colour (blue, green, red) that says what a structure is made of, in shades by `number`.
[[nodiscard]] inline cv::Vec3b tissue_colour(std::string_view tissue, std::size_t number) {
  constexpr std::array<std::pair<std::string_view, std::array<int, 3>>, 14> kColours{
      {{"bone", {200, 230, 240}},
       {"cartilage", {225, 205, 150}},
       {"labrum", {200, 170, 120}},
       {"muscle", {90, 90, 190}},
       {"tendon", {205, 225, 235}},
       {"ligament", {180, 205, 215}},
       {"bursa", {220, 180, 60}},
       {"synovial_fluid", {230, 190, 80}},
       {"fluid", {230, 190, 80}},
       {"capsule", {150, 170, 190}},
       {"nerve", {60, 220, 240}},
       {"artery", {40, 40, 210}},
       {"vein", {200, 80, 50}},
       {"skin", {170, 190, 225}}}};
  std::array<int, 3> base{150, 200, 180};
  for (const auto& [name, colour] : kColours)
    if (name == tissue) base = colour;
  const double shade = 1 - 0.07 * static_cast<double>(number % 4);
  cv::Vec3b out;
  for (int c = 0; c < 3; ++c)
    out[c] = static_cast<std::uint8_t>(std::lround(shade * base.at(static_cast<std::size_t>(c))));
  return out;
}

}  // namespace artus
