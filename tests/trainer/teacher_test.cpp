// SPDX-License-Identifier: AGPL-3.0-or-later
#include <string>

#include <httplib.h>

#include <gtest/gtest.h>

#include "artus/detail/trainer/teacher_board.h"
#include "artus/detail/trainer/teacher_server.h"

namespace artus {
namespace {

constexpr const char* kJson = "application/json";

ImageSnapshot picture_of(std::uint64_t number) {
  ImageSnapshot image;
  image.width = 4;
  image.height = 3;
  image.pixel = 1e-3;
  image.grey.assign(12, 128);
  image.input.number = number;
  return image;
}

/// A task at a moment, s.
Lesson lead(TeacherFollow& follow, double time, Lesson lesson = {}) {
  HapticSnapshot now;
  now.input.tick = static_cast<std::uint64_t>(1000 * time);
  const NeedleReading needle;
  follow.lead({now, needle}, lesson);
  return lesson;
}

Scenario task() {
  Scenario scenario = *find_scenario("gel-align");
  scenario.aids.clear();
  return scenario;
}

TEST(TeacherServer, FollowsAnAttemptAndDoesOnItWhatIsAsked) {
  TeacherBoard board;
  const auto server = TeacherServer::open(board, {});
  ASSERT_TRUE(server) << server.error().to_string();
  EXPECT_EQ((*server)->link(), "http://127.0.0.1:" + std::to_string((*server)->port()) + "/");
  httplib::Client browser("127.0.0.1", (*server)->port());
  auto page = browser.Get("/");
  ASSERT_TRUE(page);
  EXPECT_NE(page->body.find("id=\"picture\""), std::string::npos);
  EXPECT_EQ(browser.Get("/picture")->status, 404);
  EXPECT_FALSE(nlohmann::json::parse(browser.Get("/state")->body)["running"].get<bool>());

  TeacherFollow follow(board, task(), {}, 1000, Language::english);
  board.take_image(picture_of(7));
  Lesson lesson;
  lesson.title = "a task";
  lead(follow, 1, lesson);
  const auto state = nlohmann::json::parse(browser.Get("/state")->body);
  EXPECT_TRUE(state["running"].get<bool>());
  EXPECT_EQ(state["title"], "a task");
  EXPECT_EQ(state["picture"], 7);
  EXPECT_GT(state["marks"].size(), 3U);
  const auto picture = browser.Get("/picture");
  ASSERT_EQ(picture->status, 200);
  EXPECT_EQ(picture->body.substr(1, 3), "PNG");

  for (const char* command : {R"({"do":"freeze","on":true})", R"({"do":"point","x":0.25,"y":0.5})",
                              R"({"do":"aid","name":"tip_marker","on":true})",
                              R"({"do":"remark","text":"rest your hand"})"})
    EXPECT_EQ(browser.Post("/command", command, kJson)->status, 200) << command;
  const Lesson asked = lead(follow, 2.5);
  EXPECT_EQ(asked.frozen, true);
  ASSERT_TRUE(asked.pointed);
  EXPECT_EQ(asked.pointed->first, 0.25);
  ASSERT_TRUE(asked.aids);
  EXPECT_EQ(asked.aids->tip, 1);
  EXPECT_EQ(asked.remark, "Teacher: rest your hand");
  EXPECT_TRUE(follow.aided()) << "nobody passes by an aid of the teacher's";
  const Lesson later = lead(follow, 13);
  EXPECT_FALSE(later.frozen) << "once; then the learner's own again";
  EXPECT_EQ(later.remark, "");
  ASSERT_EQ(follow.events().size(), 4U);
  EXPECT_EQ(follow.events().back().kind, "remark");
  EXPECT_EQ(follow.events().back().text, "rest your hand");
  EXPECT_DOUBLE_EQ(follow.events().back().time, 2.5);
}

TEST(TeacherServer, RefusesWhatIsNoCommand) {
  TeacherBoard board;
  const auto server = TeacherServer::open(board, {});
  ASSERT_TRUE(server);
  httplib::Client browser("127.0.0.1", (*server)->port());
  for (const char* command :
       {"", "[]", "{", R"({"do":"fly"})", R"({"do":"freeze"})", R"({"do":"point","x":2,"y":0})",
        R"({"do":"point","x":0.5})", R"({"do":"aid","name":"wings","on":true})",
        R"({"do":"aid","name":"labels"})", R"({"do":"remark","text":""})",
        R"({"do":"remark","text":7})"})
    EXPECT_EQ(browser.Post("/command", command, kJson)->status, 400) << command;
  EXPECT_EQ(browser.Post("/command", R"({"do":"freeze","on":true})", "text/plain")->status, 415)
      << "a form of another page";
  EXPECT_EQ(browser.Post("/command", std::string(10000, 'x'), kJson)->status, 413);
  EXPECT_TRUE(board.take().empty());
}

TEST(TeacherServer, OthersNeedTheTokenAndNoOtherPageReachesThisMachines) {
  TeacherBoard board;
  const auto local = TeacherServer::open(board, {});
  ASSERT_TRUE(local);
  httplib::Client browser("127.0.0.1", (*local)->port());
  EXPECT_EQ(browser.Get("/state", {{"Host", "evil.example"}})->status, 403);
  EXPECT_EQ(browser.Get("/state", {{"Host", "localhost:99"}})->status, 200);

  TeacherServer::Options everywhere;
  everywhere.address = "0.0.0.0";
  const auto open = TeacherServer::open(board, everywhere);
  ASSERT_TRUE(open);
  const std::string link = (*open)->link();
  const std::string token = link.substr(link.find("?token=") + 7);
  EXPECT_EQ(token.size(), 16U) << link;
  httplib::Client other("127.0.0.1", (*open)->port());
  EXPECT_EQ(other.Get("/state")->status, 403);
  EXPECT_EQ(other.Get("/state?token=0000000000000000")->status, 403);
  EXPECT_EQ(other.Get("/state?token=" + token)->status, 200);
}

TEST(TeacherServer, APortThatIsTakenIsToldAndAStrangersAddressToo) {
  TeacherBoard board;
  TeacherServer::Options nowhere;
  nowhere.address = "203.0.113.9";  // of nobody
  const auto none = TeacherServer::open(board, nowhere);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().where, "--teacher");
}

TEST(TeacherFollow, WhatWasAskedBeforeTheAttemptIsNotDoneOnIt) {
  TeacherBoard board;
  board.ask({TeacherCommand::Kind::remark, "too late", 0, {}});
  TeacherFollow follow(board, task(), {}, 1000, Language::english);
  EXPECT_EQ(lead(follow, 1).remark, "");
  EXPECT_TRUE(follow.events().empty());
  EXPECT_FALSE(follow.aided());
}

}  // namespace
}  // namespace artus
