// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "artus/detail/session/shm/shared_memory.h"

namespace artus {

/// A shared segment that is made anew when another program spoils it. One thread uses it (the tick,
/// which never waits), another looks after it a few times a second.
template <class Payload>
class ReopeningChannel {
 public:
  using Channel = SharedChannel<Payload>;

  /// Errors: as SharedSegment::open.
  [[nodiscard]] static Result<std::unique_ptr<ReopeningChannel>> open(const std::string& prefix,
                                                                      const SegmentLayout& layout,
                                                                      SegmentAccess access) {
    Result<Channel> channel = Channel::open(prefix, layout, access);
    ARTUS_TRY(channel);
    return std::unique_ptr<ReopeningChannel>(
        new ReopeningChannel(prefix + layout.name, std::move(*channel)));
  }

  /// The newest mapping. For the one thread that uses the segment; valid until its next call.
  [[nodiscard]] ARTUS_REALTIME Channel& use() noexcept {
    Channel* newest = newest_.load(std::memory_order_acquire);
    used_.store(newest, std::memory_order_release);
    return *newest;
  }

  /// Looks whether other programs still meet this one here and makes the segment anew if not; says
  /// what it found and did, once. For the thread that looks after it.
  [[nodiscard]] std::optional<std::string> repair_connection() {
    if (former_ && used_.load(std::memory_order_acquire) != channel_.get()) return std::nullopt;
    former_.reset();
    const char* trouble = channel_->segment().find_trouble();
    if (trouble == nullptr) return std::nullopt;
    Result<Channel> fresh = channel_->open_again();
    std::string said = "shared memory " + name_ + " " + trouble +
                       (fresh ? "; recreated" : "; " + fresh.error().message);
    if (fresh) {
      former_ = std::exchange(channel_, std::make_unique<Channel>(std::move(*fresh)));
      newest_.store(channel_.get(), std::memory_order_release);
    }
    if (!fresh && said == said_) return std::nullopt;
    said_ = fresh ? std::string() : said;
    return said;
  }

  /// Removes the name if it still leads here; when nobody uses the segment any more.
  void remove_own() const noexcept { channel_->segment().remove_own(); }

 private:
  ReopeningChannel(std::string name, Channel channel)
      : name_(std::move(name)),
        channel_(std::make_unique<Channel>(std::move(channel))),
        newest_(channel_.get()),
        used_(channel_.get()) {}

  std::string name_;
  std::unique_ptr<Channel> channel_;
  std::unique_ptr<Channel> former_;  // until the user has let go of it
  std::atomic<Channel*> newest_;
  std::atomic<Channel*> used_;
  std::string said_;
};

}  // namespace artus
