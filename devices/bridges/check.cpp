// SPDX-License-Identifier: AGPL-3.0-or-later
#include "check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace artus::bridge {
namespace {

constexpr double kRest = 2;     // s
constexpr double kPush = 0.5;   // s
constexpr double kPause = 0.5;  // s
constexpr double kForce = 0.3;  // N
constexpr const char* kNames[6] = {"+x", "-x", "+y", "-y", "+z", "-z"};

/// What the check does at a time, and what it saw.
class Check {
 public:
  explicit Check(std::atomic<bool>& done) : done_(done) {}

  Triple tick(const Reading& reading) {
    const double now = 1e-9 * static_cast<double>(artus_shm_now_ns());
    if (ticks_ == 0) start_ = last_ = now;
    ++ticks_;
    longest_ = std::max(longest_, now - last_);
    last_ = now;
    sound_ += reading.sound ? 1U : 0U;
    buttons_ |= reading.buttons;
    if (!reading.sound) return {};
    reading_ = reading;
    const double time = now - start_ - kRest;
    if (time < 0) return {};
    const auto push = static_cast<std::size_t>(time / (kPush + kPause));
    if (push >= 6) {
      done_ = true;
      return {};
    }
    const double within = time - static_cast<double>(push) * (kPush + kPause);
    if (push != pushed_) {
      from_ = reading.position;
      pushed_ = push;
    }
    if (within > kPush) return {};
    for (std::size_t i = 0; i < 3; ++i) went_[push][i] = reading.position[i] - from_[i];
    Triple force{};
    const double ramp = std::min({1.0, within / 0.1, (kPush - within) / 0.1});
    force[push / 2] = (push % 2 == 0 ? kForce : -kForce) * ramp;
    return force;
  }

  void print() const {
    const double seconds = std::max(last_ - start_, 1e-3);
    std::printf("%llu ticks, %.0f a second, the longest step %.2f ms; %llu of them sound\n",
                static_cast<unsigned long long>(ticks_), static_cast<double>(ticks_) / seconds,
                1e3 * longest_, static_cast<unsigned long long>(sound_));
    std::printf("at %.1f, %.1f, %.1f mm; %s; buttons that were pressed: %u\n",
                1e3 * reading_.position[0], 1e3 * reading_.position[1], 1e3 * reading_.position[2],
                reading_.has_wrist ? "with a wrist" : "without a wrist", buttons_);
    for (std::size_t i = 0; i < 6; ++i)
      std::printf("0.3 N along the device's %s: it went %.1f, %.1f, %.1f mm\n", kNames[i],
                  1e3 * went_[i][0], 1e3 * went_[i][1], 1e3 * went_[i][2]);
    std::printf(
        "A device that is held loosely goes where it is pushed. Send these lines, its model "
        "and the maker's version to the project.\n");
  }

 private:
  std::atomic<bool>& done_;
  Reading reading_;
  Triple from_{};
  std::array<Triple, 6> went_{};
  std::size_t pushed_ = 6;
  std::uint64_t ticks_ = 0;
  std::uint64_t sound_ = 0;
  std::uint32_t buttons_ = 0;
  double start_ = 0;
  double last_ = 0;
  double longest_ = 0;
};

}  // namespace

int run_check(Driver& driver, const Options& options) {
  int failed = 0;
  for (const ChosenDevice& chosen : options.devices) {
    std::string why;
    const auto device = driver.open(chosen.name, why);
    if (device) {
      std::atomic<bool> done{false};
      Check check(done);
      why = device->run([&](const Reading& reading) { return check.tick(reading); }, done);
      check.print();
    }
    if (why.empty()) continue;
    std::fprintf(stderr, "%s '%s': %s\n", driver.maker(), chosen.name.c_str(), why.c_str());
    failed = 1;
  }
  return failed;
}

}  // namespace artus::bridge
