// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/tissue_bytes.h"

#include <array>

namespace artus {
namespace {

// Every number of a tissue in file order, for writing and reading alike.
template <class T, class Value = std::conditional_t<std::is_const_v<T>, const double, double>>
std::array<Value*, 14> numbers_of_tissue(T& t) {
  return {
      &t.acoustic.speed_of_sound,    &t.acoustic.density,         &t.acoustic.attenuation,
      &t.acoustic.attenuation_power, &t.acoustic.backscatter,     &t.acoustic.interface_roughness,
      &t.mechanical.youngs_modulus,  &t.mechanical.poisson_ratio, &t.haptic.cutting_force,
      &t.haptic.wall_stiffness,      &t.haptic.attracted_force,   &t.haptic.friction,
      &t.haptic.clamping_stiffness,  &t.haptic.puncture_force};
}

/// One of `n` values; another refuses the file.
template <class Value>
Value get_choice(ByteReader& in, std::size_t n) {
  const auto value = in.get<std::uint8_t>();
  if (value >= n) in.refuse();
  return static_cast<Value>(value);
}

}  // namespace

void put_tissues(ByteWriter& out, const std::vector<Tissue>& tissues) {
  out.put(static_cast<std::uint32_t>(tissues.size()));
  for (const Tissue& t : tissues) {
    out.put(std::string_view(t.name));
    for (const double* value : numbers_of_tissue(t)) out.put(*value);
    out.put(static_cast<std::uint8_t>(t.haptic.hard ? 1 : 0));
    out.put(static_cast<std::uint8_t>(t.acoustic.kind));
    out.put(static_cast<std::uint8_t>(t.haptic.cutting_law));
    out.put(static_cast<std::uint8_t>(t.haptic.prepuncture_law));
    out.put(static_cast<std::uint32_t>(t.source.size()));
    for (const auto& [group, text] : t.source) {
      out.put(std::string_view(group));
      out.put(std::string_view(text));
    }
  }
}

std::vector<Tissue> get_tissues(ByteReader& in) {
  std::vector<Tissue> tissues(in.get_count(4));
  for (Tissue& t : tissues) {
    t.name = in.get_text();
    for (double* value : numbers_of_tissue(t)) *value = in.get<double>();
    t.haptic.hard = in.get<std::uint8_t>() != 0;
    t.acoustic.kind = get_choice<TissueKind>(in, kTissueKindNames.size());
    t.haptic.cutting_law = get_choice<CuttingLaw>(in, kCuttingLawNames.size());
    t.haptic.prepuncture_law = get_choice<PrepunctureLaw>(in, kPrepunctureLawNames.size());
    const std::uint32_t n = in.get_count(4);
    for (std::uint32_t i = 0; i < n && in.ok(); ++i) {
      std::string group = in.get_text();
      t.source[std::move(group)] = in.get_text();
    }
  }
  return tissues;
}

}  // namespace artus
