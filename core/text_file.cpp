// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/text_file.h"

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

Result<void> make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    return fail(ErrorCode::unreadable, "no folder can be made here: " + error.message(),
                folder.string());
  return {};
}

Result<std::string> read_bytes(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    return fail(ErrorCode::not_found, "there is no such file", file.string());
  if (!std::filesystem::is_regular_file(status))
    return fail(ErrorCode::unreadable, "this is a folder or a device, not a file", file.string());
  const auto size = std::filesystem::file_size(file, error);
  std::ifstream in(file, std::ios::binary);
  if (error || !in)
    return fail(ErrorCode::unreadable, "the file cannot be opened; check its permissions",
                file.string());
  std::string bytes(size, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(in.gcount()) != size)
    return fail(ErrorCode::unreadable, "the file changed or failed while it was read",
                file.string());
  return bytes;
}

}  // namespace artus
