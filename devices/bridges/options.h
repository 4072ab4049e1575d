// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "driver.h"

namespace artus::bridge {

/// One device on the command line: "A=needle".
struct ChosenDevice {
  std::string name;  ///< as the maker calls it; empty: the first
  bool probe = false;
};

/// The command line of a bridge.
struct Options {
  std::vector<ChosenDevice> devices;
  HandSetup setup;     ///< of all; probe is each device's own
  std::string prefix;  ///< of the shared memory
  bool list = false;
  bool check = false;
  bool limits = false;      ///< print a device file
  bool left = false;        ///< hands exchanged
  bool statistics = false;  ///< print JSON at the end
  double seconds = 0;       ///< run for so long; 0: until a signal
};

/// Reads it; what is wrong, or empty.
std::string parse_options(int argc, char** argv, const Driver& driver, Options& options);
/// What --help says.
std::string help(const Driver& driver);
/// The limits as `artus serve --device-file` reads them.
std::string device_file(const Driver& driver);

}  // namespace artus::bridge
