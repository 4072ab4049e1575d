// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/viewer/cine_loop.h"

namespace artus {

void CineLoop::add(const ImageSnapshot& image, double time) {
  frames_.push_back({image, time});
  bytes_ += image.grey.size() + image.motion.size();
  while (frames_.size() > 1 && (time - frames_.front().time > kSeconds || bytes_ > kMostBytes)) {
    bytes_ -= frames_.front().image.grey.size() + frames_.front().image.motion.size();
    frames_.pop_front();
  }
}

}  // namespace artus
