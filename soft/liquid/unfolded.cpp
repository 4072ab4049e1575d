// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/unfolded.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Dense>

#include "artus/detail/core/check.h"
#include "artus/detail/soft/cage/tet_locator.h"

namespace artus {
namespace {

using Mat3 = Eigen::Matrix3d;
using Triangles = std::vector<WallTriangle>;

constexpr double kLeast = 0.05;     // of its volume at rest, what a tetrahedron keeps
constexpr double kFlattest = 1e-5;  // compactness of what has no shape to keep
constexpr double kStiffness = 30;   // of volume against shape; assumed
constexpr int kRings = 2;           // of tetrahedra around what is wrong that may move
constexpr int kWidenings = 3;       // by as many rings each
constexpr int kSweeps = 60;         // at most, of all vertices of a patch
constexpr int kEvening = 30;        // times, of all vertices of the widest patch
constexpr int kSettling = 3;        // of them after all are right
constexpr int kHalvings = 12;       // of a step
constexpr double kStride = 0.2e-3;  // m that a step is at most
constexpr double kRests =
    2e-6;  // m, of a step after which a vertex is left until one beside it moves
constexpr double kDescent = 1e-4;  // of what a step should give, what it must
constexpr double kSofter = 0.2;    // at first, of the worst
constexpr double kSoft = 1e-3;     // the same, of what is not turned over
constexpr double kHardest = 1e-9;  // softness at last
constexpr double kSame = 1e-3;     // of the liquid's volume, until a last push
constexpr double kStrongest = 5;   // of a first guess at the pressure
constexpr int kPushes = 6;

Mat3 edges_of(const std::vector<Vec3>& p, const std::array<std::uint32_t, 4>& tet) {
  Mat3 edges;
  for (int k = 0; k < 3; ++k) edges.col(k) = p[tet[static_cast<std::size_t>(k + 1)]] - p[tet[0]];
  return edges;
}

/// Triangles around each vertex, and which of their corners it is.
using Around = std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>>;

Around walls_around(const Triangles& walls, std::size_t n_vertices) {
  Around around(n_vertices);
  for (std::uint32_t w = 0; w < walls.size(); ++w)
    for (std::uint32_t k = 0; k < 3; ++k) around[walls[w][k]].emplace_back(w, k);
  return around;
}

/// m^2: what the volume within gains by a vertex's motion.
Vec3 area_at(std::uint32_t v, const Triangles& walls, const Around& around,
             const std::vector<Vec3>& p) {
  Vec3 area = Vec3::Zero();
  for (const auto& [w, k] : around[v])
    area += (p[walls[w][(k + 1) % 3]] - p[v]).cross(p[walls[w][(k + 2) % 3]] - p[v]) / 6;
  return area;
}

/// Of a tetrahedron at rest: `none` has no shape to keep.
enum class Fitness { none, sliver, whole };

/// Tetrahedra that resist being drawn out, squeezed and turned over, and liquid that presses on
/// some of their corners.
class Patch {
 public:
  Patch(const TetMesh& rest, const Triangles& walls, double volume, std::vector<Vec3>& moved)
      : rest_(rest),
        walls_(walls),
        around_walls_(walls_around(walls, moved.size())),
        wanted_(volume),
        moved_(moved) {}

  void add(std::size_t tetrahedron, bool judged) {
    Element e;
    e.v = rest_.tetrahedra[tetrahedron];
    const Mat3 edges = edges_of(rest_.vertices, e.v);
    e.inverse = edges.inverse();
    e.weight = edges.determinant();
    e.judged = judged;
    for (int k = 0; k < 3; ++k)
      e.share[static_cast<std::size_t>(k + 1)] = e.inverse.row(k).transpose();
    e.share[0] = -(e.share[1] + e.share[2] + e.share[3]);
    elements_.push_back(e);
  }

  /// Those vertices may move; the liquid's pressure is what they push back with.
  void free(std::vector<std::uint32_t> vertices) {
    free_ = std::move(vertices);
    Around around(moved_.size());
    for (std::uint32_t e = 0; e < elements_.size(); ++e)
      for (std::uint32_t k = 0; k < 4; ++k) around[elements_[e].v[k]].emplace_back(e, k);
    around_.clear();
    for (const std::uint32_t v : free_) around_.push_back(std::move(around[v]));
    active_.assign(moved_.size(), true);
    gave_.assign(free_.size(), 0);
    soft_ = std::hypot(kSofter * std::min(least(), 0.0), kSoft);
    double along = 0;
    double across = 0;
    for (std::size_t i = 0; i < free_.size(); ++i) {
      const Vec3 area = area_at(free_[i], walls_, around_walls_, moved_);
      if (area.isZero(0)) continue;
      collect(i);
      along += derivatives().gradient.dot(area);
      across += area.squaredNorm();
    }
    pressure_ = across > 0 ? std::clamp(along / across, 0.0, kStrongest) : 0;
  }

