// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/face_stress.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr double kLength = 40e-3;  // m
constexpr double kWidth = 6e-3;
constexpr double kForce = 3;  // N

/// An evenly pressing face of 16 x 3 pieces in z = 0.
ContactForce make_face() {
  ContactForce contact;
  contact.piece_area = kLength * kWidth / 48;
  for (int i = 0; i < 16; ++i)
    for (int j = 0; j < 3; ++j)
      contact.pieces.push_back(
          {Vec3(kLength * ((i + 0.5) / 16 - 0.5), kWidth * ((j + 0.5) / 3 - 0.5), 0), kForce / 48});
  return contact;
}

/// Under the corner of a rectangle a x b that presses with 1 Pa, [Johnson1985] section 3.3.
double under_corner(double a, double b, double z) {
  const double r1 = a * a + z * z;
  const double r2 = b * b + z * z;
  const double r3 = std::sqrt(a * a + b * b + z * z);
  return (std::atan(a * b / (z * r3)) + a * b * z / r3 * (1 / r1 + 1 / r2)) /
         (2 * std::numbers::pi);
}

TEST(FaceStress, IsThatUnderARectangleThatPressesEvenly) {
  const ContactForce face = make_face();
  for (const double z : {8e-3, 15e-3, 25e-3}) {
    const double wanted =
        4 * kForce / (kLength * kWidth) * under_corner(kLength / 2, kWidth / 2, z);
    EXPECT_NEAR(stress_below(face, 0, Vec3(0, 0, z)), wanted, 0.02 * wanted) << z;
  }
  EXPECT_EQ(stress_below(face, 1e-3, Vec3(0, 0, -1e-3)), 0);
}

TEST(FaceStress, CarriesAllOfTheForceThroughEveryLevel) {
  const ContactForce face = make_face();
  constexpr double kRise = 1.26e-3;
  for (const double z : {1e-3, 5e-3, 20e-3}) {
    double sum = 0;
    for (double x = -0.4; x < 0.4; x += 1e-3)
      for (double y = -0.4; y < 0.4; y += 1e-3)
        sum += stress_below(face, kRise, Vec3(x, y, z)) * 1e-6;
    EXPECT_NEAR(sum, kForce, 0.02 * kForce) << z;
  }
}

}  // namespace
}  // namespace artus
