// SPDX-License-Identifier: AGPL-3.0-or-later
// What a recording's bytes may be: each number of each record is checked before it is believed.
#include "artus/session/recording.h"

#include <limits>
#include <sstream>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "tests/session/session_support.h"

namespace artus {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TickRecord sound_tick(std::uint64_t number) {
  TickRecord tick;
  tick.input.tick = number;
  tick.input.device = test::sample_at(1e-3, 1000, number);
  return tick;
}

FrameRecord sound_frame(std::uint64_t number) {
  FrameRecord frame;
  frame.input.number = number;
  return frame;
}

template <class T>
void put(std::string& bytes, std::uint32_t kind, const T& record) {
  const RecordStart start{kind, sizeof(T)};
  bytes.append(reinterpret_cast<const char*>(&start), sizeof start);
  bytes.append(reinterpret_cast<const char*>(&record), sizeof record);
}

std::string file_of(const TickRecord& tick, const FrameRecord& frame) {
  static const std::string kHead =
      to_line(make_head(test::make_layered_scene()->joint(), test::make_small_session())) + "\n";
  std::string bytes = kHead;
  put(bytes, RecordStart::kTick, sound_tick(1));
  put(bytes, RecordStart::kTick, tick);
  put(bytes, RecordStart::kFrame, frame);
  put(bytes, RecordStart::kEnd, std::uint64_t{0});
  return bytes;
}

TEST(RecordedPacket, IsRefusedWhenNoTissueCanBeLikeIt) {
  PacketRecord sound;
  sound.tick = 1;
  sound.packet.needle.compliance = test::make_even_compliance();
  EXPECT_EQ(find_fault(sound, 0), nullptr);
  EXPECT_NE(find_fault(sound, 1), nullptr);
  const auto refuses = [&sound](const auto& spoil) {
    PacketRecord wrong = sound;
    spoil(wrong.packet.needle);
    return find_fault(wrong, 0) != nullptr;
  };
  EXPECT_TRUE(refuses([](NeedlePacket& n) { n.carried[1] = kNan; }));
  EXPECT_TRUE(refuses([](NeedlePacket& n) { n.compliance.points = NeedleCompliance::kMax + 1; }));
  EXPECT_TRUE(refuses([](NeedlePacket& n) { n.compliance.spacing = 0; }));
  EXPECT_TRUE(refuses([](NeedlePacket& n) { n.compliance.by_load[2][2] = 0; }));
  EXPECT_TRUE(refuses([](NeedlePacket& n) { n.compliance.by_load[2][5] = 1e9; }));
  EXPECT_TRUE(refuses([](NeedlePacket& n) { n.compliance.near_field[0] = kNan; }));
}

struct Wrong {
  const char* name;
  void (*spoil)(TickRecord&, FrameRecord&);
};

class WrongRecord : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongRecord, IsRefused) {
  TickRecord tick = sound_tick(2);
  FrameRecord frame = sound_frame(1);
  ASSERT_TRUE(test::parse_recording(file_of(tick, frame)));
  GetParam().spoil(tick, frame);
  const auto recording = test::parse_recording(file_of(tick, frame));
  ASSERT_FALSE(recording);
  EXPECT_EQ(recording.error().code, ErrorCode::corrupt);
  EXPECT_FALSE(recording.error().message.empty());
}

