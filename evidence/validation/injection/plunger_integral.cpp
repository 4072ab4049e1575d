// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/injection/plunger_integral.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace artus {
namespace {

constexpr double kMinStep = 1e-10;  // s, beyond something that happens

/// What changes: volume in the place and what its wall will yet relax, Pa. While the stopper rests
/// its travel is kept, while it glides the thumb's force is.
struct Scalars {
  double volume = 0;
  double relaxing = 0;
};

Scalars operator+(const Scalars& a, const Scalars& b) {
  return {a.volume + b.volume, a.relaxing + b.relaxing};
}
Scalars operator*(double s, const Scalars& a) {
  return {s * a.volume, s * a.relaxing};
}

class Integral {
 public:
  explicit Integral(const IntegralSetup& setup)
      : thumb_(setup.thumb),
        law_(setup.law),
        area_(std::numbers::pi * std::pow(setup.plunger.syringe.diameter, 2) / 4),
        compliance_(setup.plunger.syringe.compliance),
        air_(setup.plunger.syringe.air),
        glide_(setup.plunger.syringe.glide),
        break_loose_(setup.plunger.syringe.break_loose),
        viscosity_(setup.plunger.liquid.viscosity.zero) {
    ARTUS_REQUIRE(setup.plunger.liquid.viscosity.newtonian(), "the liquid must be Newtonian");
    const NeedleBore& bore = setup.plunger.needle;
    const double across = std::numbers::pi * std::pow(bore.diameter, 2) / 4;
    bore_ = 8 * std::numbers::pi * viscosity_ * bore.length / (across * across);
    entry_ = setup.plunger.entry_loss * setup.plunger.liquid.density / 2 / (across * across);
    open_ = !(law_.opening > 0);
  }

  std::vector<IntegralRow> run(double seconds, double each, double step) {
    std::vector<IntegralRow> rows;
    const auto n = static_cast<int>(std::lround(seconds / each));
    const auto parts = static_cast<int>(std::ceil(each / step - 1e-9));
    settle();
    for (int k = 0;; ++k) {
      rows.push_back(row());
      if (k == n) return rows;
      for (int i = 0; i < parts; ++i) advance(each * (k + (i + 1.0) / parts));
    }
  }

