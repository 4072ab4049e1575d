// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/gate_report.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/evidence/validation/needle/experiment.h"

namespace artus {
namespace {

std::vector<Claim> claims_of(const MeasuredSet& measured) {
  return all_claims({&measured, 1});
}

const TextTable* find_beside(const Gate& gate) {
  for (const auto& [title, table] : gate.tables)
    if (title == kBesideTable) return &table;
  return nullptr;
}

nlohmann::json verdict_of_gate(const Gate& gate) {
  nlohmann::json json = verdict(gate);
  if (const TextTable* beside = find_beside(gate))
    for (const auto& row : beside->rows) json["with_tissue"][row[0]] = row[3];
  return json;
}

TextTable overview(const MeasuredSet& measured) {
  TextTable table{{"gate", "what", "claims", "hold", "rests on an assumed value"}, {}};
  for (const Gate& gate : measured.gates) {
    const auto held = std::count_if(gate.claims.begin(), gate.claims.end(),
                                    [](const Claim& claim) { return claim.pass; });
    table.rows.push_back({gate.name, gate.title, std::to_string(gate.claims.size()),
                          all_hold(gate.claims) ? "all" : std::to_string(held),
                          gate.assumed.empty() ? "" : "yes"});
  }
  return table;
}

/// A cell that may hold what Markdown takes for a border.
std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
    text.insert(at, "\\");
  return text;
}

TextTable claims_table(const Gate& gate) {
  TextTable table{{"claim", "kind", "measured", "bound", "holds"}, {}};
  for (const Claim& c : gate.claims)
    table.rows.push_back(
        {cell(c.text),
         to_string(c.basis.kind) + (c.basis.why.empty() ? std::string() : ": " + cell(c.basis.why)),
         printed("%.4g", c.value), cell(c.bound), c.pass ? "yes" : "**no**"});
  return table;
}

}  // namespace

std::vector<Claim> all_claims(std::span<const MeasuredSet> sets) {
  std::vector<Claim> all;
  for (const MeasuredSet& measured : sets)
    for (const Gate& gate : measured.gates)
      for (Claim claim : gate.claims) {
        claim.text = gate.name + ": " + claim.text;
        all.push_back(std::move(claim));
      }
  return all;
}

nlohmann::json verdict(const MeasuredSet& measured) {
  nlohmann::json json = verdict(claims_of(measured));
  json["set"] = measured.set->name;
  json["title"] = measured.set->title;
  json["source"] = measured.set->source;
  for (const Gate& gate : measured.gates) json["gates"][gate.name] = verdict_of_gate(gate);
  // As `artus experiment` told them; to go with that name, in the version after 0.2.
  if (measured.set->apart) json.update(json["gates"]);
  return json;
}

nlohmann::json verdict(std::span<const MeasuredSet> sets) {
  if (sets.size() == 1) return verdict(sets.front());
  nlohmann::json json = verdict(all_claims(sets));
  json.erase("claims");
  for (const MeasuredSet& measured : sets) {
    json["sets"][std::string(measured.set->name)] = verdict(measured);
    if (measured.set->apart)  // as above
      for (const Gate& gate : measured.gates) json[gate.name] = verdict_of_gate(gate);
  }
  return json;
}

Result<void> write_report(const MeasuredSet& measured, const std::filesystem::path& folder) {
  const GateSet& set = *measured.set;
  if (set.apart && measured.gates.size() == 1) return write_report(measured.gates.front(), folder);
  const TextTable table = overview(measured);
  std::string report = "# " + std::string(set.title) + "\n\nBeside " + std::string(set.source) +
                       ".\n\n" + to_markdown(table) + "\n" + count_claims(claims_of(measured)) +
                       ".\n";
  for (const Gate& gate : measured.gates) {
    report += "\n## " + gate.name + (all_hold(gate.claims) ? "" : " - does not hold") + "\n\n" +
              to_markdown(gate, set.apart ? gate.name : ".");
    ARTUS_TRY(set.apart ? write_report(gate, folder / gate.name) : write_files(gate, folder));
  }
  ARTUS_TRY(write_text(folder / (std::string(set.name) + "-table.csv"), to_csv_text(table)));
  ARTUS_TRY(write_text(folder / "report.md", report));
  return write_text(folder / set.verdict_file, verdict(measured).dump(2) + "\n");
}

std::string results_page(const MeasuredSet& measured, const Provenance& from) {
  std::string page = "# " + std::string(measured.set->title) + "\n\n" +
                     to_markdown(TextTable{{"", ""},
                                           {{"date", from.date},
                                            {"commit", from.commit},
                                            {"command", "`" + cell(from.command) + "`"},
                                            {"processor", from.processor},
                                            {"compiler", from.compiler},
                                            {"build type", from.build_type}}}) +
                     "\nBeside " + std::string(measured.set->source) + ". " +
                     count_claims(claims_of(measured)) +
                     ".\nWritten by the command above; how to read it: [results](README.md).\n";
  for (const Gate& gate : measured.gates) {
    page += "\n## " + gate.name + "\n" + gate.title + ".\n\n" + to_markdown(claims_table(gate));
    if (const TextTable* beside = find_beside(gate))
      page += "\n" + std::string(kBesideTable) + ":\n\n" + to_markdown(*beside);
  }
  return page;
}

}  // namespace artus
