// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/opening_field.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "artus/detail/core/check.h"
#include "artus/detail/soft/cage/material.h"

namespace artus {
namespace {

// Tissue keeps its volume along the whole flow; that cubes so stiff lock a little makes each of
// them keep it in each of its points. Fitted: 0.45 leaves 0.14 of a volume beside a hip's bone at
// 20 ml.
constexpr double kPoisson = 0.497;
constexpr double kSoftest = 30e3;  // Pa, of tissue; fitted: softer fat takes all of it in one bulge
constexpr double kStiffest = 300e3;  // Pa
constexpr double kAir = 100;         // Pa: next to nothing, so that skin moves out into a field
constexpr double kFilm = 2e6;        // Pa/m that holds walls together at a rim; assumed
constexpr double kFade = 6;          // e-folds of that from the rim to the place farthest from it
constexpr double kFaint = 0.01;      // of it, that is none
constexpr double kAnchor = 1e-6;     // of a node's stiffness: for what hangs on nothing
constexpr double kLoose = 1e-3;  // the same, of a shell around a body; assumed: it lies on a bed
constexpr double kExact = 3e-5;  // of the load
constexpr int kMaxPasses = 3000;
constexpr int kPassesToAsk = 16;
constexpr double kExactDistance = 1e-6;  // of the first error
constexpr double kTiny = 1e-9;           // of a node's own: tissue that touches no wall
constexpr double kAlong = 10;  // by which a number on the walls spreads more easily along motion

using Element = Eigen::Matrix<float, 24, 24>;  // as exact as the passes need
using Corner = Eigen::Matrix<float, 24, 1>;

using Slopes = Eigen::Matrix<double, 8, 3>;

/// Of the corners' shares at one of a cube's eight Gauss points, edge 1 m.
Slopes slopes_at(int point) {
  const auto at = [&](int a) {
    return 0.5 + (((point >> a) & 1) != 0 ? 0.5 : -0.5) / std::sqrt(3.0);
  };
  Slopes slope;
  for (int i = 0; i < 8; ++i)
    for (int a = 0; a < 3; ++a) {
      double s = ((i >> a) & 1) != 0 ? 1 : -1;
      for (int b = 0; b < 3; ++b)
        if (b != a) s *= ((i >> b) & 1) != 0 ? at(b) : 1 - at(b);
      slope(i, a) = s;
    }
  return slope;
}

/// Stiffness of a cube of edge 1 m and Young's modulus 1 Pa.
Eigen::Matrix<double, 24, 24> unit_cube() {
  const double lambda = kPoisson / ((1 + kPoisson) * (1 - 2 * kPoisson));
  const double mu = 0.5 / (1 + kPoisson);
  Eigen::Matrix<double, 24, 24> k = Eigen::Matrix<double, 24, 24>::Zero();
  for (int g = 0; g < 8; ++g) {
    const Slopes slope = slopes_at(g);
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j < 8; ++j) {
        const Eigen::Matrix3d outer = slope.row(i).transpose() * slope.row(j);
        k.block<3, 3>(3 * i, 3 * j) += (lambda * outer + mu * outer.transpose() +
                                        mu * outer.trace() * Eigen::Matrix3d::Identity()) /
                                       8;
      }
  }
  return k;
}

using Conduction = Eigen::Matrix<double, 8, 8>;

/// The parts of a cube of edge 1 m, by the conduction's xx, yy, zz, xy, xz, yz.
std::array<Conduction, 6> unit_conduction() {
  constexpr std::array<std::array<int, 2>, 6> kPairs{
      {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};
  std::array<Conduction, 6> parts;
  for (std::size_t k = 0; k < 6; ++k) {
    parts[k].setZero();
    for (int g = 0; g < 8; ++g) {
      const Slopes slope = slopes_at(g);
      const Conduction part = slope.col(kPairs[k][0]) * slope.col(kPairs[k][1]).transpose() / 8;
      parts[k] += kPairs[k][0] == kPairs[k][1] ? part : Conduction(part + part.transpose());
    }
  }
  return parts;
}

}  // namespace

OpeningField::OpeningField(const CompiledJoint& joint, const SidedCage& cage,
                           const std::atomic<bool>* stop)
    : cage_(&cage), held_(cage.n_nodes(), false), on_wall_(cage.n_nodes(), false) {
  find_stiffness(joint);
  find_held(joint);
  hold_islands();
  stick();
  load();
  solve(stop);
  join_nodes();
  carry_distances();
}

/// A copy is as stiff as a whole cube of its tissue: slivers at the walls do not run ahead.
void OpeningField::find_stiffness(const CompiledJoint& joint) {
  const auto values = read_bundled_soft_tissues();
  ARTUS_REQUIRE(values.has_value(), "the bundled soft tissues must be valid");
  std::vector<double> young;
  for (RegionId r = 0; r < joint.regions.size(); ++r) {
    const SoftMaterial material =
        make_soft_material(joint.tissue_of(r), *values, Vec3::Zero(), kPoisson);
    young.push_back(r == kOutside
                        ? kAir
                        : std::clamp(2 * (1 + kPoisson) * material.shear, kSoftest, kStiffest));
  }
  for (const SidedCage::Copy& copy : cage_->copies()) {
    double sum = 0;
    for (const RegionId r : copy.samples) sum += young[r];
    modulus_.push_back(sum / static_cast<double>(copy.samples.size()) * cage_->edge());
  }
}

/// Every node of a cube that holds bone stands, on bone's side; so does what lies beyond the body's
/// cut, and the box's border.
void OpeningField::find_held(const CompiledJoint& joint) {
  const auto hold = [&](const SidedCage::Copy& copy) {
    for (const std::uint32_t node : copy.nodes) held_[node] = true;
  };
  for (const SidedCage::Copy& copy : cage_->copies()) {
    bool air = true;
    for (const RegionId r : copy.samples) {
      if (r == kBeyond || joint.tissue_of(r).haptic.hard) hold(copy);
      air = air && r == kOutside;
    }
    for (std::size_t i = 0; i < 8 && !air; ++i)
      if (cage_->on_border(copy, i)) held_[copy.nodes[i]] = true;
  }
  for (const Interface& f : joint.mesh.interfaces) {
    const auto hard = [&](RegionId r) {
      return r == kBeyond || joint.tissue_of(r).haptic.hard;
    };
    if (!hard(f.front) && !hard(f.back)) continue;
    const Vec3& a = joint.mesh.vertices[f.vertices[0]];
    const Vec3 ab = joint.mesh.vertices[f.vertices[1]] - a;
    const Vec3 ac = joint.mesh.vertices[f.vertices[2]] - a;
    const Vec3 into = (hard(f.front) ? 1 : -1) * ab.cross(ac);
    const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    const int n = std::max(1, static_cast<int>(std::ceil(longest / cage_->spacing())));
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) {
        const SidedCage::Place place = cage_->locate(a + (ab * i + ac * j) / n, into);
        if (place.copy >= 0) hold(cage_->copies()[static_cast<std::size_t>(place.copy)]);
      }
  }
}

