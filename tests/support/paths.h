// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>

namespace artus::test {

/// The root of the source tree.
[[nodiscard]] std::filesystem::path source_dir();
/// Where the fixture bundled_joints puts the compiled joints.
[[nodiscard]] std::filesystem::path test_joints();

}  // namespace artus::test
