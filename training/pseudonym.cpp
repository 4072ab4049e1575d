// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/pseudonym.h"

#include <algorithm>
#include <array>
#include <random>

namespace artus {
namespace {

std::string draw_pseudonym() {
  constexpr std::array<const char*, 16> kColours{
      "amber", "azure", "black", "blue",   "bronze", "coral", "green",  "grey",
      "ivory", "jade",  "lilac", "orange", "red",    "ruby",  "silver", "white"};
  constexpr std::array<const char*, 24> kBirds{
      "avocet", "bunting", "crane",  "curlew", "dipper", "dove",  "eagle",   "falcon",
      "finch",  "gull",    "heron",  "hoopoe", "ibis",   "jay",   "kestrel", "lark",
      "linnet", "magpie",  "osprey", "owl",    "plover", "raven", "robin",   "wren"};
  std::random_device random;
  const auto of = [&random](unsigned n) {
    return static_cast<std::size_t>(random() % n);
  };
  return std::string(kColours.at(of(kColours.size()))) + "-" + kBirds.at(of(kBirds.size())) + "-" +
         std::to_string(10 + of(90));
}

}  // namespace

std::string make_pseudonym(std::span<const PersonRecord> taken) {
  constexpr int kTries = 1000;
  for (int i = 0; i < kTries; ++i) {
    std::string name = draw_pseudonym();
    const bool free = std::none_of(taken.begin(), taken.end(),
                                   [&](const PersonRecord& other) { return other.id == name; });
    if (free) return name;
  }
  return make_random_id();
}

}  // namespace artus