/// To all nodes of the tissue that one of them is in.
void OpeningField::spread(std::vector<bool>& nodes) const {
  const auto copies = cage_->copies();
  const auto over = [&](const SidedCage::Copy& copy) {
    const auto is = [&](std::uint32_t node) {
      return nodes[node];
    };
    const auto n = std::count_if(copy.nodes.begin(), copy.nodes.end(), is);
    if (n == 0 || n == 8) return false;
    for (const std::uint32_t node : copy.nodes) nodes[node] = true;
    return true;
  };
  for (bool more = true; more;) {
    more = false;
    for (const SidedCage::Copy& copy : copies) more = over(copy) || more;
    for (std::size_t c = copies.size(); c-- > 0;) more = over(copies[c]) || more;
  }
}

/// What hangs on nothing that stands and is not open to the air, as a film between two of the
/// space's regions, stands itself; a shell around the body that its space parts from it is free.
void OpeningField::hold_islands() {
  std::vector<bool> anchored = held_;
  const auto copies = cage_->copies();
  for (const SidedCage::Copy& copy : copies)
    if (std::find(copy.samples.begin(), copy.samples.end(), kOutside) != copy.samples.end())
      for (const std::uint32_t node : copy.nodes) anchored[node] = true;
  spread(anchored);
  for (std::size_t i = 0; i < held_.size(); ++i) held_[i] = held_[i] || !anchored[i];
}

