// SPDX-License-Identifier: AGPL-3.0-or-later
// A teacher's browser and a learner's window at the same time: real requests, real keys.
#include <string>

#include <httplib.h>

#include <gtest/gtest.h>

#include "artus/detail/trainer/teacher_board.h"
#include "artus/detail/trainer/teacher_server.h"
#include "tests/viewer/window_events_support.h"

namespace artus {
namespace {

using test::Person;

class WindowTeacher : public test::WindowEventsTest {};

TEST_F(WindowTeacher, ARemarkStandsInTheLearnersWindowWhileTheyWorkAndInTheRecord) {
  TeacherBoard board;
  const auto server = TeacherServer::open(board, {});
  ASSERT_TRUE(server) << server.error().to_string();
  TeacherFollow follow(board, *find_scenario("gel-align"), {}, params_.haptic_rate,
                       Language::english);
  LessonOptions lesson;
  lesson.aids.tip = 1;
  lesson.lead = [&follow](const LessonView& view) {
    Lesson told;
    told.title = "a task";
    follow.lead(view, told);
    return told;
  };
  options_.lesson = lesson;
  run([&server](Person& person) {
    httplib::Client browser("127.0.0.1", (*server)->port());
    const auto ask = [&browser](const char* command) {
      const auto answer = browser.Post("/command", command, "application/json");
      ASSERT_TRUE(answer);
      EXPECT_EQ(answer->status, 200);
    };
    EXPECT_EQ(person.seen().remark, "");
    person.x().key("n");
    person.wait_until("in hand", [](const WindowStatus& s) { return s.grab == Grab::needle; });
    ask(R"({"do":"remark","text":"keep the tip in sight"})");
    person.wait_until("the remark", [](const WindowStatus& s) {
      return s.remark == "Teacher: keep the tip in sight";
    });
    EXPECT_EQ(person.seen().grab, Grab::needle) << "the hand is not disturbed";
    person.x().wheel(30);
    person.wait_until("the needle goes in", [](const WindowStatus& s) { return s.needle.inside; });
    EXPECT_EQ(person.seen().remark, "Teacher: keep the tip in sight") << "it stands for 10 s";
    ask(R"({"do":"freeze","on":true})");
    person.wait_until("the picture stands", [](const WindowStatus& s) { return s.frozen; });
    ask(R"({"do":"freeze","on":false})");
    person.wait_until("it goes on", [](const WindowStatus& s) { return !s.frozen; });
    person.wait_until(
        "the remark goes", [](const WindowStatus& s) { return s.remark.empty(); }, 20);
  });
  ASSERT_EQ(follow.events().size(), 3U);
  EXPECT_EQ(follow.events().front().kind, "remark");
  EXPECT_EQ(follow.events().front().text, "keep the tip in sight");
  EXPECT_GT(follow.events().front().time, 0);
}

}  // namespace
}  // namespace artus
