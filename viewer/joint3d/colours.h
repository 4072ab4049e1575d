// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "artus/anatomy/compiled_joint.h"

namespace artus {

/// Red, green, blue of sRGB, 0 to 255.
using Rgb = std::array<std::uint8_t, 3>;

/// Of what is drawn over the picture; each is outlined in kOutline.
inline constexpr Rgb kOverlay{255, 220, 90};
inline constexpr Rgb kOutline{0, 0, 0};

/// The colour of a tissue by its name in the library, told apart by people of any colour vision
/// from all tissues that it stands beside; grey for a tissue that is not known.
[[nodiscard]] Rgb tissue_colour(std::string_view tissue) noexcept;
/// Of each region: its tissue's, with a shade a structure so that neighbours of one tissue differ.
[[nodiscard]] std::vector<Rgb> region_colours(const CompiledJoint& joint);

/// Ratio of luminances, 1 to 21. Source [WCAG] 1.4.3.
[[nodiscard]] double contrast(const Rgb& a, const Rgb& b) noexcept;

/// Whose eyes look.
enum class Vision { all_cones, protanopia, deuteranopia, tritanopia };
/// How a colour looks to eyes that lack one kind of cone. Source [Machado2009] table 1, severity 1.
[[nodiscard]] Rgb seen_by(Vision vision, const Rgb& colour) noexcept;
/// Distance of two colours in CIE L*a*b* (D65), 2.3 just noticeable. Source [Sharma2003].
[[nodiscard]] double difference(const Rgb& a, const Rgb& b) noexcept;

}  // namespace artus
