// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/feel_options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "artus/detail/core/known_names.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

/// "name" or "key=name".
std::pair<std::string, std::string> split(const std::string& text) {
  const auto at = text.find('=');
  if (at == std::string::npos) return {"", text};
  return {text.substr(0, at), text.substr(at + 1)};
}

template <class Law, class Find>
Result<void> read_laws(const std::vector<std::string>& flags, const char* flag, Find find,
                       LawChoice<Law>& choice) {
  for (const std::string& text : flags) {
    const auto [tissue, name] = split(text);
    const Result<Law> law = find(name);
    if (!law) return fail(law.error().code, law.error().message, flag);
    if (tissue.empty()) {
      choice.all = *law;
    } else {
      choice.of_tissue[tissue] = *law;
    }
  }
  return {};
}

Result<void> read_patient(const std::vector<std::string>& flags, PatientProfile& patient) {
  for (const std::string& text : flags) {
    const auto [name, number] = split(text);
    double value = 0;
    const char* end = number.data() + number.size();
    const auto read = std::from_chars(number.data(), end, value);
    if (read.ec != std::errc{} || read.ptr != end || !(value >= 0 && value <= 10))
      return fail(ErrorCode::invalid, "\"" + text + "\" must be NAME=FACTOR, factor 0 to 10",
                  "--patient");
    std::vector<std::string> factors;
    bool found = false;
    visit_fields(patient, [&, &wanted = name](const std::string& factor, double& member) {
      factors.push_back(factor);
      if (factor != wanted) return;
      member = value;
      found = true;
    });
    const std::vector<std::string_view> known(factors.begin(), factors.end());
    if (!found) ARTUS_TRY(find_name(known, name, "factor", "--patient"));
  }
  return {};
}

Result<void> read_workspace(const FeelOptions& options, std::optional<HemisphereParams>& sphere) {
  const std::vector<double>& mm = options.workspace_mm;
  if (mm.empty()) return {};
  const bool finite =
      std::all_of(mm.begin(), mm.end(), [](double value) { return std::isfinite(value); });
  constexpr double kFarthest = 10e3;  // mm
  const auto is_near = [](double value) {
    return std::abs(value) < kFarthest;
  };
  if (mm.size() != 4 || !finite || !(mm[3] > 0) || !std::all_of(mm.begin(), mm.end(), is_near))
    return fail(ErrorCode::invalid,
                "needs centre x, y, z and a radius above 0, mm, each below 10000",
                "--workspace-mm");
  sphere.emplace();
  sphere->centre = Vec3(mm[0], mm[1], mm[2]) * kMillimetre;
  sphere->radius = mm[3] * kMillimetre;
  sphere->push = options.workspace_push;
  return {};
}

}  // namespace

void add_feel_options(Command* command, FeelOptions& options) {
  const std::string group = "Force laws of the needle";
  command
      ->add_option("--cutting", options.cutting,
                   "LAW, or TISSUE=LAW for one tissue: tracking_wall, direct, spring, voigt")
      ->group(group);
  command
      ->add_option("--prepuncture", options.prepuncture,
                   "LAW, or TISSUE=LAW: membrane, simone_okamura, barbe, god_object")
      ->group(group);
  command
      ->add_option("--bone-tap", options.tap,
                   "what a touch of bone is felt by (default: decaying_sinusoid)")
      ->one_of({"decaying_sinusoid", "impulse"})
      ->group(group);
  command
      ->add_option("--clamping", options.clamping,
                   "what holds the needle on its line (default: projection)")
      ->one_of({"projection", "plasticity"})
      ->group(group);
  command
      ->add_option("--friction-set", options.friction_set,
                   "LuGre parameters: 1, 2: 20 mm at 0.025 and 0.05 Hz; 3, 4: 40 mm (default: 3)")
      ->check(whole_number_in(1, 4))
      ->group(group);
  command
      ->add_option("--patient", options.patient,
                   "NAME=FACTOR on the tissues' cutting, friction, attracted, clamping, puncture")
      ->group(group);
  command
      ->add_option("--workspace-mm", options.workspace_mm,
                   "X Y Z R: a sphere that the needle is pushed out of, frame of the joint")
      ->expected(4)
      ->group(group);
  command->add_option("--workspace-push-n", options.workspace_push, "how hard, N")
      ->check(number_in(0, 50))
      ->capture_default_str()
      ->group(group);
  command
      ->add_flag("--passivity-control", options.passivity_control,
                 "damp when the forces have given more energy than they took")
      ->group(group);
}

Error at_flag(Error error) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kFlags{
      {{"cutting", "--cutting"},
       {"prepuncture", "--prepuncture"},
       {"tap", "--bone-tap"},
       {"clamping", "--clamping"},
       {"friction", "--friction-set"},
       {"patient", "--patient"},
       {"workspace", "--workspace-mm"},
       {"needle_length", "--needle-length-mm"},
       {"passivity_control", "--passivity-control"}}};
  for (const auto& [kind, flag] : kFlags)
    if (error.where == kind) {
      error.where = flag;
      break;
    }
  return error;
}

Result<NeedleFeel> make_feel(const FeelOptions& options) {
  NeedleFeel feel;
  ARTUS_TRY(read_laws(options.cutting, "--cutting", find_cutting_law, feel.cutting));
  ARTUS_TRY(
      read_laws(options.prepuncture, "--prepuncture", find_prepuncture_law, feel.prepuncture));
  ARTUS_TRY(read_patient(options.patient, feel.patient));
  ARTUS_TRY(read_workspace(options, feel.workspace));
  if (options.tap)
    feel.tap = *options.tap == "impulse" ? HardLaw::impulse : HardLaw::decaying_sinusoid;
  if (options.clamping)
    feel.clamping =
        *options.clamping == "plasticity" ? ClampingLaw::plasticity : ClampingLaw::projection;
  if (options.friction_set)
    feel.friction = lugre_sets().at(static_cast<std::size_t>(*options.friction_set - 1));
  if (options.needle_length_mm) feel.needle_length = *options.needle_length_mm * kMillimetre;
  feel.passivity_control = options.passivity_control;
  return feel;
}

Result<NeedleFeel> make_feel(const FeelOptions& options, const CompiledJoint& joint) {
  auto feel = make_feel(options);
  ARTUS_TRY(feel);
  if (const auto valid = check(*feel, scope_of(joint)); !valid)
    return tl::unexpected<Error>(at_flag(valid.error()));
  return feel;
}

}  // namespace artus
