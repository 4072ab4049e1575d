// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/evidence/probe/probe_experiment.h"

#include <array>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "artus/core/csv.h"
#include "artus/core/text_file.h"
#include "artus/evidence/probe/probe_experiment_list.h"

namespace artus {
namespace {

namespace fs = std::filesystem;

using Run = ProbeExperiment (*)(const ProbeExperimentOptions&);

constexpr std::array<std::string_view, 3> kNames{"probe-isp", "probe-ssp", "probe-study"};
constexpr std::array<Run, kNames.size()> kRuns{run_probe_isp, run_probe_ssp, run_probe_study};

std::string markdown_row(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + cell + " |";
  return line + "\n";
}

std::string markdown_table(const TextTable& table) {
  std::string text = markdown_row(table.header) + "|";
  for (std::size_t i = 0; i < table.header.size(); ++i) text += "---|";
  text += "\n";
  for (const auto& row : table.rows) text += markdown_row(row);
  return text + "\n";
}

TextTable observation_table(const ProbeExperiment& e) {
  TextTable table{{"observation", "published", "artus", "difference", "verdict", "likely cause",
                   "parameter fitted to it"},
                  {}};
  for (const ProbeObservation& o : e.observations) {
    table.rows.push_back({o.what, o.published, fixed(o.artus, 3) + " " + o.unit, o.difference,
                          o.reproduced ? "reproduced" : "refuted", o.cause,
                          o.fitted.empty() ? "none" : o.fitted});
  }
  return table;
}

std::string make_report(const ProbeExperiment& e) {
  std::string text = "# " + e.name + "\n\n" + e.title + "\n\n";
  if (!e.observations.empty()) text += markdown_table(observation_table(e));
  for (const auto& [title, table] : e.tables) text += title + "\n\n" + markdown_table(table);
  return text + to_markdown(e.claims);
}

nlohmann::json make_verdict(const ProbeExperiment& e) {
  nlohmann::json json = verdict(e.claims);
  json["experiment"] = e.name;
  json["title"] = e.title;
  nlohmann::json list = nlohmann::json::array();
  for (const ProbeObservation& o : e.observations) {
    list.push_back({{"observation", o.what},
                    {"published", o.published},
                    {"artus", o.artus},
                    {"unit", o.unit},
                    {"difference", o.difference},
                    {"verdict", o.reproduced ? "reproduced" : "refuted"},
                    {"cause", o.cause},
                    {"fitted", o.fitted}});
  }
  json["observations"] = list;
  return json;
}

std::string make_csv(const TextTable& table) {
  std::string text;
  const auto add = [&text](const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      text += (i == 0 ? "\"" : ",\"") + cells[i] + "\"";
    }
    text += "\n";
  };
  add(table.header);
  for (const auto& row : table.rows) add(row);
  return text;
}

Result<void> write_texts(const ProbeExperiment& e, const fs::path& folder) {
  for (const ProbeTrace& trace : e.traces) {
    auto written =
        write_text(folder / (e.name + "-" + trace.label + ".csv"), probe_csv(trace.rows));
    if (!written) return written;
  }
  const bool published = !e.observations.empty();
  ARTUS_TRY(write_text(
      folder / (e.name + "-table.csv"),
      make_csv(published || e.tables.empty() ? observation_table(e) : e.tables.front().second)));
  ARTUS_TRY(write_text(folder / "report.md", make_report(e)));
  return write_text(folder / "verdict.json", make_verdict(e).dump(2) + "\n");
}

}  // namespace

std::string fixed(double value, int digits) {
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.*f", digits, value);
  return buffer.data();
}

std::span<const std::string_view> probe_experiments() noexcept {
  return kNames;
}

Result<ProbeExperiment> run_probe_experiment(std::string_view name,
                                             const ProbeExperimentOptions& options) {
  std::string all;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) return kRuns[i](options);
    all += (all.empty() ? "" : ", ") + std::string(kNames[i]);
  }
  return fail(ErrorCode::not_found,
              "no probe experiment \"" + std::string(name) + "\"; there are " + all);
}

Result<void> write_probe_experiment(const ProbeExperiment& e, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return fail(ErrorCode::unreadable, error.message(), folder.string());
  ARTUS_TRY(write_texts(e, folder));
  for (const NamedPlot& plot : e.plots) {
    ARTUS_TRY(write_plot(folder / plot.file, plot.plot));
  }
  return {};
}

Result<std::vector<Claim>> run_and_write_probe_experiment(std::string_view name,
                                                          const fs::path& folder,
                                                          const ProbeExperimentOptions& options) {
  const auto experiment = run_probe_experiment(name, options);
  ARTUS_TRY(experiment);
  const auto written = write_probe_experiment(*experiment, folder);
  ARTUS_TRY(written);
  return experiment->claims;
}

}  // namespace artus
