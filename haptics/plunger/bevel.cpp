// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/plunger/bevel.h"

#include <algorithm>
#include <span>

namespace artus {
namespace {

std::uint32_t space_of(RegionId region, const BevelPlaces& places) noexcept {
  return places.of_region[region < places.of_region.size() ? region : kOutside];
}

bool is_cavity(std::uint32_t space, const BevelPlaces& places) noexcept {
  return places.kinds[space] == SpaceKind::cavity;
}

/// The layers that the opening is in, shallow to deep, by what of it each takes.
class OpeningParts {
 public:
  void add(std::uint32_t space, double from, double to) noexcept {
    if (!(to > from)) return;
    for (std::size_t k = 0; k < n_; ++k) {
      if (parts_[k].space != space) continue;
      parts_[k].share += to - from;
      return;
    }
    if (n_ < parts_.size()) parts_[n_++] = {space, to - from};
  }
  /// The largest that is not `space`.
  [[nodiscard]] TipShare largest_but(std::uint32_t space) const noexcept {
    TipShare found;
    for (std::size_t k = 0; k < n_; ++k)
      if (parts_[k].space != space && parts_[k].share > found.share) found = parts_[k];
    return found;
  }

 private:
  std::array<TipShare, 16> parts_{};  // more layers than a bevel meets
  std::size_t n_ = 0;
};

/// The part of a stretch of tissue that lies so near to a cavity on the line that it tears, first
/// of the one behind it, then of the one before it.
struct TornFilms {
  double behind_to = 0;      // m along the line, where the film of the cavity behind ends
  double before_from = 0;    // m, where that of the cavity before begins
  std::uint32_t behind = 0;  // their spaces
  std::uint32_t before = 0;
};

TornFilms films_of(const NeedleTick& tick, std::size_t k, const BevelPlaces& places,
                   std::span<const double> lifted) noexcept {
  const std::span<const ShaftLayer> shaft = tick.shaft;
  const ShaftLayer& s = shaft[k];
  TornFilms films{s.entry, s.exit, 0, 0};
  const std::uint32_t own = space_of(s.region, places);
  if (places.kinds[own] != SpaceKind::split) return films;
  for (std::size_t i = 0; i < shaft.size(); ++i) {
    const std::uint32_t space = space_of(shaft[i].region, places);
    const double lift = space < lifted.size() ? lifted[space] : 0;
    if (!is_cavity(space, places) || shaft[i].entry - lift >= tick.depth) continue;
    if (i < k && shaft[i].exit + kHoldingFilm > films.behind_to) {
      films.behind_to = std::min(shaft[i].exit + kHoldingFilm, s.exit);
      films.behind = space;
    }
    const double from = shaft[i].entry - lift - kHoldingFilm;
    if (i > k && from < films.before_from) {
      films.before_from = std::max(from, s.entry);
      films.before = space;
    }
  }
  films.before_from = std::max(films.before_from, films.behind_to);
  return films;
}

}  // namespace

BevelPlaces make_bevel_places(const JointSpaces& spaces) {
  BevelPlaces places{spaces.of_region, {}};
  for (const Space& space : spaces.spaces) places.kinds.push_back(space.law.kind);
  return places;
}

std::array<TipShare, 2> bevel_shares(const NeedleContact& contact, double bevel,
                                     const BevelPlaces& places,
                                     std::span<const double> lifted) noexcept {
  std::array<TipShare, 2> shares{{{space_of(kOutside, places), 1}, {}}};
  if (!contact.inserted()) return shares;
  const NeedleTick& tick = contact.tick();
  const double first = tick.depth - bevel;
  OpeningParts parts;
  parts.add(space_of(kOutside, places), first, std::min(0.0, tick.depth));
  shares[0].space = space_of(contact.region(), places);
  for (std::size_t k = 0; k < tick.shaft.size(); ++k) {
    const ShaftLayer& s = tick.shaft[k];
    const double from = std::max(s.entry, first);
    const double to = std::min(s.exit, tick.depth);
    if (!(to > from)) continue;
    const TornFilms films = films_of(tick, k, places, lifted);
    parts.add(films.behind, from, std::min(to, films.behind_to));
    parts.add(space_of(s.region, places), std::max(from, films.behind_to),
              std::min(to, films.before_from));
    parts.add(films.before, std::max(from, films.before_from), to);
    if (s.region != contact.region()) continue;
    if (tick.depth <= films.behind_to && films.behind_to > s.entry) shares[0].space = films.behind;
    if (tick.depth > films.before_from) shares[0].space = films.before;
  }
  shares[1] = parts.largest_but(shares[0].space);
  shares[1].share = std::clamp(shares[1].share / bevel, 0.0, 1.0);
  shares[0].share = 1 - shares[1].share;
  return shares;
}

}  // namespace artus
