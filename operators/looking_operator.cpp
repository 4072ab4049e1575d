// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/operators/looking_operator.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/noise.h"

namespace artus {
namespace {

constexpr double kLookGlance = 0.05;  // s
constexpr double kSweep = 15e-3;      // m/s; assumed
constexpr double kGo = 40e-3;         // m/s to a place that is remembered; assumed
constexpr double kCentre = 15e-3;     // m/s; assumed
constexpr double kLookPatience = 4;   // s that a wrong one is shown; assumed
constexpr double kOverlap = 0.8;      // of the picture's width from lane to lane

}  // namespace

LookingOperator::LookingOperator(const OperatorSkill& skill, const LookPlan& plan,
                                 std::uint64_t seed)
    : skill_(skill), plan_(plan), seed_(seed), in_view_(plan.n, 0), places_(plan.n) {
  const double reach = std::max(0.0, plan.half_x - 0.5 * plan.view);
  const int n = 1 + static_cast<int>(std::ceil(2 * reach / (kOverlap * plan.view)));
  double end = plan.half_y;
  for (int k = 0; k < n; ++k) {
    const double x = n > 1 ? reach * (2.0 * k / (n - 1) - 1) : 0;
    lanes_.push_back({x, -end});
    lanes_.push_back({x, end});
    end = -end;
  }
}

double LookingOperator::draw() noexcept {
  return uniform_noise(seed_, draws_++);
}

void LookingOperator::move_to(const Place& place, double speed) noexcept {
  const double dx = place.x - x_;
  const double dy = place.y - y_;
  const double left = std::hypot(dx, dy);
  const double step = std::min(left, speed * kLookGlance);
  if (left <= 0) return;
  x_ += dx / left * step;
  y_ += dy / left * step;
}

void LookingOperator::sweep() noexcept {
  const Place& corner = lanes_[next_];
  move_to(corner, kSweep);
  if (std::hypot(corner.x - x_, corner.y - y_) < 1e-9) next_ = (next_ + 1) % lanes_.size();
}

/// What has come into the picture since the last glance is recognised, mistaken, or passed over.
void LookingOperator::notice(double time, const LookGlance& glance) {
  for (std::size_t k = 0; k < plan_.n; ++k) {
    const bool is_new = glance.x[k].has_value() && in_view_[k] == 0;
    in_view_[k] = glance.x[k].has_value() ? 1 : 0;
    if (!is_new || taken_) continue;
    const bool known = draw() < skill_.know;
    const bool mistaken = !known && draw() < skill_.know;
    if (known) places_[k] = Place{x_ + *glance.x[k], y_};
    if ((known && k == glance.asked) || (mistaken && k != glance.asked)) {
      taken_ = k;
      taken_time_ = time;
    }
  }
}

void LookingOperator::centre(double time, const LookGlance& glance) {
  if (time - taken_time_ > kLookPatience) {  // nobody says that it was found: it was another
    taken_.reset();
    return;
  }
  if (time - taken_time_ < skill_.reaction) return;
  const auto& x = glance.x[*taken_];
  if (x && std::abs(*x) > skill_.judge_sd) move_to({x_ + *x, y_}, kCentre);
  if (!x)
    y_ += (lanes_[next_].y > y_ ? -1 : 1) * 0.3 * kCentre * kLookGlance;  // it came on past it
}

void LookingOperator::look(double time, const LookGlance& glance) {
  if (glance.asked != asked_) {
    asked_ = glance.asked;
    taken_.reset();
    std::fill(in_view_.begin(), in_view_.end(), 0);
  }
  done_ = asked_ >= plan_.n;
  if (done_) return;
  notice(time, glance);
  if (taken_) {
    centre(time, glance);
    return;
  }
  if (auto& place = places_[asked_]) {
    move_to(*place, kGo);
    if (std::hypot(place->x - x_, place->y - y_) < 1e-9) place.reset();
    return;
  }
  sweep();
}

}  // namespace artus
