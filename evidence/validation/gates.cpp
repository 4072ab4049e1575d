// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/gates.h"

#include <algorithm>
#include <filesystem>

#include "artus/detail/core/known_names.h"

namespace artus {
namespace {

bool has_enough(const GateEntry& entry, const GateOptions& options) {
  if (entry.needs == GateNeeds::nothing) return true;
  if (entry.needs == GateNeeds::reference) return std::filesystem::is_directory(options.reference);
  return options.joint != nullptr &&
         (entry.needs == GateNeeds::joint || !options.reference.empty());
}

}  // namespace

Result<const GateSet*> find_gate_set(std::string_view name) {
  const auto at = find_name(item_names(gate_sets()), name, "set of gates");
  ARTUS_TRY(at);
  return &gate_sets()[*at];
}

std::vector<std::string_view> gate_names(std::string_view set) {
  std::vector<std::string_view> names;
  for (const GateEntry& entry : gate_entries())
    if (entry.set == set) names.push_back(entry.name);
  return names;
}

std::vector<std::string_view> gate_names(std::string_view set, const GateOptions& options) {
  std::vector<std::string_view> names;
  for (const GateEntry& entry : gate_entries())
    if (entry.set == set && has_enough(entry, options)) names.push_back(entry.name);
  return names;
}

Result<Gate> run_gate(std::string_view set, std::string_view name, const GateOptions& options) {
  ARTUS_TRY(find_name(gate_names(set), name, "gate of " + std::string(set)));
  const auto entries = gate_entries();
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const GateEntry& entry) {
    return entry.set == set && entry.name == name;
  });
  if (!has_enough(*found, options))
    return fail(ErrorCode::malformed,
                "gate \"" + std::string(name) +
                    (found->needs == GateNeeds::joint ? "\" measures a joint: needs -j"
                     : found->needs == GateNeeds::reference
                         ? "\" needs the folder of real pictures: --reference DIR"
                         : "\" needs -j and --reference"));
  if (set != "needle")
    ARTUS_TRY(
        check(options.feel, {std::string(name), {}, 0, "has no law of the needle to choose"}));
  Result<Gate> gate = found->run(name, options);
  ARTUS_TRY(gate);
  gate->name = name;
  const bool apart = (*find_gate_set(set))->apart;
  for (NamedPlot& plot : gate->plots)
    if (plot.file.empty()) plot.file = (apart ? "" : "pictures/") + gate->name + ".svg";
  return gate;
}

}  // namespace artus
