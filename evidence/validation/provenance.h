// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

namespace artus {

/// Where a page of results comes from.
struct Provenance {
  std::string date;    ///< of today, UTC: 2026-11-26
  std::string commit;  ///< as git describes it; "unknown" when the program runs in no checkout
  std::string command;
  std::string processor;
  std::string compiler;
  std::string build_type;
};

/// That of this program, now. The commit is that of the checkout in which the program was built,
/// with "-dirty" when it has changes. Cost: a run of git.
[[nodiscard]] Provenance find_provenance(const std::string& command);

}  // namespace artus
