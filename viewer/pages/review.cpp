// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/pages/review.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "artus/detail/core/units.h"
#include "artus/detail/viewer/input/body_contact.h"

namespace artus {

const ReviewMoment& ReviewFilm::at(double time) const noexcept {
  const auto after = std::upper_bound(moments.begin(), moments.end(), time,
                                      [](double t, const ReviewMoment& m) { return t < m.time; });
  return after == moments.begin() ? moments.front() : *(after - 1);
}

double ReviewFilm::contact() const noexcept {
  const auto in = std::find_if(moments.begin(), moments.end(),
                               [](const ReviewMoment& m) { return m.state.inserted != 0; });
  return in == moments.end() ? 0 : in->time;
}

ReviewCursor::ReviewCursor(double length, std::vector<double> faults)
    : length_(length), faults_(std::move(faults)) {}

void ReviewCursor::play(bool playing) noexcept {
  playing_ = playing;
  if (playing_ && time_ >= length_) time_ = 0;
}

void ReviewCursor::go_to(double time) noexcept {
  time_ = std::clamp(time, 0.0, length_);
}

void ReviewCursor::pass(double seconds) noexcept {
  if (!playing_) return;
  go_to(time_ + seconds);
  if (time_ >= length_) playing_ = false;
}

void ReviewCursor::later_fault() noexcept {
  constexpr double kPast = 1e-6;  // s
  double next = length_ + 1;
  for (const double fault : faults_)
    if (fault > time_ + kPast) next = std::min(next, fault);
  if (next <= length_) go_to(next);
}

void ReviewCursor::earlier_fault() noexcept {
  constexpr double kBefore = 1e-6;  // s
  double before = -1;
  for (const double fault : faults_)
    if (fault < time_ - kBefore) before = std::max(before, fault);
  if (before >= 0) go_to(before);
}

std::optional<std::size_t> ReviewCursor::near() const noexcept {
  constexpr double kNear = 2;  // s
  std::optional<std::size_t> nearest;
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    const double off = std::abs(faults_[i] - time_);
    if (off <= kNear && (!nearest || off < std::abs(faults_[*nearest] - time_))) nearest = i;
  }
  return nearest;
}

std::optional<MendedProbe> mend_probe(const Scene& scene, const Pose& X_JP, const Pose& X_JN) {
  constexpr double kMaxTurn = 45 * kDegree;
  constexpr double kMinShare = 0.17;  // of the shaft along the face: steeper than 80 degrees
  Vec3 shaft_P = X_JP.linear().transpose() * X_JN.linear().col(2);
  if (shaft_P.x() < 0) shaft_P = -shaft_P;
  if (std::hypot(shaft_P.x(), shaft_P.y()) < kMinShare) return std::nullopt;
  MendedProbe mended;
  mended.turned = std::atan2(shaft_P.y(), shaft_P.x());
  if (std::abs(mended.turned) > kMaxTurn) return std::nullopt;
  Pose X_JM = X_JP;
  X_JM.rotate(Eigen::AngleAxisd(mended.turned, Vec3::UnitZ()));
  mended.moved = (X_JM.inverse() * X_JN.translation()).y();
  X_JM.translate(Vec3(0, mended.moved, 0));
  if (const auto gap = BodyContact{&scene, Pose::Identity()}.find_gap(X_JM))
    X_JM.translate(Vec3(0, 0, *gap));
  mended.X_JP = X_JM;
  return mended;
}

}  // namespace artus