/// How much each node is kept in its place, of its own stiffness.
Eigen::VectorXd OpeningField::anchors() const {
  std::vector<bool> bound = held_;
  spread(bound);
  Eigen::VectorXd share(static_cast<Eigen::Index>(3 * bound.size()));
  for (std::size_t i = 0; i < bound.size(); ++i)
    share.segment<3>(static_cast<Eigen::Index>(3 * i)).setConstant(bound[i] ? kAnchor : kLoose);
  return share;
}

/// Walls that lie on each other stick toward a rim, where both sides are one.
void OpeningField::stick() {
  const auto copies = cage_->copies();
  std::vector<Vec3> rim;
  for (const SidedCage::Film& film : cage_->films()) {
    const auto& here = copies[static_cast<std::size_t>(film.here.copy)].nodes;
    const auto& there = copies[static_cast<std::size_t>(film.there.copy)].nodes;
    if (std::find_first_of(here.begin(), here.end(), there.begin(), there.end()) != here.end())
      rim.push_back((film.here.p + film.there.p) / 2);
  }
  std::vector<double> far;
  double most = 0;
  for (const SidedCage::Film& film : cage_->films()) {
    double least = cage_->extent();
    for (const Vec3& p : rim) least = std::min(least, (p - film.here.p).norm());
    far.push_back(least);
    most = std::max(most, least);
  }
  for (std::size_t k = 0; k < far.size(); ++k) {
    const SidedCage::Film& film = cage_->films()[k];
    const double fade = std::exp(-kFade * far[k] / most);
    if (fade < kFaint || film.here.copy == film.there.copy) continue;
    Film out;
    out.stiffness = kFilm * fade * film.area;
    const auto here = cage_->weights(film.here);
    const auto there = cage_->weights(film.there);
    for (std::size_t i = 0; i < 8; ++i) {
      out.nodes[i] = copies[static_cast<std::size_t>(film.here.copy)].nodes[i];
      out.nodes[i + 8] = copies[static_cast<std::size_t>(film.there.copy)].nodes[i];
      out.share[i] = here[i];
      out.share[i + 8] = -there[i];
    }
    films_.push_back(out);
  }
}

/// A pressure of 1 Pa on all walls.
void OpeningField::load() {
  force_.assign(3 * cage_->n_nodes(), 0);
  for (const SidedCage::Wall& wall : cage_->walls()) {
    const Vec3 ab = wall.p[1] - wall.p[0];
    const Vec3 ac = wall.p[2] - wall.p[0];
    const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    const int n = std::max(1, static_cast<int>(std::ceil(longest / (2 * cage_->spacing()))));
    const Vec3 part = ab.cross(ac).norm() / (2 * n * n) * wall.into;  // m^2
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j)
        for (const double third : {1.0 / 3, 2.0 / 3}) {
          if (third > 0.5 && i + j + 1 >= n) continue;
          const SidedCage::Place place =
              cage_->locate(wall.p[0] + (ab * (i + third) + ac * (j + third)) / n, wall.into);
          if (place.copy < 0) continue;
          const auto weights = cage_->weights(place);
          const auto& nodes = cage_->copies()[static_cast<std::size_t>(place.copy)].nodes;
          for (std::size_t k = 0; k < 8; ++k) {
            on_wall_[nodes[k]] = true;
            for (std::size_t a = 0; a < 3; ++a)
              force_[3 * nodes[k] + a] += weights[k] * part[static_cast<int>(a)];
          }
        }
  }
}

