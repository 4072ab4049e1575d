// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/fuzz/fuzz_surface.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  artus::check_promises(artus::parse_ply(artus::as_text(data, size), "fuzz.ply"), size);
  return 0;
}
