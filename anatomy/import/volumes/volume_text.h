// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/anatomy/import/volumes/image_volume.h"

namespace artus {

/// Keys in lower case and their texts, of a header that is lines of text.
using HeaderText = std::map<std::string, std::string, std::less<>>;

/// Takes the first line off `bytes`, without spaces around it. nullopt: there is no further line.
[[nodiscard]] std::optional<std::string_view> take_line(std::string_view& bytes);

/// What stands before and after the first `separator` of a line, without spaces around.
/// Errors: malformed, naming `where` and the form that a line of such a header has.
[[nodiscard]] Result<std::pair<std::string_view, std::string_view>> key_and_value(
    std::string_view line, char separator, const char* form, const std::string& where);

/// How a format's words name types of samples.
using SampleTypeNames = std::span<const std::pair<std::string_view, SampleType>>;

/// The type that a word of a header names. Errors: unsupported, naming `where`.
[[nodiscard]] Result<SampleType> sample_type_of(std::string_view word, SampleTypeNames known,
                                                const std::string& where);

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