  /// Each that may move goes as those around it do: what is twisted is not untwisted a vertex at a
  /// time.
  void even_out() {
    for (int pass = 0; pass < kEvening; ++pass)
      for (std::size_t i = 0; i < free_.size(); ++i) {
        Vec3 sum = Vec3::Zero();
        for (const auto& [e, k] : around_[i])
          for (const std::uint32_t v : elements_[e].v) sum += moved_[v] - rest_.vertices[v];
        if (!around_[i].empty())
          moved_[free_[i]] =
              rest_.vertices[free_[i]] + sum / (4.0 * static_cast<double>(around_[i].size()));
      }
    soft_ = std::hypot(kSofter * std::min(least(), 0.0), kSoft);
  }

  /// Until all are right, and some sweeps more. False: some are still turned over.
  [[nodiscard]] bool settle() {
    int settled = 0;
    bool whole = false;
    for (int k = 0; k < kSweeps && settled < kSettling; ++k) {
      const double before = energy();
      sweep();
      const double off = wanted_ - volume_within(walls_, moved_);
      if (giving_ > 0) pressure_ += off / (2 * giving_);
      if (!(std::abs(off) < kSame * wanted_)) wake_walls();
      const double worst = least();
      whole = worst > 0 && std::abs(off) < kSame * wanted_;
      settled = whole && worst > kLeast ? settled + 1 : 0;
      soften(worst, before, energy());
    }
    return whole;
  }

 private:
  struct Element {
    std::array<std::uint32_t, 4> v{};
    std::array<Vec3, 4> share;  // 1/m, by which a corner's motion goes into the gradient
    Mat3 inverse;
    double weight = 0;  // m^3
    bool judged = true;
  };
  /// An element as a function of where one of its corners goes.
  struct Term {
    double weight;
    double square;  // of the gradient's norm
    double stretch;
    Vec3 drawn;
    double det;
    Vec3 cofactor;
  };
  struct Derivatives {
    Vec3 gradient = Vec3::Zero();
    Mat3 hessian = Mat3::Zero();
  };

  [[nodiscard]] double held_up(double det) const {
    return (det + std::sqrt(det * det + soft_ * soft_)) / 2;
  }
  [[nodiscard]] double value(double square, double det) const {
    const double chi = held_up(det);
    return square / std::cbrt(chi * chi) + kStiffness * (det * det + 1) / chi;
  }
  [[nodiscard]] double energy() const {
    double sum = 0;
    for (const Element& e : elements_) {
      const Mat3 f = edges_of(moved_, e.v) * e.inverse;
      sum += e.weight * value(f.squaredNorm(), f.determinant());
    }
    return sum;
  }
  /// The least share of its volume that one is left with.
  [[nodiscard]] double least() const {
    double least = 1;
    for (const Element& e : elements_)
      if (e.judged) least = std::min(least, (edges_of(moved_, e.v) * e.inverse).determinant());
    return least;
  }
  /// So soft that what is worst still resists, and less so from round to round.
  void soften(double worst, double before, double now) {
    const double goal = (1 - std::max(1 - now / before, 0.1)) * held_up(worst);
    soft_ = worst < goal ? std::max(2 * std::sqrt(goal * (goal - worst)), kHardest) : kHardest;
  }

