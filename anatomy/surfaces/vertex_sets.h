// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <numeric>
#include <vector>

#include <boost/pending/disjoint_sets.hpp>
#include <boost/property_map/property_map.hpp>

namespace artus {

/// Sets of 0..n-1, each in a set of its own at first; Boost's, on vectors that it finds by name
/// however CGAL's headers come before it.
class VertexSets {
  using Map = boost::iterator_property_map<std::vector<std::size_t>::iterator,
                                           boost::typed_identity_property_map<std::size_t>>;

 public:
  explicit VertexSets(std::size_t n)
      : rank_(n), parent_(n), sets_(Map(rank_.begin()), Map(parent_.begin())) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  VertexSets(const VertexSets&) = delete;
  VertexSets& operator=(const VertexSets&) = delete;

  void union_set(std::size_t a, std::size_t b) { sets_.union_set(a, b); }
  /// The one that stands for its set. Cost: nearly none.
  [[nodiscard]] std::size_t find_set(std::size_t a) { return sets_.find_set(a); }

 private:
  std::vector<std::size_t> rank_;
  std::vector<std::size_t> parent_;
  boost::disjoint_sets<Map, Map> sets_;
};

}  // namespace artus
