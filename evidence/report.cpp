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
  std::vector<std::string> pictures;
  for (const NamedPlot& plot : report.plots) pictures.push_back(plot.file);
  for (const NamedFile& file : report.files)
    if (std::filesystem::path(file.file).extension() == ".png") pictures.push_back(file.file);
  if (!pictures.empty()) text += "\n";
  for (const std::string& picture : pictures)
    text += "![" + report.name + "](" + folder + "/" + picture + ")\n";
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

Result<void> write_files(const EvidenceReport& report, const std::filesystem::path& folder) {
  ARTUS_TRY(make_folder(folder));
  for (const NamedFile& file : report.files) {
    ARTUS_TRY(make_folder((folder / file.file).parent_path()));
    ARTUS_TRY(file.write(folder / file.file));
  }
  for (const NamedPlot& plot : report.plots) {
    ARTUS_TRY(make_folder((folder / plot.file).parent_path()));
    ARTUS_TRY(write_plot(folder / plot.file, plot.plot));
  }
  return {};
}

Result<void> write_report(const EvidenceReport& report, const std::filesystem::path& folder) {
  ARTUS_TRY(make_folder(folder));
  if (!report.tables.empty())
    ARTUS_TRY(write_text(folder / (report.name + "-table.csv"),
                         to_csv_text(report.tables.front().second)));
  ARTUS_TRY(write_text(folder / "report.md", "# " + report.name + "\n\n" + to_markdown(report)));
  ARTUS_TRY(write_text(folder / "verdict.json", verdict(report).dump(2) + "\n"));
  return write_files(report, folder);
}

}  // namespace artus
