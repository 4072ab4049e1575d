// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "artus/detail/exchange/igtl/server.h"
#include "artus/detail/exchange/reference_frame.h"
#include "artus/detail/exchange/remote_command.h"
#include "artus/detail/exchange/tracker_device.h"
#include "artus/session/session.h"

namespace artus {

/// A session on OpenIGTLink: pictures, poses and forces out; a tracker's poses and commands in.
/// Out, with each image: IMAGE Image_Reference (header 2 with Force_N and more as metadata),
/// TRANSFORM ProbeToReference and NeedleToReference; to those who asked with STT_STRING STRING
/// Force, with STT_SENSOR SENSOR Force and of the syringe ThumbForce, PlungerTravel,
/// SyringePressure, SyringeFlow, SyringeVolume. In: see TrackerInbox, docs/openigtlink.md for
/// commands.
class SessionLink {
 public:
  struct Options {
    igtl::Server::Options server;
    ReferenceFrame reference;
    std::shared_ptr<TrackerInbox> inbox;  ///< null: TRANSFORM is not taken
    std::string version;                  ///< of the program, for the command Version
    /// Turns a knob of the scanner; called in the server's thread. Null: the link itself sets the
    /// session's, which then nobody else may.
    std::function<void(double ImageControls::*knob, double value)> turn;
    /// Begins the scenario of that name, or says why not; called in the server's thread, and the
    /// link must not be used in it. Null: none runs here.
    std::function<RemoteAnswer(const std::string& name)> begin;
  };
  /// Errors: as Server::listen.
  [[nodiscard]] static Result<std::unique_ptr<SessionLink>> open(const Options& options);
  /// Closes all connections.
  ~SessionLink();
  SessionLink(const SessionLink&) = delete;
  SessionLink& operator=(const SessionLink&) = delete;

  /// The session that is spoken for from now on; null before it ends.
  void attach(Session* session);
  /// To be called with each image, in the thread that made it (Session::Options::on_image).
  void take_image(const ImageSnapshot& image);

  [[nodiscard]] igtl::Server& server() noexcept { return *server_; }

 private:
  explicit SessionLink(const Options& options) : options_(options) {}
  [[nodiscard]] std::vector<igtl::Message> answer(const igtl::Message& message);
  [[nodiscard]] RemoteAnswer obey(const RemoteCommand& command);
  [[nodiscard]] RemoteAnswer turn(const RemoteCommand& command, double low, double high,
                                  double scale, double ImageControls::*knob);

  Options options_;
  std::mutex mutex_;  // of the three below: between slow threads, never in a tick
  Session* session_ = nullptr;
  ImageControls controls_;
  std::unique_ptr<igtl::Server> server_;  // last: its thread uses all of the above
};

/// What goes out with an image. `haptic`: of the same time; null: without forces.
[[nodiscard]] std::vector<igtl::Message> messages_of(const ImageSnapshot& image,
                                                     const HapticSnapshot* haptic,
                                                     const Session& session,
                                                     const ReferenceFrame& reference);

}  // namespace artus
