// SPDX-License-Identifier: AGPL-3.0-or-later
// The main job on simple-shoulder against committed results. Each golden has a JSON sidecar with
// what made it and how far a run may stray (another compiler or CGAL moves the mesh a little).
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/echo/display/frame_measure.h"
#include "artus/detail/evidence/runs/three_injections.h"
#include "artus/echo/image_io.h"
#include "artus/echo/labels.h"
#include "artus/echo/renderer.h"
#include "tests/golden/picture_difference.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

const std::filesystem::path kExpected = artus::test::source_dir() / "tests/golden/expected";
const std::filesystem::path kOutput = ARTUS_GOLDEN_OUTPUT;

bool updating() {
  return std::getenv("ARTUS_UPDATE_GOLDENS") != nullptr;
}

nlohmann::json sidecar(const std::string& name) {
  return nlohmann::json::parse(std::ifstream(kExpected / (name + ".json")));
}

std::shared_ptr<const Scene> simple_shoulder() {
  auto joint = read_compiled_joint(artus::test::test_joints() / "simple-shoulder.artus");
  if (!joint) throw std::runtime_error(joint.error().to_string());
  return std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(std::move(*joint)));
}

const ThreeInjections& the_run() {
  static const ThreeInjections run = [] {
    const auto scene = simple_shoulder();
    auto result = run_three_injections(*scene, scene->joint().injections);
    if (!result) throw std::runtime_error(result.error().to_string());
    return *std::move(result);
  }();
  return run;
}

// ---- the force trace: every 25th millisecond, the components a reader would plot

constexpr std::size_t kStride = 25;
constexpr std::size_t kColumns = 11;
const char* const kHeader =
    "time_s,depth_mm,region,cutting_n,attracted_n,friction_n,clamping_n,hard_n,total_n,"
    "probe_normal_n,probe_friction_n";

std::vector<std::array<double, kColumns>> sample_trace(const ThreeInjections& run) {
  std::vector<std::array<double, kColumns>> rows;
  for (std::size_t i = 0; i < run.rows.size(); i += kStride) {
    const NeedleRow& r = run.rows[i];
    rows.push_back({r.time, r.depth * 1e3, static_cast<double>(r.region), r.forces.cutting,
                    r.forces.attracted, r.forces.friction, r.forces.clamping.norm(), r.forces.hard,
                    r.command.force.norm(), run.probe[i].normal_force,
                    run.probe[i].friction.norm()});
  }
  return rows;
}

void write_trace(const std::filesystem::path& file,
                 const std::vector<std::array<double, kColumns>>& rows) {
  std::ofstream out(file);
  out << kHeader << '\n';
  for (const auto& row : rows)
    for (std::size_t c = 0; c < kColumns; ++c) {
      char text[32];
      std::snprintf(text, sizeof text, "%.5g", row[c]);
      out << text << (c + 1 < kColumns ? ',' : '\n');
    }
}

std::vector<std::array<double, kColumns>> read_trace(const std::filesystem::path& file) {
  std::vector<std::array<double, kColumns>> rows;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    std::string cell;
    std::array<double, kColumns> row{};
    for (double& value : row) {
      std::getline(cells, cell, ',');
      value = std::stod(cell);
    }
    rows.push_back(row);
  }
  return rows;
}

TEST(ThreeInjectionsGolden, ForceTraceIsTheCommittedOne) {
  const auto actual = sample_trace(the_run());
  const auto file = kExpected / "three-injections-trace.csv";
  const auto old = read_trace(file);
  std::array<double, kColumns> rms{};
  const std::size_t n = std::min(actual.size(), old.size());
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t c = 0; c < kColumns; ++c) rms[c] += std::pow(actual[i][c] - old[i][c], 2);
  for (double& value : rms) value = n > 0 ? std::sqrt(value / static_cast<double>(n)) : 0;
  std::cout << "golden trace: " << old.size() << " -> " << actual.size() << " rows, rms change";
  for (const double value : rms) std::cout << ' ' << value;
  std::cout << '\n';
  if (updating()) {
    write_trace(file, actual);
    return;
  }
  const auto tolerance = sidecar("three-injections-trace").at("tolerance");
  bool good = std::abs(static_cast<double>(actual.size()) - static_cast<double>(old.size())) <=
              tolerance.at("rows").get<double>();
  good = good && rms[1] <= tolerance.at("depth_rms_mm").get<double>();
  for (std::size_t c = 3; c < kColumns; ++c)
    good = good && rms[c] <= tolerance.at("force_rms_n").get<double>();
  if (!good) {
    std::filesystem::create_directories(kOutput);
    write_trace(kOutput / "three-injections-trace.csv", actual);
  }
  EXPECT_TRUE(good) << "actual trace in " << kOutput;
}

// ---- two images: the bursa reached, and the bone touched

class ImageGolden : public testing::TestWithParam<const char*> {};