  /// All that have not come to rest, or lie beside what has not.
  void sweep() {
    double giving = 0;
    std::vector<bool> next(moved_.size(), false);
    for (std::size_t i = 0; i < free_.size(); ++i) {
      if (!active_[free_[i]]) continue;
      const Step taken = step(i);
      gave_[i] = taken.giving;
      if (!(taken.way > kRests)) continue;
      for (const auto& [e, k] : around_[i])
        for (const std::uint32_t v : elements_[e].v) next[v] = active_[v] = true;
    }
    for (const double g : gave_) giving += g;
    giving_ = giving;
    active_ = std::move(next);
  }
  void collect(std::size_t i) {
    terms_.clear();
    for (const auto& [e, k] : around_[i]) {
      const Element& element = elements_[e];
      const Mat3 f = edges_of(moved_, element.v) * element.inverse;
      const Vec3& g = element.share[k];
      Mat3 cofactors;
      for (int c = 0; c < 3; ++c) cofactors.col(c) = f.col((c + 1) % 3).cross(f.col((c + 2) % 3));
      terms_.push_back({element.weight, f.squaredNorm(), g.squaredNorm(), f * g,
                        f.col(0).dot(cofactors.col(0)), cofactors * g});
    }
  }
  [[nodiscard]] double energy_at(const Vec3& d) const {
    double sum = 0;
    for (const Term& t : terms_)
      sum += t.weight * value(t.square + 2 * t.drawn.dot(d) + t.stretch * d.squaredNorm(),
                              t.det + t.cofactor.dot(d));
    return sum;
  }
  [[nodiscard]] Derivatives derivatives() const {
    Derivatives sum;
    for (const Term& t : terms_) {
      const double root = std::sqrt(t.det * t.det + soft_ * soft_);
      const double chi = (t.det + root) / 2;
      const double chi1 = chi / root;  // by det
      const double chi2 = soft_ * soft_ / (2 * root * root * root);
      const double p = 1 / std::cbrt(chi * chi);
      const double p1 = -2.0 / 3 * p / chi * chi1;
      const double p2 = 10.0 / 9 * p / (chi * chi) * chi1 * chi1 - 2.0 / 3 * p / chi * chi2;
      const double h = (t.det * t.det + 1) / chi;
      const double h1 = 2 * t.det / chi - h / chi * chi1;
      const double h2 = 2 / chi - 4 * t.det / (chi * chi) * chi1 +
                        2 * h / (chi * chi) * chi1 * chi1 - h / chi * chi2;
      sum.gradient += t.weight * (2 * p * t.drawn + (t.square * p1 + kStiffness * h1) * t.cofactor);
      const Mat3 both = t.drawn * t.cofactor.transpose();
      sum.hessian +=
          t.weight * (2 * p * t.stretch * Mat3::Identity() + 2 * p1 * (both + both.transpose()) +
                      (t.square * p2 + kStiffness * h2) * t.cofactor * t.cofactor.transpose());
    }
    return sum;
  }

  void wake_walls() {
    for (const auto& wall : walls_)
      for (const std::uint32_t v : wall) active_[v] = true;
  }
  struct Step {
    double way = 0;     // m
    double giving = 0;  // m^3 by a pressure of 1
  };
  /// Of one vertex, down its energy.
  Step step(std::size_t i) {
    collect(i);
    const Vec3 area = area_at(free_[i], walls_, around_walls_, moved_);
    const Vec3 push = pressure_ * area;
    const Derivatives at = derivatives();
    const Vec3 gradient = at.gradient - push;
    Eigen::SelfAdjointEigenSolver<Mat3> solver;
    solver.computeDirect(at.hessian);
    const double stiffest = solver.eigenvalues().cwiseAbs().maxCoeff();
    if (!(stiffest > 0)) return {};
    const Vec3 stiff = solver.eigenvalues().cwiseAbs().cwiseMax(1e-6 * stiffest);
    const Mat3 axes = solver.eigenvectors();
    const double giving = (axes.transpose() * area).cwiseAbs2().cwiseQuotient(stiff).sum();
    Vec3 d = -(axes * (axes.transpose() * gradient).cwiseQuotient(stiff));
    d *= std::min(1.0, kStride / std::max(d.norm(), kStride));
    const double now = energy_at(Vec3::Zero());
    for (int k = 0; k < kHalvings; ++k, d /= 2) {
      if (!(energy_at(d) - push.dot(d) <= now + kDescent * gradient.dot(d))) continue;
      moved_[free_[i]] += d;
      return {d.norm(), giving};
    }
    return {0, giving};
  }

  const TetMesh& rest_;
  const Triangles& walls_;
  Around around_walls_;
  double wanted_;  // m^3
  std::vector<Vec3>& moved_;
  std::vector<Element> elements_;
  std::vector<std::uint32_t> free_;
  Around around_;            // by free vertex: elements
  std::vector<Term> terms_;  // of the vertex that is looked at
  double soft_ = 0;
  double pressure_ = 0;       // of the elements' stiffness
  std::vector<bool> active_;  // by vertex
  std::vector<double> gave_;  // by free vertex, m^3 by a pressure of 1
  double giving_ = 0;         // m^3 by a pressure of 1, a vertex at a time
};

/// What is around what is wrong, and grows.
class Neighbourhood {
 public:
  Neighbourhood(const TetMesh& rest, const std::vector<bool>& loose, const std::vector<Vec3>& moved)
      : rest_(rest), fitness_(rest.tetrahedra.size(), Fitness::none), near_(moved.size(), false) {
    for (std::size_t t = 0; t < fitness_.size(); ++t) {
      if (rest.regions[t] < loose.size() && loose[rest.regions[t]]) continue;
      const auto& v = rest.tetrahedra[t];
      const double compactness = tet_compactness(rest, t);
      if (compactness > kFlattest) fitness_[t] = Fitness::sliver;
      if (!(compactness > kSliver)) continue;
      fitness_[t] = Fitness::whole;
      if (edges_of(moved, v).determinant() > kLeast * 6 * tet_volume(rest, t)) continue;
      wrong_ = true;
      for (const std::uint32_t i : v) near_[i] = true;
    }
  }

