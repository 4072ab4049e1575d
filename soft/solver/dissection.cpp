// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/dissection.h"

#include <algorithm>
#include <limits>

namespace artus {
namespace {

constexpr std::size_t kLeafNodes = 10;  // fewer are eliminated as one front
constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

/// Splits nodes in two by a plane and takes out what touches the other side.
struct Cut {
  std::vector<std::uint32_t> low;
  std::vector<std::uint32_t> high;
  std::vector<std::uint32_t> between;
};

class Dissector {
 public:
  Dissector(const NodeGraph& graph, std::span<const Vec3> places)
      : graph_(graph), places_(places), side_(graph.size(), 0) {}

  /// Fronts of `nodes` behind those that are there; the last one added is their root.
  void order(std::vector<std::uint32_t> nodes, std::vector<FrontPlan>& fronts) {
    if (nodes.size() <= kLeafNodes) {
      fronts.push_back({std::move(nodes), {}, {}});
      return;
    }
    Cut cut = best_cut(nodes);
    if (cut.low.empty() || cut.high.empty()) {
      fronts.push_back({std::move(nodes), {}, {}});
      return;
    }
    FrontPlan root;
    root.own = std::move(cut.between);
    order(std::move(cut.low), fronts);
    root.children.push_back(static_cast<std::uint32_t>(fronts.size() - 1));
    order(std::move(cut.high), fronts);
    root.children.push_back(static_cast<std::uint32_t>(fronts.size() - 1));
    fronts.push_back(std::move(root));
  }

 private:
  [[nodiscard]] Cut cut_at(const std::vector<std::uint32_t>& nodes, int axis, double plane) {
    for (const std::uint32_t n : nodes) side_[n] = places_[n][axis] <= plane ? 1 : 2;
    Cut cut;
    for (const std::uint32_t n : nodes) {
      const auto near = graph_.of(n);
      const bool touches = side_[n] == 1 && std::any_of(near.begin(), near.end(),
                                                        [&](auto m) { return side_[m] == 2; });
      (touches ? cut.between : side_[n] == 1 ? cut.low : cut.high).push_back(n);
    }
    for (const std::uint32_t n : nodes) side_[n] = 0;
    return cut;
  }

  /// The plane whose separator is smallest for what it leaves of the larger half.
  [[nodiscard]] Cut best_cut(const std::vector<std::uint32_t>& nodes) {
    Cut best;
    double least = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> sorted;
      sorted.reserve(nodes.size());
      for (const std::uint32_t n : nodes) sorted.push_back(places_[n][axis]);
      std::sort(sorted.begin(), sorted.end());
      double last = sorted.back();
      for (const double share : {0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65}) {
        const double plane =
            sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size()))];
        if (plane == last || plane == sorted.back()) continue;
        last = plane;
        Cut cut = cut_at(nodes, axis, plane);
        const auto larger = static_cast<double>(std::max(cut.low.size(), cut.high.size()));
        const auto all = static_cast<double>(nodes.size());
        const double cost = static_cast<double>(cut.between.size()) * (0.5 + larger / all);
        if (!cut.low.empty() && !cut.high.empty() && cost < least) {
          least = cost;
          best = std::move(cut);
        }
      }
    }
    return best;
  }

  const NodeGraph& graph_;
  std::span<const Vec3> places_;
  std::vector<std::uint8_t> side_;
};

/// What each front is coupled to beyond its own nodes: the later neighbours of its nodes and what
/// its children left.
void find_boundaries(const NodeGraph& graph, Dissection& plan) {
  std::vector<std::uint32_t> mark(graph.size(), kUnused);
  for (std::uint32_t f = 0; f < plan.fronts.size(); ++f) {
    FrontPlan& front = plan.fronts[f];
    for (const std::uint32_t n : front.own) mark[n] = f;
    const auto take = [&](std::uint32_t m) {
      if (mark[m] == f) return;
      mark[m] = f;
      front.boundary.push_back(m);
    };
    const std::uint32_t first = front.own.empty() ? 0 : plan.position[front.own.front()];
    for (const std::uint32_t n : front.own) {
      for (const std::uint32_t m : graph.of(n)) {
        if (plan.position[m] > first) take(m);
      }
    }
    for (const std::uint32_t child : front.children) {
      for (const std::uint32_t m : plan.fronts[child].boundary) take(m);
    }
    std::sort(front.boundary.begin(), front.boundary.end(),
              [&](auto a, auto b) { return plan.position[a] < plan.position[b]; });
  }
}

}  // namespace

Dissection dissect(const NodeGraph& graph, std::span<const Vec3> places,
                   std::span<const std::uint32_t> last) {
  Dissection plan;
  std::vector<std::uint32_t> rest;
  std::vector<bool> is_last(graph.size(), false);
  for (const std::uint32_t n : last) is_last[n] = true;
  for (std::uint32_t n = 0; n < graph.size(); ++n) {
    if (!is_last[n]) rest.push_back(n);
  }
  Dissector(graph, places).order(std::move(rest), plan.fronts);
  FrontPlan root;
  root.own.assign(last.begin(), last.end());
  root.children.push_back(static_cast<std::uint32_t>(plan.fronts.size() - 1));
  plan.fronts.push_back(std::move(root));
  plan.position.resize(graph.size());
  std::uint32_t next = 0;
  for (const FrontPlan& front : plan.fronts) {
    for (const std::uint32_t n : front.own) plan.position[n] = next++;
  }
  find_boundaries(graph, plan);
  return plan;
}

}  // namespace artus
