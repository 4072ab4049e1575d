// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/joint3d/colours.h"

#include <algorithm>
#include <cmath>

namespace artus {
namespace {

struct Named {
  std::string_view tissue;
  Rgb colour;
};

// Lightness carries what hue cannot for all eyes: 3D and picture labels use the same.
constexpr std::array<Named, 17> kTissues{{{"skin", {236, 188, 160}},
                                          {"fat", {247, 224, 132}},
                                          {"fascia", {190, 185, 170}},
                                          {"muscle", {140, 58, 52}},
                                          {"tendon", {255, 250, 228}},
                                          {"ligament", {205, 130, 160}},
                                          {"capsule", {74, 78, 92}},
                                          {"bursa", {60, 205, 225}},
                                          {"synovial_fluid", {150, 160, 250}},
                                          {"cartilage", {100, 180, 125}},
                                          {"labrum", {30, 145, 105}},
                                          {"bone", {214, 202, 188}},
                                          {"nerve", {255, 165, 20}},
                                          {"blood", {95, 8, 22}},
                                          {"artery", {230, 32, 40}},
                                          {"vein", {38, 70, 200}},
                                          {"fluid", {110, 140, 215}}}};

using Linear = std::array<double, 3>;
using Matrix = std::array<Linear, 3>;

double to_linear(std::uint8_t channel) noexcept {
  const double c = channel / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

Linear to_linear(const Rgb& colour) noexcept {
  return {to_linear(colour[0]), to_linear(colour[1]), to_linear(colour[2])};
}

std::uint8_t to_srgb(double c) noexcept {
  c = std::clamp(c, 0.0, 1.0);
  const double s = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * s));
}

Linear times(const Matrix& m, const Linear& v) noexcept {
  Linear out{};
  for (std::size_t i = 0; i < 3; ++i) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return out;
}

double luminance(const Rgb& colour) noexcept {
  const Linear c = to_linear(colour);
  return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

/// L*, a*, b* under D65.
Linear to_lab(const Rgb& colour) noexcept {
  constexpr Matrix kToXyz{{{0.4124564, 0.3575761, 0.1804375},
                           {0.2126729, 0.7151522, 0.0721750},
                           {0.0193339, 0.1191920, 0.9503041}}};
  constexpr Linear kWhite{0.95047, 1.0, 1.08883};
  const Linear xyz = times(kToXyz, to_linear(colour));
  Linear f{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double t = xyz[i] / kWhite[i];
    f[i] = t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
  }
  return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

}  // namespace

Rgb tissue_colour(std::string_view tissue) noexcept {
  for (const Named& named : kTissues) {
    if (named.tissue == tissue) return named.colour;
  }
  return {128, 128, 128};
}

std::vector<Rgb> region_colours(const CompiledJoint& joint) {
  std::vector<Rgb> colours;
  for (std::size_t r = 0; r < joint.regions.size(); ++r) {
    if (r < kFirstRegion) {
      colours.push_back({20, 20, 24});
      continue;
    }
    Rgb colour = tissue_colour(joint.tissue_of(static_cast<RegionId>(r)).name);
    const double shade = 1 - 0.02 * static_cast<double>(r * 37 % 5);
    for (std::uint8_t& channel : colour)
      channel = static_cast<std::uint8_t>(std::lround(shade * channel));
    colours.push_back(colour);
  }
  return colours;
}

double contrast(const Rgb& a, const Rgb& b) noexcept {
  const auto [low, high] = std::minmax({luminance(a), luminance(b)});
  return (high + 0.05) / (low + 0.05);
}

Rgb seen_by(Vision vision, const Rgb& colour) noexcept {
  constexpr std::array<Matrix, 3> kLacking{{{{{0.152286, 1.052583, -0.204868},
                                              {0.114503, 0.786281, 0.099216},
                                              {-0.003882, -0.048116, 1.051998}}},
                                            {{{0.367322, 0.860646, -0.227968},
                                              {0.280085, 0.672501, 0.047413},
                                              {-0.011820, 0.042940, 0.968881}}},
                                            {{{1.255528, -0.076749, -0.178779},
                                              {-0.078411, 0.930809, 0.147602},
                                              {0.004733, 0.691367, 0.303900}}}}};
  if (vision == Vision::all_cones) return colour;
  const auto which = static_cast<std::size_t>(vision) - 1;
  const Linear seen = times(kLacking[which], to_linear(colour));
  return {to_srgb(seen[0]), to_srgb(seen[1]), to_srgb(seen[2])};
}

double difference(const Rgb& a, const Rgb& b) noexcept {
  const Linear p = to_lab(a);
  const Linear q = to_lab(b);
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

}  // namespace artus
