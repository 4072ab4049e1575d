// SPDX-License-Identifier: AGPL-3.0-or-later
#include "hand.h"

#include <algorithm>
#include <cmath>

namespace artus::bridge {
namespace {

constexpr double kSecond = 1e9;        // ns
constexpr double kFastest = 1;         // m/s
constexpr double kRamp = 0.2;          // s
constexpr double kFirstMotion = 5e-3;  // m
constexpr double kSpeedSpan = 3e-3;    // s over which a speed is taken: encoders step
constexpr double kFoldTime = 5;        // s at the peak until what lasts is all; assumed

Triple turned(const Turn& R, const Triple& v) noexcept {
  return {R[0] * v[0] + R[1] * v[1] + R[2] * v[2], R[3] * v[0] + R[4] * v[1] + R[5] * v[2],
          R[6] * v[0] + R[7] * v[1] + R[8] * v[2]};
}

Turn transposed(const Turn& R) noexcept {
  return {R[0], R[3], R[6], R[1], R[4], R[7], R[2], R[5], R[8]};
}

Turn product(const Turn& A, const Turn& B) noexcept {
  Turn out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) out[3 * i + j] += A[3 * i + k] * B[3 * k + j];
  return out;
}

double norm(const Triple& v) noexcept {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

Triple difference(const Triple& a, const Triple& b) noexcept {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

bool is_finite(const Triple& v) noexcept {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

/// Quaternion w, x, y, z by the largest of its parts, of a rotation.
void put_quaternion(const Turn& R, double* q) noexcept {
  const double squares[4] = {1 + R[0] + R[4] + R[8], 1 + R[0] - R[4] - R[8], 1 - R[0] + R[4] - R[8],
                             1 - R[0] - R[4] + R[8]};
  const auto most = std::max_element(squares, squares + 4) - squares;
  const double twice = 2 * std::sqrt(std::max(squares[most], 1e-300));
  const double a = (R[7] - R[5]) / twice;
  const double b = (R[2] - R[6]) / twice;
  const double c = (R[3] - R[1]) / twice;
  const double xy = (R[1] + R[3]) / twice;
  const double xz = (R[2] + R[6]) / twice;
  const double yz = (R[5] + R[7]) / twice;
  const double own = twice / 4;
  const double all[4][4] = {{own, a, b, c}, {a, own, xy, xz}, {b, xy, own, yz}, {c, xz, yz, own}};
  std::copy_n(all[most], 4, q);
}

/// A rotation whose z is `z`; the turn about it is any.
Turn along(const Triple& z) noexcept {
  const Triple other = std::abs(z[0]) < 0.9 ? Triple{1, 0, 0} : Triple{0, 1, 0};
  Triple y{z[1] * other[2] - z[2] * other[1], z[2] * other[0] - z[0] * other[2],
           z[0] * other[1] - z[1] * other[0]};
  const double n = norm(y);
  for (double& value : y) value /= n;
  const Triple x{y[1] * z[2] - y[2] * z[1], y[2] * z[0] - y[0] * z[2], y[0] * z[1] - y[1] * z[0]};
  return {x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]};
}

}  // namespace

void Hand::find_motion(const Reading& reading, std::uint64_t now_ns) noexcept {
  if (!begun_) {
    last_ = reading.position;
    if (!free_) first_ = reading.position;
    last_ns_ = now_ns;
    begun_ = true;
  }
  if (reading.buttons != 0 || norm(difference(reading.position, first_)) > kFirstMotion)
    free_ = true;
  const double seconds = static_cast<double>(now_ns - last_ns_) / kSecond;
  if (seconds < kSpeedSpan) return;
  fast_ = norm(difference(reading.position, last_)) > kFastest * seconds;
  last_ = reading.position;
  last_ns_ = now_ns;
}

Triple Hand::direction(const Triple& tip, const artus_shm_force& felt) noexcept {
  constexpr double kNear = 5e-3;  // m from the entry, where a direction is not yet known
  constexpr double kFar = 20e-3;  // m, from where on it is
  if (felt.contact == 0) inside_ = false;
  if (felt.contact != 0 && !inside_) {
    inside_ = true;
    entered_ = tip;
  }
  if (!inside_) return setup_.direction;
  Triple way = difference(tip, entered_);
  const double depth = norm(way);
  if (depth < kNear) return setup_.direction;
  const double share = std::min(1.0, (depth - kNear) / (kFar - kNear));
  for (std::size_t i = 0; i < 3; ++i)
    way[i] = share * way[i] / depth + (1 - share) * setup_.direction[i];
  const double n = norm(way);
  if (n < 0.1) return setup_.direction;
  for (double& value : way) value /= n;
  return way;
}

bool Hand::pose(const Reading& reading, const artus_shm_force& felt, std::uint64_t now_ns,
                artus_shm_pos& pos) noexcept {
  fault_ = !reading.sound || !is_finite(reading.position);
  for (const double value : reading.rotation) fault_ = fault_ || !std::isfinite(value);
  if (fault_) {
    begun_ = false;
    return false;
  }
  find_motion(reading, now_ns);
  const bool clutch = (reading.buttons & setup_.clutch) != 0;
  Triple at = turned(setup_.R_WD, reading.position);
  for (std::size_t i = 0; i < 3; ++i) at[i] += shift_[i];
  if (clutch && !clutched_) held_ = at;
  if (clutch)
    for (std::size_t i = 0; i < 3; ++i) {
      shift_[i] += held_[i] - at[i];
      at[i] = held_[i];
    }
  clutched_ = clutch;
  const Turn R = reading.has_wrist ? product(product(setup_.R_WD, reading.rotation), setup_.R_TN)
                                   : along(setup_.probe ? setup_.direction : direction(at, felt));
  std::copy_n(at.begin(), 3, setup_.probe ? pos.probe_position : pos.needle_position);
  put_quaternion(R, setup_.probe ? pos.probe_rotation : pos.needle_rotation);
  if ((reading.buttons & setup_.choose) != 0) pos.buttons |= 1U;
  pos.present |= setup_.probe ? 2U : 1U;
  return true;
}

double Hand::fold_back(double wanted, double seconds) noexcept {
  const double above = setup_.limits.peak - setup_.limits.lasting;
  const double budget = above * kFoldTime;  // N s
  if (!(above > 0)) return std::min(wanted, setup_.limits.peak);
  const double cap = setup_.limits.peak - above * spent_ / budget;
  const double given = std::min(wanted, cap);
  spent_ = std::clamp(spent_ + (given - setup_.limits.lasting) * seconds, 0.0, budget);
  return given;
}

Triple Hand::force(const artus_shm_force& felt, bool fresh, std::uint64_t now_ns) noexcept {
  const double* said = setup_.probe ? felt.probe_force : felt.force;
  Triple force{said[0], said[1], said[2]};
  const double seconds =
      tick_ns_ == 0 ? 0 : std::min(0.1, static_cast<double>(now_ns - tick_ns_) / kSecond);
  tick_ns_ = now_ns;
  rest_ = fault_              ? Rest::fault
          : !fresh            ? Rest::silent
          : !is_finite(force) ? Rest::not_finite
          : fast_             ? Rest::fast
          : clutched_         ? Rest::clutched
          : !free_            ? Rest::waiting
                              : Rest::none;
  if (rest_ != Rest::none) {
    ramp_ns_ = 0;
    static_cast<void>(fold_back(0, seconds));
    return {};
  }
  if (ramp_ns_ == 0) ramp_ns_ = now_ns;
  force[2] += setup_.gravity;
  const double ramp = std::min(1.0, static_cast<double>(now_ns - ramp_ns_) / kSecond / kRamp);
  const double wanted = ramp * norm(force);
  const double given = fold_back(wanted, seconds);
  const double scale = wanted > 0 ? ramp * given / wanted : 0;
  for (double& value : force) value *= scale;
  return turned(transposed(setup_.R_WD), force);
}

void Hand::become(bool probe) noexcept {
  if (setup_.probe == probe) return;
  setup_.probe = probe;
  ramp_ns_ = 0;
  inside_ = false;
}

}  // namespace artus::bridge