std::vector<double> OpeningField::times(const std::vector<double>& x) const {
  const Element unit = unit_cube().cast<float>();
  std::vector<double> y(x.size(), 0);
  const auto copies = cage_->copies();
  for (const std::uint32_t c : giving_) {
    const auto& nodes = copies[c].nodes;
    Corner in;
    for (int i = 0; i < 8; ++i)
      for (std::size_t a = 0; a < 3; ++a)
        in[3 * i + static_cast<int>(a)] =
            static_cast<float>(x[3 * nodes[static_cast<std::size_t>(i)] + a]);
    const Corner out = unit * in;
    for (int i = 0; i < 8; ++i)
      for (std::size_t a = 0; a < 3; ++a)
        y[3 * nodes[static_cast<std::size_t>(i)] + a] +=
            modulus_[c] * static_cast<double>(out[3 * i + static_cast<int>(a)]);
  }
  for (const Film& film : films_)
    for (std::size_t a = 0; a < 3; ++a) {
      double apart = 0;
      for (std::size_t k = 0; k < 16; ++k) apart += film.share[k] * x[3 * film.nodes[k] + a];
      for (std::size_t k = 0; k < 16; ++k)
        y[3 * film.nodes[k] + a] += film.stiffness * apart * film.share[k];
    }
  return y;
}

/// Conjugate gradients with the diagonal.
void OpeningField::solve(const std::atomic<bool>* stop) {
  const std::size_t n = force_.size();
  motion_.assign(n / 3, Vec3::Zero());
  const double own = unit_cube()(0, 0);
  std::vector<double> diagonal(n, 0);
  const auto copies = cage_->copies();
  for (std::size_t c = 0; c < copies.size(); ++c)
    for (const std::uint32_t node : copies[c].nodes)
      for (std::size_t a = 0; a < 3; ++a) diagonal[3 * node + a] += own * modulus_[c];
  for (const Film& film : films_)
    for (std::size_t k = 0; k < 16; ++k)
      for (std::size_t a = 0; a < 3; ++a)
        diagonal[3 * film.nodes[k] + a] += film.stiffness * film.share[k] * film.share[k];
  giving_.clear();
  for (std::uint32_t c = 0; c < copies.size(); ++c)
    if (std::any_of(copies[c].nodes.begin(), copies[c].nodes.end(),
                    [&](std::uint32_t node) { return !held_[node]; }))
      giving_.push_back(c);
  using Vector = Eigen::Map<const Eigen::VectorXd>;
  const auto size = static_cast<Eigen::Index>(n);
  Eigen::VectorXd free(size);
  for (std::size_t i = 0; i < n; ++i) free[static_cast<Eigen::Index>(i)] = held_[i / 3] ? 0 : 1;
  const Eigen::VectorXd weight = free.cwiseQuotient(Vector(diagonal.data(), size));
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size);
  Eigen::VectorXd r = free.cwiseProduct(Vector(force_.data(), size));
  Eigen::VectorXd z = weight.cwiseProduct(r);
  std::vector<double> p(z.data(), z.data() + n);
  const Eigen::VectorXd anchor = anchors().cwiseProduct(Vector(diagonal.data(), size));
  double rz = r.dot(z);
  const double enough = kExact * kExact * rz;
  for (int pass = 0; pass < kMaxPasses && rz > enough; ++pass) {
    if (stop != nullptr && pass % kPassesToAsk == 0 && *stop) return;
    const std::vector<double> kp = times(p);
    Eigen::Map<Eigen::VectorXd> d(p.data(), size);
    const Eigen::VectorXd q = free.cwiseProduct(Vector(kp.data(), size) + anchor.cwiseProduct(d));
    const double alpha = rz / d.dot(q);
    x += alpha * d;
    r -= alpha * q;
    z = weight.cwiseProduct(r);
    const double before = rz;
    rz = r.dot(z);
    d = z + rz / before * d;
  }
  for (std::size_t i = 0; i < motion_.size(); ++i)
    motion_[i] = x.segment<3>(static_cast<Eigen::Index>(3 * i));
}

/// xx, yy, zz, xy, xz, yz of how easily something spreads in a cube.
std::array<double, 6> OpeningField::conduction_of(const SidedCage::Copy& copy) const {
  Vec3 along = Vec3::Zero();
  for (const std::uint32_t node : copy.nodes) along += motion_[node];
  const double size = along.norm();
  if (size > 0) along *= std::sqrt(kAlong) / size;
  return {1 + along.x() * along.x(), 1 + along.y() * along.y(), 1 + along.z() * along.z(),
          along.x() * along.y(),     along.x() * along.z(),     along.y() * along.z()};
}

