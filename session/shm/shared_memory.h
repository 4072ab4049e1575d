// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "artus/core/result.h"
#include "artus/detail/core/check.h"
#include "artus/detail/session/shm/seqlock.h"
#include "artus/session/client/artus_shm.h"

namespace artus {

/// What a segment must look like before anything in it is believed.
struct SegmentLayout {
  const char* name = "";  ///< POS, POS-PROBE, FORCE or IMAGE
  std::uint64_t magic = 0;
  std::uint32_t payload_size = 0;  ///< bytes after the header
  [[nodiscard]] std::uint32_t size() const noexcept {
    return static_cast<std::uint32_t>(sizeof(artus_shm_header)) + payload_size;
  }
};

inline constexpr SegmentLayout kPosLayout{"POS", ARTUS_SHM_MAGIC_POS, sizeof(artus_shm_pos)};
/// Of a program that holds the probe alone.
inline constexpr SegmentLayout kProbePosLayout{"POS-PROBE", ARTUS_SHM_MAGIC_POS,
                                               sizeof(artus_shm_pos)};
inline constexpr SegmentLayout kForceLayout{"FORCE", ARTUS_SHM_MAGIC_FORCE,
                                            sizeof(artus_shm_force)};
inline constexpr SegmentLayout kImageLayout{"IMAGE", ARTUS_SHM_MAGIC_IMAGE,
                                            sizeof(artus_shm_image)};

/// All that artus and its device programs share.
inline constexpr std::array<SegmentLayout, 4> kAllLayouts{kPosLayout, kProbePosLayout, kForceLayout,
                                                          kImageLayout};

/// What one process may do with a segment.
enum class SegmentAccess {
  owner_reads,   ///< makes it when it is missing or damaged; another process writes
  owner_writes,  ///< the same, and this process is its one writer
  observer       ///< must exist and be sound; looks only
};

/// One named piece of memory shared with other processes of this user, mapped. Its head and size
/// are checked before it is used; a damaged left-over is replaced by an owner and refused for an
/// observer. The writer holds a lock that the system releases when the process dies, so nothing
/// survives a crash that would hinder the next start. A segment that another program truncates
/// becomes memory of this process alone (docs/decisions): no access to it ever faults.
class SharedSegment {
 public:
  /// `prefix` stands before the layout's name. Errors: not_found and corrupt (observer), invalid
  /// (the prefix, others may touch it, or it has another writer), unreadable (the system refuses).
  [[nodiscard]] static Result<SharedSegment> open(const std::string& prefix,
                                                  const SegmentLayout& layout,
                                                  SegmentAccess access);
  /// The same name once more, after find_trouble(), in the place of this one. Errors: as of open.
  [[nodiscard]] Result<SharedSegment> open_again() const;
  /// Removes the name, if it still leads here; programs that have it mapped keep their memory.
  void remove_own() const noexcept;
  /// Removes the name, whatever it leads to.
  static void remove(const std::string& prefix, const SegmentLayout& layout) noexcept;

  ~SharedSegment();
  SharedSegment(SharedSegment&&) noexcept;
  SharedSegment& operator=(SharedSegment&&) noexcept;
  SharedSegment(const SharedSegment&) = delete;
  SharedSegment& operator=(const SharedSegment&) = delete;

  [[nodiscard]] std::uint64_t heartbeat() const noexcept;
  /// The process that writes, and when it opened the segment (monotonic clock, ns); 0: unknown.
  [[nodiscard]] ARTUS_REALTIME std::uint64_t writer_pid() const noexcept;
  [[nodiscard]] ARTUS_REALTIME std::uint64_t opened_ns() const noexcept;
  ARTUS_REALTIME void beat() noexcept;
  /// Address of the sequence word, where the Seqlock of the payload lies.
  [[nodiscard]] void* seqlock() const noexcept;
  /// Why other programs no longer meet this one here: the name has gone or leads to other memory,
  /// its size or head was changed. Null: all well. Makes system calls: not for a tick.
  [[nodiscard]] const char* find_trouble() const noexcept;

 private:
  struct Impl;
  explicit SharedSegment(std::unique_ptr<Impl> impl) noexcept;
  std::unique_ptr<Impl> impl_;
};

/// A segment with its payload's type.
template <class Payload>
class SharedChannel {
 public:
  static_assert(sizeof(Seqlock<Payload>) == 8 + sizeof(Payload), "payload must be whole words");

  [[nodiscard]] static Result<SharedChannel> open(const std::string& prefix,
                                                  const SegmentLayout& layout,
                                                  SegmentAccess access) {
    Result<SharedSegment> segment = SharedSegment::open(prefix, layout, access);
    ARTUS_TRY(segment);
    return SharedChannel(std::move(*segment));
  }

  [[nodiscard]] Result<SharedChannel> open_again() const {
    Result<SharedSegment> segment = segment_.open_again();
    ARTUS_TRY(segment);
    return SharedChannel(std::move(*segment));
  }

  /// Publishes and beats. One writer.
  ARTUS_REALTIME void write(const Payload& payload) noexcept {
    lock().store(payload);
    segment_.beat();
  }
  /// The same for the first `size` bytes of the payload.
  ARTUS_REALTIME void write_prefix(const Payload& payload, std::size_t size) noexcept {
    lock().store_prefix(payload, size);
    segment_.beat();
  }
  /// False when nothing whole could be read; bounded.
  [[nodiscard]] ARTUS_REALTIME bool read(Payload& payload, int tries = 64) const noexcept {
    return lock().load(payload, tries);
  }
  [[nodiscard]] const SharedSegment& segment() const noexcept { return segment_; }

 private:
  explicit SharedChannel(SharedSegment segment) noexcept : segment_(std::move(segment)) {}
  [[nodiscard]] Seqlock<Payload>& lock() const noexcept {
    return *static_cast<Seqlock<Payload>*>(segment_.seqlock());
  }
  SharedSegment segment_;
};

}  // namespace artus
