// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>

#include "artus/core/result.h"
#include "artus/detail/trainer/hands_program.h"
#include "artus/detail/viewer/pages/page.h"

namespace artus {

/// Which program sees the hands, by which camera and kit.
struct HandsSetup {
  std::filesystem::path program;  ///< artus-hands
  std::string source;             ///< webcam, a file or a folder
  std::filesystem::path kit;      ///< hands.toml
  std::filesystem::path prints;   ///< folder of sheets and parts
};

/// What can be chosen on the first page, in its order.
enum class HandsChoice { go, print, camera, markers, tip, face, leave };

/// The first page: print, glue, calibrate, go; what is missing is marked first. It says what these
/// hands cannot: there is no force, and by how much they are off.
[[nodiscard]] Page make_hands_page(const HandsState& state, const HandsSetup& setup,
                                   Language language);

/// What a choice runs artus-hands with. Requires: not go, not leave.
[[nodiscard]] std::vector<std::string> hands_arguments(HandsChoice choice, const HandsSetup& setup);

/// Shows the page, and what is chosen on it while it is done, until someone goes on (true) or
/// leaves. Errors: those of the pages; failed (artus-hands does not say what was measured).
[[nodiscard]] Result<bool> lead_to_hands(PageWindow& pages, const HandsSetup& setup,
                                         Language language);

}  // namespace artus
