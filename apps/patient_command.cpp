// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/source/patient.h"
#include "artus/detail/apps/commands.h"

namespace artus {
namespace {

struct PatientCommandOptions {
  std::string what;
  std::string patient;
  std::filesystem::path joint;
  std::int64_t seed = 1;
  std::int64_t count = 1;
  bool json = false;
};

nlohmann::json values_json(const std::vector<PatientValue>& values) {
  auto json = nlohmann::json::object();
  for (const PatientValue& v : values) json[v.name] = v.value;
  return json;
}

/// What the joint can take, or all quantities where there is none.
Result<nlohmann::json> list_of(const PatientCommandOptions& options, const Population& population) {
  auto json = nlohmann::json{{"patients", nlohmann::json::array()},
                             {"quantities", nlohmann::json::array()}};
  for (const KnownPatient& p : population.profiles)
    json["patients"].push_back({{"name", p.name},
                                {"title", p.title},
                                {"values", values_json(p.values)},
                                {"source", p.source}});
  for (const Quantity& q : population.quantities)
    json["quantities"].push_back(
        {{"name", q.name}, {"title", q.title}, {"unit", q.unit}, {"source", q.source}});
  if (options.joint.empty()) return json;
  const auto joint = read_joint(options.joint);
  ARTUS_TRY(joint);
  json["parameters"] = nlohmann::json::array();
  for (const JointParameter& p : joint->parameters)
    json["parameters"].push_back(
        {{"name", p.name},
         {"title", p.title},
         {"unit", p.unit},
         {"modelled", p.modelled},
         {"least", p.least},
         {"most", p.most},
         {"usual", p.usual ? nlohmann::json(*p.usual) : nlohmann::json()}});
  return json;
}

void print_list(const nlohmann::json& list) {
  const auto text = [](const nlohmann::json& one, const char* key) {
    return one.at(key).get<std::string>();
  };
  for (const auto& p : list.at("patients"))
    std::printf("%-16s %s\n", text(p, "name").c_str(), text(p, "title").c_str());
  std::printf("\n");
  if (!list.contains("parameters")) {
    for (const auto& q : list.at("quantities"))
      std::printf("%-16s %s %s\n", text(q, "name").c_str(), text(q, "title").c_str(),
                  text(q, "unit").c_str());
    return;
  }
  for (const auto& p : list.at("parameters"))
    std::printf("%-16s %s, %g to %g %s, modelled %g\n", text(p, "name").c_str(),
                text(p, "title").c_str(), p.at("least").get<double>(), p.at("most").get<double>(),
                text(p, "unit").c_str(), p.at("modelled").get<double>());
}

/// What a joint would be given, or all that is known of the patient where there is none.
Result<std::vector<PatientValue>> values_of(const PatientCommandOptions& options,
                                            const std::string& patient) {
  if (!options.joint.empty()) {
    const auto joint = read_joint(with_patient(options.joint, patient));
    ARTUS_TRY(joint);
    return joint->patient;
  }
  const auto population = read_bundled_population();
  ARTUS_TRY(population);
  std::vector<JointParameter> any;
  for (const Quantity& q : population->quantities)
    any.push_back({q.name, q.title, q.unit, 0, -1e6, 1e6});
  return resolve_patient(patient, any);
}

ExitCode run_patient(const PatientCommandOptions& options) {
  if (options.what == "list") {
    const auto population = read_bundled_population();
    if (!population) return report_error(population.error(), options.json);
    const auto list = list_of(options, *population);
    if (!list) return report_error(list.error(), options.json);
    if (options.json)
      std::cout << list->dump(2) << '\n';
    else
      print_list(*list);
    return ExitCode::ok;
  }
  if (options.what == "show" && options.patient.empty())
    return report_error(
        {ErrorCode::malformed, "say whom to show: artus patient show NAME", "--patient"},
        options.json);
  auto all = nlohmann::json::array();
  const std::int64_t count = options.what == "draw" ? options.count : 1;
  for (std::int64_t i = 0; i < count; ++i) {
    const std::string drawn = "seed=" + std::to_string(options.seed + i);
    const std::string patient = options.what == "show"    ? options.patient
                                : options.patient.empty() ? drawn
                                                          : options.patient + "," + drawn;
    const auto values = values_of(options, patient);
    if (!values) return report_error(values.error(), options.json);
    if (options.json)
      all.push_back({{"patient", patient}, {"values", values_json(*values)}});
    else
      std::printf("%s\n", to_text(*values).c_str());
  }
  if (options.json) std::cout << all.dump(2) << '\n';
  return ExitCode::ok;
}

}  // namespace

void add_patient_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<PatientCommandOptions>();
  Command* command = add_command(
      app, "patient", "List, show and draw patients: what differs from body to body",
      "list: those that have a name, and what a joint can be given. show: the values of one. "
      "draw:\n"
      "values from the published distributions, given those of a patient. What is printed can be\n"
      "said wherever a patient can, and after '@' behind a joint.\n"
      "Examples:\n"
      "  artus patient list -j meshes/shoulder\n"
      "  artus patient show obese_m_bmi38 -j meshes/shoulder\n"
      "  artus patient draw bmi=38 --seed 7 --count 5 -j meshes/shoulder\n"
      "  artus image -j meshes/shoulder@seed=7 -o drawn.png");
  command->add_option("what", options->what, "list, show or draw")
      ->required()
      ->one_of({"list", "show", "draw"});
  command->add_option("patient", options->patient,
                      "a name, fat=12, or several with commas between");
  command->add_option("--joint,-j", options->joint, "the joint that is to be this patient's");
  command->add_option("--seed", options->seed, "of the first that is drawn")
      ->check(whole_number_in(0, 1000000000))
      ->capture_default_str();
  command->add_option("--count", options->count, "how many are drawn, of this seed and the next")
      ->check(whole_number_in(1, 100000))
      ->capture_default_str();
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_patient(*options); });
}

}  // namespace artus
