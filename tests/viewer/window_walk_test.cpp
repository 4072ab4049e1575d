// SPDX-License-Identifier: AGPL-3.0-or-later
// What new trainees met when they tried the window without a plan, by their real events.
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/viewer/window_events_support.h"

namespace artus {
namespace {

using test::Person;
using test::WindowEventsTest;

TEST_F(WindowEventsTest, EscapeClosesTheHelpAndThenLetsGo) {
  run([](Person& person) {
    person.x().key("n");
    person.x().key("F1");
    person.wait_until("help", [](const WindowStatus& s) { return s.help; });
    person.x().key("Escape");
    person.wait_until("no help", [](const WindowStatus& s) { return !s.help; });
    EXPECT_EQ(person.seen().grab, Grab::needle);
    person.x().key("Escape");
    person.wait_until("let go", [](const WindowStatus& s) { return s.grab == Grab::nothing; });
  });
}

TEST_F(WindowEventsTest, TheWelcomeLeadsToTrainingByKeysAndTheWindowEnds) {
  options_.welcome = options_.training = true;
  run([](Person& person) {
    person.x().key("Tab");
    for (int i = 0; i < 8; ++i) person.x().key("Down");
    person.x().key("Up");  // above the help, which is the last
    person.x().key("Return");
    Person::rest(2);  // a window that has ended shows nothing more
  });
  EXPECT_TRUE(report_->training);
}

TEST_F(WindowEventsTest, APressBeforeThePointerIsBackTakesHoldOfNothing) {
  options_.rate = 2;
  run([](Person& person) {
    const WindowStatus before = person.seen();
    const double title_x = (before.picture_panel.x + 0.1) * 1280;
    person.x().move(title_x, before.picture_panel.y * 720 + 8);
    person.x().key("n");
    person.wait_until("in hand", [](const WindowStatus& s) { return s.grab == Grab::needle; });
    person.wait_pictures(2);
    person.x().key("Escape");  // the next picture is half a second away
    person.x().move_by(2, 1);
    Person::rest(0.02);
    person.x().button(1, true);
    for (int i = 0; i < 4; ++i) {
      person.x().move_by(12, 20);
      Person::rest(0.02);
    }
    person.x().button(1, false);
    person.wait_until("let go", [](const WindowStatus& s) { return s.grab == Grab::nothing; });
    person.wait_pictures(3);
    EXPECT_EQ(person.seen().picture_panel.x, before.picture_panel.x);
    EXPECT_EQ(person.seen().picture_panel.y, before.picture_panel.y);
    EXPECT_EQ(person.seen().caliper_points, 0U);
  });
}

TEST_F(WindowEventsTest, AFlippedZoomedPictureIsMovedAndMeasuredAtItsTrueScale) {
  std::vector<ImagePoint> measured;
  run([&measured](Person& person) {
    const double scale = person.seen().image_place.scale;
    const double left = person.seen().image_place.x;
    const double top = person.seen().image_place.y;
    person.x().key("i");
    for (int i = 0; i < 4; ++i) person.x().key("Prior");
    person.wait_until("it is flipped and zoomed", [](const WindowStatus& s) {
      return s.look.flipped && std::abs(s.view.zoom - std::pow(1.25, 4)) < 1e-9;
    });
    person.wait_pictures(2);
    const WindowStatus before = person.seen();
    EXPECT_NEAR(before.image_place.scale, scale * std::pow(1.25, 4), 1e-6);
    person.x().drag(left + 150, top + 150, left + 190, top + 130);
    person.wait_pictures(3);
    const WindowStatus after = person.seen();
    EXPECT_EQ(after.caliper_points, 0U);
    EXPECT_NEAR(after.image_place.x - before.image_place.x, 40, 6);
    EXPECT_NEAR(after.image_place.y - before.image_place.y, -20, 6);
    person.x().click(left + 100, top + 100, 30);
    person.wait_until("a point", [](const WindowStatus& s) { return s.caliper_points == 1; });
    person.x().click(left + 100 + 8 * after.image_place.scale, top + 100, 30);
    person.wait_until("a caliper", [](const WindowStatus& s) { return s.caliper_points == 2; });
    measured = {after.image_place.point_at(left + 100, top + 100),
                after.image_place.point_at(left + 100 + 8 * after.image_place.scale, top + 100)};
  });
  ASSERT_EQ(report_->calipers.size(), 2U);
  EXPECT_NEAR(distance_mm(report_->calipers[0], report_->calipers[1]), 8, 0.2);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_LT(distance_mm(report_->calipers[i], measured[i]), 0.2) << i;
  EXPECT_LT(report_->calipers[1].x_mm, report_->calipers[0].x_mm) << "flipped";
}

TEST_F(WindowEventsTest, AKeptPictureKeepsItsMeasuresWhenTheOtherGoesOn) {
  run([](Person& person) {
    const ImagePlace place = person.seen().image_place;
    person.x().key("f");
    person.wait_until("frozen", [](const WindowStatus& s) { return s.frozen; });
    person.x().click(place.x + 50, place.y + 50, 20);
    person.x().click(place.x + 90, place.y + 50, 20);
    person.wait_until("a caliper", [](const WindowStatus& s) { return s.caliper_points == 2; });
    person.x().key("u");
    person.wait_until("two pictures", [](const WindowStatus& s) { return s.dual; });
    person.wait_pictures(2);
    EXPECT_LT(person.seen().image_place.scale, place.scale) << "they share the room";
    person.x().key("f");
    person.wait_until("it goes on", [](const WindowStatus& s) { return !s.frozen; });
    person.wait_pictures(2);
    EXPECT_EQ(person.seen().caliper_points, 2U);
    person.x().key("u");
    person.wait_until("one picture", [](const WindowStatus& s) { return !s.dual; });
  });
}

TEST_F(WindowEventsTest, AMessageGoesAfterItsTime) {
  options_.message_seconds = 1;
  run([](Person& person) {
    person.x().key("F2");
    person.wait_until("a message", [](const WindowStatus& s) { return !s.message.empty(); });
    person.wait_until(
        "none", [](const WindowStatus& s) { return s.message.empty(); }, 30);
  });
}

/// How the keys lie, until the end of its life.
class KeyboardLayout {
 public:
  explicit KeyboardLayout(const std::string& name) { set(name); }
  ~KeyboardLayout() { set("us"); }
  KeyboardLayout(const KeyboardLayout&) = delete;
  KeyboardLayout& operator=(const KeyboardLayout&) = delete;

