// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/core/result.h"

namespace artus {

const char* to_string(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::not_found:
      return "not_found";
    case ErrorCode::unreadable:
      return "unreadable";
    case ErrorCode::malformed:
      return "malformed";
    case ErrorCode::invalid:
      return "invalid";
    case ErrorCode::unsupported:
      return "unsupported";
    case ErrorCode::corrupt:
      return "corrupt";
    case ErrorCode::defective:
      return "defective";
    case ErrorCode::failed:
      return "failed";
  }
  return "failed";
}

}  // namespace artus