 private:
  [[nodiscard]] double wall(double v) const {
    if (law_.kind == SpaceKind::open) return law_.rest;
    if (law_.kind == SpaceKind::split)
      return v < law_.peak_volume ? law_.opening + (law_.peak - law_.opening) * v / law_.peak_volume
                                  : law_.peak / std::pow(v / law_.peak_volume, 0.2);
    return law_.rest + tension(v);
  }
  /// Pa of a cavity's wall: the integral of its slope, and its suction where it is nearly empty.
  [[nodiscard]] double tension(double v) const {
    const auto straight = [this](double u) {
      const double beyond = std::max(0.0, u - law_.slack);
      const double toe = std::min(beyond, law_.toe);
      const double curved = law_.toe > 0 ? law_.stiffness * toe * toe / (2 * law_.toe) : 0;
      return curved + law_.stiffness * (beyond - toe);
    };
    double p = straight(std::min(v, law_.yield));
    if (v > law_.yield) p += (straight(v) - straight(law_.yield)) / 3;
    if (v < law_.suction_volume) p -= law_.suction * (1 - v / law_.suction_volume);
    return p;
  }
  [[nodiscard]] double slope(double v) const {
    constexpr double kBeside = 1e-12;  // m^3
    return (wall(v + kBeside) - wall(std::max(0.0, v - kBeside))) /
           (v > kBeside ? 2 * kBeside : kBeside + v);
  }
  [[nodiscard]] double film(double v) const {
    if (!(law_.film_area > 0)) return 0;
    constexpr double kWhole = 3e-6;    // m^3, of a lens as wide as the film
    constexpr double kFirst = 2.5e-4;  // m^2, parted by the needle
    const double grown = law_.film_area * std::pow(std::max(v, 0.0) / kWhole, 2.0 / 3);
    const double gap = law_.film_gap + v / std::min(law_.film_area, std::max(grown, kFirst));
    return 6 * viscosity_ * std::log(25.0) / (std::numbers::pi * gap * gap * gap);
  }
  /// m^3/s at a pressure in the barrel: the root of entry q^2 + (bore + near) q = dp.
  [[nodiscard]] double flow(double pressure, const Scalars& s) const {
    const double dp = pressure - wall(s.volume) - s.relaxing;
    if (!open_ || (dp < 0 && (law_.kind == SpaceKind::split || !(s.volume > 0)))) return 0;
    const double b = bore_ + law_.resistance + film(s.volume);
    const double root = entry_ > 0
                            ? (std::sqrt(b * b + 4 * entry_ * std::abs(dp)) - b) / (2 * entry_)
                            : std::abs(dp) / b;
    return dp < 0 ? -root : root;
  }
  /// m^3 by which the barrel and its air, by Boyle's law, give way.
  [[nodiscard]] double squeezed(double p) const {
    return compliance_ * p + air_ * (1 - Syringe::kAtmosphere / (Syringe::kAtmosphere + p));
  }
  /// Where a p + b squeezed(p) = c, by Newton.
  [[nodiscard]] double pressure_where(double a, double b, double c) const {
    double p = 0;
    for (int k = 0; k < 50; ++k) {
      const double whole = Syringe::kAtmosphere + p;
      const double slope = a + b * (compliance_ + air_ * Syringe::kAtmosphere / (whole * whole));
      const double by = (c - a * p - b * squeezed(p)) / slope;
      // Never across the vacuum.
      p = std::max(p + by, (p - Syringe::kAtmosphere) / 2);
      if (std::abs(by) < 1e-9) break;
    }
    return p;
  }
  [[nodiscard]] double pressure(double t, const Scalars& s) const {
    if (direction_ == 0) return pressure_where(0, 1, area_ * travel_ - s.volume);
    const double push = thumb_.force(t) + thumb_.stiffness * thumb_.place(t) - direction_ * glide_;
    return pressure_where(area_, thumb_.stiffness / area_,
                          push - thumb_.stiffness * s.volume / area_);
  }
  [[nodiscard]] double travel(double t, const Scalars& s) const {
    return direction_ == 0 ? travel_ : (s.volume + squeezed(pressure(t, s))) / area_;
  }
  [[nodiscard]] double push(double t, const Scalars& s) const {
    return thumb_.force(t) + thumb_.stiffness * (thumb_.place(t) - travel(t, s));
  }
  [[nodiscard]] Scalars rate(double t, const Scalars& s) const {
    const double q = flow(pressure(t, s), s);
    Scalars change{q, 0};
    if (law_.relaxing > 0)
      change.relaxing = law_.relaxing * slope(s.volume) * q - s.relaxing / law_.relaxation;
    return change;
  }
  [[nodiscard]] Scalars after(double h) const {
    const Scalars a = rate(time_, now_);
    const Scalars b = rate(time_ + h / 2, now_ + (h / 2) * a);
    const Scalars c = rate(time_ + h / 2, now_ + (h / 2) * b);
    const Scalars d = rate(time_ + h, now_ + h * c);
    return now_ + (h / 6) * (a + 2 * b + 2 * c + d);
  }
  /// m/s of the stopper, in the way it goes.
  [[nodiscard]] double speed(double t, const Scalars& s) const {
    constexpr double kMoment = 1e-7;  // s
    const Scalars next = s + kMoment * rate(t, s);
    return direction_ * (travel(t + kMoment, next) - travel(t, s)) / kMoment;
  }
  /// N beyond what holds a resting stopper.
  [[nodiscard]] double loose(double t, const Scalars& s) const {
    return std::abs(push(t, s) - area_ * pressure(t, s)) - break_loose_;
  }
  [[nodiscard]] double opens(double t, const Scalars& s) const {
    const double shut = law_.kind == SpaceKind::split ? 0 : law_.opening;
    return pressure(t, s) - wall(s.volume) - s.relaxing - shut;
  }
  /// Whether something has happened by a time.
  [[nodiscard]] bool happened(double t, const Scalars& s) const {
    if (!open_ && opens(t, s) > 0) return true;
    return direction_ == 0 ? loose(t, s) > 0 : !(speed(t, s) > 0);
  }
  /// What happens, happens.
  void settle() {
    for (int k = 0; k < 4 && happened(time_, now_); ++k) {
      if (!open_ && opens(time_, now_) > 0) {
        open_ = true;
      } else if (direction_ == 0) {
        direction_ = push(time_, now_) > area_ * pressure(time_, now_) ? 1 : -1;
      } else {
        travel_ = travel(time_, now_);
        direction_ = 0;
      }
    }
  }
  void advance(double to) {
    while (time_ < to) {
      double h = to - time_;
      Scalars next = after(h);
      const bool event = happened(to, next);
      if (event) {
        double low = 0;
        for (int k = 0; k < 40; ++k) {
          const double mid = (low + h) / 2;
          (happened(time_ + mid, after(mid)) ? h : low) = mid;
        }
        h = std::max(h, kMinStep);
        next = after(h);
      }
      time_ = event ? time_ + h : to;
      now_ = next;
      settle();
    }
  }
  [[nodiscard]] IntegralRow row() const {
    const double p = pressure(time_, now_);
    return {time_, travel(time_, now_), now_.volume, p, flow(p, now_), push(time_, now_)};
  }

  ThumbCourse thumb_;
  SpaceLaw law_;
  double area_;         // m^2
  double compliance_;   // m^3/Pa
  double air_;          // m^3
  double glide_;        // N
  double break_loose_;  // N
  double viscosity_;    // Pa s
  double bore_ = 0;     // Pa s/m^3
  double entry_ = 0;    // Pa s^2/m^6
  double time_ = 0;
  Scalars now_;
  double travel_ = 0;  // m, of a resting stopper
  int direction_ = 0;
  bool open_ = false;
};

}  // namespace

std::vector<IntegralRow> integrate_plunger(const IntegralSetup& setup, double seconds, double each,
                                           double step) {
  ARTUS_REQUIRE(seconds > 0 && each > 0 && step > 0, "times must be above 0");
  return Integral(setup).run(seconds, each, step);
}

}  // namespace artus
