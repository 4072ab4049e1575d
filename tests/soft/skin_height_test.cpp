// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/cage/skin_height.h"

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr double kOff = 1e-3;  // m above the skin, from which on a point is brought down

/// A limb's skin, which falls away to both sides; no body beyond 25 mm.
double skin_at(double x) {
  return 5e-3 + 8 * x * x;
}

MaterialField limb() {
  MaterialField field;
  field.at = [](const Vec3& p) {
    return p.z() > skin_at(p.x()) && std::abs(p.x()) < 25e-3 ? 0 : kNoMaterial;
  };
  return field;
}

SkinHeight height_of(const MaterialField& field) {
  CageParams params;
  params.low = {-30e-3, -12e-3, -12e-3};
  params.high = {30e-3, 12e-3, 24e-3};
  params.cell = 3e-3;
  const Cage cage(params, [&](const Vec3& low, double edge) {
    return field.at(low + Vec3::Constant(edge)) != kNoMaterial;
  });
  return SkinHeight(cage, field);
}

TEST(SkinHeight, BringsWhatLiesOffTheBodyDownToTheSkin) {
  const MaterialField field = limb();
  const SkinHeight height = height_of(field);
  for (double x = -18e-3; x < 18e-3; x += 0.7e-3)
    for (const double up : {1.5e-3, 4e-3, 15e-3}) {
      const Vec3 p(x, 3e-3, skin_at(x) - up);
      const SkinHeight::Below found = height.below(p);
      EXPECT_TRUE(found.lowered);
      EXPECT_EQ(found.p_C.head<2>(), p.head<2>());
      EXPECT_NEAR(found.p_C.z(), skin_at(x) - kOff, 0.05e-3);
      EXPECT_NEAR(found.slope[0], 16 * x, 0.04);
      EXPECT_NEAR(found.slope[1], 0, 1e-6);
    }
}

TEST(SkinHeight, LeavesTheBodyAndWhatHasNoneBelow) {
  const MaterialField field = limb();
  const SkinHeight height = height_of(field);
  for (const Vec3& p : {Vec3(0, 0, 8e-3), Vec3(10e-3, 2e-3, skin_at(10e-3) + 0.1e-3),
                        Vec3(29e-3, 0, 0), Vec3(0, 0.2, 0), Vec3(0, 0, 1)}) {
    const SkinHeight::Below found = height.below(p);
    EXPECT_FALSE(found.lowered);
    EXPECT_EQ(found.p_C, p);
  }
  EXPECT_FALSE(SkinHeight().below(Vec3::Zero()).lowered);
}

TEST(SkinHeight, IsContinuous) {
  const MaterialField field = limb();
  const SkinHeight height = height_of(field);
  Vec3 before = height.below(Vec3(-20e-3, 1e-3, -4e-3)).p_C;
  for (double x = -20e-3; x < 20e-3; x += 0.05e-3) {
    const Vec3 here = height.below(Vec3(x, 1e-3, -4e-3)).p_C;
    EXPECT_LT((here - before).norm(), 0.1e-3);
    before = here;
  }
  for (double z = -10e-3; z < 12e-3; z += 0.05e-3) {
    const double step =
        height.below(Vec3(4e-3, 0, z + 0.05e-3)).p_C.z() - height.below(Vec3(4e-3, 0, z)).p_C.z();
    EXPECT_GE(step, 0);
    EXPECT_LT(step, 0.051e-3);
  }
}

}  // namespace
}  // namespace artus
