// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "artus/core/result.h"

namespace artus::igtl {

/// Where a server listens: this machine alone unless somebody says otherwise.
struct ListenAddress {
  std::string address = "127.0.0.1";
  int port = 18944;  ///< the protocol's own; 0: any that is free
};

/// "[address:]port": "18944", "0.0.0.0:18944", "[::1]:18944". Errors: malformed, naming `flag`.
[[nodiscard]] Result<ListenAddress> parse_address(std::string_view text, const std::string& flag);

/// A socket that listens there and does not block. Errors: invalid (no such address, not allowed),
/// unreadable (another program listens there).
[[nodiscard]] Result<int> open_listener(const ListenAddress& where);

/// A socket that is connected there, which does not block from then on. `give_up` is asked every
/// 100 ms. Errors: not_found (nobody listens, no such host, no answer within 2 s, given up).
[[nodiscard]] Result<int> open_connection(const ListenAddress& where,
                                          const std::function<bool()>& give_up);

/// The port that a listening socket has; 0 when it has none.
[[nodiscard]] int port_of(int socket) noexcept;

}  // namespace artus::igtl
