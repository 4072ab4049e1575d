// SPDX-License-Identifier: AGPL-3.0-or-later
// The 3D view of a body that gives way: where its surfaces are drawn, and of which picture.
#include "artus/detail/viewer/joint3d/joint_view.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include <gtest/gtest.h>

#include "artus/detail/raycast/moving_scene.h"
#include "artus/detail/raycast/pressed_scene.h"
#include "artus/detail/soft/liquid/injected_body.h"
#include "artus/detail/viewer/input/screen.h"
#include "artus/detail/viewer/panels/cine_loop.h"
#include "artus/detail/viewer/window.h"
#include "tests/session/session_support.h"
#include "tests/support/meshed_block.h"

namespace artus {
namespace {

std::shared_ptr<const CompiledJoint> make_block() {
  const std::array<FlatLayer, 4> layers{
      {{"skin", 2e-3}, {"fat", 8e-3}, {"muscle", 20e-3}, {"bone", 10e-3}}};
  return std::make_shared<const CompiledJoint>(test::make_meshed_block(layers, 0.064, 0.048, 4e-3));
}

std::shared_ptr<const Scene> pressed(const std::shared_ptr<const CompiledJoint>& joint,
                                     double depth) {
  auto made = press_scene(joint, joint->X_JP_default, {depth, std::nullopt});
  EXPECT_TRUE(made) << made.error().to_string();
  return made->scene;
}

ImageSnapshot image_of(std::shared_ptr<const Scene> body, std::uint64_t number) {
  ImageSnapshot image;
  image.input.number = number;
  image.body = std::move(body);
  return image;
}

TEST(BodyShape, AMeanGoesWithTheVertexNextToItAndTwoSheetsWithTheSame) {
  const auto joint = make_block();
  const auto body = pressed(joint, 3e-3);
  const VertexPlaces places = places_in(*joint, state_of(*body));
  const auto& rest = joint->mesh.vertices;
  double most = 0;
  for (const Sheet& sheet : find_sheets(*joint)) {
    ASSERT_EQ(sheet.surface.sources.size(), sheet.surface.points.size());
    const Surface coarse = decimated(sheet.surface, 5e-3);
    ASSERT_EQ(coarse.sources.size(), coarse.points.size());
    for (std::size_t i = 0; i < coarse.points.size(); ++i) {
      const Vec3 mean = coarse.points[i].cast<double>();
      EXPECT_LT((rest[coarse.sources[i]] - mean).norm(), 5e-3);
      const Vec3 moved = places.displacement(coarse.sources[i]);
      EXPECT_LT((body->tissue()->displacement(mean) - moved).norm(), 0.8e-3) << mean.transpose();
      most = std::max(most, moved.norm());
    }
  }
  EXPECT_NEAR(most, 3e-3, 0.3e-3) << "the skin under the face";
}

TEST(BodyShape, SeesWhatAPersonCanSee) {
  const auto joint = make_block();
  const auto body = pressed(joint, 1e-3);
  BodySight sight;
  const BodyState rest{joint, nullptr};
  EXPECT_TRUE(sight.changed(rest));
  EXPECT_FALSE(sight.changed(rest));
  EXPECT_TRUE(sight.changed(state_of(*body)));
  const auto moved_by = [&](double by) {
    const DeformedBody& tissue = *body->tissue();
    std::vector<Vec3> nodes(tissue.node_displacements().begin(), tissue.node_displacements().end());
    nodes[nodes.size() / 2] += Vec3(by, 0, 0);
    return BodyState{joint, std::make_shared<const DeformedBody>(joint, tissue.shared_map(), nodes,
                                                                 tissue.contact())};
  };
  EXPECT_FALSE(sight.changed(moved_by(20e-6)));
  EXPECT_TRUE(sight.changed(moved_by(40e-6)));
  EXPECT_TRUE(sight.changed(rest)) << "lifted";
}

TEST(BodyShape, APictureOfTheLoopHasItsOwnBody) {
  const auto joint = make_block();
  const std::array<std::shared_ptr<const Scene>, 2> bodies{pressed(joint, 1e-3),
                                                           pressed(joint, 2e-3)};
  CineLoop cine(joint);
  for (std::size_t i = 0; i < bodies.size(); ++i)
    cine.add(image_of(bodies[i], i + 1), {{"muscle", 4, 1, 1.0 + static_cast<double>(i)}},
             0.1 * static_cast<double>(i));
  cine.add(image_of(std::make_shared<const Scene>(joint), 3), {}, 0.2);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    EXPECT_EQ(cine.at(i).body, nullptr) << "a scene is not kept for 20 s";
    EXPECT_EQ(cine.labels(i).at(0).y_mm, 1.0 + static_cast<double>(i));
    const BodyState body = cine.body(i);
    ASSERT_TRUE(body.tissue);
    for (const Vec3& p : {Vec3(0, 0, 1e-3), Vec3(5e-3, 0, 12e-3)})
      EXPECT_LT((body.tissue->displacement(p) - bodies[i]->tissue()->displacement(p)).norm(), 1e-9);
  }
  EXPECT_EQ(cine.body(2).joint, joint);
  EXPECT_EQ(cine.body(2).tissue, nullptr);
}

TEST(BodyShape, APictureWithLiquidIsKeptWithoutItsJoint) {
  const auto joint = make_block();
  const auto body = pressed(joint, 1e-3);
  const auto filled = std::make_shared<const CompiledJoint>(
      with_injected(*joint, {{"muscle", 1e-6, false, Vec3(0, 0, 20e-3)}}, Liquid{}));
  const auto& cage = body->tissue()->map();
  const auto both = make_scene(std::make_shared<const DeformedBody>(
      filled, make_body_map(*filled, cage.X_JC, cage.model), body->tissue()->node_displacements(),
      body->tissue()->contact()));
  CineLoop cine(joint);
  cine.add(image_of(body, 1), {}, 0);
  cine.add(image_of(both, 2), {}, 0.1);
  EXPECT_EQ(cine.body(1).joint, filled) << "the newest is whole";
  cine.add(image_of(body, 3), {}, 0.2);
  const BodyState kept = cine.body(1);
  EXPECT_EQ(kept.joint, joint);
  ASSERT_TRUE(kept.tissue);
  EXPECT_LT(
      (kept.tissue->displacement(Vec3(0, 0, 1e-3)) - body->tissue()->displacement(Vec3(0, 0, 1e-3)))
          .norm(),
      1e-9);
}

/// With OpenGL, without a session.
class WindowJoint : public testing::Test {
 protected:
  void SetUp() override {
    if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display; ctest runs it under Xvfb";
    auto screen = Screen::open(320, 240);
    ASSERT_TRUE(screen) << screen.error().to_string();
    screen_ = std::move(*screen);
    texture_ = std::make_unique<GlTexture>();
    const std::array<std::uint8_t, 1> black{0};
    texture_->set_grey(1, 1, black);
    auto view = JointView::make(joint_, 40e-3, 60e-3);
    ASSERT_TRUE(view) << view.error().to_string();
    view_ = std::move(*view);
  }
  void TearDown() override {
    view_.reset();
    texture_.reset();
  }

