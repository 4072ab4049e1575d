// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/line_file.h"

#include "artus/detail/dataset/npz_file.h"
#include "artus/detail/echo/display/rf_lines.h"
#ifdef ARTUS_HAS_HDF5
#include "artus/detail/exchange/uff_file.h"
#endif

namespace artus {

Result<LineFile> line_file_of(const std::string& ending, const std::string& flag) {
  if (ending == "npz")
    return LineFile{ending, [](const RfLines& lines) {
                      return npz_bytes(arrays_of(lines));
                    }};
  if (ending == "uff" || ending == "h5" || ending == "hdf5") {
#ifdef ARTUS_HAS_HDF5
    return LineFile{ending, [](const RfLines& lines) {
                      return uff_bytes(lines);
                    }};
#else
    return fail(ErrorCode::unsupported, "this artus was built without HDF5; take .npz", flag);
#endif
  }
  return fail(
      ErrorCode::unsupported,
      "lines before the envelope are written as .npz, .uff, .h5 or .hdf5, not '" + ending + "'",
      flag);
}

Result<LineFile> line_file_of(const std::filesystem::path& file, const std::string& flag) {
  const std::string ending = file.extension().string();
  return line_file_of(ending.empty() ? ending : ending.substr(1), flag);
}

}  // namespace artus
