// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"

namespace artus {

/// Appends a file to an archive in the ustar format: the same bytes for the same members, since
/// nobody owns them and they have no time. Requires: a name of 1 to 100 bytes, below 8 GiB.
void append_member(std::string& archive, std::string_view name, std::string_view bytes);
/// Closes an archive: two empty blocks.
void finish_archive(std::string& archive);

struct TarMember {
  std::string_view name;
  std::string_view bytes;
};
/// The members of an archive, looking into it. Errors: corrupt (a header's sum, a size beyond the
/// end, no end).
[[nodiscard]] Result<std::vector<TarMember>> list_members(std::string_view archive);

/// Writes `bytes` so that after a crash, even of the machine, `file` is there whole or not at all:
/// another name, fsync, rename, fsync of the folder. Errors: unreadable.
[[nodiscard]] Result<void> write_durably(const std::filesystem::path& file, std::string_view bytes);

}  // namespace artus
