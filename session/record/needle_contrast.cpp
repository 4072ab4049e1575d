// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/record/needle_contrast.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace artus {
namespace {

// The end of a shaft in the picture, a line.
constexpr double kShaftEnd = 5e-3;    // m of it that are looked at
constexpr double kTipEnd = 2e-3;      // m of these that must stand out by themselves
constexpr double kLeastEnd = 1.5e-3;  // m; a shorter one shows as a point
constexpr double kAside = 0.3e-3;     // m by which all of it is as far from the plane as the tip
constexpr double kBin = 0.1e-3;       // m, from one line beside the shaft to the next
constexpr int kBins = 29;             // to either side
// Bins to either side in which the brightest is the shaft's: of 18 G, whose wall shows 0.6 mm
// beside its axis, too.
constexpr int kOnShaft = 8;
constexpr int kBeside = 12;           // the first one that is beside it
constexpr double kSmoothed = 0.1e-3;  // m to either side along the beam, that nulls count less
constexpr std::size_t kFewest = 4;    // lines beside it
constexpr double kShownRange = 60;    // dB under the brightest, below which a screen shows nothing
// dB by which the brightest of those lines stands out of speckle; fitted: with it a needle in the
// plane is seen in 99 % of 500 pictures, one whose echo is 7 to 12 dB below muscle's in none of 57.
constexpr double kChoice = 2;
// A shaft that crosses the plane, a point.
constexpr double kDisc = 0.75e-3;       // m, radius
constexpr double kInner = 2e-3;         // m
constexpr double kOuter = 4e-3;         // m
constexpr double kLeastPower = 1e-30;   // of the envelope
constexpr std::size_t kSquare = 20000;  // samples that are room enough for most pictures

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Power around a place of a picture.
class Around {
 public:
  explicit Around(const Vec3& place) : place_(place) { ring_.reserve(kSquare); }

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
      if (off >= kInner && off <= kOuter) ring_.push_back(amplitude * amplitude);
    }
  }

  /// dB; empty where the place is off the lines.
  [[nodiscard]] std::optional<double> contrast() {
    if (n_disc_ == 0 || ring_.empty()) return std::nullopt;
    const double typical = median_of(ring_) / std::numbers::ln2;  // of that median's exponential
    return 10 * std::log10(std::max(disc_ / n_disc_, kLeastPower) / std::max(typical, kLeastPower));
  }

 private:
  Vec3 place_;
  double disc_ = 0;
  int n_disc_ = 0;
  std::vector<double> ring_;
};

double smoothed_db(const float* samples, int n, int at, double step) {
  const int reach = static_cast<int>(std::lround(kSmoothed / step));
  double power = 0;
  const int first = std::max(0, at - reach);
  const int last = std::min(n - 1, at + reach);
  for (int k = first; k <= last; ++k) {
    const double amplitude = static_cast<double>(samples[k]);
    power += amplitude * amplitude / (last - first + 1);
  }
  return 10 * std::log10(std::max(power, kLeastPower));
}

/// How bright the end of a shaft is beside lines that run along it.
class ShaftEnd {
 public:
  /// `back`: unit, in the plane, from the tip along the shaft.
  ShaftEnd(const Vec3& tip, const Vec3& back, double length)
      : tip_(tip), back_(back), across_(back.z(), 0, -back.x()), length_(length) {
    samples_.reserve(kSquare);
  }

  void add(const Scanline& line, const float* samples, int n, double step) {
    const double reach = length_ + (kBins + 1) * kBin;
    const double along = (tip_ - line.origin).dot(line.direction);
    if ((tip_ - line.origin - along * line.direction).norm() > reach) return;
    const int first = std::max(0, static_cast<int>((along - reach) / step));
    const int last = std::min(n - 1, static_cast<int>((along + reach) / step));
    for (int k = first; k <= last; ++k) {
      const Vec3 from = line.origin + k * step * line.direction - tip_;
      const double behind = from.dot(back_);
      const long bin = std::lround(from.dot(across_) / kBin);
      if (behind < 0 || behind > length_ || std::abs(bin) > kBins) continue;
      samples_.push_back({behind, static_cast<int>(bin), smoothed_db(samples, n, k, step)});
      if (std::abs(bin) <= kOnShaft) seen_ = std::max(seen_, behind);
    }
  }

