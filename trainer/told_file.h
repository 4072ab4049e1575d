// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "artus/core/result.h"
#include "artus/detail/viewer/pages/page.h"
#include "artus/detail/viewer/window.h"

namespace artus {

/// What a window says, a JSON object a line whenever it says something else: for screen readers,
/// and for scripts that act as people do.
class ToldFile {
 public:
  /// Errors: unreadable (it cannot be written).
  [[nodiscard]] static Result<ToldFile> open(const std::filesystem::path& file);

  void tell(const Page& page);
  void tell(const WindowStatus& window);

 private:
  explicit ToldFile(std::ofstream out) : out_(std::move(out)) {}
  void write(const nlohmann::json& said);

  std::ofstream out_;
  std::string last_;
};

}  // namespace artus
