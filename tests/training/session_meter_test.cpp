// SPDX-License-Identifier: AGPL-3.0-or-later
// What a session measures while it runs is what its recording says afterwards, to the last digit.
#include "artus/detail/training/session_meter.h"

#include <sstream>

#include <gtest/gtest.h>

#include "artus/simulation/simulation.h"
#include "tests/session/session_support.h"
#include "tests/support/real_time.h"

namespace artus {
namespace {

template <class T>
void put(std::ostream& out, std::uint32_t kind, const T& record) {
  const RecordStart start{kind, sizeof(T)};
  out.write(reinterpret_cast<const char*>(&start), sizeof start);
  out.write(reinterpret_cast<const char*>(&record), sizeof record);
}

TEST(SessionMeter, LiveAndRecordedAreTheSameToTheLastDigit) {
  const auto scene = test::make_layered_scene();
  const SessionParams params = test::make_small_session();
  const RecordingHead head = make_head(scene->joint(), params);
  const double period = 1 / params.haptic_rate;
  AttemptMeter live(scene, options_for(head));
  std::stringstream file;
  file << to_line(head) << '\n';
  Simulation simulation(scene, params);
  std::uint64_t frames = 0;
  double given = 0;
  for (std::uint64_t n = 1; n <= 3000; ++n) {
    TickInput input;
    input.tick = n;
    const double z = n < 2000 ? -5e-3 + 17e-6 * static_cast<double>(n) : 29e-3;
    input.device = test::sample_at(z, static_cast<std::int64_t>(n) * 1000000, n);
    if (n > 1000 && n < 1600) {
      input.device.plunger = PlungerSign::force;
      input.device.plunger_force = 10;
    }
    const HapticSnapshot& out = simulation.tick(input);
    given = out.feedback.plunger.given;
    add_tick(live, out, period);
    put(file, RecordStart::kTick, to_record(out));
    if (n % 500 != 0) continue;
    const FrameInput frame = frame_input(out, controls_of(params), ++frames);
    const Frame& drawn = simulation.render(frame, simulation.advance(frame));
    add_frame(live, frame, drawn, static_cast<double>(n) * period);
    put(file, RecordStart::kFrame, to_record(frame, drawn, params.transducer));
  }
  put(file, RecordStart::kEnd, std::uint64_t{0});
  const auto recording = read_recording(file, "here");
  ASSERT_TRUE(recording);
  const auto replayed = assess(*recording, scene, options_for(head), SightSource::drawn);
  ASSERT_TRUE(replayed);
  const auto kept = assess(*recording, scene, options_for(head), SightSource::recorded);
  ASSERT_TRUE(kept);
  EXPECT_EQ(to_json(kept->metrics).dump(), to_json(replayed->metrics).dump());
  EXPECT_TRUE(find_metric(kept->metrics, "tip_visible")->value);
  const auto none = assess(*recording, scene, options_for(head), SightSource::none);
  ASSERT_TRUE(none);
  EXPECT_FALSE(find_metric(none->metrics, "tip_visible")->value);
  EXPECT_EQ(to_json(live.measure().metrics).dump(), to_json(replayed->metrics).dump());
  const Metric* contacts = find_metric(replayed->metrics, "bone_contacts");
  ASSERT_NE(contacts, nullptr);
  EXPECT_TRUE(contacts->value);
  EXPECT_TRUE(find_metric(replayed->metrics, "tip_visible")->value);
  EXPECT_GT(given, 0.01e-6);
  EXPECT_NEAR(find_metric(replayed->metrics, "given_ml")->value.value_or(0), 1e6 * given, 1e-9);
  double in_layers = 0;
  for (const Metric& m : replayed->metrics)
    if (m.name.rfind("given_ml:", 0) == 0) in_layers += m.value.value_or(0);
  EXPECT_NEAR(in_layers, 1e6 * given, 1e-9);
}

TEST(SessionMeter, TakesATickWithoutMemory) {
  const auto scene = test::make_layered_scene();
  const SessionParams params = test::make_small_session();
  AttemptMeter meter(scene, options_for(make_head(scene->joint(), params)));
  Simulation simulation(scene, params);
  TickInput input;
  input.tick = 1;
  input.device = test::sample_at(1e-3, 1000000, 1);
  const HapticSnapshot& out = simulation.tick(input);
  ARTUS_RUNS_REALTIME(add_tick, add_tick(meter, out, 1e-3));
}

}  // namespace
}  // namespace artus