/// Where the bone's line and the needle are in a picture, by the labels of its plane.
test::Landmarks find_landmarks(const LabelImage& labels, const CompiledJoint& joint) {
  test::Landmarks marks;
  marks.pixel_mm = labels.pixel * 1e3;
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(labels.width) +
           static_cast<std::size_t>(x);
  };
  for (int x = 0; x < labels.width; x += marks.bone_step) {
    int row = 0;
    while (row < labels.height && (labels.regions[at(x, row)] < kFirstRegion ||
                                   joint.tissue_of(labels.regions[at(x, row)]).name != "bone"))
      ++row;
    marks.bone.push_back(row < labels.height ? row : -1);
  }
  bool begun = false;
  for (int x = 0; x < labels.width; ++x) {
    int sum = 0;
    int n = 0;
    for (int y = 0; y < labels.height; ++y)
      if (labels.needle[at(x, y)] != 0) {
        sum += y;
        ++n;
      }
    if (n == 0) continue;
    if (!begun) marks.needle_in = {x, sum / n};
    marks.needle_to = {x, sum / n};
    begun = true;
  }
  return marks;
}

/// Sound is faster in tendon and muscle than the scanner assumes: bone's echo stands above its
/// place, where the picture is brightest.
void follow_echo(test::Landmarks& marks, const cv::Mat& picture) {
  constexpr int kAbove = 25;  // px
  constexpr int kBelow = 8;   // px
  for (std::size_t i = 0; i < marks.bone.size(); ++i) {
    const int x = static_cast<int>(i) * marks.bone_step;
    if (marks.bone[i] < 0) continue;
    const int from = std::max(0, marks.bone[i] - kAbove);
    const int to = std::min(picture.rows, marks.bone[i] + kBelow);
    const int left = std::max(0, x - 1);
    const int right = std::min(picture.cols, x + 2);
    double brightest = -1;
    for (int row = from; row < to; ++row) {
      const double here = cv::mean(picture(cv::Range(row, row + 1), cv::Range(left, right)))[0];
      if (here <= brightest) continue;
      brightest = here;
      marks.bone[i] = row;
    }
  }
}

TEST_P(ImageGolden, ShowsNothingThatASonographerWouldSee) {
  const std::string label = GetParam();
  const auto& run = the_run();
  const NamedMoment* moment = nullptr;
  for (const auto& m : run.moments)
    if (moment == nullptr && m.label == label) moment = &m;
  ASSERT_NE(moment, nullptr) << "no moment called " << label;
  NeedleShape shape;
  shape.length = run.needle_length;
  const NeedleView needle{moment->X_JN, shape};
  const auto scene = simple_shoulder();
  Renderer renderer(scene, Transducer{}, raw_settings());
  renderer.set_contact(moment->coverage);
  const cv::Mat actual = grey_image(renderer.render(moment->X_JP, needle));

  std::string name = "bmode-" + label;
  for (char& c : name)
    if (c == ' ') c = '-';
  const auto file = kExpected / (name + ".png");
  const cv::Mat old = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
  const bool same_size = old.size() == actual.size();
  if (updating()) {
    test::Landmarks marks =
        find_landmarks(render_labels(*scene, moment->X_JP, {}, {}, needle), scene->joint());
    follow_echo(marks, actual);
    if (same_size)
      std::cout << "golden " << name << ": " << to_text(test::compare_pictures(old, actual, marks))
                << '\n';
    ASSERT_TRUE(cv::imwrite(file.string(), actual));
    std::ofstream(kExpected / (name + ".json"))
        << nlohmann::json{{"of", "bmode.json"}, {"landmarks", test::to_json(marks)}} << '\n';
    return;
  }
  std::vector<std::string> visible{"the size"};
  if (same_size) {
    const auto marks = test::landmarks_from(sidecar(name).at("landmarks"));
    const auto difference = test::compare_pictures(old, actual, marks);
    std::cout << "golden " << name << ": " << to_text(difference) << '\n';
    visible = find_visible(difference, sidecar("bmode").at("tolerance"));
  }
  if (!visible.empty()) {
    std::filesystem::create_directories(kOutput);
    cv::imwrite((kOutput / (name + "-actual.png")).string(), actual);
    if (!old.empty()) cv::imwrite((kOutput / (name + "-expected.png")).string(), old);
    cv::Mat diff;
    if (same_size) cv::absdiff(old, actual, diff);
    if (!diff.empty()) cv::imwrite((kOutput / (name + "-diff.png")).string(), diff);
  }
  EXPECT_THAT(visible, testing::IsEmpty()) << "actual, expected and difference in " << kOutput;
}

INSTANTIATE_TEST_SUITE_P(Moments, ImageGolden, testing::Values("bursa reached", "bone touched"),
                         [](const auto& parameter) {
                           return std::string(parameter.param) == "bursa reached" ? "BursaReached"
                                                                                  : "BoneTouched";
                         });

}  // namespace
}  // namespace artus
