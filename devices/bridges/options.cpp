// SPDX-License-Identifier: AGPL-3.0-or-later
#include "options.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace artus::bridge {
namespace {

bool read_numbers(const std::string& text, double* out, int count) {
  const char* at = text.c_str();
  for (int i = 0; i < count; ++i) {
    char* end = nullptr;
    out[i] = std::strtod(at, &end);
    if (end == at || !std::isfinite(out[i])) return false;
    at = end;
    if (i + 1 < count && *at++ != ',') return false;
  }
  return *at == '\0';
}

/// "x,-z,y" as the rows of a rotation: W's axes by the device's.
bool read_axes(const std::string& text, Turn& R) {
  R = {};
  std::size_t row = 0;
  std::size_t at = 0;
  while (row < 3 && at < text.size()) {
    const double sign = text[at] == '-' ? -1 : 1;
    if (text[at] == '-' || text[at] == '+') ++at;
    if (at >= text.size() || text[at] < 'x' || text[at] > 'z') return false;
    R[3 * row + static_cast<std::size_t>(text[at] - 'x')] = sign;
    ++at;
    ++row;
    if (row < 3 && (at >= text.size() || text[at++] != ',')) return false;
  }
  const double determinant = R[0] * (R[4] * R[8] - R[5] * R[7]) -
                             R[1] * (R[3] * R[8] - R[5] * R[6]) +
                             R[2] * (R[3] * R[7] - R[4] * R[6]);
  return row == 3 && at == text.size() && determinant == 1;
}

/// "A=needle", "=probe", "needle".
bool read_device(const std::string& text, ChosenDevice& device) {
  const std::size_t equals = text.rfind('=');
  const std::string hand = equals == std::string::npos ? text : text.substr(equals + 1);
  if (hand != "needle" && hand != "probe") return false;
  device.probe = hand == "probe";
  device.name = equals == std::string::npos ? "" : text.substr(0, equals);
  return true;
}

/// A flag with a value; whether the value is sound. `known`: whether there is such a flag.
bool take_value(const std::string& flag, const std::string& value, Options& options, bool& known) {
  double number = 0;
  known = true;
  if (flag == "--prefix") {
    options.prefix = value;
    return artus_shm_is_prefix(value.c_str()) != 0;
  }
  if (flag == "--axes") return read_axes(value, options.setup.R_WD);
  if (flag == "--tool-axes") return read_axes(value, options.setup.R_TN);
  if (flag == "--centre-mm") {
    if (!read_numbers(value, options.setup.centre.data(), 3)) return false;
    for (double& v : options.setup.centre) v *= 1e-3;
    return true;
  }
  if (flag == "--direction") {
    Triple& d = options.setup.direction;
    if (!read_numbers(value, d.data(), 3)) return false;
    const double n = std::hypot(d[0], d[1], d[2]);
    for (double& v : d) v /= n;
    return n > 1e-9;
  }
  if (flag != "--gravity-n" && flag != "--clutch" && flag != "--choose" && flag != "--seconds" &&
      flag != "--force-n") {
    known = false;
    return false;
  }
  if (!read_numbers(value, &number, 1) || number < 0) return false;
  if (flag == "--gravity-n") {
    options.setup.gravity = number;
    return number <= 2;
  }
  if (flag == "--force-n") {
    const bool less = number <= options.setup.limits.peak;
    options.setup.limits = {number, std::fmin(number, options.setup.limits.lasting)};
    return less;
  }
  if (flag == "--seconds") {
    options.seconds = number;
    return true;
  }
  const auto mask = number >= 1 ? 1U << (static_cast<unsigned>(number) - 1U) : 0U;
  (flag == "--clutch" ? options.setup.clutch : options.setup.choose) = mask;
  return number <= 8 && number == std::floor(number);
}

}  // namespace

std::string parse_options(int argc, char** argv, const Driver& driver, Options& options) {
  options.setup.limits = driver.limits();
  options.setup.R_WD = driver.axes();
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    bool* const flag = word == "--list"         ? &options.list
                       : word == "--check"      ? &options.check
                       : word == "--limits"     ? &options.limits
                       : word == "--left"       ? &options.left
                       : word == "--statistics" ? &options.statistics
                                                : nullptr;
    if (flag != nullptr) {
      *flag = true;
      continue;
    }
    if (word.compare(0, 2, "--") != 0) {
      ChosenDevice device;
      if (!read_device(word, device)) return "'" + word + "' is not NAME=needle or NAME=probe";
      options.devices.push_back(device);
      continue;
    }
    bool known = false;
    const std::string value = i + 1 < argc ? argv[++i] : "";
    const bool sound = take_value(word, value, options, known);
    if (!known) return "'" + word + "' is not a flag; --help lists them";
    if (!sound) return "'" + value + "' cannot be the value of " + word;
  }
  if (options.list || options.limits) return "";
  if (options.devices.empty()) options.devices.push_back({});
  if (options.devices.size() > 2) return "there are two hands: name one or two devices";
  if (options.devices.size() == 2 && options.devices[0].probe == options.devices[1].probe)
    return "two devices must be needle and probe";
  if (options.left)
    for (ChosenDevice& device : options.devices) device.probe = !device.probe;
  return "";
}

std::string help(const Driver& driver) {
  return std::string("A bridge from devices of ") + driver.maker() +
         " to artus' shared memory.\n"
         "  NAME=needle|probe  a device and its hand, one or two; NAME as the maker calls it, or "
         "none: the first\n"
         "  --list             what is there\n"
         "  --limits           print the device's limits, for artus serve --device-file\n"
         "  --check            axes, rate and 0.3 N six ways, without artus\n"
         "  --prefix P         of the shared memory\n"
         "  --axes x,-z,y      W's axes by the device's (W: x right, y away, z up)\n"
         "  --tool-axes A      the needle's axes by the tool's (default: x,-y,-z)\n"
         "  --centre-mm X,Y,Z  where the device's origin lies in W\n"
         "  --direction X,Y,Z  of a needle whose device has no wrist, until it has entered\n"
         "  --gravity-n N      upwards, what a mounted handle weighs\n"
         "  --clutch K         button that shifts the hand, from 1 (default: 2); 0: none\n"
         "  --choose K         button that chooses the entry point (default: 1); 0: none\n"
         "  --force-n N        the most; less than the device's own\n"
         "  --left             exchange the hands\n"
         "  --seconds S        run for so long\n"
         "  --statistics       print ticks, round trips and losses as JSON at the end\n";
}

std::string device_file(const Driver& driver) {
  const Triple edges = driver.workspace();
  const Turn R = driver.axes();
  Triple box{};  // in W
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) box[i] += std::fabs(R[3 * i + j]) * edges[j];
  char text[512];
  std::snprintf(text, sizeof text,
                "# What artus serve may ask of this device: artus serve --device-file FILE\n"
                "format = 1\nname = \"%s\"\n\n[needle]\nforce_n = %.2f\ntorque_nm = 0.0\n"
                "workspace_mm = [%.1f, %.1f, %.1f]\n",
                driver.maker(), driver.limits().peak, box[0], box[1], box[2]);
  return text;
}

}  // namespace artus::bridge
