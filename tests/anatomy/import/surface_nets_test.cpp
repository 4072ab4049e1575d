// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/surface_nets.h"

#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/surfaces/defects.h"
#include "tests/anatomy/import/label_samples.h"

namespace artus {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Surfaces of all labels after smoothing and fitting.
struct Made {
  std::vector<LabelSurface> surfaces;
  std::vector<LabelVolumes> volumes;
  LabelSurface outer;
};

Made make(const LabelVolume& volume) {
  SurfaceNet net = make_surface_net(volume.labels, volume.size);
  smooth(net);
  std::vector<std::size_t> counts;
  for (const auto& s : volume.segments) counts.push_back(s.n_voxels);
  Made made;
  made.volumes = fit_volumes(net, counts, volume.X_LI);
  made.surfaces = make_label_surfaces(net, counts.size(), volume.X_LI);
  made.outer = make_outer_surface(net, volume.X_LI);
  return made;
}

/// A ball of bone, a cap of cartilage 2 mm thick on its upper part, fat around in a slab.
LabelVolume ball_and_cap(const IndexFrame& frame = test::oblique_frame()) {
  return test::painted({96, 96, 60}, frame, {"bone", "cartilage", "fat"},
                       [](const Vec3& p) -> std::uint16_t {
                         constexpr double kRadius = 10e-3;
                         const double r = p.norm();
                         if (r < kRadius) return 1;
                         if (r < kRadius + 2e-3 && p.z() > 0.3 * r) return 2;
                         return r < 15e-3 ? 3 : 0;
                       });
}

TEST(SurfaceNets, ASingleVoxelIsACubeOfOneVoxelsVolume) {
  std::vector<std::uint16_t> labels(27, 0);
  labels[13] = 1;
  const SurfaceNet net = make_surface_net(labels, {3, 3, 3});
  EXPECT_EQ(net.points.size(), 8U);
  EXPECT_EQ(net.faces.size(), 6U);
  const auto surfaces = make_label_surfaces(net, 1, IndexFrame::Identity());
  EXPECT_NEAR(signed_volume(surfaces[0].mesh), 1, 1e-12);
}

TEST(SurfaceNets, SurfacesAreClosedManifoldAndOutward) {
  const Made made = make(ball_and_cap());
  for (const LabelSurface& s : made.surfaces)
    for (const Defect& d : find_defects(s.mesh))
      if (d.kind != DefectKind::several_components)  // fat has an inner side
        ADD_FAILURE() << d.message;
  for (const Defect& d : find_defects(made.outer.mesh)) ADD_FAILURE() << d.message;
}

TEST(SurfaceNets, MirroredAxesStayOutward) {
  IndexFrame mirrored = test::oblique_frame();
  mirrored.linear().col(0) *= -1;
  ASSERT_LT(mirrored.linear().determinant(), 0);
  const Made made = make(ball_and_cap(mirrored));
  for (const LabelSurface& s : made.surfaces) EXPECT_GT(signed_volume(s.mesh), 0);
  EXPECT_GT(signed_volume(made.outer.mesh), 0);
}

TEST(SurfaceNets, VolumesAreThoseOfTheVoxels) {
  const LabelVolume volume = ball_and_cap();
  const Made made = make(volume);
  for (std::size_t i = 0; i < made.surfaces.size(); ++i) {
    const double counted = static_cast<double>(volume.segments[i].n_voxels) * volume.voxel_volume();
    EXPECT_NEAR(signed_volume(made.surfaces[i].mesh) / counted, 1, 1e-3);
    EXPECT_NEAR(made.volumes[i].fitted, signed_volume(made.surfaces[i].mesh), 1e-12);
  }
  // Without the fitting they are not.
  EXPECT_LT(made.volumes[0].smoothed / made.volumes[0].counted, 0.998);
}

TEST(SurfaceNets, NormalsOfABallAreWithinSixDegrees) {
  const LabelVolume volume = ball_and_cap();
  const Made made = make(volume);
  const SurfaceMesh& ball = made.surfaces[0].mesh;
  double sum = 0, area = 0, worst = 0;
  for (const Triangle& t : ball.triangles) {
    const Vec3 a = ball.vertices[t[0]];
    const Vec3 n = (ball.vertices[t[1]] - a).cross(ball.vertices[t[2]] - a) / 2;
    if (n.norm() < 1e-15) continue;
    const Vec3 middle = volume.X_LI * Vec3(47.5, 47.5, 29.5);
    const Vec3 radial = (triangle_centre(ball, t) - middle).normalized();
    const double angle = std::acos(std::clamp(n.normalized().dot(radial), -1.0, 1.0));
    sum += n.norm() * angle * angle;
    area += n.norm();
    worst = std::max(worst, std::abs((triangle_centre(ball, t) - middle).norm() - 10e-3));
  }
  EXPECT_LT(std::sqrt(sum / area), 6 * kDegree);
  EXPECT_LT(worst, 0.75 * volume.voxel_edge());
}

TEST(SurfaceNets, NeighboursShareTheirTriangles) {
  const Made made = make(ball_and_cap());
  using Key = std::array<std::array<double, 3>, 3>;
  const auto keys = [](const SurfaceMesh& mesh) {
    std::map<Key, int> all;
    for (const Triangle& t : mesh.triangles) {
      Key key;
      for (std::size_t k = 0; k < 3; ++k)
        key[k] = {mesh.vertices[t[k]].x(), mesh.vertices[t[k]].y(), mesh.vertices[t[k]].z()};
      std::sort(key.begin(), key.end());
      ++all[key];
    }
    return all;
  };
  const auto bone = keys(made.surfaces[0].mesh);
  const auto cartilage = keys(made.surfaces[1].mesh);
  const auto fat = keys(made.surfaces[2].mesh);
  std::size_t n_shared = 0;
  for (const auto& [key, n] : bone) {
    const bool with_cartilage = cartilage.contains(key);
    n_shared += with_cartilage ? 1U : 0U;
    EXPECT_NE(with_cartilage, fat.contains(key));  // each belongs to one neighbour
  }
  EXPECT_GT(n_shared, 500U);
}

TEST(SurfaceNets, ATiltedSheetOfOneVoxelIsKept) {
  const Vec3 normal = Vec3(0.35, 0.2, 1).normalized();
  LabelVolume volume = test::painted({80, 80, 40}, test::oblique_frame({0.4, 0.4, 0.4}),
                                     {"sheet", "below"}, [&](const Vec3& p) -> std::uint16_t {
                                       if (p.norm() > 13e-3) return 0;
                                       const double h = p.dot(normal);
                                       if (h < -0.2e-3) return 2;
                                       return h < 0.2e-3 ? 1 : 0;
                                     });
  const Made made = make(volume);
  EXPECT_NEAR(made.volumes[0].fitted / made.volumes[0].counted, 1, 0.05)
      << made.volumes[0].smoothed / made.volumes[0].counted;
  EXPECT_EQ(make_surface_net(volume.labels, volume.size).size, volume.size);
}

TEST(SurfaceNets, WhatIsCutByTheVolumeEndsFlatOnItsBorder) {
  const LabelVolume volume =
      test::painted({30, 30, 20}, test::oblique_frame({0.5, 0.5, 0.5}), {"shaft"},
                    [](const Vec3& p) -> std::uint16_t { return p.head<2>().norm() < 5e-3; });
  const Made made = make(volume);
  const LabelSurface& shaft = made.surfaces[0];
  double cut = 0;
  for (std::size_t f = 0; f < shaft.is_cut.size(); ++f) {
    if (shaft.is_cut[f] == 0) continue;
    cut += triangle_area(shaft.mesh, shaft.mesh.triangles[f]);
    const Vec3 at = test::from_middle(volume, triangle_centre(shaft.mesh, shaft.mesh.triangles[f]));
    EXPECT_NEAR(std::abs(at.z()), 5e-3, 1e-9);
  }
  EXPECT_NEAR(cut, 2 * std::numbers::pi * 25e-6, 0.05 * cut);
}

TEST(SurfaceNets, LabelsThatMeetInAnEdgeAreManifold) {
  LabelVolume volume = test::painted({6, 6, 4}, test::oblique_frame({1, 1, 1}), {"checks"},
                                     [](const Vec3&) -> std::uint16_t { return 0; });
  const auto set = [&](std::size_t x, std::size_t y, std::size_t z) {
    volume.labels[(z * 6 + y) * 6 + x] = 1;
    ++volume.segments[0].n_voxels;
  };
  set(1, 1, 1);
  set(2, 2, 1);  // an edge
  set(3, 3, 2);  // a corner
  SurfaceNet net = make_surface_net(volume.labels, volume.size);
  const auto surfaces = make_label_surfaces(net, 1, volume.X_LI);
  EXPECT_EQ(surfaces[0].n_split, 1U);
  for (const Defect& d : find_defects(surfaces[0].mesh)) {
    EXPECT_NE(d.kind, DefectKind::non_manifold_edge);
    EXPECT_NE(d.kind, DefectKind::non_manifold_vertex);
    EXPECT_NE(d.kind, DefectKind::open_edge);
  }
}

}  // namespace
}  // namespace artus
