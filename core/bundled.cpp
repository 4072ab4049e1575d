// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/bundled.h"

#include <cstdlib>
#include <vector>

#include <dlfcn.h>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

namespace fs = std::filesystem;

/// The library that holds this code, such as the Python module; of a program, its name as it was
/// called, which need not be a path.
fs::path own_library() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&find_bundled), &info) == 0 || info.dli_fname == nullptr)
    return {};
  const fs::path file = info.dli_fname;
  std::error_code unknown;
  return file.is_absolute() ? fs::canonical(file, unknown) : fs::path{};
}

std::vector<fs::path> places() {
  std::vector<fs::path> all;
  // NOLINTNEXTLINE(concurrency-mt-unsafe): nothing in artus changes the environment
  if (const char* named = std::getenv("ARTUS_DATA"); named != nullptr && *named != '\0')
    all.emplace_back(named);
  std::error_code unknown;
  for (const fs::path& file : {own_library(), fs::read_symlink("/proc/self/exe", unknown)}) {
    for (fs::path folder = file.parent_path(); !folder.empty(); folder = folder.parent_path()) {
      all.push_back(folder / "share" / "artus");
      all.push_back(folder);
      if (folder == folder.root_path()) break;
    }
  }
  all.emplace_back();  // the current folder
  return all;
}

}  // namespace

fs::path find_bundled(const fs::path& relative) {
  ARTUS_REQUIRE(relative.is_relative() && !relative.empty(), "a path within what is bundled");
  std::error_code ignored;
  for (const fs::path& place : places())
    if (fs::exists(place / relative, ignored)) return place / relative;
  return {};
}

}  // namespace artus
