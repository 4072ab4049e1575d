// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "artus/detail/exchange/igtl/message.h"
#include "artus/detail/exchange/igtl/stream_reader.h"

namespace artus::test {

/// A plain client on a socket of its own, as another program would be.
class IgtlClient {
 public:
  /// `receive_buffer`: bytes, as small as the system allows; 0: as it is.
  explicit IgtlClient(int port, int receive_buffer = 0);
  ~IgtlClient();
  IgtlClient(const IgtlClient&) = delete;
  IgtlClient& operator=(const IgtlClient&) = delete;

  void send(const std::string& bytes) const;
  void send(const igtl::Message& message) const { send(igtl::pack(message)); }

  /// The first message from now on for which `wanted` holds; nothing after `seconds` or when the
  /// server closed the connection.
  [[nodiscard]] std::optional<igtl::Message> wait_for(
      const std::function<bool(const igtl::Message&)>& wanted, double seconds = 20);
  [[nodiscard]] std::optional<igtl::Message> wait_for(const std::string& type,
                                                      double seconds = 20) {
    return wait_for([&](const igtl::Message& message) { return message.type == type; }, seconds);
  }
  /// Whether the server closes within so many seconds; what it still sends is thrown away.
  [[nodiscard]] bool is_closed_within(double seconds);

 private:
  bool read_more(double seconds);

  int socket_;
  bool closed_ = false;
  igtl::StreamReader reader_;
  std::vector<igtl::Message> waiting_;
};

}  // namespace artus::test
