// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/display/compound.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/check.h"

namespace artus {

CompoundView::CompoundView(const Transducer& transducer, const ImageSettings& settings,
                           double offset)
    : transducer_(transducer) {
  ARTUS_REQUIRE(transducer.radius == 0, "only a linear probe can be compounded");
  transducer_.steering += offset;
  const double sample_depth = settings.depth / settings.n_samples;
  for (int i = 0; i < settings.n_samples; ++i) {
    const double along = i * sample_depth;
    const double x = along * std::sin(transducer.steering);
    const double z = along * std::cos(transducer.steering);
    Place place;
    place.line = static_cast<float>((x - z * std::tan(transducer_.steering)) / transducer.pitch());
    place.sample = static_cast<float>(z / std::cos(transducer_.steering) / sample_depth);
    places_.push_back(place);
  }
}

void CompoundView::add(std::span<const float> envelope, int l, std::span<float> sum,
                       std::span<float> weight) const noexcept {
  const std::size_t n = places_.size();
  const auto last_line = static_cast<float>(transducer_.n_lines - 1);
  const auto last_sample = static_cast<float>(n - 1);
  for (std::size_t i = 0; i < n; ++i) {
    const float line = static_cast<float>(l) + places_[i].line;
    const float sample = places_[i].sample;
    if (!(line >= 0) || line > last_line || sample >= last_sample) continue;
    const auto k = static_cast<std::size_t>(line);
    const auto j = static_cast<std::size_t>(sample);
    const float t = line - static_cast<float>(k);
    const float u = sample - static_cast<float>(j);
    const float* a = envelope.data() + k * n + j;
    const float* b = t > 0 ? a + n : a;
    const float near = a[0] + u * (a[1] - a[0]);
    const float far = b[0] + u * (b[1] - b[0]);
    sum[i] += near + t * (far - near);
    weight[i] += 1;
  }
}

CompoundMean::CompoundMean(const Transducer& transducer, const ImageSettings& settings)
    : n_samples_(static_cast<std::size_t>(settings.n_samples)), n_lines_(transducer.n_lines) {
  const int n = settings.compound_angles;
  if (n == 1) return;
  for (int k = 0; k < n; ++k) {
    const double offset = settings.compound_spread * (static_cast<double>(k) / (n - 1) - 0.5);
    if (2 * k + 1 != n) views_.emplace_back(transducer, settings, offset);
  }
  views_.emplace_back(transducer, settings, 0);
  sum_.resize(static_cast<std::size_t>(n_lines_) * n_samples_);
  weight_.resize(sum_.size());
}

void CompoundMean::clear() noexcept {
  std::fill(sum_.begin(), sum_.end(), 0.0F);
  std::fill(weight_.begin(), weight_.end(), 0.0F);
}

void CompoundMean::add(const CompoundView& view, std::span<const float> envelope,
                       BlockWorkers& workers) {
  workers.for_blocks(n_lines_, [&](int, int first, int last) {
    for (int l = first; l < last; ++l) {
      const std::size_t begin = static_cast<std::size_t>(l) * n_samples_;
      view.add(envelope, l, std::span(sum_).subspan(begin, n_samples_),
               std::span(weight_).subspan(begin, n_samples_));
    }
  });
}

void CompoundMean::write(std::span<float> envelope) const noexcept {
  for (std::size_t i = 0; i < sum_.size(); ++i) {
    envelope[i] = weight_[i] > 0 ? sum_[i] / weight_[i] : 0.0F;
  }
}

}  // namespace artus