  /// One whole picture, when there is anything new.
  bool draw(const std::shared_ptr<const Scene>& body, std::uint64_t number) {
    const ImageSnapshot image = image_of(body, number);
    const std::optional<EntryChoice> none;
    for (int k = 0; k < 1000; ++k) {
      view_->draw(320, 240, {now_, to_pose(now_.X_JN), state_of(*body), &image, *texture_, none});
      if (view_->drew()) return true;
      if (k == 0 && view_->image_shown() != 0 && !view_->making()) return false;
    }
    return false;
  }

  std::shared_ptr<const CompiledJoint> joint_ = make_block();
  HapticSnapshot now_;
  std::unique_ptr<Screen> screen_;
  std::unique_ptr<GlTexture> texture_;
  std::unique_ptr<JointView> view_;
};

TEST_F(WindowJoint, ASurfaceIsWhereTheBodyHasItAndOnlyWhatMovedIsSentAgain) {
  const auto body = pressed(joint_, 3e-3);
  const VertexPlaces places = places_in(*joint_, state_of(*body));
  for (const Sheet& sheet : find_sheets(*joint_)) {
    MovingMesh mesh(sheet.surface);
    std::size_t moved = 0;
    for (const std::uint32_t v : sheet.surface.sources)
      moved += places.displacement(v).norm() >= MovingMesh::kStep ? 1 : 0;
    const std::size_t sent = mesh.move(places);
    EXPECT_GE(sent, moved);
    EXPECT_EQ(sent == 0, moved == 0);
    for (std::size_t i = 0; i < mesh.points().size(); ++i)
      EXPECT_LT(
          (mesh.points()[i].cast<double>() - body->tissue()->vertices()[sheet.surface.sources[i]])
              .norm(),
          1.01 * MovingMesh::kStep);
    EXPECT_EQ(mesh.move(places), 0U) << "nothing moved since";
    EXPECT_EQ(mesh.move({joint_->mesh.vertices, {}}), sent) << "and back";
  }
}

TEST_F(WindowJoint, APictureIsOfTheBodyOfItsImage) {
  const auto rest = std::make_shared<const Scene>(joint_);
  ASSERT_TRUE(draw(rest, 1));
  EXPECT_EQ(view_->image_shown(), 1U);
  EXPECT_EQ(view_->points_sent(), 0U);
  EXPECT_FALSE(draw(rest, 2)) << "nothing moved";
  const auto body = pressed(joint_, 3e-3);
  ASSERT_TRUE(draw(body, 3)) << "the hands stood still, the tissue did not";
  EXPECT_EQ(view_->image_shown(), 3U);
  EXPECT_GT(view_->points_sent(), 100U);
  now_.X_JP = to_plain(joint_->X_JP_default * Eigen::Translation3d(5e-3, 0, 0));
  ASSERT_TRUE(draw(body, 4)) << "the probe moved";
  EXPECT_EQ(view_->image_shown(), 4U);
  EXPECT_EQ(view_->points_sent(), 0U) << "and nothing else did";
}

TEST_F(WindowJoint, LiquidInTissueLiftsItAndIsDrawn) {
  const auto filled = std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(
      with_injected(*joint_, {{"muscle", 2e-6, false, Vec3(0, 0, 20e-3)}}, Liquid{})));
  ASSERT_TRUE(draw(std::make_shared<const Scene>(joint_), 1));
  const std::size_t looks = view_->looks().size();
  ASSERT_TRUE(draw(filled, 2));
  EXPECT_GT(view_->points_sent(), 100U);
  EXPECT_EQ(view_->looks().size(), looks + 1);
  EXPECT_EQ(view_->looks().back().name, "injected");
}

