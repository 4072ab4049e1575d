// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/plot.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "artus/detail/core/csv.h"

namespace artus {
namespace {

namespace fs = std::filesystem;

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

// One index block of the data file per series.
void write_data(std::ostream& out, const Plot& plot) {
  for (const PlotPanel& panel : plot.panels) {
    for (const PlotSeries& series : panel.series) {
      for (std::size_t i = 0; i < series.x.size() && i < series.y.size(); ++i) {
        out << to_csv(series.x[i]) << ' ' << to_csv(series.y[i]) << '\n';
      }
      out << "\n\n";
    }
  }
}

// Characters right of the panels, the same for all, so that their axes stand under one another.
std::size_t key_width(const Plot& plot) {
  constexpr std::size_t kSample = 8;
  std::size_t longest = 0;
  for (const PlotPanel& panel : plot.panels)
    for (const PlotSeries& series : panel.series) longest = std::max(longest, series.label.size());
  return longest + kSample;
}

void write_script(std::ostream& out, const Plot& plot, const fs::path& data, const fs::path& png) {
  const auto rows = plot.panels.size();
  out << "set terminal pngcairo size " << plot.width << ','
      << plot.panel_height * static_cast<int>(rows) + 40 << " noenhanced font 'sans,11'\n"
      << "set output " << quoted(png.string()) << "\nset grid\nset lmargin 10\nset rmargin "
      << key_width(plot) << "\nset key outside right top\n"
      << "set multiplot layout " << rows << ",1 title " << quoted(plot.title) << '\n';
  std::size_t index = 0;
  for (const PlotPanel& panel : plot.panels) {
    out << (panel.log_y ? "set logscale y\nunset offsets\n"
                        : "unset logscale y\nset offsets graph 0, graph 0, graph 0.05, graph "
                          "0.05\n")
        << "set xlabel " << quoted(panel.x_label) << "\nset ylabel " << quoted(panel.y_label)
        << "\nplot ";
    for (std::size_t i = 0; i < panel.series.size(); ++i) {
      out << (i == 0 ? "" : ", ") << quoted(data.string()) << " index " << index++ << " with "
          << panel.series[i].style << " title " << quoted(panel.series[i].label);
    }
    out << '\n';
  }
  out << "unset multiplot\n";
}

Result<int> run_gnuplot(const fs::path& script) {
  std::string program = "gnuplot";
  std::string argument = script.string();
  std::array<char*, 3> arguments{program.data(), argument.data(), nullptr};
  posix_spawn_file_actions_t quiet{};
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int error = posix_spawnp(&child, "gnuplot", &quiet, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&quiet);
  if (error != 0) {
    return fail(ErrorCode::not_found, "gnuplot is not installed (package gnuplot-nox)");
  }
  int status = 0;
  if (waitpid(child, &status, 0) < 0)
    return fail(ErrorCode::failed, "gnuplot could not be awaited");
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

Result<void> write_plot(const fs::path& png, const Plot& plot) {
  std::string folder = (fs::temp_directory_path() / "artus-plot-XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) {
    return fail(ErrorCode::unreadable, "cannot make a temporary folder", folder);
  }
  const fs::path data = fs::path(folder) / "plot.dat";
  const fs::path script = fs::path(folder) / "plot.gp";
  std::ofstream data_out(data, std::ios::binary);
  write_data(data_out, plot);
  data_out.close();
  std::ofstream script_out(script, std::ios::binary);
  write_script(script_out, plot, data, png);
  script_out.close();
  const bool written = static_cast<bool>(data_out) && static_cast<bool>(script_out);
  std::error_code ignored;
  const Result<int> exit = written ? run_gnuplot(script) : Result<int>(-1);
  fs::remove_all(folder, ignored);
  ARTUS_TRY(exit);
  if (*exit == 127) return fail(ErrorCode::not_found, "gnuplot is not installed");
  if (*exit != 0 || !fs::exists(png)) {
    return fail(ErrorCode::failed, "gnuplot could not draw the plot", png.string());
  }
  return {};
}

}  // namespace artus
