// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/anatomy/joint_file.h"
#include "tests/fuzz/fuzz_surface.h"

/// The joint file and the tissue library: a valid object or a refusal with a message.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto text = artus::as_text(data, size);
  const auto joint = artus::parse_joint(text, "/nonexistent");
  if (!joint && joint.error().message.empty()) std::abort();
  const auto tissues = artus::parse_tissues(text, "fuzz.toml");
  if (!tissues && tissues.error().message.empty()) std::abort();
  return 0;
}