TEST_F(WindowJoint, NamesGoWithTheirStructures) {
  view_->camera().pitch = 0;
  ASSERT_TRUE(draw(std::make_shared<const Scene>(joint_), 1));
  const auto height_of = [&](const std::string& name) {
    for (const ScreenLabel& label : view_->labels(320, 240))
      if (label.name == name) return label.y;
    ADD_FAILURE() << name << " is not named";
    return 0.F;
  };
  for (TissueLook& look : view_->looks()) look.alpha = 0.5F;
  const float before = height_of("fat");
  ASSERT_TRUE(draw(pressed(joint_, 4e-3), 2));
  EXPECT_GT(height_of("fat"), before + 0.5F) << "deeper";
}

TEST_F(WindowJoint, TheWindowsViewIsOfThePictureThatItShows) {
  view_.reset();
  texture_.reset();
  screen_.reset();
  HandTarget hands;
  hands.X_WP = to_plain(joint_->X_JP_default * Eigen::Translation3d(0, 0, 3e-3));
  hands.X_WN = to_plain(make_pose(Vec3(0, 0, -10e-3), Vec3::UnitZ(), Vec3::UnitX()));
  SessionParams params = test::make_small_session();
  params.deform = true;
  Session::Options session_options;
  session_options.haptic_options = {};
  session_options.imaging_options = {};
  auto device = std::make_unique<HandDevice>(hands, 1 / params.haptic_rate);
  HandDevice* hand = device.get();
  auto session = Session::start(std::make_shared<const Scene>(joint_), params, std::move(device),
                                session_options);
  ASSERT_TRUE(session) << session.error().to_string();
  WindowOptions options;
  options.width = 640;
  options.height = 400;
  options.quit_after_script = true;
  options.script = *parse_script("wait 4\n", "test");
  std::vector<std::uint64_t> images;
  std::vector<std::uint64_t> bodies;
  std::size_t sent = 0;
  options.watch = [&](const WindowStatus& now) {
    images.push_back(now.image);
    sent += now.joint_image != (bodies.empty() ? 0 : bodies.back()) ? now.joint_points_sent : 0;
    bodies.push_back(now.joint_image);
  };
  WindowReport report;
  ASSERT_TRUE(run_window(**session, hand, hands, options, report));
  EXPECT_GT(sent, 100U) << "the probe pressed, and the view showed it";
  std::size_t changes = 0;
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    if (bodies[i] == bodies[i - 1]) continue;
    ++changes;
    EXPECT_GE(bodies[i], bodies[i - 1]);
    const auto shown = images.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    EXPECT_TRUE(std::find(images.begin(), shown, bodies[i]) != shown)
        << "a picture that the window showed: " << bodies[i];
  }
  EXPECT_GT(changes, 1U);
}

}  // namespace
}  // namespace artus
