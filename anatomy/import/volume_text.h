// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/anatomy/import/image_volume.h"

namespace artus {

/// Keys in lower case and their texts, of a header that is lines of text.
using HeaderText = std::map<std::string, std::string, std::less<>>;

/// The text of a key; empty when it is not there.
[[nodiscard]] std::string text_of(const HeaderText& header, std::string_view key);

[[nodiscard]] std::string to_lower(std::string_view text);

/// All numbers of a text; brackets and commas count as spaces. nullopt when a word is no number.
[[nodiscard]] std::optional<std::vector<double>> numbers_of(std::string_view text);

/// Words parted by spaces.
[[nodiscard]] std::vector<std::string> words_of_line(std::string_view text);

/// A whole number from 1 to 2^31 - 1; 0 when it is none.
[[nodiscard]] std::size_t whole_of(double value) noexcept;

/// What of `data` is the volume's samples (raw or compressed), cut to size and turned round where
/// the file's byte order is big. Requires: volume.size, layers and type are set. Errors: corrupt
/// (too short, broken off).
[[nodiscard]] Result<void> take_samples(std::string_view data, bool compressed, bool big_endian,
                                        ImageVolume& volume, const std::string& name);

/// The sign of each axis of a space, as "left-posterior-superior", that leads to LPS. nullopt: a
/// space that says no directions of a body.
[[nodiscard]] std::optional<Vec3> signs_of_space(std::string_view space);

}  // namespace artus
