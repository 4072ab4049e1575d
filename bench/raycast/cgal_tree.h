// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <memory>

#include "artus/anatomy/compiled_joint.h"
#include "artus/core/geometry.h"

namespace artus::bench {

/// The peer: CGAL's AABB tree over the same triangles.
class CgalTree {
 public:
  /// Simple_cartesian<double>: CGAL's fastest kernel; rounding may lose or double a hit.
  [[nodiscard]] static std::unique_ptr<CgalTree> make_inexact(const CompiledJoint& joint);
  /// Exact_predicates_inexact_constructions_kernel: the one CGAL recommends; finds what is there,
  /// as Scene does.
  [[nodiscard]] static std::unique_ptr<CgalTree> make_exact_predicates(const CompiledJoint& joint);

  CgalTree() = default;
  virtual ~CgalTree() = default;
  CgalTree(const CgalTree&) = delete;
  CgalTree& operator=(const CgalTree&) = delete;
  CgalTree(CgalTree&&) = delete;
  CgalTree& operator=(CgalTree&&) = delete;
  /// Number of intersections found by all_intersections (points and facets, unsorted).
  [[nodiscard]] virtual std::size_t all_hits(const Segment& segment) = 0;
};

}  // namespace artus::bench