  /// m of the shaft that the lines show.
  [[nodiscard]] double seen() const noexcept { return seen_; }

  /// dB, of all of it and of its last bit alone the lesser; empty where too little is beside it.
  [[nodiscard]] std::optional<double> contrast() const {
    const auto whole = contrast_to(length_);
    const auto end = contrast_to(std::min(kTipEnd, length_));
    if (!whole || !end) return std::nullopt;
    return std::min(*whole, *end) - kChoice;
  }

 private:
  struct Sample {
    double behind = 0;
    int bin = 0;
    double db = 0;
  };

  [[nodiscard]] std::optional<double> contrast_to(double length) const {
    std::array<double, 2 * kBins + 1> sum{};
    std::array<int, 2 * kBins + 1> count{};
    double brightest = 10 * std::log10(kLeastPower);
    for (const Sample& sample : samples_) brightest = std::max(brightest, sample.db);
    for (const Sample& sample : samples_) {
      if (sample.behind > length) continue;
      const auto at = static_cast<std::size_t>(sample.bin + kBins);
      sum.at(at) += std::max(sample.db, brightest - kShownRange);
      ++count.at(at);
    }
    std::optional<double> on;
    std::vector<double> beside;
    for (int bin = -kBins; bin <= kBins; ++bin) {
      const auto at = static_cast<std::size_t>(bin + kBins);
      if (count.at(at) == 0) continue;
      const double mean = sum.at(at) / count.at(at);
      if (std::abs(bin) <= kOnShaft) on = on ? std::max(*on, mean) : mean;
      if (std::abs(bin) >= kBeside) beside.push_back(mean);
    }
    if (!on || beside.size() < kFewest) return std::nullopt;
    return *on - median_of(beside);
  }

  Vec3 tip_;
  Vec3 back_;
  Vec3 across_;
  double length_;
  double seen_ = 0;
  std::vector<Sample> samples_;
};

template <class Taker>
void add_all(const Frame& frame, const Transducer& transducer, Taker& taker) {
  for (int i = 0; i < frame.n_lines; ++i)
    taker.add(scanline(transducer, i),
              frame.envelope.data() + static_cast<std::ptrdiff_t>(i) * frame.n_samples,
              frame.n_samples, frame.sample_depth);
}

}  // namespace

std::optional<double> needle_contrast(const FrameInput& input, const Frame& frame,
                                      const Transducer& transducer) {
  if (!frame.tip_shown) return std::nullopt;
  const double left = -0.5 * frame.pixel * frame.width;
  const double top = std::min(0.0, scanline(transducer, 0).origin.z());
  const Vec3 tip(left + (frame.tip_shown->x + 0.5) * frame.pixel, 0,
                 top + (frame.tip_shown->y + 0.5) * frame.pixel);
  const Vec3 axis = (to_pose(input.X_JP).inverse() * to_pose(input.X_JN)).linear().col(2);
  const Vec3 flat(axis.x(), 0, axis.z());
  const double slope = std::abs(axis.y());
  const double length =
      slope * kShaftEnd > kAside * flat.norm() ? kAside * flat.norm() / slope : kShaftEnd;
  if (length >= kLeastEnd) {
    ShaftEnd end(tip, -flat.normalized(), length);
    add_all(frame, transducer, end);
    if (end.seen() >= kLeastEnd)
      if (const auto contrast = end.contrast()) return contrast;
  }
  Around around(tip);
  add_all(frame, transducer, around);
  return around.contrast();
}

}  // namespace artus
