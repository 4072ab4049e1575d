// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "artus/detail/session/shm/reopening_channel.h"
#include "artus/simulation/input_device.h"

namespace artus {

/// The newest believable sample of POS: values are checked, silence and age are judged by this
/// side's own clock, so nothing a peer writes (garbage, a frozen or future time) keeps it alive.
/// Samples are counted upwards: a smaller number is refused, unless another writer opened POS, or
/// nothing was taken for as long as makes a peer lost and the numbers rise: then they count anew,
/// and a number that one flipped bit made huge deafens nobody.
class PosReader {
 public:
  /// `allowed`: the bits of artus_shm_pos.present that may stand in this segment.
  explicit PosReader(std::uint32_t allowed = ~0U) noexcept : allowed_(allowed) {}

  /// `writer`: any number that changes when another writer opens POS; read after `pos`.
  [[nodiscard]] ARTUS_REALTIME DeviceSample accept(bool whole, const artus_shm_pos& pos,
                                                   std::int64_t now_ns,
                                                   std::uint64_t writer = 0) noexcept;

 private:
  void take(const artus_shm_pos& pos, std::int64_t now_ns) noexcept;

  DeviceSample last_;
  std::uint32_t allowed_;
  std::int64_t heard_ns_ = 0;    // when a new sample was last taken
  std::int64_t changed_ns_ = 0;  // when POS last changed
  std::uint64_t writer_ = 0;
  std::uint64_t seen_ = 0;    // number that POS last had
  std::uint64_t number_ = 0;  // of the last sample that was sound
  bool started_ = false;
};

/// What two programs say together: needle and plunger of `needle` (of POS), the probe of `probe`
/// (of POS-PROBE) while that is alive, else of `needle`. Alive when one of them is.
[[nodiscard]] ARTUS_REALTIME DeviceSample join_hands(const DeviceSample& needle,
                                                     const DeviceSample& probe) noexcept;

/// One device program in another process, through POS and FORCE, or two: one for the needle and one
/// for the probe, through POS-PROBE. When somebody removes or truncates the segments
/// repair_connection() makes them anew.
class SharedMemoryDevice final : public InputDevice {
 public:
  /// `layer_names` by region. Errors: as SharedSegment::open.
  [[nodiscard]] static Result<std::unique_ptr<SharedMemoryDevice>> open(
      const std::string& prefix, std::vector<std::string> layer_names);
  /// Says "stopped" with zero force and removes the names.
  ~SharedMemoryDevice() override;
  SharedMemoryDevice(const SharedMemoryDevice&) = delete;
  SharedMemoryDevice& operator=(const SharedMemoryDevice&) = delete;

  [[nodiscard]] ARTUS_REALTIME DeviceSample read(std::int64_t now_ns) noexcept override;
  ARTUS_REALTIME void write(const DeviceFeedback& feedback) noexcept override;
  [[nodiscard]] std::vector<std::string> repair_connection() override;
  [[nodiscard]] std::string_view name() const noexcept override { return "shared memory"; }

 private:
  using PosChannel = ReopeningChannel<artus_shm_pos>;
  using ForceChannel = ReopeningChannel<artus_shm_force>;
  SharedMemoryDevice(std::unique_ptr<PosChannel> pos, std::unique_ptr<PosChannel> probe_pos,
                     std::unique_ptr<ForceChannel> force, std::vector<std::string> layer_names);

  void answer_each(artus_shm_force& out) const noexcept;

  std::unique_ptr<PosChannel> pos_;
  std::unique_ptr<PosChannel> probe_pos_;
  std::unique_ptr<ForceChannel> force_;
  std::vector<std::string> layer_names_;
  PosReader reader_;
  PosReader probe_reader_;
  DeviceSample needle_;  // as last read from POS
  DeviceSample probe_;   // as last read from POS-PROBE
};

}  // namespace artus
