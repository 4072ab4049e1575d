// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <memory>

#include "anatomy/compiled_joint.h"
#include "core/geometry.h"

namespace artus::bench {

/// The peer: CGAL's AABB tree over the same triangles, Simple_cartesian<double>, its fastest
/// kernel.
class CgalTree {
 public:
  explicit CgalTree(const CompiledJoint& joint);
  ~CgalTree();
  CgalTree(const CgalTree&) = delete;
  CgalTree& operator=(const CgalTree&) = delete;
  /// Number of intersections found by all_intersections (points and facets, unsorted).
  [[nodiscard]] std::size_t all_hits(const Segment& segment);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace artus::bench
