// SPDX-License-Identifier: AGPL-3.0-or-later
#include "core/text_file.h"

#include <fstream>
#include <system_error>

namespace artus {

Result<void> write_text(const std::filesystem::path& file, std::string_view text) {
  std::error_code ignored;  // a folder that cannot be made shows when the file is opened
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out)
    return fail(ErrorCode::unreadable, "cannot be written; check folder, rights and free space",
                file.string());
  return {};
}

}  // namespace artus
