// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "tests/session/session_support.h"
#include "tests/support/temporary_folder.h"
#include "tests/viewer/person.h"

namespace artus::test {

inline HandTarget over_the_skin() {
  HandTarget target;
  target.X_WN = to_plain(make_pose(Vec3(0, 0, -10e-3), Vec3::UnitZ(), Vec3::UnitX()));
  target.X_WP = to_plain(make_pose(Vec3(0.01, 0, 0), Vec3::UnitZ(), Vec3::UnitX()));
  return target;
}

/// A person with a mouse and a keyboard at the window of a session on six flat layers.
class WindowEventsTest : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display; ctest runs it under Xvfb";
    x_ = XActor::open();
    ASSERT_NE(x_, nullptr) << "the display has no XTEST";
    options_.pictures = folder_;
    PlannedTask task;
    task.injection = {"bursa", Vec3::Zero(), Vec3(0, 0, 23e-3)};
    task.start = over_the_skin();
    options_.tasks = {task};
  }

  void run(const std::function<void(Person&)>& does) {
    auto device = std::make_unique<HandDevice>(over_the_skin(), 1 / params_.haptic_rate);
    hand_ = device.get();
    Session::Options options;
    options.haptic_options = {};
    options.imaging_options = {};
    auto session = Session::start(scene_, params_, std::move(device), options);
    EXPECT_TRUE(session) << session.error().to_string();
    session_ = session->get();
    report_ = Person(*x_).sit_before(**session, hand_, over_the_skin(), options_, does);
  }

  std::unique_ptr<XActor> x_;
  std::shared_ptr<const Scene> scene_ = make_layered_scene();
  SessionParams params_ = make_small_session();
  Session* session_ = nullptr;
  HandDevice* hand_ = nullptr;
  WindowOptions options_;
  std::unique_ptr<WindowReport> report_;
};

}  // namespace artus::test
