// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"

namespace artus {

/// What a tissue's fine structure looks like in an ultrasound image.
enum class TissueKind : std::uint8_t { plain, fat, muscle, tendon, nerve, skin, fluid, bone };

/// The kinds' names in a tissue library, in order of their values.
inline constexpr std::array<std::string_view, 8> kTissueKindNames{
    "plain", "fat", "muscle", "tendon", "nerve", "skin", "fluid", "bone"};

/// What sound does in a tissue. Amplitude attenuation at frequency f is
/// `attenuation * (f / 1 MHz)^attenuation_power`.
struct Acoustic {
  double speed_of_sound = 1540;    ///< m/s
  double density = 1000;           ///< kg/m^3
  double attenuation = 0;          ///< Np/m at 1 MHz, one way, amplitude
  double attenuation_power = 1;    ///< exponent of frequency
  double backscatter = 0;          ///< rms speckle amplitude relative to muscle across fibres (1)
  double interface_roughness = 0;  ///< 0 mirror-smooth .. 1 fully diffuse boundary
  TissueKind kind = TissueKind::plain;  ///< its septa, fibres, sheath or lumen
  [[nodiscard]] double impedance() const noexcept { return speed_of_sound * density; }  ///< Rayl
};

/// What a probe or a deformation feels.
struct Mechanical {
  double youngs_modulus = 0;  ///< Pa
  double poisson_ratio = 0.49;
};

/// Which law gives the force of cutting a tissue. The laws themselves are the business of haptics/.
enum class CuttingLaw : std::uint8_t { tracking_wall, direct, spring, voigt };
/// Which law gives the force of a surface that dimples before it is punctured.
enum class PrepunctureLaw : std::uint8_t { membrane, simone_okamura, barbe, god_object };

/// The laws' names in files and flags, in order of their values.
inline constexpr std::array<std::string_view, 4> kCuttingLawNames{"tracking_wall", "direct",
                                                                  "spring", "voigt"};
inline constexpr std::array<std::string_view, 4> kPrepunctureLawNames{"membrane", "simone_okamura",
                                                                      "barbe", "god_object"};

/// What a needle feels; the tracking wall's parameters [Alamilla2020] section 2.4.
struct Haptic {
  double cutting_force = 0;       ///< N, f_R
  double wall_stiffness = 500;    ///< N/m, K_t
  double attracted_force = 0;     ///< N, f_A, opposes withdrawal
  double friction = 0;            ///< scale on the LuGre friction of shaft length in this tissue
  double clamping_stiffness = 0;  ///< N/m, lateral, at full depth
  double puncture_force = 0;      ///< N, threshold of the membrane on entry; 0 = no membrane
  bool hard = false;              ///< bone: the needle cannot enter
  CuttingLaw cutting_law = CuttingLaw::tracking_wall;
  PrepunctureLaw prepuncture_law = PrepunctureLaw::membrane;
};

/// One named tissue. `source` says where the values come from, group by group.
struct Tissue {
  std::string name;
  Acoustic acoustic;
  Mechanical mechanical;
  Haptic haptic;
  std::map<std::string, std::string>
      source;  ///< group ("acoustic", ...) -> reference or "assumed: why"
};

/// The tissues of a library file in file order. Errors: not_found, malformed (with line), invalid
/// (unknown key, missing value, value out of its physical range).
[[nodiscard]] Result<std::vector<Tissue>> read_tissues(const std::filesystem::path& file);

/// The same from memory; `name` stands in messages.
[[nodiscard]] Result<std::vector<Tissue>> parse_tissues(std::string_view text,
                                                        const std::string& name);

/// The library that comes with artus (meshes/tissues.toml, built in).
[[nodiscard]] Result<std::vector<Tissue>> read_bundled_tissues();

}  // namespace artus
