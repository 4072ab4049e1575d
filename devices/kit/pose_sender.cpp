// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/devices/kit/pose_sender.h"

#include <cmath>
#include <utility>

#include "artus/detail/core/units.h"
#include "artus/detail/exchange/igtl/contents.h"

namespace artus::kit {
namespace {

std::uint64_t stamp_of(double time) {
  constexpr double kFraction = 4294967296.0;  // 2^32 a second
  const double whole = std::floor(time);
  return static_cast<std::uint64_t>(whole) << 32U |
         static_cast<std::uint64_t>((time - whole) * kFraction);
}

/// From the sheet to the middle of the block's top.
Pose on_block(const Pose& X_SB, double block_height) {
  Pose X_RB = X_SB;
  X_RB.translation().z() -= block_height;
  return X_RB;
}

igtl::Message transform(const char* name, const Pose& X_RB, double time) {
  igtl::Matrix matrix;
  matrix << X_RB.linear(), X_RB.translation() / kMillimetre;
  igtl::Message message;
  message.type = "TRANSFORM";
  message.device = name;
  message.time = stamp_of(time);
  message.content = igtl::pack_transform(matrix);
  return message;
}

}  // namespace

std::vector<igtl::Message> messages_of(const HandsFrame& frame, double block_height) {
  std::vector<igtl::Message> messages;
  if (frame.X_SP)
    messages.push_back(
        transform("ProbeToReference", on_block(*frame.X_SP, block_height), frame.time));
  if (frame.X_SN)
    messages.push_back(
        transform("NeedleToReference", on_block(*frame.X_SN, block_height), frame.time));
  if (frame.plunger) {
    igtl::Message message;
    message.type = "SENSOR";
    message.device = "Plunger";
    message.time = stamp_of(frame.time);
    message.content = igtl::pack_sensor({igtl::kMetre, {*frame.plunger}});
    messages.push_back(std::move(message));
  }
  return messages;
}

Result<PoseSender> PoseSender::open(const std::string& connect, const std::string& listen) {
  igtl::Server::Options options;
  const auto where = igtl::parse_address(connect.empty() ? listen : connect,
                                         connect.empty() ? "--igtl" : "--connect");
  ARTUS_TRY(where);
  if (connect.empty())
    options.where = *where;
  else
    options.connect_to = *where;
  options.on_request = {};
  auto server = igtl::Server::listen(
      options, [](const igtl::Message& /*message*/) { return std::vector<igtl::Message>(); });
  ARTUS_TRY(server);
  return PoseSender(std::move(*server));
}

void PoseSender::send(const HandsFrame& frame, double block_height) {
  auto messages = messages_of(frame, block_height);
  if (!messages.empty()) server_->publish(std::move(messages));
}

}  // namespace artus::kit
