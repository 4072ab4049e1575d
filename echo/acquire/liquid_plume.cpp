// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/liquid_plume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "artus/detail/core/noise.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr std::size_t kMax = 800;
constexpr double kBubbles = 400 / kCubicCentimetre;  // per m^3 drawn up and shaken. assumed
constexpr double kClumps = 600 / kCubicCentimetre;   // per m^3 of a suspension. assumed
constexpr double kBubbleRadius = 25e-6;              // m, median. assumed
constexpr double kBubbleSpread = 0.5;                // of the radius' logarithm. assumed
constexpr double kBubbleEcho = 0.025 / 50e-6;        // per m of radius: 50 um as a needle's track
constexpr double kClumpRadius = 10e-6;               // m
constexpr double kMuscle = 0.01;                     // rms of its speckle, mirror = 1
constexpr double kGravity = 9.81;                    // m/s^2
constexpr double kGrainDensity = 1320;               // kg/m^3
constexpr double kMemory = 0.3;                      // s, of swirls
constexpr double kSwirl = 0.35;                      // of the speed, sideways. assumed
constexpr double kSpread = 0.12;                     // rad, of the jet. assumed
constexpr double kWall = 0.1e-3;                     // m that a point keeps from a wall
constexpr double kLife = 15;           // s of a bubble of 20 um, as its square. assumed
constexpr double kTail = 2e-3;         // m
constexpr double kStirred = 1;         // s. assumed
constexpr double kForever = 1e9;       // s
constexpr double kDeflected = 5e-3;    // m that a jet goes on along a wall. assumed
constexpr int kTracers = 16;           // of an image: the jet itself. assumed
constexpr double kTracerEcho = 0.007;  // 3 dB below muscle's speckle. assumed
constexpr double kTracerLife = 0.05;   // s
constexpr double kJetTime = 10e-3;     // s along which they are spread
constexpr double kTailRadius = 40e-6;  // m, from which on a bubble rings visibly. assumed

enum Draw : std::uint64_t { kKind, kRadius, kWhen, kAside, kAcross, kPhase, kTurn, kDraws = 16 };

/// How far a jet carries in `time`.
double distance_of_jet(double u0, double fall, double time) noexcept {
  const double core = fall / u0;  // m, to where the speed begins to fall
  if (u0 * time <= core) return u0 * time;
  return std::sqrt(core * core + 2 * fall * (time - core / u0));
}

/// m/s at which a single grain sinks, by Stokes' law.
double settling_speed(const Liquid& liquid) noexcept {
  const double heavier = std::max(0.0, kGrainDensity - liquid.density);
  return 2.0 / 9 * heavier * kGravity * liquid.grain_radius * liquid.grain_radius /
         liquid.viscosity.zero;
}

}  // namespace

LiquidPlume::LiquidPlume(const Liquid& liquid, std::uint64_t seed) : liquid_(liquid), seed_(seed) {}

void LiquidPlume::clear() {
  given_ = 0;
  fallen_ = 0;
  owed_ = 0;
  next_ = 0;
  points_.clear();
  seeds_.clear();
}

void LiquidPlume::find_liquid(const Scene& scene) {
  if (known_ == scene.shared_joint()) return;
  known_ = scene.shared_joint();
  wet_.clear();
  for (const Region& region : known_->regions)
    wet_.push_back(region.tissue < known_->tissues.size() &&
                   is_injected(known_->tissues[region.tissue].name));
}

bool LiquidPlume::is_liquid(const Scene& scene, const Vec3& p_J) const noexcept {
  const RegionId region = scene.region_at(p_J);
  return region < wet_.size() && wet_[region];
}

/// Where a path leads that ends before the first wall.
Vec3 LiquidPlume::drift(const Scene& scene, const Vec3& from, const Vec3& displacement,
                        bool& hit) const noexcept {
  const double length = displacement.norm();
  hit = false;
  if (length < 1e-9) return from;
  std::array<Crossing, 16> crossings;
  const auto found =
      scene.find_crossings({from, from + displacement * ((length + kWall) / length)}, crossings);
  for (std::size_t i = 0; i < found.size; ++i) {
    const RegionId to = crossings[i].to;
    if (to < wet_.size() && wet_[to]) continue;
    hit = true;
    return from + displacement * (std::max(0.0, crossings[i].depth - kWall) / length);
  }
  return from + displacement;
}

void LiquidPlume::add(const DriftingPoint& point, const Seed& seed) {
  if (points_.size() == kMax) {
    points_.erase(points_.begin());
    seeds_.erase(seeds_.begin());
  }
  points_.push_back(point);
  seeds_.push_back(seed);
}

