// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "artus/core/result.h"
#include "artus/detail/exchange/igtl/contents.h"
#include "artus/detail/exchange/igtl/message.h"

namespace artus {

/// What somebody asks by a COMMAND message.
struct RemoteCommand {
  std::string name;
  /// The attribute Value of the content's first XML element, in quotes of either kind; or the whole
  /// content where that is no XML.
  std::string value;
};
/// Errors: malformed, XML whose first tag or quote has no end.
[[nodiscard]] Result<RemoteCommand> remote_command_of(const igtl::CommandText& command);

/// What is said to it.
struct RemoteAnswer {
  bool done = false;
  std::string text;  ///< the result, or why not
};

/// RTS_COMMAND with the command's number and the metadata by which 3D Slicer knows success.
[[nodiscard]] igtl::Message answer_message(const igtl::Message& asked,
                                           const igtl::CommandText& command,
                                           const RemoteAnswer& answer);

}  // namespace artus
