// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/session_link.h"

#include <cmath>
#include <utility>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/units.h"
#include "artus/detail/session/session_thread.h"

namespace artus {
namespace {

/// UTC of a time of the monotonic clock.
std::uint64_t utc_of(std::int64_t monotonic) {
  const std::int64_t ago = monotonic_ns() - monotonic;
  constexpr double kSecond = 4294967296.0;  // units of igtl::Header::time
  return igtl::utc_time_now() -
         static_cast<std::uint64_t>(std::max(0.0, 1e-9 * static_cast<double>(ago) * kSecond));
}

std::string number_text(double value) {
  return printed("%.6g", value);
}

igtl::Message message_of(const char* type, const char* device, std::uint64_t time,
                         std::string content) {
  igtl::Message message;
  message.type = type;
  message.device = device;
  message.time = time;
  message.content = std::move(content);
  return message;
}

std::string name_of(const std::vector<Region>& regions, std::uint32_t region) {
  return region < regions.size() ? regions[region].name : std::string();
}

/// What is felt, as words beside the picture.
std::vector<igtl::MetaEntry> force_entries(const HapticSnapshot& haptic, const Session& session) {
  const Vec3 force(haptic.force_J[0], haptic.force_J[1], haptic.force_J[2]);
  const Vec3 axis = to_pose(haptic.X_JN).linear().col(2);
  const auto& regions = session.scene().joint().regions;
  return {{"Force_N", number_text(force.norm())},
          {"AxialForce_N", number_text(-force.dot(axis))},
          {"Depth_mm", number_text(haptic.feedback.depth / kMillimetre)},
          {"Layer", name_of(regions, haptic.feedback.region)},
          {"Status", std::to_string(haptic.status)},
          {"HapticRate_Hz", number_text(session.params().haptic_rate)},
          {"ImageRate_Hz", number_text(session.params().image_rate)}};
}

/// The syringe, as words beside the picture.
std::vector<igtl::MetaEntry> syringe_entries(const HapticSnapshot& haptic,
                                             const std::vector<Region>& regions) {
  constexpr double kKilopascal = 1e3;  // Pa
  const PlungerFeedback& plunger = haptic.feedback.plunger;
  std::string into;
  for (std::uint32_t k = 0; k < haptic.n_sites; ++k)
    into += (k == 0 ? "" : ", ") + name_of(regions, haptic.sites[k].region) + " " +
            number_text(haptic.sites[k].volume / kCubicCentimetre);
  return {{"ThumbForce_N", number_text(plunger.thumb_force)},
          {"BarrelPressure_kPa", number_text(plunger.pressure / kKilopascal)},
          {"TipPressure_kPa", number_text(plunger.tip_pressure / kKilopascal)},
          {"Flow_ml_s", number_text(plunger.flow / kCubicCentimetre)},
          {"Given_ml", number_text(plunger.given / kCubicCentimetre)},
          {"Drawn_ml", number_text(plunger.drawn / kCubicCentimetre)},
          {"Into_ml", into},
          {"PlungerStatus", std::to_string(plunger.status)}};
}

/// The syringe in numbers, a message for each unit.
void append_syringe(std::vector<igtl::Message>& messages, const PlungerFeedback& plunger,
                    std::uint64_t time) {
  const auto append = [&](const char* name, igtl::Sensor sensor) {
    messages.push_back(message_of("SENSOR", name, time, igtl::pack_sensor(sensor)));
  };
  append("ThumbForce", {igtl::kNewton, {plunger.thumb_force}});
  append("PlungerTravel", {igtl::kMetre, {plunger.travel}});
  append("SyringePressure", {igtl::kPascal, {plunger.pressure, plunger.tip_pressure}});
  append("SyringeFlow", {igtl::kCubicMetrePerSecond, {plunger.flow}});
  append("SyringeVolume", {igtl::kCubicMetre, {plunger.given, plunger.drawn}});
}

void append_forces(std::vector<igtl::Message>& messages, const HapticSnapshot& haptic,
                   const ReferenceFrame& reference, std::uint64_t time) {
  const Vec3 force_J(haptic.force_J[0], haptic.force_J[1], haptic.force_J[2]);
  const Vec3 force = reference.X_JR().linear().transpose() * force_J;
  igtl::Sensor sensor{igtl::kNewton, {force.x(), force.y(), force.z()}};
  messages.push_back(message_of("SENSOR", "Force", time, igtl::pack_sensor(sensor)));
  messages.push_back(
      message_of("STRING", "Force", time,
                 igtl::pack_string(number_text(force.x()) + " " + number_text(force.y()) + " " +
                                   number_text(force.z()))));
}

std::vector<std::string> known_types() {
  return {"IMAGE",       "TRANSFORM",  "POSITION",    "TDATA",      "QTDATA",
          "STRING",      "SENSOR",     "STATUS",      "CAPABILITY", "COMMAND",
          "RTS_COMMAND", "GET_STATUS", "GET_CAPABIL", "STT_STRING", "STP_STRING",
          "STT_SENSOR",  "STP_SENSOR", "STT_TDATA",   "STP_TDATA"};
}

igtl::Message status_message(const Session* session) {
  igtl::Status status;
  constexpr std::uint16_t kNotReady = 13;
  status.code = session != nullptr ? igtl::Status::kOk : kNotReady;
  status.error = "None";
  status.message = session != nullptr ? "the session runs" : "the session starts";
  return message_of("STATUS", "artus", igtl::utc_time_now(), igtl::pack_status(status));
}

}  // namespace

std::vector<igtl::Message> messages_of(const ImageSnapshot& image, const HapticSnapshot* haptic,
                                       const Session& session, const ReferenceFrame& reference) {
  std::vector<igtl::Message> messages;
  const std::uint64_t time = utc_of(image.input.sample_time_ns);
  const igtl::Matrix probe = reference.to_reference(to_pose(image.input.X_JP));
  if (image.width > 0 && image.height > 0) {
    Transducer transducer = session.params().transducer;
    transducer.width = image.probe_width;
    igtl::Image out;
    out.width = image.width;
    out.height = image.height;
    out.image_to_reference = chained(probe, image_to_probe(transducer, image.pixel, image.height));
    out.grey = {reinterpret_cast<const char*>(image.grey.data()), image.grey.size()};
    messages.push_back(message_of("IMAGE", "Image_Reference", time, igtl::pack_image(out)));
    messages.back().id = static_cast<std::uint32_t>(image.input.number);
    messages.back().meta = {{"Modality", "simulated ultrasound"}};
    if (haptic != nullptr) {
      std::vector<igtl::MetaEntry>& meta = messages.back().meta;
      for (const igtl::MetaEntry& entry : force_entries(*haptic, session)) meta.push_back(entry);
      for (const igtl::MetaEntry& entry : syringe_entries(*haptic, session.scene().joint().regions))
        meta.push_back(entry);
    }
  }
  if (image.input.has_probe != 0)
    messages.push_back(
        message_of("TRANSFORM", "ProbeToReference", time, igtl::pack_transform(probe)));
  if (image.input.has_needle != 0)
    messages.push_back(
        message_of("TRANSFORM", "NeedleToReference", time,
                   igtl::pack_transform(reference.to_reference(to_pose(image.input.X_JN)))));
  std::vector<igtl::TrackedTool> tools;
  for (const igtl::Message& pose : messages)
    if (pose.type == "TRANSFORM")
      tools.push_back({pose.device, *igtl::parse_transform(pose.content)});
  messages.push_back(message_of("TDATA", "artus", time, igtl::pack_tdata(tools)));
  if (haptic != nullptr) {
    append_forces(messages, *haptic, reference, time);
    append_syringe(messages, haptic->feedback.plunger, time);
  }
  return messages;
}

Result<std::unique_ptr<SessionLink>> SessionLink::open(const Options& options) {
  std::unique_ptr<SessionLink> link(new SessionLink(options));
  const std::lock_guard<std::mutex> lock(link->mutex_);  // until the server's thread may use it
  auto server = igtl::Server::listen(
      options.server,
      [self = link.get()](const igtl::Message& message) { return self->answer(message); });
  ARTUS_TRY(server);
  link->server_ = std::move(*server);
  return link;
}

SessionLink::~SessionLink() = default;

void SessionLink::attach(Session* session) {
  const std::lock_guard<std::mutex> lock(mutex_);
  session_ = session;
  if (session != nullptr) controls_ = controls_of(session->params());
}

void SessionLink::take_image(const ImageSnapshot& image) {
  std::vector<igtl::Message> messages;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (session_ == nullptr || server_->clients() == 0) return;
    HapticSnapshot haptic;
    const bool felt = session_->newest(haptic);
    messages = messages_of(image, felt ? &haptic : nullptr, *session_, options_.reference);
  }
  server_->publish(std::move(messages));
}

