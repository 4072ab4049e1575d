// SPDX-License-Identifier: AGPL-3.0-or-later
// A recording holds all that its results depend on: each parameter of a session by itself.
#include "artus/session/replay.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "artus/detail/simulation/session_fields.h"
#include "artus/simulation/simulation.h"
#include "tests/session/session_support.h"

namespace artus {
namespace {

template <class T>
void write_record(std::ostream& out, std::uint32_t kind, const T& record) {
  const RecordStart start{kind, sizeof(T)};
  out.write(reinterpret_cast<const char*>(&start), sizeof start);
  out.write(reinterpret_cast<const char*>(&record), sizeof record);
}

/// Few lines and samples: 150 sessions are recorded and replayed here.
SessionParams small_session() {
  SessionParams params = test::make_small_session();
  params.transducer.n_lines = 8;
  params.image.n_samples = 128;
  params.image.pixel = 1e-3;
  return params;
}

/// A session without threads and clocks: in to bone, out, in again beside the first line, a rest
/// and on, the plunger pushed all the while, with two images on the way.
std::string record(const std::shared_ptr<const Scene>& scene, const SessionParams& params,
                   const PreparedBody& prepared = {}) {
  std::ostringstream out;
  out << to_line(make_head(scene->joint(), params)) << '\n';
  Simulation simulation(scene, params, 0, prepared);
  std::uint64_t n = 0;
  std::uint64_t frames = 0;
  const double period = 1e9 / params.haptic_rate;  // ns
  const auto tick = [&](double x, double z, std::uint32_t buttons) {
    ++n;
    TickInput input;
    input.tick = n;
    input.device =
        test::sample_at(z, static_cast<std::int64_t>(static_cast<double>(n) * period), n);
    input.device.X_WN =
        to_plain(make_pose(Vec3(x, 0, z), Vec3(0.02, 0, 1).normalized(), Vec3::UnitX()));
    input.device.buttons = buttons;
    input.device.plunger = PlungerSign::travel;
    input.device.plunger_travel = 4e-6 * static_cast<double>(n);
    const HapticSnapshot& snapshot = simulation.tick(input);
    write_record(out, RecordStart::kTick, to_record(snapshot));
    if (n % 600 != 0) return;
    const FrameInput frame = frame_input(snapshot, controls_of(params), ++frames);
    write_record(out, RecordStart::kFrame,
                 to_record(frame, simulation.render(frame, simulation.advance(frame)),
                           simulation.transducer()));
  };
  for (int i = 0; i < 520; ++i) tick(0, -8e-3 + 75e-6 * i, 0);
  for (int i = 0; i < 300; ++i) tick(0, 31e-3 - 130e-6 * i, 0);
  for (int i = 0; i < 400; ++i) tick(1e-3, -8e-3 + 75e-6 * i, i == 60 ? Button::kCalibrate : 0U);
  for (int i = 0; i < 200; ++i) tick(1e-3, 22e-3 + 75e-6 * std::max(0, i - 160), 0);
  write_record(out, RecordStart::kEnd, std::uint64_t{0});
  return out.str();
}

/// A change of a session's params, by name.
struct Change {
  std::string name;
  std::function<void(SessionParams&)> apply;
};

/// Changes one field to another value that it may have.
void nudge(const std::string& name, double& value) {
  if (name == "haptic_rate")
    value = 1300;
  else if (name == "device.force")
    value = 1;
  else if (name == "guard.force_slew")
    value = 100;
  else if (name == "needle_shape.outer_diameter")
    value = 1.27e-3;
  else if (name == "transducer.radius")
    value = 0.06;
  else if (name == "syringe.air")
    value = 1e-7;
  else if (name == "image.persistence" || name == "image.smoothing")
    value = 0.3;
  else if (name == "gesture.p_W" || value == 0)
    value = 0.01;
  else if (std::isfinite(value))
    value *= 0.97;
  else
    value = 0.5;
}

std::vector<Change> all_changes() {
  std::vector<Change> changes;
  SessionParams names = small_session();
  visit_fields(names, [&changes](const std::string& name, auto& /*member*/) {
    changes.push_back({name, [name](SessionParams& params) {
                         visit_fields(params, [&name](const std::string& at, auto& member) {
                           using Member = std::remove_cvref_t<decltype(member)>;
                           if (at != name) return;
                           if constexpr (std::is_same_v<Member, double>)
                             nudge(name, member);
                           else if constexpr (std::is_same_v<Member, bool>)
                             member = !member;
                           else if constexpr (std::is_same_v<Member, std::string>)
                             member = "hyaluronic_light";
                           else if constexpr (std::is_enum_v<Member>)
                             member = static_cast<Member>(static_cast<int>(member) == 1 ? 0 : 1);
                           else if constexpr (std::is_same_v<Member, Vec3>) {
                             if (name == "gesture.axis_W")
                               member = Vec3(0, 0.6, 0.8);
                             else
                               for (double& x : member) nudge(name, x);
                           } else if (name == "image.compound_angles")
                             member = 3;
                           else
                             member += 1;
                         });
                       }});
  });
  const auto feel = [&changes](const char* name, auto change) {
    changes.push_back({std::string("feel.") + name, [change](SessionParams& p) {
                         change(p.feel);
                       }});
  };
  feel("cutting", [](NeedleFeel& f) { f.cutting.all = CuttingLaw::voigt; });
  feel("cutting_of_fat", [](NeedleFeel& f) { f.cutting.of_tissue["fat"] = CuttingLaw::direct; });
  feel("prepuncture", [](NeedleFeel& f) { f.prepuncture.all = PrepunctureLaw::god_object; });
  feel("prepuncture_of_skin",
       [](NeedleFeel& f) { f.prepuncture.of_tissue["skin"] = PrepunctureLaw::barbe; });
  feel("patient", [](NeedleFeel& f) { f.patient = {1.1, 1.2, 0.9, 1.3, 0.8}; });
  feel("tap", [](NeedleFeel& f) { f.tap = HardLaw::impulse; });
  feel("clamping", [](NeedleFeel& f) { f.clamping = ClampingLaw::plasticity; });
  feel("friction", [](NeedleFeel& f) { f.friction = lugre_sets()[0]; });
  feel("workspace", [](NeedleFeel& f) {
    f.workspace = HemisphereParams{Vec3(0.001, -0.02, 0.03), 0.05, 0.5};
  });
  feel("needle_length", [](NeedleFeel& f) { f.needle_length = 0.05; });
  feel("passivity", [](NeedleFeel& f) { f.passivity_control = true; });
  changes.push_back({"device_name", [](SessionParams& p) {
                       p.device = *find_device("touch");
                     }});
  changes.push_back(
      {"X_WJ", [](SessionParams& p) {
         p.X_WJ.linear() =
             Eigen::AngleAxisd(0.1234567, Vec3(1, 2, 3).normalized()).toRotationMatrix();
         p.X_WJ.translation() = Vec3(1e-3, -2e-3, 1.0 / 3000);
       }});
  return changes;
}

class EachParameter : public ::testing::Test {
 protected:
  static std::shared_ptr<const Scene> scene() {
    static const auto kScene = test::make_layered_scene(0.06);
    return kScene;
  }
  /// A space takes seconds to be made ready and depends on the joint alone.
  static PreparedBody prepared() {
    static const auto kSpaces = std::make_shared<const OpenedSpaces>(scene()->shared_joint());
    return {nullptr, kSpaces};
  }
};

TEST_F(EachParameter, IsInTheRecordingAndReplaysToTheSameBytes) {
  for (const Change& change : all_changes()) {
    SCOPED_TRACE(change.name);
    SessionParams params = small_session();
    change.apply(params);
    ASSERT_TRUE(validate(params)) << validate(params).error().to_string();
    const std::string line = to_line(make_head(scene()->joint(), params));
    EXPECT_NE(line, to_line(make_head(scene()->joint(), small_session())));
    const auto recording = test::parse_recording(record(scene(), params, prepared()));
    ASSERT_TRUE(recording) << recording.error().to_string();
    EXPECT_EQ(to_line(recording->head), line) << "read and written again";
    const auto report = replay(*recording, scene(), {}, 1, prepared());
    ASSERT_TRUE(report) << report.error().to_string();
    EXPECT_TRUE(report->identical());
    EXPECT_EQ(report->ticks, 1420U);
    EXPECT_EQ(report->frames, 2U);
  }
}

TEST_F(EachParameter, ThatIsAnotherThanTheHeadsChangesTheResults) {
  // Not every parameter shows in every session (a law that is not chosen); those of the first rank
  // must. What a knob turns, as the gain, is an input of each frame and is taken from there.
  const auto recording =
      test::parse_recording(record(scene(), test::make_small_session(), prepared()));
  ASSERT_TRUE(recording);
  for (const Change& change : all_changes()) {
    for (const char* shown :
         {"haptic_rate", "device.force", "needle.friction.mu_c", "needle.wall.settling_time",
          "needle.hard.sinusoid.amplitude", "guard.force_slew", "guard.ramp_time",
          "transducer.frequency", "transducer.n_lines", "image.speckle_db", "image.seed",
          "image.depth", "needle_shape.outer_diameter", "feel.cutting", "feel.patient",
          "gesture.steepness", "X_WJ"}) {
      if (change.name != shown) continue;
      Recording other = *recording;
      change.apply(other.head.params);
      const auto report = replay(other, scene(), {}, 1, prepared());
      ASSERT_TRUE(report);
      EXPECT_FALSE(report->identical()) << shown;
    }
  }
}

TEST(Replay, AHeadThatWasChangedOrLacksAFieldIsRefused) {
  const auto scene = test::make_layered_scene(0.06);
  const std::string line = to_line(make_head(scene->joint(), small_session()));
  ASSERT_TRUE(parse_head(line));
  const auto json = nlohmann::json::parse(line);
  std::size_t fields = 0;
  for (const auto& item : json.at("params").items()) {
    ++fields;
    nlohmann::json lacking = json;
    lacking["params"].erase(item.key());
    EXPECT_FALSE(parse_head(lacking.dump())) << item.key();
    nlohmann::json changed = json;
    changed["params"][item.key()] = 0.123;
    const auto head = parse_head(changed.dump());
    ASSERT_FALSE(head) << item.key();
    EXPECT_EQ(head.error().code, ErrorCode::corrupt);
  }
  EXPECT_GT(fields, 100U);
}

TEST(Replay, AnotherBodyIsRefused) {
  const auto scene = test::make_layered_scene(0.06);
  const auto recording = test::parse_recording(record(scene, test::make_small_session()));
  CompiledJoint joint = scene->joint();
  joint.tissues.back().haptic.friction *= 1.001;
  const auto other = replay(
      *recording, std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(joint)));
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, ErrorCode::invalid);
}

}  // namespace
}  // namespace artus
