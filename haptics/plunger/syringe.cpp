// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/plunger/syringe.h"

#include <algorithm>
#include <array>

namespace artus {
namespace {

struct Barrel {
  double volume;       // m^3
  double diameter;     // m
  double break_loose;  // N
  double glide;        // N
};
constexpr std::array<Barrel, 6> kBarrels{{{1e-6, 4.70e-3, 1.5, 1},
                                          {2.5e-6, 8.66e-3, 2.5, 1.7},
                                          {5e-6, 12.06e-3, 3, 2},
                                          {10e-6, 14.5e-3, 4, 2.7},
                                          {20e-6, 19.13e-3, 5, 3.5},
                                          {50e-6, 26.7e-3, 7, 5}}};
constexpr double kRounding = 1e-12;  // m^3

}  // namespace

Syringe syringe_for(double volume) {
  const Barrel* barrel = &kBarrels.back();
  for (const Barrel& b : kBarrels)
    if (b.volume + kRounding >= volume && b.volume < barrel->volume) barrel = &b;
  Syringe syringe;
  syringe.volume = barrel->volume;
  syringe.diameter = barrel->diameter;
  syringe.break_loose = barrel->break_loose;
  syringe.glide = barrel->glide;
  syringe.filled = std::min(volume, barrel->volume);
  return syringe;
}

}  // namespace artus
