// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cmath>
#include <cstdint>
#include <limits>

#include "artus/detail/core/noise.h"
#include "artus/haptics/needle_renderer.h"

/// What a broken device can send.
namespace artus::test {

enum class Fault { none, nan, infinite, teleport, frozen, reversed, out_of_workspace, not_rigid };
inline constexpr std::size_t kFaults = 8;

/// The sane pose with a fault in it, at random in size and place.
inline TimedPose broken(Fault fault, std::uint64_t seed, std::uint64_t i, TimedPose pose,
                        const TimedPose& frozen) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto axis = static_cast<Eigen::Index>(3 * uniform_noise(seed, 4 * i));
  const double size = uniform_noise(seed, 4 * i + 1);
  Vec3 place = Vec3::Zero();
  for (auto& c : place)
    c = normal_noise(seed + 1, 3 * i + static_cast<std::uint64_t>(&c - place.data()));
  switch (fault) {
    case Fault::none:
      return pose;
    case Fault::nan:
      if (size < 0.3)
        pose.time = kNaN;
      else if (size < 0.6)
        pose.X_JN.linear()(axis, 0) = kNaN;
      else
        pose.X_JN.translation()[axis] = kNaN;
      return pose;
    case Fault::infinite:
      if (size < 0.3)
        pose.time = kInfinity;
      else
        pose.X_JN.translation()[axis] = size < 0.6 ? -kInfinity : 1e308;
      return pose;
    case Fault::teleport:
      pose.X_JN.translation() += 0.03 * place.normalized();
      return pose;
    case Fault::frozen:
      return frozen;
    case Fault::reversed:
      pose.time -= 1e-3 + size;
      return pose;
    case Fault::out_of_workspace:
      pose.X_JN.translation() = (0.5 + 100 * size) * place.normalized();
      return pose;
    case Fault::not_rigid:
      pose.X_JN.linear() *= 1 + 1e-3 + size;
      return pose;
  }
  return pose;
}

/// Sane stretches of random length between bursts of one fault or of all at random; asked tick by
/// tick.
struct Bursts {
  std::uint64_t seed = 0;
  std::uint64_t burst = 0;
  std::uint64_t until = 1500;
  bool faulty = false;
  Fault kind = Fault::none;

  Fault at(std::uint64_t i) {
    if (i == until) {
      faulty = !faulty;
      ++burst;
      const double length = uniform_noise(seed + 7, burst);
      until = i + static_cast<std::uint64_t>(faulty ? 1 + 60 * length : 20 + 1500 * length);
      kind = static_cast<Fault>(1 + burst / 2 % (kFaults - 1));
    }
    const bool mixed = burst % 10 == 5;
    return !faulty ? Fault::none
           : mixed ? static_cast<Fault>(kFaults * uniform_noise(seed + 8, i))
                   : kind;
  }
};

}  // namespace artus::test
