// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "artus/core/result.h"
#include "artus/detail/core/plot.h"
#include "artus/detail/evidence/claim.h"
#include "artus/detail/evidence/table.h"

namespace artus {

/// What the source says of its experiment, beside what this one shows.
struct PublishedValue {
  std::string what;
  std::string published;  ///< in the source's words and figures
  std::string artus;      ///< value and unit
};

/// A plot and the file it goes to.
struct NamedPlot {
  std::string file;  ///< without folder
  Plot plot;
};

/// What lies beside a report: a trace, a picture, a folder of such.
struct NamedFile {
  std::string file;  ///< under the report's folder
  std::function<Result<void>(const std::filesystem::path&)> write;
};

/// What an experiment has to say, whatever it was made with.
struct EvidenceReport {
  std::string name;
  std::string title;   ///< what it shows
  std::string source;  ///< figures, tables and equations of the source it stands beside
  std::vector<PublishedValue> published;
  std::vector<std::string> assumed;  ///< numbers that it rests on without a source, bounds too
  std::vector<std::pair<std::string, TextTable>> tables;  ///< with what each shows
  std::vector<NamedPlot> plots;
  std::vector<Claim> claims;
  std::vector<NamedFile> files;
};

/// Title, source, published values, assumptions, plots, pictures, claims and tables in Markdown,
/// without a heading. `folder`: where the plots lie, as seen from the text's file.
[[nodiscard]] std::string to_markdown(const EvidenceReport& report,
                                      const std::string& folder = ".");

/// verdict(claims), and name, title, source, published values and assumptions.
[[nodiscard]] nlohmann::json verdict(const EvidenceReport& report);

/// Writes the files and plots into `folder`. Errors: those of the files; unreadable.
[[nodiscard]] Result<void> write_files(const EvidenceReport& report,
                                       const std::filesystem::path& folder);

/// The same, and <name>-table.csv (the first table), report.md and verdict.json.
[[nodiscard]] Result<void> write_report(const EvidenceReport& report,
                                        const std::filesystem::path& folder);

}  // namespace artus
