// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "artus/detail/evidence/runs/injection_run.h"

namespace artus {

/// An injection as people ask for it: names and sizes in place of parameters.
struct InjectionRequest {
  std::string injection;                      ///< the joint's planned one; empty: its first
  std::optional<std::pair<Vec3, Vec3>> line;  ///< m, frame J, entry and target in its place
  std::string into;      ///< structure to inject, on that line or on one that is found
  double volume = 5e-6;  ///< m^3
  double rate = 1e-7;    ///< m^3/s
  std::string liquid = "lidocaine";
  int gauge = 22;
  double needle_length = 0.05;  ///< m
  double syringe = 0;           ///< m^3 of the barrel; 0: the least that holds the volume
  double air = 0;               ///< m^3 trapped behind the liquid
  double aspirate = 3;          ///< s of pulling before; 0: none
  Technique technique = Technique::direct;
  Transducer transducer;  ///< of the probe that presses
  bool rigid = false;     ///< tissue does not give way
  double press = 3;       ///< N of the probe
  double rate_hz = 1000;
  std::string device = "virtuose_6d_desktop";
  std::uint64_t seed = 1;  ///< of hand and plunger
  NeedleFeel feel;
};

/// Runs it. Errors: not_found (planned injection, structure, liquid, gauge, device), invalid (a
/// syringe that does not hold the volume), naming what it is; those of run_injection.
[[nodiscard]] Result<InjectionRun> run_injection(const Scene& scene,
                                                 const InjectionRequest& request);

}  // namespace artus