std::vector<igtl::Message> SessionLink::answer(const igtl::Message& message) {
  if (message.type == "COMMAND") {
    const auto command = igtl::parse_command(message.content);
    if (!command) return {};
    const auto wish = remote_command_of(*command);
    return {answer_message(message, *command,
                           wish ? obey(*wish) : RemoteAnswer{false, wish.error().message})};
  }
  if (message.type == "GET_CAPABIL")
    return {message_of("CAPABILITY", "artus", igtl::utc_time_now(),
                       igtl::pack_capability(known_types()))};
  if (message.type == "GET_STATUS") {
    const std::lock_guard<std::mutex> lock(mutex_);
    return {status_message(session_)};
  }
  if (options_.inbox) {
    const auto taken = options_.inbox->take(message, monotonic_ns());
    const std::string said = taken ? options_.inbox->take_notice() : taken.error().message;
    if (said.empty()) return {};
    const std::lock_guard<std::mutex> lock(mutex_);
    server_->tell(said);
  }
  return {};
}

RemoteAnswer SessionLink::turn(const RemoteCommand& command, double low, double high, double scale,
                               double ImageControls::*knob) {
  const auto value = parse_number(command.value);
  if (!value || !(*value >= low && *value <= high))
    return {false,
            command.name + " needs a Value from " + number_text(low) + " to " + number_text(high)};
  if (options_.turn) {
    options_.turn(knob, *value * scale);
  } else {
    controls_.*knob = *value * scale;
    session_->set_controls(controls_);
  }
  return {true, command.name + " " + number_text(*value)};
}

RemoteAnswer SessionLink::obey(const RemoteCommand& command) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (command.name == "Version") return {true, "artus " + options_.version};
  if (command.name == "Scenario")
    return options_.begin ? options_.begin(command.value)
                          : RemoteAnswer{false, "no scenario runs in this program"};
  if (session_ == nullptr) return {false, "the session does not run yet"};
  if (command.name == "Freeze" || command.name == "Unfreeze") {
    session_->set_frozen(command.name == "Freeze");
    return {true, command.name == "Freeze" ? "frozen" : "running"};
  }
  if (command.name == "Gain") return turn(command, -40, 60, 1, &ImageControls::gain_db);
  if (command.name == "Depth") return turn(command, 10, 200, kMillimetre, &ImageControls::depth);
  return {false, "'" + command.name +
                     "' is not known; Version, Freeze, Unfreeze, Gain, Depth, Scenario are"};
}

}  // namespace artus
