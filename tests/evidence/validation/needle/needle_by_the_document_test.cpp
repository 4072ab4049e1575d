// SPDX-License-Identifier: AGPL-3.0-or-later
// A reader's needle, programmed from docs/needle-steps.md alone, beside the engine's on paths that
// sway.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/evidence/validation/needle/sway.h"
#include "tests/haptics/needle/document_needle.h"

namespace artus {
namespace {

TEST(NeedleByTheDocument, IsTheEnginesUnderASwayDrawnBackAndPushedInAgain) {
  const std::vector<test::DocumentTissue> tissues{{0, 1, 0.25, 1500, 1.5, 200},
                                                  {0.0041, 2, 0.5, 500, 0, 200},
                                                  {0.018, 1.5, 0.375, 500, 2, 200},
                                                  {0.021, 2.5, 0.625, 500, 0, 200}};
  const LayerTable table = test::sway_layers(true);
  double worst = 0;
  for (int run = 0; run < 40; ++run) {
    test::Sway sway;
    sway.back = 0.001 + 0.0004 * run;
    sway.phase = 0.9 * run;
    sway.pivots = run % 2 == 0;
    const int rate = run % 3 == 0 ? 1000 : 5000;
    test::DocumentNeedle reader(tissues, 1.0 / rate);
    double axial = 0;
    double aside = 0;
    double size = 0;
    int ticks = 0;
    test::run_sway(rate, sway, table, [&](int /*i*/, const Pose& X_JN, const NeedleModel& model) {
      const test::DocumentForce read = reader.step(X_JN.translation(), Vec3(X_JN.linear().col(2)));
      const NeedleForces& f = model.forces();
      const double engine = f.prepuncture + f.cutting + f.attracted;
      axial += (engine - read.axial) * (engine - read.axial);
      aside += (f.clamping - read.clamping).squaredNorm();
      size += engine * engine;
      ++ticks;
    });
    const std::string where = "run " + std::to_string(run);
    EXPECT_GT(std::sqrt(size / ticks), 0.5) << where;
    EXPECT_LT(std::sqrt(axial / ticks), 0.01) << where;
    EXPECT_LT(std::sqrt(aside / ticks), 0.005) << where;
    worst = std::max({worst, std::sqrt(axial / ticks), std::sqrt(aside / ticks)});
  }
  RecordProperty("worst_rms", std::to_string(worst));
}

}  // namespace
}  // namespace artus
