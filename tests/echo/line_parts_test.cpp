// SPDX-License-Identifier: AGPL-3.0-or-later
// The small parts that the stages of an image are made of.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/acquire/block_workers.h"
#include "artus/detail/echo/acquire/line_shaping.h"
#include "artus/detail/echo/display/compound.h"
#include "artus/detail/echo/display/scan_converter.h"
#include "artus/detail/echo/medium/scatter_field.h"
#include "artus/detail/echo/probe/gaussian.h"
#include "artus/detail/echo/probe/placed_line.h"

namespace artus {
namespace {

TEST(PlacedLine, IsTheScanlineSeenFromTheJoint) {
  Transducer curved;
  curved.radius = 40e-3;
  const Pose X_JP = make_pose(Vec3(0.01, -0.02, 0.3), Vec3(0.3, 0.2, 1), Vec3(1, 0.4, 0));
  for (const int l : {0, 17, 255}) {
    const PlacedLine placed = place_line(curved, l, X_JP);
    const Scanline line = scanline(curved, l);
    EXPECT_EQ(placed.index, l);
    EXPECT_TRUE(placed.origin_J.isApprox(X_JP * line.origin));
    EXPECT_TRUE(placed.direction_J.isApprox(X_JP.linear() * line.direction));
    EXPECT_NEAR(placed.across.norm(), 1, 1e-15);
    EXPECT_NEAR(placed.across.dot(line.direction), 0, 1e-15);
    EXPECT_EQ(placed.across.y(), 0);
    EXPECT_NEAR(placed.elevation_J.dot(placed.direction_J), 0, 1e-15);
  }
}

TEST(BlockWorkers, GiveEachLineToOneBlockAtAnyNumberOfThreads) {
  for (const int threads : {0, 1, 3}) {
    BlockWorkers workers(threads);
    for (const int n : {0, 1, 8, 27}) {
      std::vector<int> times(static_cast<std::size_t>(n), 0);
      workers.for_blocks(n, [&](int worker, int first, int last) {
        EXPECT_GE(worker, 0);
        EXPECT_LT(worker, workers.workers());
        EXPECT_EQ(first % BlockWorkers::kBlock, 0);
        EXPECT_EQ(last, std::min(n, first + BlockWorkers::kBlock));
        for (int l = first; l < last; ++l) ++times[static_cast<std::size_t>(l)];
      });
      for (int l = 0; l < n; ++l) EXPECT_EQ(times[static_cast<std::size_t>(l)], 1);
    }
  }
}

TEST(ScatterField, OfManyPiecesIsThatOfEach) {
  const ScatterField field(3, {0.4e-3, 1.5e-3, 0.1e-3});
  const Vec3 direction = Vec3(0.2, 0.1, 1).normalized();
  const ScatterView view =
      field.make_view(direction, direction.cross(Vec3(1, 0.3, 0)).normalized());
  const std::array<ScatterPiece, 4> pieces{{{3, 20, Vec3(1e-3, 2e-3, 3e-3), 4e-5 * direction},
                                            {20, 21, Vec3(2e-3, 2e-3, 3e-3), 3e-5 * direction},
                                            {40, 77, Vec3(0, -2e-3, 5e-3), Vec3(0, 0, 3e-5)},
                                            {77, 90, Vec3(0, -2e-3, 6e-3), Vec3(1e-5, 0, 3e-5)}}};
  constexpr std::size_t kSamples = 90;
  std::vector<float> gain;
  for (std::size_t i = 0; i < kSamples; ++i) gain.push_back(0.01F * static_cast<float>(i + 1));
  std::vector<float> re(kSamples, 0.5F);
  std::vector<float> im(kSamples, -0.5F);
  std::vector<float> re_each = re;
  std::vector<float> im_each = im;
  ScatterRoom room;
  room.resize(kSamples);
  ScatterField::add(view, pieces, gain, room, re, im);
  for (const ScatterPiece& piece : pieces) {
    const std::size_t n = piece.end - piece.begin;
    ScatterField::add(view, piece.p_J, piece.step_J, std::span(gain).subspan(piece.begin, n),
                      std::span(re_each).subspan(piece.begin, n),
                      std::span(im_each).subspan(piece.begin, n));
  }
  EXPECT_EQ(re, re_each);
  EXPECT_EQ(im, im_each);
  EXPECT_NE(re[30 + 20], 0.5F);
  EXPECT_EQ(re[30], 0.5F) << "between the pieces";
}

TEST(CompoundMean, OfEqualViewsIsTheView) {
  ImageSettings settings;
  settings.n_samples = 128;
  settings.compound_angles = 5;
  Transducer transducer;
  transducer.n_lines = 40;
  CompoundMean mean(transducer, settings);
  ASSERT_EQ(mean.views().size(), 5U);
  EXPECT_EQ(mean.views().back().transducer(), transducer);  // the unsteered one last
  BlockWorkers workers(1);
  const std::vector<float> flat(40 * 128, 0.25F);
  for (int frame = 0; frame < 2; ++frame) {
    mean.clear();
    for (const CompoundView& view : mean.views()) mean.add(view, flat, workers);
    std::vector<float> out(flat.size(), -1.0F);
    mean.write(out);
    EXPECT_NEAR(out[20 * 128 + 64], 0.25F, 1e-7F);
    EXPECT_EQ(out[20 * 128 + 127], 0.0F);  // no view has a sample behind its last
  }
}

TEST(CompoundMean, OfOneAngleHasNoViews) {
  EXPECT_TRUE(CompoundMean(Transducer{}, ImageSettings{}).views().empty());
}

TEST(ScanConverter, PixelsAndPointsAreEachOthersInverse) {
  Transducer curved;
  curved.radius = 50e-3;
  for (const Transducer& transducer : {Transducer{}, curved}) {
    const ScanConverter converter(transducer, ImageSettings{});
    for (const auto& [x, y] : {std::pair(0, 0), {37, 211}, {120, 5}}) {
      const PixelPoint pixel = converter.pixel_of(converter.point_of(x, y));
      EXPECT_NEAR(pixel.x, x, 1e-9);
      EXPECT_NEAR(pixel.y, y, 1e-9);
    }
  }
}

TEST(ScanConverter, WhiteIsZeroDecibelAndBlackTheDynamicRange) {
  ImageSettings settings;
  settings.n_samples = 64;
  Transducer transducer;
  transducer.n_lines = 8;
  ScanConverter converter(transducer, settings);
  std::vector<std::uint8_t> image(static_cast<std::size_t>(converter.width()) *
                                  static_cast<std::size_t>(converter.height()));
  const std::size_t middle = image.size() / 2 + static_cast<std::size_t>(converter.width()) / 2;
  const auto grey = [&](float db) {
    converter.convert(std::vector<float>(8 * 64, db), 0, converter.height(), image);
    return static_cast<int>(image[middle]);
  };
  for (const double range : {60.0, 90.0}) {
    converter.set_dynamic_range(range);
    EXPECT_EQ(grey(0), 255);
    EXPECT_EQ(grey(20), 255);
    EXPECT_EQ(grey(static_cast<float>(-range)), 0);
    EXPECT_NEAR(grey(static_cast<float>(-range / 2)), 128, 1);
  }
}

TEST(TimeGain, UndoesWhatTheSettingsSayUpToItsLimit) {
  ImageSettings settings;
  settings.tgc_db_cm_mhz = 0.5;
  settings.tgc_limit_db = 30;
  const Transducer transducer;  // 12 MHz: 12 dB a cm, both ways
  const auto gain = make_time_gain(transducer, settings);
  ASSERT_EQ(gain.size(), 1024U);
  EXPECT_EQ(gain[0], 1.0F);
  EXPECT_NEAR(20 * std::log10(gain[512]), 2 * 0.5 * 12 * 2, 1e-3);  // 2 cm
  EXPECT_NEAR(20 * std::log10(gain[1023]), 30, 1e-3);
}

TEST(Gaussian, IsHalfAsHighAtHalfItsWidth) {
  const double u = 0.5 / kSigmaPerWidth;
  EXPECT_NEAR(std::exp(-0.5 * u * u), 0.5, 1e-15);
}

}  // namespace
}  // namespace artus
