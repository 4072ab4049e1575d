// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/session/felt_laws.h"

#include <array>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

namespace artus {
namespace {

template <class Owner>
using Field = std::pair<const char*, double Owner::*>;

constexpr std::array<Field<PatientProfile>, 5> kPatient{{{"cutting", &PatientProfile::cutting},
                                                         {"friction", &PatientProfile::friction},
                                                         {"attracted", &PatientProfile::attracted},
                                                         {"clamping", &PatientProfile::clamping},
                                                         {"puncture", &PatientProfile::puncture}}};

constexpr std::array<Field<LugreParams>, 10> kFriction{
    {{"sigma0", &LugreParams::sigma0},
     {"sigma1", &LugreParams::sigma1},
     {"sigma2", &LugreParams::sigma2},
     {"mu_c", &LugreParams::mu_c},
     {"mu_s", &LugreParams::mu_s},
     {"alpha", &LugreParams::alpha},
     {"length", &LugreParams::length},
     {"stiffness_limit", &LugreParams::stiffness_limit},
     {"damping_limit", &LugreParams::damping_limit},
     {"relaxation_time", &LugreParams::relaxation_time}}};

constexpr std::array<Field<HemisphereParams>, 2> kWorkspace{
    {{"radius", &HemisphereParams::radius}, {"push", &HemisphereParams::push}}};

template <class Owner, class Fields>
nlohmann::json numbers_of(const Owner& owner, const Fields& fields) {
  nlohmann::json json;
  for (const auto& [name, member] : fields) json[name] = owner.*member;
  return json;
}

template <class Owner, class Fields>
void read_numbers(const nlohmann::json& json, const Fields& fields, Owner& owner) {
  for (const auto& [name, member] : fields) json.at(name).get_to(owner.*member);
}

/// The law for all tissues under "", then those of single tissues.
template <class Law>
nlohmann::json names_of(const std::optional<Law>& all, const std::map<std::string, Law>& some) {
  auto json = nlohmann::json::object();
  if (all) json[""] = to_string(*all);
  for (const auto& [tissue, law] : some) json[tissue] = to_string(law);
  return json;
}

template <class Law, class Find>
Result<void> read_names(const nlohmann::json& json, Find find, std::optional<Law>& all,
                        std::map<std::string, Law>& some) {
  for (const auto& item : json.items()) {
    const Result<Law> law = find(item.value().get<std::string>());
    ARTUS_TRY(law);
    if (item.key().empty()) {
      all = *law;
    } else {
      some[item.key()] = *law;
    }
  }
  return {};
}

}  // namespace

FeltLaws felt_laws_of(const SessionParams& params) {
  return {params.laws,
          params.patient,
          params.needle.hard.law,
          params.needle.clamping,
          params.needle.friction,
          params.needle.use_workspace,
          params.needle.workspace,
          params.passivity};
}

void apply(const FeltLaws& felt, SessionParams& params) {
  params.laws = felt.laws;
  params.patient = felt.patient;
  params.needle.hard.law = felt.tap;
  params.needle.clamping = felt.clamping;
  params.needle.friction = felt.friction;
  params.needle.use_workspace = felt.use_workspace;
  params.needle.workspace = felt.workspace;
  params.passivity = felt.passivity;
}

nlohmann::json to_json(const FeltLaws& felt) {
  return {{"cutting", names_of(felt.laws.cutting, felt.laws.cutting_of_tissue)},
          {"prepuncture", names_of(felt.laws.prepuncture, felt.laws.prepuncture_of_tissue)},
          {"patient", numbers_of(felt.patient, kPatient)},
          {"impulse_tap", felt.tap == HardLaw::impulse},
          {"plasticity_clamping", felt.clamping == ClampingLaw::plasticity},
          {"friction", numbers_of(felt.friction, kFriction)},
          {"use_workspace", felt.use_workspace},
          {"workspace", numbers_of(felt.workspace, kWorkspace)},
          {"workspace_centre",
           {felt.workspace.centre.x(), felt.workspace.centre.y(), felt.workspace.centre.z()}},
          {"passivity_control", felt.passivity.control},
          {"passivity_damping", felt.passivity.max_damping}};
}

Result<FeltLaws> to_felt_laws(const nlohmann::json& json) {
  FeltLaws felt;
  ARTUS_TRY(read_names(json.at("cutting"), find_cutting_law, felt.laws.cutting,
                       felt.laws.cutting_of_tissue));
  ARTUS_TRY(read_names(json.at("prepuncture"), find_prepuncture_law, felt.laws.prepuncture,
                       felt.laws.prepuncture_of_tissue));
  read_numbers(json.at("patient"), kPatient, felt.patient);
  if (json.at("impulse_tap").get<bool>()) felt.tap = HardLaw::impulse;
  if (json.at("plasticity_clamping").get<bool>()) felt.clamping = ClampingLaw::plasticity;
  read_numbers(json.at("friction"), kFriction, felt.friction);
  json.at("use_workspace").get_to(felt.use_workspace);
  read_numbers(json.at("workspace"), kWorkspace, felt.workspace);
  for (std::size_t i = 0; i < 3; ++i)
    json.at("workspace_centre").at(i).get_to(felt.workspace.centre[static_cast<Eigen::Index>(i)]);
  json.at("passivity_control").get_to(felt.passivity.control);
  json.at("passivity_damping").get_to(felt.passivity.max_damping);
  return felt;
}

}  // namespace artus
