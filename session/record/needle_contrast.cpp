// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/record/needle_contrast.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace artus {
namespace {

constexpr double kDisc = 0.75e-3;       // m, radius
constexpr double kInner = 2e-3;         // m
constexpr double kOuter = 4e-3;         // m
constexpr double kShaft = 1e-3;         // m to either side of its line
constexpr double kAcross = 0.1;         // of a unit axis in the plane: less is a shaft across it
constexpr double kLeastPower = 1e-30;   // of the envelope
constexpr std::size_t kSquare = 20000;  // samples that are room enough for most pictures

/// Power around a place of a picture.
class Around {
 public:
  /// `axis`: of the shaft, frame P.
  Around(const Vec3& place, const Vec3& axis) : place_(place) {
    const Vec3 flat(axis.x(), 0, axis.z());
    if (flat.norm() > kAcross) across_ = Vec3(flat.z(), 0, -flat.x()).normalized();
    ring_.reserve(kSquare);
  }

  /// One scanline's samples of `step` m.
  void add(const Scanline& line, const float* samples, int n, double step) {
    const double along = (place_ - line.origin).dot(line.direction);
    const double aside = (place_ - line.origin - along * line.direction).norm();
    if (aside > kOuter) return;
    const int first = std::max(0, static_cast<int>((along - kOuter) / step));
    const int last = std::min(n - 1, static_cast<int>((along + kOuter) / step));
    for (int k = first; k <= last; ++k) {
      const double amplitude = static_cast<double>(samples[k]);
      const double off = std::hypot(aside, k * step - along);
      if (off <= kDisc) {
        disc_ += amplitude * amplitude;
        ++n_disc_;
      }
      if (off < kInner || off > kOuter) continue;
      const Vec3 from = line.origin + k * step * line.direction - place_;
      if (across_.isZero() || std::abs(from.dot(across_)) > kShaft)
        ring_.push_back(amplitude * amplitude);
    }
  }

  /// dB; empty where the place is off the lines.
  [[nodiscard]] std::optional<double> contrast() {
    if (n_disc_ == 0 || ring_.empty()) return std::nullopt;
    const auto middle = ring_.begin() + static_cast<std::ptrdiff_t>(ring_.size() / 2);
    std::nth_element(ring_.begin(), middle, ring_.end());
    const double typical = *middle / std::numbers::ln2;  // the mean of that median's exponential
    return 10 * std::log10(std::max(disc_ / n_disc_, kLeastPower) / std::max(typical, kLeastPower));
  }

 private:
  Vec3 place_;
  Vec3 across_ = Vec3::Zero();  // across the shaft in the picture; zero: it shows as a point
  double disc_ = 0;
  int n_disc_ = 0;
  std::vector<double> ring_;
};

}  // namespace

std::optional<double> needle_contrast(const FrameInput& input, const Frame& frame,
                                      const Transducer& transducer) {
  if (!frame.tip_shown) return std::nullopt;
  const double left = -0.5 * frame.pixel * frame.width;
  const double top = std::min(0.0, scanline(transducer, 0).origin.z());
  const Vec3 tip(left + (frame.tip_shown->x + 0.5) * frame.pixel, 0,
                 top + (frame.tip_shown->y + 0.5) * frame.pixel);
  const Pose X_PN = to_pose(input.X_JP).inverse() * to_pose(input.X_JN);
  Around around(tip, X_PN.linear().col(2));
  for (int i = 0; i < frame.n_lines; ++i)
    around.add(scanline(transducer, i),
               frame.envelope.data() + static_cast<std::ptrdiff_t>(i) * frame.n_samples,
               frame.n_samples, frame.sample_depth);
  return around.contrast();
}

}  // namespace artus