  [[nodiscard]] bool anything_wrong() const noexcept { return wrong_; }
  void widen() {
    std::vector<bool> wider = near_;
    for (std::size_t t = 0; t < fitness_.size(); ++t)
      if (is_near(t))
        for (const std::uint32_t i : rest_.tetrahedra[t]) wider[i] = true;
    near_ = std::move(wider);
  }
  void hand_to(Patch& patch, const std::vector<bool>& held) const {
    for (std::size_t t = 0; t < fitness_.size(); ++t)
      if (is_near(t)) patch.add(t, fitness_[t] == Fitness::whole);
    std::vector<std::uint32_t> free;
    for (std::uint32_t i = 0; i < near_.size(); ++i)
      if (near_[i] && !held[i]) free.push_back(i);
    patch.free(std::move(free));
  }

 private:
  [[nodiscard]] bool is_near(std::size_t t) const {
    const auto& v = rest_.tetrahedra[t];
    return fitness_[t] != Fitness::none &&
           std::any_of(v.begin(), v.end(), [this](std::uint32_t i) { return near_[i]; });
  }

  const TetMesh& rest_;
  std::vector<Fitness> fitness_;
  std::vector<bool> near_;  // by vertex
  bool wrong_ = false;
};

/// Vertices of no tetrahedron, as the one that they lie in has moved since.
void take_along(const TetMesh& rest, const std::vector<Vec3>& before, std::vector<Vec3>& moved) {
  std::vector<bool> corner(moved.size(), false);
  for (const auto& tet : rest.tetrahedra)
    for (const std::uint32_t v : tet) corner[v] = true;
  if (std::find(corner.begin(), corner.end(), false) == corner.end()) return;
  const TetLocator locator(rest);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (corner[i]) continue;
    const std::int64_t in = locator.find(rest.vertices[i]);
    if (in < 0) continue;
    const auto& v = rest.tetrahedra[static_cast<std::size_t>(in)];
    const Vec3 share =
        edges_of(rest.vertices, v).inverse() * (rest.vertices[i] - rest.vertices[v[0]]);
    moved[i] += (1 - share.sum()) * (moved[v[0]] - before[v[0]]);
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t at = v[static_cast<std::size_t>(k + 1)];
      moved[i] += share[k] * (moved[at] - before[at]);
    }
  }
}

/// All walls that may, by the same way along their normals, until that volume is within them.
void push_out(const Triangles& walls, const std::vector<bool>& held, double volume,
              std::vector<Vec3>& moved) {
  const Around around = walls_around(walls, moved.size());
  std::vector<Vec3> normals(moved.size(), Vec3::Zero());
  for (std::uint32_t v = 0; v < moved.size(); ++v)
    if (!held[v] && !around[v].empty()) normals[v] = area_at(v, walls, around, moved).normalized();
  for (int k = 0; k < kPushes; ++k) {
    double area = 0;
    for (std::uint32_t v = 0; v < moved.size(); ++v)
      if (!normals[v].isZero(0)) area += normals[v].dot(area_at(v, walls, around, moved));
    const double by = (volume - volume_within(walls, moved)) / area;
    if (!std::isfinite(by)) return;
    for (std::size_t v = 0; v < moved.size(); ++v) moved[v] += by * normals[v];
  }
}

}  // namespace

bool unfold(const TetMesh& rest, const Unfolding& unfolding, std::vector<Vec3>& moved) {
  ARTUS_REQUIRE(moved.size() == rest.vertices.size() && unfolding.held.size() == moved.size(),
                "as many vertices");
  Neighbourhood around(rest, unfolding.loose, moved);
  if (!around.anything_wrong()) return true;
  const std::vector<Vec3> before = moved;
  const double volume = volume_within(unfolding.walls, moved);
  const double drawn = volume_within(unfolding.finer, moved);
  for (int widening = 0; widening < kWidenings; ++widening) {
    for (int ring = 0; ring < kRings; ++ring) around.widen();
    Patch patch(rest, unfolding.walls, volume, moved);
    around.hand_to(patch, unfolding.held);
    if (widening == kWidenings - 1) patch.even_out();
    if (!patch.settle()) continue;
    take_along(rest, before, moved);
    push_out(unfolding.finer, unfolding.held, drawn, moved);
    return true;
  }
  moved = before;
  return false;
}

}  // namespace artus
