// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/report.h"

#include <nlohmann/json.hpp>

#include "artus/detail/core/text_file.h"

namespace artus {

std::string to_markdown(const EvidenceReport& report, const std::string& folder) {
  std::string text = report.title + "\n";
  if (!report.source.empty()) text += "\nBeside " + report.source + ".\n";
  if (!report.published.empty()) {
    TextTable published{{"what", "published", "artus"}, {}};
    for (const PublishedValue& p : report.published)
      published.rows.push_back({p.what, p.published, p.artus});
    text += "\n" + to_markdown(published);
  }
  if (!report.plots.empty()) text += "\n";
  for (const NamedPlot& plot : report.plots)
    text += "![" + report.name + "](" + folder + "/" + plot.file + ")\n";
  text += "\n" + to_markdown(report.claims);
  for (const auto& [title, table] : report.tables)
    text += (title.empty() ? "\n" : "\n" + title + "\n\n") + to_markdown(table);
  if (report.assumed.empty()) return text;
  text += "\nAssumed, without a source:\n\n";
  for (const std::string& number : report.assumed) text += "- " + number + "\n";
  return text;
}

nlohmann::json verdict(const EvidenceReport& report) {
  nlohmann::json json = verdict(report.claims);
  json["experiment"] = report.name;
  json["title"] = report.title;
  json["source"] = report.source;
  json["assumed"] = report.assumed;
  json["published"] = nlohmann::json::array();
  for (const PublishedValue& p : report.published)
    json["published"].push_back({{"what", p.what}, {"published", p.published}, {"artus", p.artus}});
  return json;
}

Result<void> write_report(const EvidenceReport& report, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail(ErrorCode::unreadable, error.message(), folder.string());
  if (!report.tables.empty())
    ARTUS_TRY(write_text(folder / (report.name + "-table.csv"),
                         to_csv_text(report.tables.front().second)));
  ARTUS_TRY(write_text(folder / "report.md", "# " + report.name + "\n\n" + to_markdown(report)));
  ARTUS_TRY(write_text(folder / "verdict.json", verdict(report).dump(2) + "\n"));
  for (const NamedPlot& plot : report.plots) ARTUS_TRY(write_plot(folder / plot.file, plot.plot));
  return {};
}

}  // namespace artus
