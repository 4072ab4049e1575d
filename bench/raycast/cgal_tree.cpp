// SPDX-License-Identifier: AGPL-3.0-or-later
#include "bench/raycast/cgal_tree.h"

#include <iterator>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Simple_cartesian.h>

namespace artus::bench {
namespace {

template <class Kernel>
class TreeOf : public CgalTree {
 public:
  explicit TreeOf(const CompiledJoint& joint) {
    const TetMesh& mesh = joint.mesh;
    for (const Interface& face : mesh.interfaces) {
      triangles_.emplace_back(point(mesh.vertices[face.vertices[0]]),
                              point(mesh.vertices[face.vertices[1]]),
                              point(mesh.vertices[face.vertices[2]]));
    }
    tree_.insert(triangles_.cbegin(), triangles_.cend());
    tree_.build();
  }

  std::size_t all_hits(const Segment& segment) override {
    found_.clear();
    tree_.all_intersections(typename Kernel::Segment_3(point(segment.start), point(segment.end)),
                            std::back_inserter(found_));
    return found_.size();
  }

 private:
  using Triangles = std::vector<typename Kernel::Triangle_3>;
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, typename Triangles::const_iterator>;
  using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
  using Intersection =
      typename Tree::template Intersection_and_primitive_id<typename Kernel::Segment_3>::Type;

  static typename Kernel::Point_3 point(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

  Triangles triangles_;
  Tree tree_;
  std::vector<Intersection> found_;
};

}  // namespace

std::unique_ptr<CgalTree> CgalTree::make_inexact(const CompiledJoint& joint) {
  return std::make_unique<TreeOf<CGAL::Simple_cartesian<double>>>(joint);
}

std::unique_ptr<CgalTree> CgalTree::make_exact_predicates(const CompiledJoint& joint) {
  return std::make_unique<TreeOf<CGAL::Exact_predicates_inexact_constructions_kernel>>(joint);
}

}  // namespace artus::bench
