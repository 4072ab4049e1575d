// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/session/input_device.h"
#include "artus/session/shared_memory.h"

namespace artus {

/// The newest believable sample of POS: values are checked, silence and age are judged by this
/// side's own clock, so nothing a peer writes (garbage, a frozen or future time) keeps it alive.
class PosReader {
 public:
  [[nodiscard]] ARTUS_REALTIME DeviceSample accept(bool whole, const artus_shm_pos& pos,
                                                   std::int64_t now_ns) noexcept;

 private:
  DeviceSample last_;
  std::int64_t heard_ns_ = 0;  // when a new sample was last seen
  std::uint64_t number_ = 0;
  bool started_ = false;
};

/// A device program in another process, through POS and FORCE.
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
  [[nodiscard]] std::string_view name() const noexcept override { return "shared memory"; }

 private:
  SharedMemoryDevice(std::string prefix, SharedChannel<artus_shm_pos> pos,
                     SharedChannel<artus_shm_force> force, std::vector<std::string> layer_names);

  std::string prefix_;
  SharedChannel<artus_shm_pos> pos_;
  SharedChannel<artus_shm_force> force_;
  std::vector<std::string> layer_names_;
  PosReader reader_;
};

}  // namespace artus