const Wrong kWrongs[] = {
    {"NeedleLoadNotFinite",
     [](TickRecord&, FrameRecord& frame) {
       frame.input.load.shaft[3] = kNan;
     }},
    {"NeedleLoadTooDeep",
     [](TickRecord&, FrameRecord& frame) {
       frame.input.load.tip_depth = 1e3;
     }},
    {"SitesTooMany",
     [](TickRecord&, FrameRecord& frame) {
       frame.input.n_sites = kMaxSites + 1;
     }},
    {"SiteNotFinite",
     [](TickRecord&, FrameRecord& frame) {
       frame.input.sites[1].p_J[2] = kNan;
     }},
    {"SiteVolume",
     [](TickRecord&, FrameRecord& frame) {
       frame.input.sites[0].volume = -1e-9;
     }},
    {"SiteRegion",
     [](TickRecord&, FrameRecord& frame) {
       frame.input.sites[0].region = 70000;
     }},
    {"SiteKind",
     [](TickRecord&, FrameRecord& frame) {
       frame.input.sites[3].cavity = 2;
     }},
    {"NeedleNotFinite",
     [](TickRecord& tick, FrameRecord&) {
       tick.input.device.X_WN.position[1] = kNan;
     }},
    {"NeedleTooFar",
     [](TickRecord& tick, FrameRecord&) {
       tick.input.device.X_WN.position[0] = 1e9;
     }},
    {"NeedleNotRigid",
     [](TickRecord& tick, FrameRecord&) {
       tick.input.device.X_WN.rotation[0] = 3;
     }},
    {"ProbeNotFinite",
     [](TickRecord& tick, FrameRecord&) {
       tick.input.device.X_WP.rotation[2] = kNan;
     }},
    {"State",
     [](TickRecord& tick, FrameRecord&) {
       tick.input.device.state = static_cast<PeerState>(4);
     }},
    {"NeedleFlag",
     [](TickRecord& tick, FrameRecord&) {
       tick.input.device.has_needle = 2;
     }},
    {"ProbeFlag",
     [](TickRecord& tick, FrameRecord&) {
       tick.input.device.has_probe = 0xffffffffU;
     }},
    {"Command",
     [](TickRecord& tick, FrameRecord&) {
       tick.input.command = 8;
     }},
    {"Reserved",
     [](TickRecord& tick, FrameRecord&) {
       tick.input.reserved = 1;
     }},
    {"PlungerTravel",
     [](TickRecord& tick, FrameRecord&) {
       tick.input.device.plunger_travel = kNan;
     }},
    {"PlungerSign",
     [](TickRecord& tick, FrameRecord&) {
       tick.input.device.plunger = static_cast<PlungerSign>(3);
     }},
    {"PlungerAnswer",
     [](TickRecord& tick, FrameRecord&) {
       tick.plunger.pressure = kNan;
     }},
    {"TickTwice",
     [](TickRecord& tick, FrameRecord&) {
       tick.input.tick = 1;
     }},
    {"Force",
     [](TickRecord& tick, FrameRecord&) {
       tick.force[2] = kNan;
     }},
    {"Torque",
     [](TickRecord& tick, FrameRecord&) {
       tick.torque[0] = -1 / 0.0;
     }},
    {"Region",
     [](TickRecord& tick, FrameRecord&) {
       tick.region = 70000;
     }},
    {"ImageNumber",
     [](TickRecord&, FrameRecord& frame) {
       frame.input.number = 0;
     }},
    {"ImageProbe",
     [](TickRecord&, FrameRecord& frame) {
       frame.input.X_JP.position[0] = kNan;
     }},
    {"ImageNeedle",
     [](TickRecord&, FrameRecord& frame) {
       frame.input.X_JN.rotation[3] = 1e200;
     }},
    {"ImageFlag",
     [](TickRecord&, FrameRecord& frame) {
       frame.input.has_needle = 7;
     }},
    {"Knob",
     [](TickRecord&, FrameRecord& frame) {
       frame.input.controls.depth = kNan;
     }},
};

INSTANTIATE_TEST_SUITE_P(Kinds, WrongRecord, ::testing::ValuesIn(kWrongs),
                         [](const auto& wrong) { return std::string(wrong.param.name); });

TEST(Recording, SomethingAfterItsEndIsRefused) {
  EXPECT_FALSE(test::parse_recording(file_of(sound_tick(2), sound_frame(1)) + "x"));
}

TEST(Recording, CutOffAnywhereItGivesWhatThereIsOrARefusal) {
  const std::string bytes = file_of(sound_tick(2), sound_frame(1));
  const std::size_t head = bytes.find('\n');
  for (std::size_t n = 0; n < bytes.size(); n += n < head ? 97 : 1) {
    const auto recording = test::parse_recording(bytes.substr(0, n));
    if (n < head)
      EXPECT_FALSE(recording) << n;
    else
      EXPECT_TRUE(recording && !recording->complete) << n;
  }
}

TEST(Recording, BytesTurnedAtRandomNeverGiveAPoseThatIsNone) {
  const std::string bytes = file_of(sound_tick(2), sound_frame(1));
  for (std::uint64_t i = 0; i < 3000; ++i) {
    std::string spoiled = bytes;
    for (std::uint64_t k = 0; k < 1 + i % 4; ++k)
      spoiled[mix_bits(7 * i + k) % spoiled.size()] = static_cast<char>(mix_bits(i * 31 + k));
    const auto recording = test::parse_recording(spoiled);
    if (!recording) continue;
    for (const TickRecord& tick : recording->ticks)
      ASSERT_TRUE(is_pose(tick.input.device.X_WN) && is_pose(tick.input.device.X_WP));
  }
}

}  // namespace
}  // namespace artus
