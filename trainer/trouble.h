// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>

#include "artus/detail/trainer/desk.h"
#include "artus/detail/viewer/pages/page.h"

namespace artus {

/// What can be done about a failure, in the page's order.
enum class AfterTrouble { again, other, leave };

/// A failure as a page of the window: what happened, that nothing is lost (`safe`, an English
/// sentence of the catalogue), and what to do. `may_go_on`: other tasks may be chosen.
[[nodiscard]] Page make_trouble_page(const Error& error, const char* safe, bool may_go_on,
                                     Language language);

/// What to do about a failure, in English: the first step that a person can take.
[[nodiscard]] const char* remedy_of(const Error& error) noexcept;

/// Opens a file in the desktop's own program, and does not wait for it. Errors: not_found (the
/// file), failed (there is no desktop program that opens it).
[[nodiscard]] Result<void> open_file(const std::filesystem::path& file);

/// The records, asked for in the window until they open. Errors: those of TrainDesk::open, when
/// someone leaves.
[[nodiscard]] Result<TrainDesk> open_desk(Screen& screen, const PageOptions& pages,
                                          const std::filesystem::path& records,
                                          const std::filesystem::path& attempts);

}  // namespace artus
