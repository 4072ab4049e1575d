// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/record/needle_feel_json.h"

#include <string>

#include <nlohmann/json.hpp>

#include "artus/detail/haptics/needle/needle_params_fields.h"
#include "artus/detail/session/record/fields_json.h"

namespace artus {
namespace {

constexpr const char* kImpulse = "impulse";
constexpr const char* kSinusoid = "decaying_sinusoid";
constexpr const char* kPlasticity = "plasticity";
constexpr const char* kProjection = "projection";

/// The law for all tissues under "", then those of single tissues.
template <class Law>
nlohmann::json names_of(const LawChoice<Law>& choice) {
  auto json = nlohmann::json::object();
  if (choice.all) json[""] = to_string(*choice.all);
  for (const auto& [tissue, law] : choice.of_tissue) json[tissue] = to_string(law);
  return json;
}

template <class Law, class Find>
Result<void> read_names(const nlohmann::json& json, Find find, LawChoice<Law>& choice) {
  for (const auto& item : json.items()) {
    const Result<Law> law = find(item.value().get<std::string>());
    ARTUS_TRY(law);
    if (item.key().empty()) {
      choice.all = *law;
    } else {
      choice.of_tissue[item.key()] = *law;
    }
  }
  return {};
}

template <class P>
void read_if_there(const nlohmann::json& json, const char* name, std::optional<P>& params) {
  if (json.contains(name)) read_fields(json.at(name), params.emplace());
}

/// Which of two names stands there; unset when none does.
template <class Choice>
Result<void> read_choice(const nlohmann::json& json, const char* name, const char* zero,
                         const char* one, std::optional<Choice>& choice) {
  if (!json.contains(name)) return {};
  const auto text = json.at(name).get<std::string>();
  if (text != zero && text != one)
    return fail(ErrorCode::not_found,
                "unknown choice \"" + text + "\"; it must be " + zero + " or " + one, name);
  choice = text == one ? static_cast<Choice>(1) : static_cast<Choice>(0);
  return {};
}
static_assert(static_cast<int>(HardLaw::impulse) == 1);
static_assert(static_cast<int>(ClampingLaw::plasticity) == 1);

}  // namespace

nlohmann::json to_json(const NeedleFeel& feel) {
  nlohmann::json json{{"cutting", names_of(feel.cutting)},
                      {"prepuncture", names_of(feel.prepuncture)},
                      {"patient", fields_to_json(feel.patient)},
                      {"passivity_control", feel.passivity_control}};
  if (feel.tap) json["tap"] = *feel.tap == HardLaw::impulse ? kImpulse : kSinusoid;
  if (feel.clamping)
    json["clamping"] = *feel.clamping == ClampingLaw::plasticity ? kPlasticity : kProjection;
  if (feel.friction) json["friction"] = fields_to_json(*feel.friction);
  if (feel.workspace) json["workspace"] = fields_to_json(*feel.workspace);
  if (feel.needle_length) json["needle_length"] = *feel.needle_length;
  return json;
}

Result<NeedleFeel> to_needle_feel(const nlohmann::json& json) {
  NeedleFeel feel;
  ARTUS_TRY(read_names(json.at("cutting"), find_cutting_law, feel.cutting));
  ARTUS_TRY(read_names(json.at("prepuncture"), find_prepuncture_law, feel.prepuncture));
  read_fields(json.at("patient"), feel.patient);
  json.at("passivity_control").get_to(feel.passivity_control);
  ARTUS_TRY(read_choice(json, "tap", kSinusoid, kImpulse, feel.tap));
  ARTUS_TRY(read_choice(json, "clamping", kProjection, kPlasticity, feel.clamping));
  read_if_there(json, "friction", feel.friction);
  read_if_there(json, "workspace", feel.workspace);
  if (json.contains("needle_length")) feel.needle_length = json.at("needle_length").get<double>();
  ARTUS_TRY(validate(feel));
  return feel;
}

}  // namespace artus
