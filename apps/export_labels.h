// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>

#include "artus/detail/apps/options/command.h"

namespace artus {

/// The flags of `artus export --labels`.
struct LabelExportOptions {
  std::filesystem::path file;   ///< empty: no label map is asked for
  std::filesystem::path names;  ///< of its names; empty: none
  std::string spacing = "0.4,0.4,0.7";
  std::string axes = "LPS";
  std::string turn = "0,0,0";
};
void add_label_export_options(Command* command, LabelExportOptions& options);

/// Writes a joint's regions as a label map, and says what is in it. Errors are printed.
[[nodiscard]] ExitCode export_labels(const LabelExportOptions& options, const JointOptions& joint,
                                     bool json);

}  // namespace artus
