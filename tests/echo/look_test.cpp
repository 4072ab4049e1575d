// SPDX-License-Identifier: AGPL-3.0-or-later
// The scanner's back end: clutter, speckle reduction, grey curve, grain.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/echo/display/clutter.h"
#include "artus/detail/echo/display/display.h"
#include "artus/detail/echo/display/scan_converter.h"
#include "artus/detail/echo/display/speckle_reduction.h"
#include "artus/detail/echo/probe/grey_curve_file.h"
#include "artus/echo/renderer.h"
#include "tests/echo/echo_fixture.h"

namespace artus {
namespace {

const std::array<test::FlatLayer, 4> kLookLayers{
    {{"skin", 2e-3}, {"fat", 6e-3}, {"muscle", 14e-3}, {"bone", 20e-3}}};

ImageSettings look_settings(Look look) {
  ImageSettings settings;
  settings.look = look;
  settings.n_threads = 2;
  return settings;
}

/// Envelopes that are silent but for some lines and samples.
struct Envelopes {
  ImageSettings settings;
  Transducer transducer;
  std::vector<float> values;
  Envelopes() : values(static_cast<std::size_t>(transducer.n_lines) * 1024, 0.0F) {}
  void set(int line, int first, int last, float value) {
    for (int i = first; i < last; ++i)
      values[static_cast<std::size_t>(line) * 1024 + static_cast<std::size_t>(i)] = value;
  }
};

/// The clutter's mean power at a place, over what the receiver alone gives there.
class ClutterTest : public ::testing::Test {
 protected:
  void gather() { clutter_.gather(workers_, echoes_.values); }
  double over_noise(int l, int i) { return clutter_.mean_power(l, i) - silent_.mean_power(l, i); }
  void SetUp() override {
    silent_.gather(workers_, std::vector<float>(echoes_.values.size(), 0.0F));
  }
  Envelopes echoes_;
  BlockWorkers workers_{2};
  Clutter clutter_{echoes_.transducer, echoes_.settings};
  Clutter silent_{echoes_.transducer, echoes_.settings};
};

TEST_F(ClutterTest, SideLobesFallByTheSameFactorToEitherSide) {
  for (const int l : {128, 129}) echoes_.set(l, 400, 404, 0.1F);
  gather();
  const double near = over_noise(108, 401);
  EXPECT_GT(near, 0);
  EXPECT_NEAR(over_noise(88, 401) / near, over_noise(68, 401) / over_noise(88, 401), 1e-3);
  EXPECT_NEAR(over_noise(149, 401) / near, 1, 0.02);
  EXPECT_LT(over_noise(88, 401), 0.8 * near);
}

TEST_F(ClutterTest, HazeComesLaterAndNeverBefore) {
  for (int l = 0; l < 256; ++l) echoes_.set(l, 400, 404, 0.1F);
  gather();
  EXPECT_EQ(over_noise(128, 380), 0);
  const double first = over_noise(128, 440);
  const double second = over_noise(128, 480);
  EXPECT_GT(first, 0);
  EXPECT_NEAR(second / first, over_noise(128, 520) / second, 1e-3);
  EXPECT_LT(second, first);
}

TEST_F(ClutterTest, AnEndlessEchoIsHeardInTheSideLobesWithAllTheirPower) {
  for (int l = 0; l < 256; ++l) echoes_.set(l, 0, 1024, 0.1F);
  gather();
  // far from the edges both sides are full: lobes of -26 dB, haze of -39 dB once it has built up
  EXPECT_NEAR(10 * std::log10(over_noise(128, 1000) / 0.01), -25.8, 0.3);
  EXPECT_LT(over_noise(1, 1000), 0.65 * over_noise(128, 1000));  // half of it at the edge
}

TEST_F(ClutterTest, AnEchoThatClipsTheReceiverAddsNoMoreThanOneThatJustDoes) {
  for (int l = 0; l < 256; ++l) echoes_.set(l, 400, 404, 0.3F);
  gather();
  const double before = over_noise(128, 440);
  for (int l = 0; l < 256; ++l) echoes_.set(l, 400, 404, 4);
  gather();
  EXPECT_DOUBLE_EQ(over_noise(128, 440), before);
}

TEST_F(ClutterTest, TheReceiverHissesMoreWithDepth) {
  EXPECT_GT(silent_.mean_power(10, 900), 4 * silent_.mean_power(10, 100));
}

TEST_F(ClutterTest, ItsSpeckleIsThatOfFullyDevelopedSpeckle) {
  gather();
  std::vector<double> share;
  std::vector<float> power(1024);
  for (int l = 0; l < 256; ++l) {
    clutter_.add(std::span(echoes_.values).subspan(static_cast<std::size_t>(l) * 1024, 1024), l,
                 power);
    for (int i = 0; i < 1024; ++i)
      share.push_back(static_cast<double>(power[static_cast<std::size_t>(i)]) /
                      clutter_.mean_power(l, i));
  }
  const double mean = std::accumulate(share.begin(), share.end(), 0.0) / 262144;
  double squares = 0;
  for (const double s : share) squares += (s - mean) * (s - mean);
  EXPECT_NEAR(mean, 1, 0.05);
  EXPECT_NEAR(squares / 262144 / (mean * mean), 1, 0.1);  // of an exponential distribution
}

TEST_F(ClutterTest, ItsSpeckleStaysInTheBodyWhileTheProbeSlides) {
  gather();
  const std::vector<float> silence(1024, 0.0F);
  std::vector<float> before(1024);
  std::vector<float> after(1024);
  clutter_.place(test::probe_at(1e-3, 0.4e-3, 0));
  clutter_.add(silence, 60, before);
  clutter_.place(test::probe_at(1e-3 + 5 * echoes_.transducer.pitch(), 0.4e-3, 0));
  clutter_.add(silence, 55, after);
  EXPECT_EQ(before, after);
  clutter_.place(test::probe_at(1e-3, 0.4e-3 + 3e-3, 0));
  clutter_.add(silence, 60, after);
  EXPECT_NE(before, after);
}

TEST(SpeckleReduction, LeavesWhatIsEvenAndMovesAnEdgeByAFewDecibels) {
  const SpeckleReduction reduction(64, 40e-6);
  std::vector<float> lines(3 * 64, -30.0F);
  std::vector<float> out(64);
  reduction.reduce(lines, 3, 1, out);
  for (const float v : out) EXPECT_FLOAT_EQ(v, -30.0F);
  for (int l = 0; l < 3; ++l)
    for (int i = 32; i < 64; ++i) lines[static_cast<std::size_t>(l * 64 + i)] = 10.0F;
  reduction.reduce(lines, 3, 1, out);
  // by its shares of 9 dB downward and of 14 dB upward, and no farther than three samples
  EXPECT_FLOAT_EQ(out[32], 10 - 0.29F * 9);
  EXPECT_FLOAT_EQ(out[31], -30 + 0.29F * 14);
  EXPECT_FLOAT_EQ(out[34], 10 - 0.05F * 9);
  EXPECT_FLOAT_EQ(out[35], 10.0F);
}

TEST(SpeckleReduction, FillsADarkSampleMoreThanItDimsABrightOne) {
  const SpeckleReduction reduction(64, 40e-6);
  std::vector<float> lines(3 * 64, -30.0F);
  std::vector<float> out(64);
  lines[64 + 20] = -60;
  lines[64 + 40] = 0;
  reduction.reduce(lines, 3, 1, out);
  EXPECT_GT(out[20] + 60, 1.5F * (0 - out[40]));
}

TEST(SpeckleReduction, NarrowsTheSpreadOfSpeckle) {
  const auto scene = test::make_block_scene(std::array<test::FlatLayer, 1>{{{"muscle", 60e-3}}});
  const auto spread = [&](bool reduced) {
    ImageSettings settings = look_settings(Look::clinical);
    settings.speckle_reduction = reduced;
    settings.texture = false;
    const Frame frame = render_bmode(scene, test::probe_at(), {}, {}, settings);
    std::vector<double> values;
    for (int l = 64; l < 192; ++l)
      for (int i = 300; i < 600; ++i)
        values.push_back(static_cast<double>(
            frame.decibel[static_cast<std::size_t>(l) * 1024 + static_cast<std::size_t>(i)]));
    return moments_of(values).deviation;
  };
  EXPECT_LT(spread(true), 0.8 * spread(false));
}

TEST(Looks, RawIsTheCompressedEnvelopeInLinearGrey) {
  const auto scene = test::make_block_scene(kLookLayers);
  ImageSettings settings = look_settings(Look::raw);
  const Frame frame = render_bmode(scene, test::probe_at(), {}, {}, settings);
  std::vector<float> decibel(frame.envelope.size());
  compress(frame.envelope, static_cast<float>(settings.gain_db), decibel);
  EXPECT_EQ(frame.decibel, decibel);
  settings.clutter = settings.speckle_reduction = settings.grain = false;
  settings.grey_curve.grey.fill(0.5);
  EXPECT_EQ(render_bmode(scene, test::probe_at(), {}, {}, settings).image, frame.image);
}

TEST(Looks, EachStageChangesTheClinicalPicture) {
  const auto scene = test::make_block_scene(kLookLayers);
  const auto picture = [&](auto change) {
    ImageSettings settings = look_settings(Look::clinical);
    change(settings);
    return render_bmode(scene, test::probe_at(), {}, {}, settings).image;
  };
  const auto clinical = picture([](ImageSettings&) {});
  EXPECT_EQ(clinical, picture([](ImageSettings& s) { s.n_threads = 7; }));
  EXPECT_NE(clinical, picture([](ImageSettings& s) { s.clutter = false; }));
  EXPECT_NE(clinical, picture([](ImageSettings& s) { s.speckle_reduction = false; }));
  EXPECT_NE(clinical, picture([](ImageSettings& s) { s.grain = false; }));
  EXPECT_NE(clinical, picture([](ImageSettings& s) { s.grey_curve.grey[4] += 0.05; }));
}

TEST(Looks, NothingFlickersWhileTheProbeRests) {
  Renderer renderer(test::make_block_scene(kLookLayers), Transducer{},
                    look_settings(Look::clinical));
  const std::vector<std::uint8_t> first = renderer.render(test::probe_at()).image;
  EXPECT_EQ(renderer.render(test::probe_at()).image, first);
}

TEST(Looks, ShadowsAreGreyAndNotBlack) {
  Renderer renderer(test::make_block_scene(kLookLayers), Transducer{},
                    look_settings(Look::clinical));
  const Frame& frame = renderer.render(test::probe_at());
  std::vector<double> shadow;
  const int first = 26 * 10;  // pixels of 0.1 mm
  for (int y = first; y < 380; ++y)
    for (int x = 20; x < frame.width - 20; ++x)
      shadow.push_back(frame.image[static_cast<std::size_t>(y * frame.width + x)]);
  std::sort(shadow.begin(), shadow.end());
  EXPECT_GT(shadow[shadow.size() / 20], 3);
  EXPECT_GT(shadow[shadow.size() / 2], 7);
  EXPECT_LT(shadow[shadow.size() / 2], 25);
}

/// Mean over deviation of the envelope of a homogeneous block.
double speckle_ratio(Look look) {
  const auto scene = test::make_block_scene(std::array<test::FlatLayer, 1>{{{"muscle", 60e-3}}},
                                            [](CompiledJoint& joint) {
                                              for (Tissue& tissue : joint.tissues)
                                                tissue.acoustic.attenuation = 0;
                                            });
  ImageSettings settings = test::bare_settings();
  settings.look = look;
  const Frame frame = render_bmode(scene, test::probe_at(), {}, {}, settings);
  std::vector<double> values;
  for (int l = 20; l < 236; ++l)
    for (int i = 300; i < 500; ++i)
      values.push_back(
          static_cast<double>(test::envelope_line(frame, l)[static_cast<std::size_t>(i)]));
  const Moments moments = moments_of(values);
  return moments.mean / moments.deviation;
}

TEST(CompoundLook, AveragesThreeIndependentSetsOfSpeckle) {
  // the mean of n independent envelopes: sqrt(n) times steadier
  EXPECT_NEAR(speckle_ratio(Look::compound) / speckle_ratio(Look::raw), std::sqrt(3.0), 0.12);
}

TEST(CompoundLook, LeavesWhatIsNoSpeckleAsItIs) {
  const auto scene = test::make_block_scene(kLookLayers, [](CompiledJoint& joint) {
    for (Tissue& tissue : joint.tissues) tissue.acoustic.backscatter = 0;
  });
  const auto envelope = [&](Look look) {
    ImageSettings settings = look_settings(look);
    settings.n_threads = look == Look::clinical ? 1 : 3;
    return render_bmode(scene, test::probe_at(),
                        test::needle_at(test::probe_at(), Vec3(2e-3, 0, 14e-3), 0.4), {}, settings)
        .envelope;
  };
  const auto once = envelope(Look::clinical);
  const auto averaged = envelope(Look::compound);
  double most = 0;
  for (std::size_t i = 0; i < once.size(); ++i)
    most = std::max(most, std::abs(static_cast<double>(once[i] - averaged[i])));
  EXPECT_LT(most, 1e-6);
}

TEST(CompoundLook, ItsSpeckleMovesWithTheTissue) {
  Renderer renderer(test::make_block_scene(kLookLayers), Transducer{},
                    look_settings(Look::compound));
  const Frame before = renderer.render(test::probe_at());
  const Frame& after = renderer.render(test::probe_at(Transducer{}.pitch()));
  std::vector<double> here;
  std::vector<double> there;
  for (int i = 250; i < 500; ++i) {
    here.push_back(
        static_cast<double>(test::envelope_line(before, 101)[static_cast<std::size_t>(i)]));
    there.push_back(
        static_cast<double>(test::envelope_line(after, 100)[static_cast<std::size_t>(i)]));
  }
  EXPECT_GT(fit_line(here, there).correlation, 0.99);
}

TEST(GreyCurves, TheDefaultIsTheFirstThatIsBundled) {
  const auto presets = read_bundled_grey_curves();
  ASSERT_TRUE(presets.has_value()) << presets.error().to_string();
  EXPECT_EQ(presets->front().curve, GreyCurve{});
  EXPECT_EQ(presets->front().name, "clinical");
  EXPECT_EQ(find_grey_curve("linear")->curve.grey[2], 0.25);
  EXPECT_EQ(find_grey_curve("nothing").error().code, ErrorCode::not_found);
  EXPECT_EQ(find_grey_curve("nothing.toml").error().code, ErrorCode::not_found);
}

TEST(GreyCurves, ALinearOneIsTheRawMapWithinALevel) {
  const ImageSettings settings;
  ScanConverter converter({}, settings);
  std::vector<float> decibel(256 * 1024);
  for (std::size_t i = 0; i < decibel.size(); ++i)
    decibel[i] = -70 + 80 * static_cast<float>(i % 1024) / 1024;
  const auto size = static_cast<std::size_t>(converter.width() * converter.height());
  std::vector<std::uint8_t> raw(size);
  std::vector<std::uint8_t> curved(size);
  converter.convert(decibel, 0, converter.height(), raw);
  converter.set_curve(find_grey_curve("linear")->curve, false);
  converter.convert(decibel, 0, converter.height(), curved);
  int most = 0;
  for (std::size_t i = 0; i < size; ++i) most = std::max(most, std::abs(raw[i] - curved[i]));
  EXPECT_LE(most, 1);
}

TEST(GreyCurves, FilesThatMakeNoSenseAreRefusedWithTheReason) {
  const std::string head = "format = 1\nname = \"a\"\ntitle = \"b\"\nsource = \"assumed: c\"\n";
  const auto reason = [&](const std::string& text) {
    const auto parsed = parse_grey_curve(text, "curve.toml");
    EXPECT_FALSE(parsed.has_value()) << text;
    return parsed ? std::string() : parsed.error().to_string();
  };
  EXPECT_NE(reason(head).find("'grey' is missing"), std::string::npos);
  EXPECT_NE(reason(head + "grey = [0, 1]").find("nine numbers"), std::string::npos);
  EXPECT_NE(reason(head + "grey = [0, 0.1, 0.2, 0.1, 0.4, 0.5, 0.6, 0.7, 1]").find("never fall"),
            std::string::npos);
  EXPECT_NE(reason(head + "grey = [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 2]").find("0 to 1"),
            std::string::npos);
  EXPECT_TRUE(
      parse_grey_curve(head + "grey = [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.9]", "curve.toml"));
}

}  // namespace
}  // namespace artus
