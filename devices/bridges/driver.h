// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "hand.h"

namespace artus::bridge {

/// One tick of one device: a reading in, the force on it out, N in its own frame.
using Tick = std::function<Triple(const Reading&)>;

/// One device of a maker while it is open.
class Device {
 public:
  virtual ~Device() = default;
  /// Calls `tick` at the device's rate and sends it each answer, also when that is zero, until
  /// `stop`, or until the device is lost; sends zero before it returns. Why it was lost; empty: it
  /// was stopped.
  virtual std::string run(const Tick& tick, const std::atomic<bool>& stop) = 0;
};

/// What a maker's program can do. A driver is made once and opens any number of devices.
class Driver {
 public:
  virtual ~Driver() = default;
  /// Opens the device of that name ("" the first); null, and `why` says why.
  virtual std::unique_ptr<Device> open(const std::string& name, std::string& why) = 0;
  /// Whether the maker's library or service is there, and what devices it sees, for people.
  virtual std::string describe() = 0;
  [[nodiscard]] virtual HandLimits limits() const = 0;
  /// Edges of the box in which the tip moves, mm.
  [[nodiscard]] virtual Triple workspace() const = 0;
  /// W's axes by the device's: W has x right, y away from the user, z up. By default of a device
  /// with x right, y up, z to the user.
  [[nodiscard]] virtual Turn axes() const { return {1, 0, 0, 0, 0, -1, 0, 1, 0}; }
  [[nodiscard]] virtual const char* maker() const = 0;
};

/// The program of a maker: reads the command line, opens devices, runs until a signal. The exit
/// code: 0 stopped, 1 no device or a failed check, 2 wrong arguments.
int run_program(int argc, char** argv, Driver& driver);

}  // namespace artus::bridge
