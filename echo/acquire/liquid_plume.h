// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "artus/detail/anatomy/body/liquid.h"
#include "artus/detail/echo/acquire/drifting_echo.h"
#include "artus/raycast/scene.h"

namespace artus {

/// The needle's opening, and what came out of it.
struct PlumeSource {
  Vec3 p_J = Vec3::Zero();      ///< m, middle of the bevel
  Vec3 axis_J = Vec3::UnitZ();  ///< unit, out of the tip
  double bore = 0.413e-3;       ///< m
  double given = 0;             ///< m^3 into places that hold it, since the beginning
};

/// What is seen to move in injected liquid: the faint jet, small bubbles and, of a suspension,
/// clumps of grains. They leave the bevel with the jet, a round laminar one whose speed is u_0 =
/// Q/A and farther on 3 K/(8 pi nu x), K = 4/3 Q^2/A; swirl with a memory of 0.3 s; rise or settle
/// by Stokes' law in the liquid's viscosity at rest; stop at walls, and are gone where there is no
/// liquid any more. Bubbles dissolve. Sequential and a pure function of its inputs and the seed.
/// assumed: how many there are and of which sizes, and that the echo grows with the radius.
class LiquidPlume {
 public:
  explicit LiquidPlume(const Liquid& liquid, std::uint64_t seed = 1);

  /// Moves on by `dt` (s) in the body of `scene`, where what with_injected made is liquid; without
  /// a source nothing new comes. `up_J`: unit, against gravity. Cost: some 3 us a point.
  void step(const Scene& scene, const std::optional<PlumeSource>& source, const Vec3& up_J,
            double dt);
  /// As at the beginning.
  void clear();

  /// m that a single grain of the liquid has sunk since it last flowed, which stirs it up again
  /// (within a second. assumed); 0 without grains.
  [[nodiscard]] double fallen() const noexcept { return fallen_; }
  /// At most 800; the oldest give way to new ones.
  [[nodiscard]] std::span<const DriftingPoint> points() const noexcept { return points_; }

 private:
  struct Seed {
    double rise = 0;  // m/s
    double age = 0;   // s
    double life = 0;  // s
  };
  struct Jet {
    Vec3 p_J = Vec3::Zero();
    Vec3 axis = Vec3::UnitZ();  // unit, as the next two
    Vec3 aside = Vec3::UnitX();
    Vec3 across = Vec3::UnitY();
    double speed = 0;  // m/s where it leaves
    double fall = 0;   // m^2/s: its speed times the distance, farther on
  };
  void find_liquid(const Scene& scene);
  [[nodiscard]] bool is_liquid(const Scene& scene, const Vec3& p_J) const noexcept;
  Vec3 drift(const Scene& scene, const Vec3& from, const Vec3& direction, bool& hit) const noexcept;
  void emit(const Scene& scene, const PlumeSource& source, double flow, double dt);
  void leave(const Scene& scene, const Jet& jet, double time, DriftingPoint point,
             const Seed& seed);
  void add(const DriftingPoint& point, const Seed& seed);

  Liquid liquid_;
  std::uint64_t seed_;
  double given_ = 0;
  double fallen_ = 0;  // m
  double owed_ = 0;    // seeds that are not whole yet
  std::uint64_t next_ = 0;
  std::shared_ptr<const CompiledJoint> known_;  // whose regions these are
  std::vector<bool> wet_;                       // of its regions: whether liquid was injected
  std::vector<DriftingPoint> points_;           // oldest first
  std::vector<Seed> seeds_;
};

}  // namespace artus
