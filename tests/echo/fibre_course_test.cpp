// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/medium/fibre_course.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/medium/region_acoustics.h"
#include "tests/echo/echo_fixture.h"

namespace artus {
namespace {

/// A bar of muscle bent to a quarter of a ring round the origin in the plane x, z: `width` (m)
/// along y, from `inner` to `outer` radius, as tetrahedra. Its ends face along x - z and z - x.
CompiledJoint make_bent_bar(double inner, double outer, double width) {
  constexpr int kAlong = 40;
  constexpr int kAcross = 5;
  CompiledJoint joint;
  joint.tissues.resize(1);
  joint.tissues[0].acoustic.kind = TissueKind::muscle;
  joint.regions = {{"outside", 0, Vec3::Zero()},
                   {"beyond", 0, Vec3::Zero()},
                   {"muscle", 0, Vec3(1, 0, -1).normalized()}};
  const auto at = [](int i, int j, int k) {
    return static_cast<std::uint32_t>((i * (kAcross + 1) + j) * (kAcross + 1) + k);
  };
  for (int i = 0; i <= kAlong; ++i) {
    const double angle = 90 * kDegree * i / kAlong;
    for (int j = 0; j <= kAcross; ++j) {
      const double radius = inner + (outer - inner) * j / kAcross;
      for (int k = 0; k <= kAcross; ++k)
        joint.mesh.vertices.emplace_back(radius * std::sin(angle),
                                         width * (static_cast<double>(k) / kAcross - 0.5),
                                         radius * std::cos(angle));
    }
  }
  constexpr std::array<std::array<int, 4>, 6> kCube{
      {{0, 1, 3, 7}, {0, 1, 7, 5}, {0, 5, 7, 4}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}}};
  for (int i = 0; i < kAlong; ++i)
    for (int j = 0; j < kAcross; ++j)
      for (int k = 0; k < kAcross; ++k)
        for (const auto& tet : kCube) {
          std::array<std::uint32_t, 4> v{};
          for (std::size_t c = 0; c < 4; ++c)
            v[c] = at(i + (tet[c] & 1), j + (tet[c] >> 1 & 1), k + (tet[c] >> 2 & 1));
          joint.mesh.tetrahedra.push_back(v);
          joint.mesh.regions.push_back(kFirstRegion);
          if (tet_volume(joint.mesh, joint.mesh.tetrahedra.size() - 1) < 0)
            std::swap(joint.mesh.tetrahedra.back()[0], joint.mesh.tetrahedra.back()[1]);
        }
  return joint;
}

TEST(FibreCourse, AFoldedTetrahedronDoesNotStraightenIt) {
  CompiledJoint joint = make_bent_bar(30e-3, 40e-3, 12e-3);
  const auto whole = fit_fibre_course(joint, kFirstRegion, std::nullopt);
  for (std::size_t t = 0; t < joint.mesh.tetrahedra.size(); t += 500)
    std::swap(joint.mesh.tetrahedra[t][0], joint.mesh.tetrahedra[t][1]);
  const auto folded = fit_fibre_course(joint, kFirstRegion, std::nullopt);
  ASSERT_TRUE(whole && folded);
  for (double degrees = 20; degrees <= 70; degrees += 10) {
    const Vec3 p = 35e-3 * Vec3(std::sin(degrees * kDegree), 0, std::cos(degrees * kDegree));
    const Vec3 was = whole->evaluate(p).gradient.row(2).normalized();
    EXPECT_GT(was.dot(Vec3(folded->evaluate(p).gradient.row(2).normalized())), 0.999) << degrees;
  }
}

TEST(FibreCourse, FollowsABentMuscle) {
  const CompiledJoint joint = make_bent_bar(30e-3, 40e-3, 12e-3);
  const auto course = fit_fibre_course(joint, kFirstRegion, std::nullopt);
  ASSERT_TRUE(course.has_value());
  for (double degrees = 20; degrees <= 70; degrees += 5) {
    for (const double radius : {31e-3, 35e-3, 39e-3}) {
      const Vec3 out(std::sin(degrees * kDegree), 0, std::cos(degrees * kDegree));
      const Vec3 along(out.z(), 0, -out.x());
      const MaterialPoint point = course->evaluate(radius * out);
      const Vec3 flow = point.gradient.row(2).normalized();
      const Vec3 drawn = point.gradient.row(0).cross(point.gradient.row(1)).normalized();
      EXPECT_GT(std::abs(flow.dot(along)), std::cos(4 * kDegree)) << degrees;
      EXPECT_GT(std::abs(drawn.dot(along)), std::cos(8 * kDegree)) << degrees;
      // sheets lie one upon another about as far apart as in a straight muscle
      EXPECT_NEAR(point.gradient.row(0).norm(), 1, 0.4) << degrees;
    }
  }
}

/// The bar's outer side as skin.
void add_skin(CompiledJoint& joint, double outer) {
  for (const auto& tet : joint.mesh.tetrahedra) {
    std::array<std::uint32_t, 3> face{};
    std::size_t n = 0;
    for (const std::uint32_t v : tet) {
      const Vec3& p = joint.mesh.vertices[v];
      if (std::hypot(p.x(), p.z()) > outer - 1e-6 && n < 3) face[n++] = v;
    }
    if (n < 3) continue;
    const Vec3& a = joint.mesh.vertices[face[0]];
    if ((joint.mesh.vertices[face[1]] - a).cross(joint.mesh.vertices[face[2]] - a).dot(a) < 0)
      std::swap(face[0], face[1]);
    joint.mesh.interfaces.push_back({face, kOutside, kFirstRegion});
  }
}

TEST(FibreCourse, OfALayerRunsBesideTheSkinAndHasNoEnds) {
  CompiledJoint joint = make_bent_bar(30e-3, 40e-3, 12e-3);
  add_skin(joint, 40e-3);
  const auto depth = fit_skin_depth(joint);
  ASSERT_TRUE(depth.has_value());
  const auto along_the_bar = [&](FibreCourse how, double degrees) {
    joint.regions.back().fibre_course = how;
    const auto course = fit_fibre_course(joint, kFirstRegion, depth);
    const Vec3 out(std::sin(degrees * kDegree), 0, std::cos(degrees * kDegree));
    return course->evaluate(35e-3 * out).gradient.row(2).dot(Vec3(out.z(), 0, -out.x()));
  };
  for (const double degrees : {4.0, 10.0, 25.0, 65.0, 80.0, 86.0}) {
    const double wanted = std::cos((degrees - 45) * kDegree);
    EXPECT_NEAR(along_the_bar(FibreCourse::layer, degrees) / along_the_bar(FibreCourse::layer, 45),
                wanted, 0.1)
        << degrees;
  }
  // Between ends the flow dies away where one begins.
  EXPECT_LT(along_the_bar(FibreCourse::ends, 4) / along_the_bar(FibreCourse::ends, 45), 0.5);
}

TEST(FibreCourse, TellsPlacesApartByMicrometres) {
  // slopes alone leave the origin open; far away, single precision would not see 20 um
  const CompiledJoint joint = make_bent_bar(30e-3, 40e-3, 12e-3);
  const auto course = fit_fibre_course(joint, kFirstRegion, std::nullopt);
  ASSERT_TRUE(course.has_value());
  const Vec3 p = 35e-3 * Vec3(1, 0, 1).normalized();
  const MaterialPoint here = course->evaluate(p);
  EXPECT_LT(here.place.norm(), 0.1);
  for (Eigen::Index a = 0; a < 3; ++a) {
    const Vec3 step = 20e-6 * Vec3::Unit(a);
    const Vec3 moved = course->evaluate(p + step).place - here.place;
    EXPECT_LT((moved - here.gradient * step).norm(), 1e-6);
  }
}

TEST(FibreCourse, MuscleAndItsTendonBlendWhereTheyMeet) {
  constexpr RegionId kMuscle = kFirstRegion;
  constexpr RegionId kTendon = kFirstRegion + 1;
  std::vector<RegionAcoustics> regions(kTendon + 1);
  regions[kMuscle].kind = TissueKind::muscle;
  regions[kMuscle].backscatter = 1;
  regions[kMuscle].continues_as = kTendon;
  regions[kMuscle].junction = 20e-3;
  regions[kTendon].kind = TissueKind::tendon;
  regions[kTendon].backscatter = 1.8;
  regions[kTendon].fibre_phase = 10;
  regions[kTendon].continues_as = kMuscle;
  regions[kTendon].junction = -5e-3;  // in the tendon's own coordinates
  for (const double cosine : {0.0, 0.3}) {
    EXPECT_DOUBLE_EQ(local_backscatter(regions, regions[kMuscle], 20e-3, cosine),
                     local_backscatter(regions, regions[kTendon], -5e-3, cosine));
    EXPECT_NEAR(local_backscatter(regions, regions[kMuscle], 0, cosine),
                fibre_backscatter(regions[kMuscle], cosine), 2e-3);
  }
  regions[kTendon].fibre = Vec3::UnitX();
  EXPECT_TRUE(is_junction(regions[kMuscle], kMuscle, regions[kTendon], kTendon, Vec3::UnitX()));
  EXPECT_TRUE(is_junction(regions[kTendon], kTendon, regions[kMuscle], kMuscle, -Vec3::UnitX()));
  // side by side they are two structures with a border
  EXPECT_FALSE(is_junction(regions[kMuscle], kMuscle, regions[kTendon], kTendon, Vec3::UnitZ()));
  regions[kMuscle].continues_as = kOutside;
  regions[kTendon].continues_as = kOutside;
  EXPECT_FALSE(is_junction(regions[kMuscle], kMuscle, regions[kTendon], kTendon, Vec3::UnitX()));
  // nor is the body's surface one
  EXPECT_FALSE(is_junction(regions[kTendon], kTendon, regions[kOutside], kOutside, Vec3::UnitX()));
  EXPECT_FALSE(is_junction(regions[kOutside], kOutside, regions[kTendon], kTendon, Vec3::UnitX()));
}

TEST(FibreCourse, IsTheSameInEachRun) {
  const CompiledJoint joint = make_bent_bar(30e-3, 40e-3, 12e-3);
  const auto once = fit_fibre_course(joint, kFirstRegion, std::nullopt);
  const auto again = fit_fibre_course(joint, kFirstRegion, std::nullopt);
  ASSERT_TRUE(once && again);
  const Vec3 p(20e-3, 1e-3, 28e-3);
  EXPECT_EQ(once->evaluate(p).place, again->evaluate(p).place);
}

TEST(FibreCourse, PhantomsWithoutTetrahedraKeepStraightFibres) {
  const std::array<test::FlatLayer, 1> layers{{{"muscle", 60e-3}}};
  const auto scene = test::make_block_scene(
      layers, [](CompiledJoint& joint) { joint.regions.back().fibre_axis = Vec3(0.8, 0, 0.6); });
  EXPECT_FALSE(fit_skin_depth(scene->joint()).has_value());
  EXPECT_FALSE(fit_fibre_course(scene->joint(), kFirstRegion, std::nullopt).has_value());
  std::vector<RegionAcoustics> regions = make_region_acoustics(scene->joint(), Transducer{});
  add_courses(scene->joint(), regions);
  const MaterialPoint point = locate_in_material(regions.back(), Vec3(1e-3, 0, 2e-3));
  EXPECT_NEAR(point.place.z(), 2e-3, 1e-12);
  EXPECT_NEAR(point.gradient.row(2).dot(Vec3(0.8, 0, 0.6)), 1, 1e-12);
}

TEST(MaterialMap, EvaluatesItsPolynomialsAndTheirSlopes) {
  MaterialMap::Coefficients coefficients = MaterialMap::Coefficients::Zero();
  const Vec3 centre(0.1, 0.2, 0.3);
  const double scale = 0.05;
  const auto value = [&](const Vec3& p) -> Vec3 {
    return coefficients.transpose() * MaterialMap::terms((p - centre) / scale);
  };
  for (Eigen::Index k = 0; k < coefficients.rows(); ++k)
    for (Eigen::Index c = 0; c < 3; ++c)
      coefficients(k, c) = 0.01 * std::sin(1.0 + static_cast<double>(3 * k + c));
  const MaterialMap map(centre, scale, coefficients);
  const Vec3 p = centre + Vec3(0.02, -0.03, 0.01);
  const MaterialPoint point = map.evaluate(p);
  EXPECT_LT((point.place - value(p)).norm(), 1e-7);
  constexpr double kStep = 1e-5;
  for (Eigen::Index a = 0; a < 3; ++a) {
    const Vec3 step = kStep * Vec3::Unit(a);
    const Vec3 slope = (value(p + step) - value(p - step)) / (2 * kStep);
    EXPECT_LT((slope - point.gradient.col(a)).norm(), 1e-4 * slope.norm());
    EXPECT_LT((coefficients.transpose() *
                   MaterialMap::slopes((p - centre) / scale).row(a).transpose() / scale -
               slope)
                  .norm(),
              1e-6 * slope.norm());
  }
}

}  // namespace
}  // namespace artus
