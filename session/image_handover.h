// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "artus/detail/simulation/imaged_body.h"
#include "artus/detail/simulation/records.h"

namespace artus {

/// A picture to be drawn.
struct ImageJob {
  FrameInput input;
  ImagedBody body;
  bool alive = false;  ///< the device was, when it told the poses
};

/// Hands images from the thread that makes the tissue's steps to the one that draws, one at a time
/// and none left out: whoever is ahead waits. Between two slow threads; never in a tick.
class ImageHandover {
 public:
  /// Waits until the one before is drawn. Then, or when it is over, returns.
  void put(ImageJob job) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return over_ || !job_; });
    if (!over_) job_ = std::move(job);
    changed_.notify_all();
  }
  /// The next one; null when it is over. It stays until done().
  [[nodiscard]] const ImageJob* take() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return over_ || job_; });
    return over_ ? nullptr : &*job_;
  }
  /// It is drawn. `failure`: why not; empty: it is.
  void done(std::string failure = {}) {
    const std::lock_guard<std::mutex> lock(mutex_);
    job_.reset();
    if (failure_.empty()) failure_ = std::move(failure);
    changed_.notify_all();
  }
  /// Waits until nothing is being drawn.
  void rest() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return over_ || !job_; });
  }
  /// What went wrong since the last question; empty: nothing.
  [[nodiscard]] std::string take_failure() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(failure_, {});
  }
  void end() {
    const std::lock_guard<std::mutex> lock(mutex_);
    over_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<ImageJob> job_;  // waits, or is being drawn
  std::string failure_;
  bool over_ = false;
};

}  // namespace artus
