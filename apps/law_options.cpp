// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/apps/law_options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "artus/core/units.h"

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
                       std::optional<Law>& all, std::map<std::string, Law>& of_tissue) {
  for (const std::string& text : flags) {
    const auto [tissue, name] = split(text);
    const Result<Law> law = find(name);
    if (!law) return fail(law.error().code, law.error().message, flag);
    if (tissue.empty()) {
      all = *law;
    } else {
      of_tissue[tissue] = *law;
    }
  }
  return {};
}

template <class Law>
Result<void> check_tissues(const std::map<std::string, Law>& of_tissue, const char* flag,
                           const CompiledJoint& joint) {
  for (const auto& entry : of_tissue) {
    std::string known;
    bool found = false;
    for (const Tissue& t : joint.tissues) {
      known.append(known.empty() ? "" : ", ").append(t.name);
      found = found || t.name == entry.first;
    }
    if (!found)
      return fail(ErrorCode::not_found,
                  "the joint has no tissue \"" + entry.first + "\"; there are " + known, flag);
  }
  return {};
}

Result<void> read_patient(const std::vector<std::string>& flags, PatientProfile& patient) {
  const std::array<std::pair<std::string_view, double*>, 5> factors{
      {{"cutting", &patient.cutting},
       {"friction", &patient.friction},
       {"attracted", &patient.attracted},
       {"clamping", &patient.clamping},
       {"puncture", &patient.puncture}}};
  for (const std::string& text : flags) {
    const auto [name, number] = split(text);
    double value = 0;
    const char* end = number.data() + number.size();
    const auto read = std::from_chars(number.data(), end, value);
    if (read.ec != std::errc{} || read.ptr != end || !(value >= 0 && value <= 10))
      return fail(ErrorCode::invalid, "\"" + text + "\" must be NAME=FACTOR, factor 0 to 10",
                  "--patient");
    const auto at = std::find_if(factors.begin(), factors.end(),
                                 [&wanted = name](const auto& f) { return f.first == wanted; });
    if (at == factors.end())
      return fail(
          ErrorCode::not_found,
          "no factor \"" + name + "\"; there are cutting, friction, attracted, clamping, puncture",
          "--patient");
    *at->second = value;
  }
  return {};
}

Result<void> read_workspace(const LawOptions& options, std::optional<HemisphereParams>& sphere) {
  const std::vector<double>& mm = options.workspace_mm;
  if (mm.empty()) return {};
  const bool finite =
      std::all_of(mm.begin(), mm.end(), [](double value) { return std::isfinite(value); });
  if (mm.size() != 4 || !finite || !(mm[3] > 0))
    return fail(ErrorCode::invalid, "needs centre x, y, z and a radius above 0, mm",
                "--workspace-mm");
  sphere.emplace();
  sphere->centre = Vec3(mm[0], mm[1], mm[2]) * kMillimetre;
  sphere->radius = mm[3] * kMillimetre;
  sphere->push = options.workspace_push;
  return {};
}

}  // namespace

void add_law_options(Command* command, LawOptions& options) {
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

Result<ExperimentLaws> make_experiment_laws(const LawOptions& options) {
  ExperimentLaws chosen;
  LawSelection& laws = chosen.laws;
  ARTUS_TRY(read_laws(options.cutting, "--cutting", find_cutting_law, laws.cutting,
                      laws.cutting_of_tissue));
  ARTUS_TRY(read_laws(options.prepuncture, "--prepuncture", find_prepuncture_law, laws.prepuncture,
                      laws.prepuncture_of_tissue));
  ARTUS_TRY(read_patient(options.patient, chosen.patient));
  ARTUS_TRY(read_workspace(options, chosen.workspace));
  if (options.tap)
    chosen.tap = *options.tap == "impulse" ? HardLaw::impulse : HardLaw::decaying_sinusoid;
  if (options.clamping)
    chosen.clamping =
        *options.clamping == "plasticity" ? ClampingLaw::plasticity : ClampingLaw::projection;
  if (options.friction_set)
    chosen.friction = lugre_sets().at(static_cast<std::size_t>(*options.friction_set - 1));
  chosen.passivity_control = options.passivity_control;
  return chosen;
}

Result<RunLaws> make_laws(const LawOptions& options, const CompiledJoint& joint) {
  const auto chosen = make_experiment_laws(options);
  ARTUS_TRY(chosen);
  ARTUS_TRY(check_tissues(chosen->laws.cutting_of_tissue, "--cutting", joint));
  ARTUS_TRY(check_tissues(chosen->laws.prepuncture_of_tissue, "--prepuncture", joint));
  RunLaws run;
  run.laws = chosen->laws;
  run.patient = chosen->patient;
  run.passivity.control = chosen->passivity_control;
  apply_laws(*chosen, run.needle);
  return run;
}

}  // namespace artus
