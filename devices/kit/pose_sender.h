// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/devices/kit/tracker.h"
#include "artus/detail/exchange/igtl/server.h"

namespace artus::kit {

/// Gives poses to a session (or to any program that speaks OpenIGTLink): NeedleToReference,
/// ProbeToReference, and the plunger's travel as SENSOR. Reference is the middle of the block's
/// top: x and y as the sheet's, z up. What was not seen is not sent, and no pose is sent twice.
class PoseSender {
 public:
  /// "HOST:PORT" connects to a session that listens; "[address:]port" listens itself. Errors: as
  /// igtl::Server::listen, malformed.
  [[nodiscard]] static Result<PoseSender> open(const std::string& connect,
                                               const std::string& listen);

  /// `block_height`: m. The messages' time is the frame's, which must be of the realtime clock.
  void send(const HandsFrame& frame, double block_height);
  [[nodiscard]] std::size_t peers() const { return server_->clients(); }
  [[nodiscard]] int port() const { return server_->port(); }
  [[nodiscard]] std::vector<std::string> take_notices() { return server_->take_notices(); }

 private:
  explicit PoseSender(std::unique_ptr<igtl::Server> server) : server_(std::move(server)) {}
  std::unique_ptr<igtl::Server> server_;
};

/// The messages of a frame.
[[nodiscard]] std::vector<igtl::Message> messages_of(const HandsFrame& frame, double block_height);

}  // namespace artus::kit
