// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/echo/transducer_file.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/paths.h"

namespace artus {
namespace {

const std::string kGood = R"(format = 1
name = "mine"
title = "My probe"
source = "assumed: test"
width_mm = 30.0
lines = 100
frequency_mhz = 8.0
bandwidth = 0.5
pulse_cycles = 2.0
f_number = 2.0
max_aperture_mm = 15.0
elevation_height_mm = 5.0
elevation_focus_mm = 18.0
)";

std::string with(const std::string& line) {
  const std::string key = line.substr(0, line.find(' '));
  std::string text = kGood;
  const auto at = text.find("\n" + key + " =");
  if (at == std::string::npos) return text + line + "\n";
  return text.replace(at + 1, text.find('\n', at + 1) - at - 1, line);
}

TEST(TransducerFile, TheFirstBundledPresetIsTheDefault) {
  const auto presets = read_bundled_transducers();
  ASSERT_TRUE(presets.has_value()) << presets.error().to_string();
  const Transducer& t = presets->front().transducer;
  const Transducer usual;
  EXPECT_EQ(presets->front().name, "linear-6-18");
  EXPECT_DOUBLE_EQ(t.width, usual.width);
  EXPECT_DOUBLE_EQ(t.radius, usual.radius);
  EXPECT_DOUBLE_EQ(t.steering, usual.steering);
  EXPECT_EQ(t.n_lines, usual.n_lines);
  EXPECT_DOUBLE_EQ(t.frequency, usual.frequency);
  EXPECT_DOUBLE_EQ(t.bandwidth, usual.bandwidth);
  EXPECT_DOUBLE_EQ(t.pulse_cycles, usual.pulse_cycles);
  EXPECT_DOUBLE_EQ(t.f_number, usual.f_number);
  EXPECT_DOUBLE_EQ(t.max_aperture, usual.max_aperture);
  EXPECT_DOUBLE_EQ(t.elevation_height, usual.elevation_height);
  EXPECT_DOUBLE_EQ(t.elevation_focus, usual.elevation_focus);
  EXPECT_DOUBLE_EQ(t.transmit_focus, usual.transmit_focus);
}

TEST(TransducerFile, ThereIsALinearAndACurvilinearPresetAndEachIsFoundByName) {
  const auto presets = read_bundled_transducers();
  ASSERT_TRUE(presets.has_value());
  bool curved = false;
  for (const auto& preset : *presets) {
    EXPECT_TRUE(find_transducer(preset.name).has_value()) << preset.name;
    EXPECT_TRUE(std::filesystem::exists(artus::test::source_dir() / "devices/transducers" /
                                        (preset.name + ".toml")));
    curved = curved || preset.transducer.radius > 0;
  }
  EXPECT_TRUE(curved);
}

TEST(TransducerFile, ReadsMillimetresAndMegahertz) {
  const auto preset = parse_transducer(with("radius_mm = 40.0"), "mine.toml");
  ASSERT_TRUE(preset.has_value()) << preset.error().to_string();
  EXPECT_DOUBLE_EQ(preset->transducer.width, 0.030);
  EXPECT_DOUBLE_EQ(preset->transducer.radius, 0.040);
  EXPECT_DOUBLE_EQ(preset->transducer.frequency, 8e6);
  EXPECT_EQ(preset->transducer.n_lines, 100);
}

TEST(TransducerFile, WhatIsWrongIsNamedWithFileAndKey) {
  struct Case {
    const char* line;
    const char* said;
  };
  for (const Case& c :
       {Case{"widht_mm = 3.0", "widht_mm"}, Case{"frequency_mhz = 900.0", "frequency_mhz"},
        Case{"frequency_mhz = nan", "frequency_mhz"}, Case{"lines = 10000", "lines"},
        Case{"lines = 10.5", "whole number"}, Case{"max_aperture_mm = 0.0", "max_aperture_mm"},
        Case{"radius_mm = 2.0", "radius"}, Case{"transmit_focus_mm = 1.0", "transmit_focus"},
        Case{"format = 2", "format"}, Case{"name = \"A B\"", "name"},
        Case{"width_mm = \"wide\"", "width_mm"}, Case{"title =", "mine.toml"}}) {
    const auto preset = parse_transducer(with(c.line), "mine.toml");
    ASSERT_FALSE(preset.has_value()) << c.line;
    EXPECT_EQ(preset.error().where.rfind("mine.toml", 0), 0U) << c.line;
    EXPECT_NE(preset.error().to_string().find(c.said), std::string::npos)
        << c.line << ": " << preset.error().to_string();
  }
  EXPECT_FALSE(parse_transducer("", "empty.toml").has_value());
}

TEST(TransducerFile, AnUnknownNameListsTheKnownOnes) {
  const auto preset = find_transducer("linear");
  ASSERT_FALSE(preset.has_value());
  EXPECT_EQ(preset.error().code, ErrorCode::not_found);
  EXPECT_NE(preset.error().message.find("linear-6-18"), std::string::npos);
  EXPECT_EQ(find_transducer("absent.toml").error().code, ErrorCode::not_found);
}

}  // namespace
}  // namespace artus
