// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include "artus/core/result.h"

namespace artus {

/// What came out of a compressed stream.
struct Inflated {
  std::string bytes;
  bool ended = false;  ///< the stream's own end was met, and its checksum fits
};

/// Whether bytes begin as gzip.
[[nodiscard]] bool is_gzip(std::string_view bytes) noexcept;

/// Expands gzip (also of several members) or zlib data, `at_most` bytes of it; memory grows with
/// what comes out, not with `at_most`. A stream that ends early is not refused: `ended` says so.
/// Errors: corrupt (no such data, wrong checksum), naming `where`.
[[nodiscard]] Result<Inflated> inflate(std::string_view bytes, std::size_t at_most,
                                       const std::string& where);

/// Exactly `size` bytes of gzip or zlib data. Errors: corrupt when it holds less (with how much)
/// or more, or breaks off.
[[nodiscard]] Result<std::string> inflate_exactly(std::string_view bytes, std::size_t size,
                                                  const std::string& where);

/// Compresses as gzip, the same bytes each time.
[[nodiscard]] std::string deflate_gzip(std::string_view bytes);

}  // namespace artus
