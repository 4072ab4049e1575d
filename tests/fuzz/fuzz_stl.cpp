// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "tests/fuzz/fuzz_surface.h"

/// Both forms of STL, and the choice of the format by content.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = artus::as_text(data, size);
  artus::check_promises(artus::parse_stl_binary(bytes, "fuzz.stl"), size);
  artus::check_promises(artus::parse_stl_ascii(bytes, "fuzz.stl"), size);
  artus::check_promises(artus::parse_surface(bytes, "fuzz.stl", 1e-3), size);
  return 0;
}
