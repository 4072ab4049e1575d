// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/plunger/needle_flow.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace artus {
namespace {

struct Gauge {
  int gauge;
  double inner;  // m
  double outer;  // m
};
constexpr std::array<Gauge, 8> kGauges{{{18, 0.838e-3, 1.270e-3},
                                        {19, 0.686e-3, 1.067e-3},
                                        {20, 0.603e-3, 0.908e-3},
                                        {21, 0.514e-3, 0.819e-3},
                                        {22, 0.413e-3, 0.718e-3},
                                        {23, 0.337e-3, 0.641e-3},
                                        {25, 0.260e-3, 0.514e-3},
                                        {27, 0.210e-3, 0.413e-3}}};

constexpr double kSlowest = 1e-3;  // 1/s, shear rates of the table at the wall
constexpr double kFastest = 1e8;
constexpr int kSubsteps = 8;         // of the integral between two points of it
constexpr double kUsualFlow = 1e-7;  // m^3/s

}  // namespace

std::optional<NeedleBore> bore_of_gauge(int gauge, double length) {
  for (const Gauge& g : kGauges)
    if (g.gauge == gauge) return NeedleBore{g.inner, g.outer, length};
  return std::nullopt;
}

NeedleFlow::NeedleFlow(const NeedleBore& bore, const Viscosity& viscosity, double density,
                       double entry_loss)
    : newtonian_(viscosity.newtonian()), resistance_(0), kinetic_(0) {
  ARTUS_REQUIRE(bore.diameter > 0 && bore.length > 0, "a needle has a bore and a length");
  ARTUS_REQUIRE(viscosity.zero > 0 && viscosity.infinite > 0 && density > 0 && entry_loss >= 0,
                "a liquid has a viscosity and a density");
  constexpr double kPi = std::numbers::pi;
  const double area = kPi * bore.diameter * bore.diameter / 4;
  kinetic_ = entry_loss * density / (2 * area * area);
  if (newtonian_) {
    resistance_ = 128 * viscosity.zero * bore.length / (kPi * std::pow(bore.diameter, 4));
    return;
  }
  tabulate(bore, viscosity);
  resistance_ = drop(kUsualFlow) / kUsualFlow;
}

/// Q = pi R^3 / tau_w^3 times the integral of tau^2 g dtau up to the wall's tau_w; dp = 2 L tau_w /
/// R. Runs over the wall's shear rate, so nothing has to be inverted.
void NeedleFlow::tabulate(const NeedleBore& bore, const Viscosity& viscosity) {
  const double radius = bore.diameter / 2;
  const auto stress = [&](double rate) {
    return viscosity.at(rate) * rate;
  };
  const double ratio = std::pow(kFastest / kSlowest, 1.0 / ((kPoints - 2) * kSubsteps));
  double rate = kSlowest;
  double tau = stress(rate);
  double integral = tau * tau * tau * rate / 4;  // a Newtonian core
  for (std::size_t i = 1; i < kPoints; ++i) {
    const double flow = std::numbers::pi * std::pow(radius / tau, 3) * integral;
    flow_[i] = flow;
    drop_[i] = 2 * bore.length * tau / radius + kinetic_ * flow * flow;
    for (int k = 0; k < kSubsteps; ++k) {
      const double next_rate = rate * ratio;
      const double next = stress(next_rate);
      integral += (tau * tau * rate + next * next * next_rate) / 2 * (next - tau);
      rate = next_rate;
      tau = next;
    }
  }
}

double NeedleFlow::flow(double dp, double extra) const noexcept {
  const double size = std::abs(dp);
  if (newtonian_) {
    const double r = resistance_ + extra;
    // 2 dp/(r + sqrt(r^2 + 4 k dp)): the usual root without cancellation.
    return std::copysign(2 * size / (r + std::sqrt(r * r + 4 * kinetic_ * size)), dp);
  }
  std::size_t low = 0;
  std::size_t high = kPoints - 1;
  while (high - low > 1) {
    const std::size_t mid = (low + high) / 2;
    if (drop_[mid] + extra * flow_[mid] <= size)
      low = mid;
    else
      high = mid;
  }
  const double from = drop_[low] + extra * flow_[low];
  const double to = drop_[high] + extra * flow_[high];
  const double q = flow_[low] + (flow_[high] - flow_[low]) * (size - from) / (to - from);
  return std::copysign(q, dp);
}

double NeedleFlow::drop(double flow, double extra) const noexcept {
  const double q = std::abs(flow);
  if (newtonian_) return std::copysign((resistance_ + extra + kinetic_ * q) * q, flow);
  const auto above = std::upper_bound(flow_.begin() + 1, flow_.end() - 1, q) - flow_.begin();
  const auto i = static_cast<std::size_t>(above);
  const double share = (q - flow_[i - 1]) / (flow_[i] - flow_[i - 1]);
  return std::copysign(drop_[i - 1] + share * (drop_[i] - drop_[i - 1]) + extra * q, flow);
}

}  // namespace artus
