// SPDX-License-Identifier: AGPL-3.0-or-later
#include "haply_messages.h"

#include <cmath>
#include <cstdlib>

#include <nlohmann/json.hpp>

namespace artus::bridge {
namespace {

using nlohmann::json;

/// A finite number of an object; whether there is one.
bool take_number(const json& object, const char* key, double& out) {
  const auto at = object.find(key);
  if (at == object.end() || !at->is_number()) return false;
  const auto value = at->get<double>();
  if (!std::isfinite(value)) return false;
  out = value;
  return true;
}

/// The object at the end of a path, or null.
const json* find(const json& object, std::initializer_list<const char*> path) {
  const json* here = &object;
  for (const char* key : path) {
    if (!here->is_object()) return nullptr;
    const auto at = here->find(key);
    if (at == here->end()) return nullptr;
    here = &*at;
  }
  return here->is_object() ? here : nullptr;
}

/// The wanted one of a list of devices; null when it is not there.
const json* device_in(const json& message, const char* list, const std::string& wanted) {
  const auto devices = message.find(list);
  if (devices == message.end() || !devices->is_array() || devices->empty()) return nullptr;
  char* end = nullptr;
  const unsigned long number = std::strtoul(wanted.c_str(), &end, 10);
  if (wanted.empty() || (*end == '\0' && wanted.size() < 3))
    return number < devices->size() ? &(*devices)[number] : nullptr;
  for (const json& device : *devices) {
    const auto id = device.is_object() ? device.find("device_id") : device.end();
    if (device.is_object() && id != device.end() && id->is_string() && *id == wanted)
      return &device;
  }
  return nullptr;
}

void take_grip(const json& message, const std::string& wanted, Reading& reading) {
  // A grip has an id of its own: it belongs to the device of the same number, else to the first.
  const std::string number = wanted.size() < 3 ? wanted : "";
  const json* grip = device_in(message, "wireless_verse_grip", number);
  if (grip == nullptr) grip = device_in(message, "verse_grip", number);
  if (grip == nullptr) return;
  double x = 0;
  double y = 0;
  double z = 0;
  double w = 0;
  const json* q = find(*grip, {"state", "orientation"});
  if (q != nullptr && take_number(*q, "x", x) && take_number(*q, "y", y) &&
      take_number(*q, "z", z) && take_number(*q, "w", w)) {
    const double n = std::sqrt(x * x + y * y + z * z + w * w);
    if (n > 0.9 && n < 1.1) {
      x /= n, y /= n, z /= n, w /= n;
      reading.rotation = {
          1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
          2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
          2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
      reading.has_wrist = true;
    }
  }
  const json* buttons = find(*grip, {"state", "buttons"});
  if (buttons == nullptr) return;
  std::uint32_t bit = 1;
  for (const char* name : {"a", "b", "c"}) {
    const auto button = buttons->find(name);
    if (button != buttons->end() && button->is_boolean())
      reading.buttons = button->get<bool>() ? reading.buttons | bit : reading.buttons & ~bit;
    bit *= 2;
  }
}

}  // namespace

bool take_haply_message(std::string_view text, const std::string& wanted, HaplyState& state) {
  state.reading.sound = false;
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object()) return false;
  const json* device = device_in(message, "inverse3", wanted);
  if (device == nullptr || !device->is_object()) return false;
  const auto id = device->find("device_id");
  if (id != device->end() && id->is_string()) state.id = id->get<std::string>();
  const json* place = find(*device, {"state", "cursor_position"});
  Triple at{};
  if (state.id.empty() || place == nullptr || !take_number(*place, "x", at[0]) ||
      !take_number(*place, "y", at[1]) || !take_number(*place, "z", at[2]))
    return false;
  state.reading.position = at;
  take_grip(message, wanted, state.reading);
  state.reading.sound = true;
  return true;
}

std::string haply_command(const std::string& id, const Triple& force) {
  const json values{{"x", force[0]}, {"y", force[1]}, {"z", force[2]}};
  const json command{{"device_id", id}, {"commands", {{"set_cursor_force", {{"values", values}}}}}};
  return json{{"inverse3", json::array({command})}}.dump();
}

}  // namespace artus::bridge
