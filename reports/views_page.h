// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "artus/detail/echo/display/seen_structures.h"
#include "artus/detail/viewer/words/translation.h"

namespace artus {

/// A standard view with its picture and what that shows of its structures.
struct ShownView {
  StandardView view;
  cv::Mat picture;
  std::vector<SeenStructure> seen;
};

/// What is not so of a structure, in a sentence; empty: nothing.
[[nodiscard]] std::string to_sentence(SightFault fault, Language language);

/// All views of a joint on one page, each with its name, its source, what the source describes and
/// what the picture has of it.
[[nodiscard]] std::string make_views_page(const std::string& joint,
                                          const std::vector<ShownView>& views, Language language);

}  // namespace artus
