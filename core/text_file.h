// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "artus/core/result.h"

namespace artus {

/// Writes `text` as the whole content of `file`; folders on the way are made. Errors: unreadable
/// (no permission, disk full), naming the file.
[[nodiscard]] Result<void> write_text(const std::filesystem::path& file, std::string_view text);

/// A folder that is to be written into, made with those on the way. Errors: unreadable (a file or a
/// device is in its place, no permission), naming it.
[[nodiscard]] Result<void> make_folder(const std::filesystem::path& folder);

/// The whole of a regular file. Errors: not_found, unreadable (a folder, a pipe, no permission).
[[nodiscard]] Result<std::string> read_bytes(const std::filesystem::path& file);

}  // namespace artus