 private:
  static void set(const std::string& name) {
    // NOLINTNEXTLINE(*-command-processor,*-mt-unsafe): no other thread runs meanwhile
    EXPECT_EQ(std::system(("setxkbmap " + name).c_str()), 0);
  }
};

TEST_F(WindowEventsTest, KeysAreKnownByTheirCharacterOnEveryKeyboard) {
  constexpr int kAboveS = 25;   // keycodes: Z on AZERTY, W on the others
  constexpr int kBesideL = 47;  // M on AZERTY
  constexpr int kBesideN = 58;  // M on the others
  for (const std::string layout : {"us", "fr", "de"}) {
    SCOPED_TRACE(layout);
    const KeyboardLayout keyboard(layout);
    const bool azerty = layout == "fr";
    run([&](Person& person) {
      EXPECT_EQ(person.seen().keys.key_of(Action::push), azerty ? "Z" : "W");
      person.x().key("n");
      person.wait_until("the needle is in hand",
                        [](const WindowStatus& s) { return s.grab == Grab::needle; });
      const double before = person.seen().needle.to_target;
      for (int i = 0; i < 6; ++i) person.x().key_at(kAboveS);
      person.wait_until("it was pushed by 3 mm", [before](const WindowStatus& s) {
        return std::abs(s.needle.to_target - before + 3e-3) < 0.2e-3;
      });
      person.x().key("Escape");
      const ImagePlace place = person.seen().image_place;
      person.x().click(place.x + 50, place.y + 50, 20);
      person.wait_until("a point", [](const WindowStatus& s) { return s.caliper_points == 1; });
      person.x().key_at(azerty ? kBesideL : kBesideN);
      person.wait_until("M removes it",
                        [](const WindowStatus& s) { return s.caliper_points == 0; });
    });
  }
}

}  // namespace
}  // namespace artus