void OpeningField::join_nodes() {
  const std::array<Conduction, 6> unit = unit_conduction();
  std::vector<Eigen::Triplet<double>> inner;
  std::vector<Eigen::Triplet<double>> outer;
  for (const SidedCage::Copy& copy : cage_->copies()) {
    const std::array<double, 6> d = conduction_of(copy);
    Conduction k = Conduction::Zero();
    for (std::size_t i = 0; i < 6; ++i) k += d[i] * unit[i];
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j < 8; ++j) {
        const auto row = copy.nodes[static_cast<std::size_t>(i)];
        const auto column = copy.nodes[static_cast<std::size_t>(j)];
        if (on_wall_[row]) continue;
        (on_wall_[column] ? outer : inner)
            .emplace_back(static_cast<int>(row), static_cast<int>(column), k(i, j));
      }
  }
  for (std::size_t i = 0; i < on_wall_.size(); ++i)
    inner.emplace_back(static_cast<int>(i), static_cast<int>(i), on_wall_[i] ? 1 : kTiny);
  const auto n = static_cast<Eigen::Index>(on_wall_.size());
  inner_ = Matrix(n, n);
  outer_ = Matrix(n, n);
  inner_.setFromTriplets(inner.begin(), inner.end());
  outer_.setFromTriplets(outer.begin(), outer.end());
  nearly_ = std::make_shared<const Preconditioner>(inner_);
}

Vec3 OpeningField::middle() const {
  Vec3 sum = Vec3::Zero();
  for (const SidedCage::Wall& wall : cage_->walls()) sum += wall.p[0];
  return sum / static_cast<double>(cage_->walls().size());
}

void OpeningField::carry_distances() {
  const Vec3 from = middle();
  for (int a = 0; a < 3; ++a)
    carried_[static_cast<std::size_t>(a)] =
        carry_on([&](const Vec3& p) { return p[a] - from[a]; }, kExactDistance);
  carried_[3] = carry_on([&](const Vec3& p) { return (p - from).squaredNorm(); }, kExactDistance);
}

std::vector<double> OpeningField::carry_on(const std::function<double(const Vec3& p_J)>& on_walls,
                                           double exactness) const {
  const std::size_t n = cage_->n_nodes();
  Eigen::VectorXd walls = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  double known = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!on_wall_[i]) continue;
    walls[static_cast<Eigen::Index>(i)] = on_walls(cage_->node(i));
    known += 1;
  }
  const double mean = walls.sum() / std::max(known, 1.0);
  for (std::size_t i = 0; i < n; ++i)
    if (on_wall_[i]) walls[static_cast<Eigen::Index>(i)] -= mean;
  const Eigen::VectorXd x = carried(walls, exactness);
  std::vector<double> out(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = mean + x[static_cast<Eigen::Index>(i)];
  return out;
}

/// Conjugate gradients. What is kept is not written to: any number of threads.
Eigen::VectorXd OpeningField::carried(const Eigen::VectorXd& walls, double exactness) const {
  Eigen::VectorXd x = walls;
  Eigen::VectorXd r = walls - outer_ * walls - inner_ * x;
  Eigen::VectorXd z = nearly_->solve(r);
  Eigen::VectorXd p = z;
  double rz = r.dot(z);
  const double enough = exactness * exactness * rz;
  for (int pass = 0; pass < kMaxPasses && rz > enough; ++pass) {
    const Eigen::VectorXd q = inner_ * p;
    const double alpha = rz / p.dot(q);
    x += alpha * p;
    r -= alpha * q;
    z = nearly_->solve(r);
    const double before = rz;
    rz = r.dot(z);
    p = z + rz / before * p;
  }
  return x;
}

/// |p - a|^2 = |p|^2 - 2 p.a + |a|^2: what is carried on is linear in what is told on the walls.
std::vector<double> OpeningField::squared_distance(const Vec3& from_J) const {
  const Vec3 a = from_J - middle();
  std::vector<double> out(carried_[3]);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Vec3 p(carried_[0][i], carried_[1][i], carried_[2][i]);
    out[i] = std::max(0.0, out[i] - 2 * p.dot(a) + a.squaredNorm());
  }
  return out;
}

}  // namespace artus
