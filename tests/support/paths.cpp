// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/support/paths.h"

namespace artus::test {

std::filesystem::path source_dir() {
  return ARTUS_SOURCE_DIR;
}

std::filesystem::path test_joints() {
  return ARTUS_TEST_JOINTS;
}

}  // namespace artus::test