/// Takes a point along with the jet for `time` s since it left the bevel.
void LiquidPlume::leave(const Scene& scene, const Jet& jet, double time, DriftingPoint point,
                        const Seed& seed) {
  const std::uint64_t id = kDraws * next_ - kDraws;
  const double turn = 2 * std::numbers::pi * uniform_noise(seed_, id + kTurn);
  const Vec3 direction = (jet.axis + kSpread * (normal_noise(seed_, id + kAside) * jet.aside +
                                                normal_noise(seed_, id + kAcross) * jet.across))
                             .normalized();
  const double x = distance_of_jet(jet.speed, jet.fall, time);
  bool hit = false;
  point.phase = 2 * std::numbers::pi * uniform_noise(seed_, id + kPhase);
  point.p_J = drift(scene, jet.p_J, x * direction, hit);
  point.v_J = std::min(jet.speed, jet.fall / std::max(x, 1e-6)) * direction;
  if (hit) {  // what hits a wall goes on along it in all directions
    const Vec3 away = kSwirl * (std::cos(turn) * jet.aside + std::sin(turn) * jet.across);
    const double rest = std::max(0.0, x - (point.p_J - jet.p_J).norm());
    point.v_J = point.v_J.norm() * away;
    point.p_J = drift(scene, point.p_J, std::min(rest, kDeflected) * away, hit);
  }
  if (is_liquid(scene, point.p_J)) add(point, seed);
}

void LiquidPlume::emit(const Scene& scene, const PlumeSource& source, double flow, double dt) {
  Jet jet;
  jet.p_J = source.p_J;
  jet.axis = source.axis_J;
  jet.aside = source.axis_J.unitOrthogonal();
  jet.across = source.axis_J.cross(jet.aside);
  jet.speed = flow / (std::numbers::pi / 4 * source.bore * source.bore);
  const double viscosity = liquid_.viscosity.at(8 * jet.speed / source.bore) / liquid_.density;
  jet.fall = 3 * (4.0 / 3 * flow * jet.speed) / (8 * std::numbers::pi * viscosity);
  const double grains = liquid_.solids > 0 ? kClumps : 0;
  owed_ += (kBubbles + grains) * flow * dt;
  for (; owed_ >= 1; owed_ -= 1) {
    const std::uint64_t id = kDraws * next_++;
    const bool bubble = uniform_noise(seed_, id + kKind) * (kBubbles + grains) < kBubbles;
    const double radius =
        bubble ? kBubbleRadius * std::exp(kBubbleSpread * normal_noise(seed_, id + kRadius))
               : kClumpRadius;
    const double lighter = liquid_.density - (bubble ? 0 : kGrainDensity);
    DriftingPoint point;
    point.amplitude = bubble ? kBubbleEcho * radius : 3 * kMuscle * liquid_.backscatter;
    point.tail = bubble && radius > kTailRadius ? kTail : 0;
    Seed seed;
    seed.rise = 2.0 / 9 * lighter * kGravity * radius * radius / liquid_.viscosity.zero;
    seed.life = bubble ? kLife * std::pow(radius / 20e-6, 2) : kForever;
    leave(scene, jet, uniform_noise(seed_, id + kWhen) * dt, point, seed);
  }
  for (int k = 0; k < kTracers; ++k) {
    DriftingPoint point;
    point.amplitude = kTracerEcho;
    ++next_;
    leave(scene, jet, (k + 0.5) / kTracers * std::min(dt, kJetTime), point, {0, 0, kTracerLife});
  }
}

void LiquidPlume::step(const Scene& scene, const std::optional<PlumeSource>& source,
                       const Vec3& up_J, double dt) {
  find_liquid(scene);
  const double keeps = std::exp(-dt / kMemory);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    DriftingPoint point = points_[i];
    Seed seed = seeds_[i];
    seed.age += dt;
    if (seed.age > seed.life || !is_liquid(scene, point.p_J)) continue;
    const auto id = static_cast<std::uint64_t>(std::lround(seed.age / dt)) * 3;
    const auto own = mix_bits(seed_ ^ static_cast<std::uint64_t>(std::llround(point.phase * 1e9)));
    const Vec3 turn(normal_noise(own, id), normal_noise(own, id + 1), normal_noise(own, id + 2));
    point.v_J = keeps * (point.v_J + kSwirl * (1 - keeps) * point.v_J.norm() * turn);
    bool hit = false;
    point.p_J = drift(scene, point.p_J, dt * (point.v_J + seed.rise * up_J), hit);
    if (hit) point.v_J *= 0.5;
    if (!is_liquid(scene, point.p_J)) continue;
    points_[kept] = point;
    seeds_[kept++] = seed;
  }
  points_.resize(kept);
  seeds_.resize(kept);
  const double flow = source ? std::max(0.0, source->given - given_) / dt : 0;
  if (flow > 0)
    fallen_ *= std::exp(-dt / kStirred);
  else if (liquid_.solids > 0 && given_ > 0)
    fallen_ += dt * settling_speed(liquid_);
  if (!source) return;
  given_ = source->given;
  if (flow > 0 && is_liquid(scene, source->p_J)) emit(scene, *source, flow, dt);
}

}  // namespace artus
