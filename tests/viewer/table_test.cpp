// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/viewer/input/event_queue.h"
#include "artus/detail/viewer/input/key_map.h"
#include "artus/detail/viewer/joint3d/colours.h"
#include "artus/detail/viewer/panels/help_rows.h"
#include "artus/detail/viewer/panels/image_place.h"
#include "artus/detail/viewer/panels/panel_layout.h"
#include "artus/detail/viewer/words/translation.h"

namespace artus {
namespace {

constexpr std::array<Vision, 4> kEyes{Vision::all_cones, Vision::protanopia, Vision::deuteranopia,
                                      Vision::tritanopia};

TEST(HelpRows, EveryActionIsToldWithItsKeyInBothLanguages) {
  for (const Language language : {Language::english, Language::french}) {
    for (const Keyboard keyboard : {Keyboard::qwerty, Keyboard::azerty, Keyboard::qwertz}) {
      const KeyMap map(keyboard);
      std::string keys;
      for (const HelpRow& row : help_rows(map, language)) {
        keys += ", " + row.keys + ", ";
        EXPECT_FALSE(std::string(row.what).empty()) << row.keys;
      }
      for (int i = 1; i < static_cast<int>(Action::n_actions); ++i) {
        const auto action = static_cast<Action>(i);
        EXPECT_NE(keys.find(", " + map.said_key(action, language) + ", "), std::string::npos)
            << name_of(action);
      }
    }
  }
}

TEST(PictureView, AZoomKeepsItsMiddleAndNeverLeavesThePicture) {
  PictureView view;
  view.move(0.3, 0.3);
  EXPECT_EQ(view.u, 0) << "the whole picture is seen";
  view.zoom_by(2);
  EXPECT_NEAR(view.u, 0.25, 1e-12);
  EXPECT_NEAR(view.v, 0.25, 1e-12);
  view.move(-1, 1);
  EXPECT_EQ(view.u, 0);
  EXPECT_NEAR(view.v, 0.5, 1e-12) << "down to the lower edge";
  view.zoom_by(100);
  EXPECT_EQ(view.zoom, PictureView::kMax);
  EXPECT_NEAR(view.v + 0.5 / view.zoom, 0.75, 1e-12);
  view.zoom_by(1e-3);
  EXPECT_EQ(view.zoom, 1);
  EXPECT_EQ(view.u, 0);
  EXPECT_EQ(view.v, 0);
}

TEST(KeyMap, NoKeyMeansTwoThingsOnAnyKeyboard) {
  for (const Keyboard keyboard : {Keyboard::qwerty, Keyboard::azerty, Keyboard::qwertz}) {
    const KeyMap map(keyboard);
    std::set<std::string> keys;
    for (int i = 1; i < static_cast<int>(Action::n_actions); ++i) {
      const std::string key = map.key_of(static_cast<Action>(i));
      EXPECT_FALSE(key.empty()) << name_of(static_cast<Action>(i));
      EXPECT_TRUE(keys.insert(key).second) << key;
    }
  }
}

TEST(KeyMap, KeysAreSaidInTheLanguage) {
  const KeyMap map;
  EXPECT_EQ(map.said_key(Action::let_go, Language::english), "Esc");
  EXPECT_EQ(map.said_key(Action::let_go, Language::french), "Échap");
  EXPECT_EQ(map.said_key(Action::depth_less, Language::french), "maj+D");
  EXPECT_EQ(map.said_key(Action::freeze, Language::french), "F");
}

TEST(KeyMap, PushLiesAbovePullOnAzerty) {
  EXPECT_EQ(keyboard_of("A", "Y"), Keyboard::azerty);
  EXPECT_EQ(keyboard_of("Q", "Z"), Keyboard::qwertz);
  EXPECT_EQ(keyboard_of("Q", "Y"), Keyboard::qwerty);
  EXPECT_EQ(KeyMap(Keyboard::azerty).find("Z", false), Action::push);
  EXPECT_EQ(KeyMap(Keyboard::qwertz).find("W", false), Action::push);
}

TEST(KeyMap, ShiftHasItsOwnMeaningOrNone) {
  const KeyMap map;
  EXPECT_EQ(map.find("D", false), Action::depth_more);
  EXPECT_EQ(map.find("D", true), Action::depth_less);
  EXPECT_EQ(map.find("W", true), Action::push);
  EXPECT_EQ(map.find("9", false), Action::none);
}

TEST(KeyMap, AFileChangesKeysAndIsRefusedWithItsLine) {
  const auto map =
      KeyMap::parse("push = [\"8\", \"F9\"]\nfreeze = \"\u00e9\"\n", "keys", Keyboard::qwerty);
  ASSERT_TRUE(map) << map.error().to_string();
  EXPECT_EQ(map->find("8", false), Action::push);
  EXPECT_EQ(map->find("F9", false), Action::push);
  EXPECT_EQ(map->find("W", false), Action::none);
  EXPECT_EQ(map->find("\u00e9", false), Action::freeze);
  for (const char* bad : {"\npush = \"NOKEY\"", "\ndance = \"8\"", "\npush = 3", "\npush = "}) {
    const auto refused = KeyMap::parse(bad, "keys", Keyboard::qwerty);
    ASSERT_FALSE(refused) << bad;
    EXPECT_EQ(refused.error().where.substr(0, 6), "keys:2") << refused.error().to_string();
  }
  const auto twice = KeyMap::parse("push = \"F\"", "keys", Keyboard::qwerty);
  ASSERT_FALSE(twice);
  EXPECT_NE(twice.error().message.find("freeze"), std::string::npos);
}

TEST(EventQueue, KeepsOrderAndShowsEachPressToOneLook) {
  EventQueue queue;
  queue.add(MoveEvent{1, 1}, 0.1);
  queue.add(MoveEvent{2, 2}, 0.2);
  queue.add(ButtonEvent{0, true}, 0.3);
  queue.add(ButtonEvent{0, false}, 0.3);
  queue.add(ButtonEvent{0, true}, 0.31);
  queue.add(MoveEvent{3, 3}, 0.4);
  queue.add(ButtonEvent{0, false}, 0.5);
  const auto groups = queue.take_groups();
  ASSERT_EQ(groups.size(), 6U);
  EXPECT_EQ(groups[0].size(), 2U);
  double last = 0;
  for (const auto& group : groups) {
    for (const TimedEvent& event : group) {
      EXPECT_GE(event.time, last);
      last = event.time;
    }
    if (group.size() > 1) {
      for (const TimedEvent& event : group)
        EXPECT_TRUE(std::holds_alternative<MoveEvent>(event.event));
    }
  }
  EXPECT_TRUE(queue.take_groups().empty());
}

TEST(Colours, KnownContrastsAndDifferences) {
  EXPECT_NEAR(contrast({0, 0, 0}, {255, 255, 255}), 21, 1e-9);
  EXPECT_NEAR(contrast({119, 119, 119}, {255, 255, 255}), 4.48, 0.01);
  EXPECT_NEAR(difference({0, 0, 0}, {255, 255, 255}), 100, 0.01);
  EXPECT_NEAR(difference({255, 0, 0}, {0, 255, 0}), 170.6, 0.1);
  const Rgb red = seen_by(Vision::protanopia, {255, 0, 0});
  EXPECT_LT(contrast(red, {0, 0, 0}), contrast({255, 0, 0}, {0, 0, 0})) << "red is darker to them";
  EXPECT_EQ(seen_by(Vision::deuteranopia, {128, 128, 128}), (Rgb{128, 128, 128}));
}

TEST(Colours, TextOnThePictureStandsOutFromItsOutline) {
  for (const Vision eyes : kEyes)
    EXPECT_GE(contrast(seen_by(eyes, kOverlay), seen_by(eyes, kOutline)), 4.5);
}

TEST(Colours, AllTissuesOfAJointAreToldApartByAllEyes) {
  constexpr double kPlain = 10;  // four times what is just noticeable
  constexpr std::array<const char*, 14> kTissues{
      "skin",           "fat",  "muscle", "tendon", "ligament", "capsule",   "bursa",
      "synovial_fluid", "bone", "nerve",  "artery", "vein",     "cartilage", "labrum"};
  for (const Vision eyes : kEyes) {
    for (const char* a : kTissues) {
      for (const char* b : kTissues) {
        if (a == b) break;
        EXPECT_GE(difference(seen_by(eyes, tissue_colour(a)), seen_by(eyes, tissue_colour(b))),
                  kPlain)
            << a << ", " << b << " by eyes " << static_cast<int>(eyes);
      }
    }
  }
  EXPECT_GT(tissue_colour("artery")[0], tissue_colour("artery")[2]) << "arteries are red";
  EXPECT_GT(tissue_colour("vein")[2], tissue_colour("vein")[0]) << "veins are blue";
}

TEST(PanelLayout, PanelsCoverTheWindowWithoutOverlapAtAllShapes) {
  for (const auto& [width, height] :
       {std::pair{500, 350}, {1280, 720}, {1366, 768}, {1920, 1080}}) {
    for (const float scale : {1.F, 2.F}) {
      for (const bool expert : {false, true}) {
        const WindowShape shape{width, height, scale, expert};
        for (const Panel chosen : {Panel::scanner, Panel::force}) {
          const auto places = usual_places(shape, chosen);
          double area = 0;
          for (std::size_t i = 0; i < kPanels; ++i) {
            const PanelPlace& a = places[i];
            area += static_cast<double>(a.width) * a.height;
            EXPECT_LE(a.x + a.width, 1.0001F);
            EXPECT_LE(a.y + a.height, 1.0001F);
            for (std::size_t j = 0; j < i; ++j) {
              const PanelPlace& b = places[j];
              const float wide = std::min(a.x + a.width, b.x + b.width) - std::max(a.x, b.x);
              const float high = std::min(a.y + a.height, b.y + b.height) - std::max(a.y, b.y);
              EXPECT_FALSE(wide > 1e-4F && high > 1e-4F) << i << " and " << j;
            }
          }
          EXPECT_NEAR(area, 1, 1e-4) << width << " x " << height << " at " << scale;
          const PanelPlace& picture = places[static_cast<std::size_t>(Panel::picture)];
          EXPECT_GE(picture.width * static_cast<float>(width), 180.F);
          EXPECT_GE(picture.height * static_cast<float>(height), 180.F);
        }
      }
    }
  }
}

TEST(PanelLayout, WhatWasMovedFollowsTheWindowAndIsPutBack) {
  PanelLayout layout;
  layout.set_shape({1280, 720, 1, false});
  const PanelPlace usual = layout.place(Panel::force);
  layout.move(Panel::force, {0.9F, 0.1F, 0.3F, 0.3F});
  EXPECT_EQ(layout.place(Panel::force).x, 0.7F) << "within the window";
  const int version = layout.version();
  layout.set_shape({1920, 1080, 1.5F, false});
  EXPECT_GT(layout.version(), version);
  EXPECT_EQ(layout.place(Panel::force).x, 0.7F);
  layout.put_back();
  EXPECT_NEAR(layout.place(Panel::force).x, usual.x, 1e-6);
}

}  // namespace
}  // namespace artus
