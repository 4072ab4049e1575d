// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/input/window_events.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include <opencv2/imgcodecs.hpp>
#include <unistd.h>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "tests/viewer/window_events_support.h"

namespace artus {
namespace {

using test::Person;
using test::WindowEventsTest;

bool same_place(const ImagePlace& a, const ImagePlace& b) {
  return std::abs(a.x - b.x) < 1 && std::abs(a.y - b.y) < 1;
}

TEST_F(WindowEventsTest, ADragInThePictureMovesNoPanelAndDropsNoCaliper) {
  run([](Person& person) {
    const ImagePlace before = person.seen().image_place;
    person.x().drag(before.x + 100, before.y + 100, before.x + 160, before.y + 130);
    person.wait_pictures(3);
    EXPECT_TRUE(same_place(person.seen().image_place, before));
    EXPECT_EQ(person.seen().caliper_points, 0U);
    EXPECT_FALSE(person.seen().frozen);
    const PanelPlace& panel = person.seen().picture_panel;  // beside the picture the panel is empty
    const double beside = (panel.x + panel.width) * 1280 - 30;
    person.x().drag(beside, before.y + 60, beside - 60, before.y + 120);
    person.wait_pictures(3);
    EXPECT_TRUE(same_place(person.seen().image_place, before));
  });
}

TEST_F(WindowEventsTest, ADragInThe3DViewTurnsTheJointAndMovesNoPanel) {
  run([](Person& person) {
    const WindowStatus before = person.seen();
    person.x().drag(200, 300, 260, 300);
    person.wait_pictures(3);
    EXPECT_NEAR(person.seen().camera.yaw, before.camera.yaw + 0.6, 0.02);
    EXPECT_TRUE(same_place(person.seen().image_place, before.image_place));
    EXPECT_EQ(person.seen().caliper_points, 0U);
  });
}

TEST_F(WindowEventsTest, APanelMovesByItsTitleAndOneKeyPutsItBack) {
  run([](Person& person) {
    const WindowStatus before = person.seen();
    const double title_x = (before.picture_panel.x + 0.1) * 1280;
    const double title_y = before.picture_panel.y * 720 + 8;
    person.x().drag(title_x, title_y, title_x - 80, title_y + 60);
    person.wait_until("the panel moved", [&](const WindowStatus& s) {
      return std::abs(s.image_place.x - before.image_place.x + 80) < 3 &&
             std::abs(s.image_place.y - before.image_place.y - 60) < 3;
    });
    person.x().key("F2");
    person.wait_until("the panel is back", [&](const WindowStatus& s) {
      return same_place(s.image_place, before.image_place);
    });
  });
}

/// Clicks of 5 to 100 ms in the picture; each is a caliper's point.
void click_often(Person& person, int n, unsigned seed) {
  std::mt19937 chance(seed);
  const auto from_to = [&chance](int low, int high) {
    return low + static_cast<int>(chance() % static_cast<unsigned>(high - low + 1));
  };
  const ImagePlace place = person.seen().image_place;
  for (int i = 0; i < n; ++i) {
    person.x().click(place.x + from_to(20, 180), place.y + from_to(20, 180), from_to(5, 100));
    Person::rest(1e-3 * from_to(5, 60));
  }
  const auto all = static_cast<std::size_t>(n);
  person.wait_until("all clicks", [all](const WindowStatus& s) { return s.caliper_points >= all; });
  person.wait_pictures(3);
  EXPECT_EQ(person.seen().caliper_points, all) << "none lost, none doubled";
}

TEST_F(WindowEventsTest, NoClickIsLostOrDoubledAtAnyRateOfTheWindow) {
  for (const double rate : {3.0, 10.0, 30.0, 60.0}) {
    options_.rate = rate;
    run([rate](Person& person) { click_often(person, 50, static_cast<unsigned>(rate)); });
  }
}

TEST_F(WindowEventsTest, TheNeedleStopsAtItsHub) {
  params_.feel.needle_length = 20e-3;
  run([](Person& person) {
    person.x().key("n");
    person.x().wheel(120);
    person.wait_until("the hub is told",
                      [](const WindowStatus& s) { return s.needle.hub_on_skin; });
    Person::rest(0.5);
    EXPECT_LT(person.seen().needle.depth, 20.1e-3);
    EXPECT_NE(person.seen().next.find("hub"), std::string::npos) << person.seen().next;
  });
}

TEST_F(WindowEventsTest, OnBoneTheDepthIsTheNeedlesAndTheHandsExcessIsAForce) {
  run([](Person& person) {
    person.x().key("n");
    person.x().wheel(120);
    person.wait_until("bone", [](const WindowStatus& s) {
      return s.needle.on_bone && s.needle.hand_excess > 3e-3;
    });
    Person::rest(1);  // the hand is slower than the wheel: now it stands as far as it can
    person.wait_pictures(2);
    EXPECT_NEAR(person.seen().needle.depth, 29e-3, 0.2e-3) << "where bone begins";
    EXPECT_GT(person.seen().needle.hand_excess, 3e-3);
    EXPECT_LT(person.seen().needle.hand_excess, HandControl::kBeyondBone + 0.5e-3);
  });
}

TEST_F(WindowEventsTest, ATorqueThatTheDeviceDoesNotRenderIsNoLimitReached) {
  params_.device = *find_device("touch");  // rotations are sensed only
  run([this](Person& person) {
    person.x().key("n");
    person.x().wheel(60);
    person.wait_until("inside", [](const WindowStatus& s) { return s.needle.depth > 15e-3; });
    for (int i = 0; i < 3; ++i) person.x().key("Right");
    Person::rest(0.5);
    HapticSnapshot now;
    ASSERT_TRUE(session_->newest(now));
    EXPECT_GT(now.cone, 0);
    EXPECT_EQ(now.status & TickStatus::kSaturated, 0U);
  });
}

TEST_F(WindowEventsTest, AFrozenPictureKeepsItsDepthAndItsCalipersGoWithIt) {
  options_.plain = true;
  run([this](Person& person) {
    person.x().key("f");
    person.wait_until("frozen", [](const WindowStatus& s) { return s.frozen; });
    person.x().key("v");
    person.wait_until("saved", [](const WindowStatus& s) { return !s.message.empty(); });
    const ImagePlace place = person.seen().image_place;
    person.x().click(place.x + 50, place.y + 50, 20);
    person.x().click(place.x + 90, place.y + 50, 20);
    person.x().key("d");
    person.x().key("d");
    person.wait_until("two points", [](const WindowStatus& s) {
      return s.caliper_points == 2 && s.controls.depth > 49e-3;
    });
    EXPECT_NEAR(person.seen().image_place.scale, place.scale, 1e-9);
    person.x().key("v");
    person.wait_until("the second is saved", [](const WindowStatus& s) {
      return s.message.find("bmode-2.png") != std::string::npos;
    });
    const cv::Mat first = cv::imread((folder_ / "bmode-1.png").string());
    const cv::Mat second = cv::imread((folder_ / "bmode-2.png").string());
    EXPECT_EQ(first.size(), second.size()) << "the picture is still 40 mm deep";
    person.x().key("f");
    person.wait_until("clear calipers",
                      [](const WindowStatus& s) { return s.caliper_points == 0; });
  });
}

TEST_F(WindowEventsTest, AnEntryIsRefusedInTheAirAndWithTheNeedleIn) {
  run([](Person& person) {
    person.x().key("n");
    person.x().wheel(40);
    person.wait_until("inside", [](const WindowStatus& s) { return s.needle.inside; });
    person.x().key("c");
    person.wait_until("a reason", [](const WindowStatus& s) {
      return s.message.find("needle is in") != std::string::npos;
    });
    Person::rest(0.3);
    EXPECT_EQ(person.seen().phase, GesturePhase::exploring);
    person.x().wheel(-60);
    person.wait_until("outside", [](const WindowStatus& s) { return !s.needle.inside; });
    person.x().key("p");
    for (int i = 0; i < 60; ++i) person.x().key("Left");  // off the block of 120 mm
    Person::rest(2);                                      // the hand is slower than the keys
    person.wait_pictures(3);
    person.x().key("c");
    person.wait_until("a reason", [](const WindowStatus& s) {
      return s.message.find("No skin") != std::string::npos;
    });
    EXPECT_EQ(person.seen().phase, GesturePhase::exploring);
  });
}

TEST_F(WindowEventsTest, TheProbeIsPressedOnAndTellsThatItLifts) {
  run([](Person& person) {
    person.x().key("p");
    for (int i = 0; i < 8; ++i) person.x().key("s");  // 2 mm up
    person.wait_until("it lifts", [](const WindowStatus& s) {
      return s.message.find("lifts") != std::string::npos &&
             s.next.find("off the skin") != std::string::npos;
    });
    for (int i = 0; i < 10; ++i) person.x().key("w");
    person.wait_until("it rests", [](const WindowStatus& s) {
      return s.message.find("lies on") != std::string::npos;
    });
  });
}

/// How many pixels of the window's uppermost 50 lines are about of a colour.
int pixels_above(Person& person, const std::array<int, 3>& rgb) {
  person.wait_pictures(3);
  const auto file = std::filesystem::temp_directory_path() /
                    ("artus-above-" + std::to_string(::getpid()) + ".png");
  person.x().save_screen(file, 1280, 50);
  const cv::Mat seen = cv::imread(file.string());
  std::filesystem::remove(file);
  const cv::Scalar colour(rgb[2], rgb[1], rgb[0]);
  cv::Mat alike;
  cv::inRange(seen, colour - cv::Scalar::all(25), colour + cv::Scalar::all(25), alike);
  return cv::countNonZero(alike);
}

TEST_F(WindowEventsTest, ExpertsAreToldWhatIsRecordedAndWhere) {
  options_.expert = true;
  run([this](Person& person) {
    person.x().key("k");
    person.wait_until("REC", [](const WindowStatus& s) { return s.recording; });
    EXPECT_GT(pixels_above(person, {255, 77, 77}), 20) << "the red mark and its seconds";
    person.x().key("k");
    person.wait_until("the file", [this](const WindowStatus& s) {
      return s.message.find((folder_ / "clip-1.avi").string()) != std::string::npos;
    });
    EXPECT_GT(pixels_above(person, {140, 242, 140}), 50) << "the message stands in the window";
  });
}

TEST_F(WindowEventsTest, ADeviceThatDiesLeavesItsLastStateMarked) {
  run([this](Person& person) {
    person.x().key("n");
    person.x().wheel(60);
    person.wait_until("deep", [](const WindowStatus& s) { return s.needle.depth > 19e-3; });
    hand_->set_connected(false);
    person.wait_until("it is told", [](const WindowStatus& s) {
      return s.next.find("does not answer") != std::string::npos;
    });
    EXPECT_GT(person.seen().needle.depth, 19e-3);
    EXPECT_TRUE(person.seen().needle.inside);
  });
}

TEST_F(WindowEventsTest, LeftHandedTheRightButtonIsTheFirst) {
  options_.left_handed = true;
  run([](Person& person) {
    const ImagePlace place = person.seen().image_place;
    person.x().click(place.x + 60, place.y + 60, 30);
    person.wait_pictures(4);
    EXPECT_EQ(person.seen().caliper_points, 0U);
    person.x().button(3, true);
    person.x().button(3, false);
    person.wait_until("a point", [](const WindowStatus& s) { return s.caliper_points == 1; });
  });
}

TEST_F(WindowEventsTest, TheColourBoxIsDraggedAndMovedByKeys) {
  params_.image.doppler = true;
  params_.image.doppler_limit = 0.05;
  run([](Person& person) {
    person.x().key("o");
    person.wait_until("colour", [](const WindowStatus& s) { return s.look.colour; });
    const ImagePlace place = person.seen().image_place;
    const ColourBox before = person.seen().look.box;
    const double middle_x = place.x + 0.5 * 40 * place.scale;  // the probe is 40 mm wide
    const double middle_y = place.y + 0.5 * 40 * place.scale;
    person.x().drag(middle_x, middle_y, middle_x - 4 * place.scale, middle_y - 2 * place.scale);
    person.wait_until("the box moved", [&](const WindowStatus& s) {
      return std::abs(s.look.box.x - before.x + 0.1) < 0.02 &&
             std::abs(s.look.box.y - before.y + 0.05) < 0.02;
    });
    EXPECT_EQ(person.seen().caliper_points, 0U);
    person.x().key("Right");
    person.wait_until("the box went right",
                      [&](const WindowStatus& s) { return s.look.box.x > before.x - 0.07; });
    person.x().key("o");
    person.wait_until("grey again", [](const WindowStatus& s) { return !s.look.colour; });
  });
}

TEST_F(WindowEventsTest, AKnobIsTurnedByKeysAlone) {
  run([](Person& person) {
    const double gain = person.seen().controls.gain_db;
    person.x().key("g");
    person.wait_until("more gain", [gain](const WindowStatus& s) {
      return std::abs(s.controls.gain_db - gain - 2) < 1e-9;
    });
    person.x().key("g", "Shift_L");
    person.wait_until("less gain", [gain](const WindowStatus& s) {
      return std::abs(s.controls.gain_db - gain) < 1e-9;
    });
    const double depth = person.seen().controls.depth;
    person.x().key("Tab");  // to the scanner's first knob
    person.x().key("Down");
    person.x().key("Return");  // take it
    for (int i = 0; i < 3; ++i) person.x().key("Right");
    person.wait_until("a knob turned", [&](const WindowStatus& s) {
      return s.controls.depth != depth || s.controls.gain_db != gain;
    });
  });
}

}  // namespace
}  // namespace artus
