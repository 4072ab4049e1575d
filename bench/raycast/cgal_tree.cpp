// SPDX-License-Identifier: AGPL-3.0-or-later
#include "bench/raycast/cgal_tree.h"

#include <iterator>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

namespace artus::bench {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
using Intersection = Tree::Intersection_and_primitive_id<Kernel::Segment_3>::Type;

Kernel::Point_3 point(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

}  // namespace

struct CgalTree::Impl {
  Triangles triangles;
  Tree tree;
  std::vector<Intersection> found;
};

CgalTree::CgalTree(const CompiledJoint& joint) : impl_(std::make_unique<Impl>()) {
  const TetMesh& mesh = joint.mesh;
  for (const Interface& face : mesh.interfaces) {
    impl_->triangles.emplace_back(point(mesh.vertices[face.vertices[0]]),
                                  point(mesh.vertices[face.vertices[1]]),
                                  point(mesh.vertices[face.vertices[2]]));
  }
  impl_->tree.insert(impl_->triangles.cbegin(), impl_->triangles.cend());
  impl_->tree.build();
}

CgalTree::~CgalTree() = default;

std::size_t CgalTree::all_hits(const Segment& segment) {
  impl_->found.clear();
  impl_->tree.all_intersections(Kernel::Segment_3(point(segment.start), point(segment.end)),
                                std::back_inserter(impl_->found));
  return impl_->found.size();
}

}  // namespace artus::bench
