// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>

#include "artus/session/recording.h"

namespace {

/// A sound head before the bytes: random ones hardly ever get past its digest.
const std::string& head() {
  static const std::string kHead = [] {
    artus::RecordingHead known;
    known.params.device = *artus::find_device("touch");
    return artus::to_line(known) + "\n";
  }();
  return kHead;
}

void check(const std::string& bytes) {
  std::istringstream in(bytes);
  const auto recording = artus::read_recording(in, "fuzz.rec");
  if (!recording) {
    if (recording.error().message.empty()) std::abort();
    return;
  }
  if (!artus::validate(recording->head.params)) std::abort();
  for (const artus::TickRecord& tick : recording->ticks) {
    const artus::DeviceSample& device = tick.input.device;
    if (!artus::is_pose(device.X_WN) || !artus::is_pose(device.X_WP)) std::abort();
    if (device.has_needle > 1 || device.has_probe > 1) std::abort();
  }
}

}  // namespace

/// A recording: whole and sound, or a refusal with a message. The bytes alone, and after a head.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  check(bytes);
  check(head() + bytes);
  return 0;
}
