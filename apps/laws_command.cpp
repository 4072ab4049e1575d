// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/core/known_names.h"
#include "artus/detail/haptics/needle/law_catalogue.h"
#include "artus/detail/haptics/needle/laws/layer_haptics.h"

namespace artus {
namespace {

struct LawsOptions {
  std::string name;
  std::filesystem::path tissues;
  bool json = false;
};

/// Those whose name or component has the text in it; all for an empty one.
std::vector<LawDescription> find_laws(const std::string& text) {
  std::vector<LawDescription> found;
  for (LawDescription& law : describe_laws())
    if (law.name.find(text) != std::string_view::npos ||
        law.component.find(text) != std::string_view::npos)
      found.push_back(std::move(law));
  return found;
}

std::string words(std::string_view text) {
  return std::string(text);
}

void print(const LawDescription& law) {
  std::printf("%s: %s%s%s\n", words(law.component).c_str(), words(law.name).c_str(),
              law.chosen_by.empty() ? "" : "   ", words(law.chosen_by).c_str());
  std::printf("    %s\n    source %s\n", words(law.says).c_str(), words(law.source).c_str());
  for (const LawParameter& p : law.parameters)
    std::printf("    %-20s %12g %-10s %s\n", words(p.name).c_str(), p.value, words(p.unit).c_str(),
                words(p.source).c_str());
}

void print(const std::vector<Tissue>& tissues) {
  std::printf("\n%-20s %-14s %-15s %6s %8s %6s %8s %9s %8s %5s\n", "tissue", "cutting law",
              "pre-puncture", "f_R N", "K_t N/m", "f_A N", "friction", "clamp N/m", "punct. N",
              "hard");
  for (const Tissue& tissue : tissues) {
    const Haptic& h = tissue.haptic;
    std::printf("%-20s %-14s %-15s %6g %8g %6g %8g %9g %8g %5s\n", tissue.name.c_str(),
                to_string(h.cutting_law), to_string(h.prepuncture_law), h.cutting_force,
                h.wall_stiffness, h.attracted_force, h.friction, h.clamping_stiffness,
                h.puncture_force, h.hard ? "yes" : "");
    const auto source = tissue.source.find("haptic");
    if (source != tissue.source.end()) std::printf("    source %s\n", source->second.c_str());
  }
}

nlohmann::json to_json(const LawDescription& law) {
  auto parameters = nlohmann::json::array();
  for (const LawParameter& p : law.parameters)
    parameters.push_back({{"name", words(p.name)},
                          {"value", p.value},
                          {"unit", words(p.unit)},
                          {"source", words(p.source)}});
  return {{"component", words(law.component)}, {"name", words(law.name)},
          {"chosen_by", words(law.chosen_by)}, {"says", words(law.says)},
          {"source", words(law.source)},       {"parameters", parameters}};
}

nlohmann::json to_json(const Tissue& tissue) {
  const Haptic& h = tissue.haptic;
  const auto source = tissue.source.find("haptic");
  return {{"name", tissue.name},
          {"cutting_law", to_string(h.cutting_law)},
          {"prepuncture_law", to_string(h.prepuncture_law)},
          {"cutting_force_n", h.cutting_force},
          {"wall_stiffness_n_m", h.wall_stiffness},
          {"attracted_force_n", h.attracted_force},
          {"friction", h.friction},
          {"clamping_stiffness_n_m", h.clamping_stiffness},
          {"puncture_force_n", h.puncture_force},
          {"hard", h.hard},
          {"source", source == tissue.source.end() ? "" : source->second}};
}

ExitCode run_laws(const LawsOptions& options) {
  const std::vector<LawDescription> laws = find_laws(options.name);
  if (laws.empty()) {
    const auto there_are = describe_laws();
    return report_error(find_name(item_names(there_are), options.name, "law", "name").error(),
                        options.json);
  }
  const auto tissues =
      options.tissues.empty() ? read_bundled_tissues() : read_tissues(options.tissues);
  if (!tissues) return report_error(tissues.error(), options.json);
  if (options.json) {
    nlohmann::json json{{"laws", nlohmann::json::array()}, {"tissues", nlohmann::json::array()}};
    for (const LawDescription& law : laws) json["laws"].push_back(to_json(law));
    for (const Tissue& tissue : *tissues) json["tissues"].push_back(to_json(tissue));
    std::cout << json.dump(2) << '\n';
    return ExitCode::ok;
  }
  for (const LawDescription& law : laws) print(law);
  if (options.name.empty()) print(*tissues);
  return ExitCode::ok;
}

}  // namespace

void add_laws_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<LawsOptions>();
  Command* command =
      add_command(app, "laws", "List the needle's force laws, their parameters and the tissues",
                  "Every value with unit and source; then what each tissue of the library is felt "
                  "by.\n"
                  "Examples:\n"
                  "  artus laws\n"
                  "  artus laws friction\n"
                  "  artus laws voigt --json");
  command->add_option("name", options->name, "only laws with this in their name or component");
  command->add_option("--tissues", options->tissues, "a tissue library (default: the bundled one)");
  command->add_flag("--json", options->json, "machine-readable");
  on_run(command, code, [options] { return run_laws(*options); });
}

}  // namespace artus
