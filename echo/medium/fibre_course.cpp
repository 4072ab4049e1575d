// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/medium/fibre_course.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

namespace artus {
namespace {

constexpr std::size_t kSamples = 1000;  // at most, of tetrahedra or triangles
constexpr double kMinContact = 5e-6;    // m2 that muscle and tendon share when they are one
constexpr double kEndShare = 0.125;     // of a muscle's volume is an end
constexpr double kFollow = 30;   // how much more it matters that fibres are followed than how far
                                 // sheets lie apart
constexpr double kRidge = 1e-7;  // of the mean diagonal: keeps terms that no sample moves at zero
constexpr std::array<double, 4> kDepths{0, 6e-3, 14e-3, 24e-3};  // m below the skin

constexpr int kTerms = static_cast<int>(MaterialMap::kTerms);
using Square = Eigen::Matrix<double, kTerms, kTerms>;
using Column = MaterialMap::Terms;
using Slopes = MaterialMap::Slopes;

/// Where polynomials are of the order of one.
struct Frame3 {
  Vec3 centre = Vec3::Zero();
  double scale = 1;

  [[nodiscard]] Vec3 local(const Vec3& p_J) const { return (p_J - centre) / scale; }
};

struct Sample {
  Vec3 p_J = Vec3::Zero();
  double weight = 0;               // share of the volume or area
  Slopes slopes = Slopes::Zero();  // by p_J
};

Frame3 frame_around(const std::vector<Sample>& samples) {
  Vec3 low = Vec3::Constant(1e9);
  Vec3 high = Vec3::Constant(-1e9);
  for (const Sample& s : samples) {
    low = low.cwiseMin(s.p_J);
    high = high.cwiseMax(s.p_J);
  }
  return {0.5 * (low + high), std::max(1e-3, 0.5 * (high - low).maxCoeff())};
}

/// Least-squares sums for polynomials that share their conditions' left sides.
class Fit {
 public:
  explicit Fit(std::size_t n_rows) : rows_(n_rows, kTerms) {}

  /// Asks that `row` times the coefficients be as given to add_values, as much as `weight` says.
  void add(const Column& row, double weight) {
    rows_.row(used_++) = std::sqrt(weight) * row.transpose();
  }
  void add_gradient(const Slopes& slopes, double weight) {
    for (int a = 0; a < 3; ++a) add(slopes.row(a).transpose(), weight);
  }

  /// Coefficients for a right side: the sum over conditions of weight * wanted value * row.
  [[nodiscard]] Column solve(const Column& right) const {
    Square normal = rows_.topRows(used_).transpose() * rows_.topRows(used_);
    normal.diagonal().array() += kRidge * normal.trace() / kTerms + 1e-300;
    return normal.ldlt().solve(right);
  }

 private:
  Eigen::Matrix<double, Eigen::Dynamic, kTerms> rows_;
  Eigen::Index used_ = 0;
};

/// The step through `count` indices that visits at most kSamples of them, evenly spread.
std::size_t stride_of(std::size_t count) {
  return std::max<std::size_t>(1, (count + kSamples - 1) / kSamples);
}

std::vector<Sample> sample_region(const CompiledJoint& joint, RegionId region) {
  const TetMesh& mesh = joint.mesh;
  std::vector<std::size_t> own;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (mesh.regions[t] == region) own.push_back(t);
  }
  const std::size_t stride = stride_of(own.size());
  std::vector<Sample> samples;
  for (std::size_t k = 0; k < own.size(); k += stride) {
    Sample sample;
    for (const std::uint32_t v : mesh.tetrahedra[own[k]]) sample.p_J += mesh.vertices[v] / 4;
    // One that what was injected has folded counts for nothing.
    sample.weight = static_cast<double>(stride) * std::max(0.0, tet_volume(mesh, own[k]));
    samples.push_back(sample);
  }
  return samples;
}

double total_weight(const std::vector<Sample>& samples) {
  double sum = 0;
  for (const Sample& s : samples) sum += s.weight;
  return sum;
}

}  // namespace

Continuation find_continuation(const CompiledJoint& joint, RegionId region) {
  const TissueKind own = joint.tissue_of(region).acoustic.kind;
  if (own != TissueKind::muscle && own != TissueKind::tendon) return {};
  const TissueKind other = own == TissueKind::muscle ? TissueKind::tendon : TissueKind::muscle;
  const TetMesh& mesh = joint.mesh;
  std::vector<double> area(joint.regions.size(), 0.0);
  std::vector<Vec3> moment(joint.regions.size(), Vec3::Zero());
  std::vector<Vec3> outward(joint.regions.size(), Vec3::Zero());
  for (const Interface& face : mesh.interfaces) {
    if (face.front != region && face.back != region) continue;
    const RegionId beyond = face.front == region ? face.back : face.front;
    if (beyond < kFirstRegion || joint.tissue_of(beyond).acoustic.kind != other) continue;
    const Vec3& a = mesh.vertices[face.vertices[0]];
    const Vec3& b = mesh.vertices[face.vertices[1]];
    const Vec3& c = mesh.vertices[face.vertices[2]];
    const Vec3 to_front = 0.5 * (b - a).cross(c - a);
    const double here = to_front.norm();
    area[beyond] += here;
    outward[beyond] += (face.front == region ? -1 : 1) * to_front;
    moment[beyond] += here / 3 * (a + b + c);
  }
  const auto most = std::max_element(area.begin(), area.end());
  if (!(*most > kMinContact)) return {};
  const auto found = static_cast<std::size_t>(most - area.begin());
  return {static_cast<RegionId>(found), moment[found] / *most, outward[found] / *most};
}

namespace {

/// A region and as much of its continuation, so that fibres run on from muscle to tendon.
std::vector<Sample> sample_continued(const CompiledJoint& joint, RegionId region) {
  std::vector<Sample> samples = sample_region(joint, region);
  const Continuation next = find_continuation(joint, region);
  if (next.region != kOutside) {
    std::vector<Sample> more = sample_region(joint, next.region);
    std::sort(more.begin(), more.end(), [&](const Sample& a, const Sample& b) {
      return (a.p_J - next.p_J).squaredNorm() < (b.p_J - next.p_J).squaredNorm();
    });
    double room = total_weight(samples);
    for (const Sample& s : more) {
      if (room <= 0) break;
      samples.push_back(s);
      room -= s.weight;
    }
  }
  const double all = total_weight(samples);
  for (Sample& s : samples) s.weight /= all;
  return samples;
}

void find_slopes(std::vector<Sample>& samples, const Frame3& frame) {
  for (Sample& s : samples) s.slopes = MaterialMap::slopes(frame.local(s.p_J)) / frame.scale;
}

/// The direction in which a region extends most.
Vec3 principal_axis(const std::vector<Sample>& samples) {
  Vec3 mean = Vec3::Zero();
  for (const Sample& s : samples) mean += s.weight * s.p_J;
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const Sample& s : samples) second += s.weight * (s.p_J - mean) * (s.p_J - mean).transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(second).eigenvectors().col(2);
}

/// The potential whose gradient leads from the eighth that lies farthest against `axis` to the one
/// that lies farthest along it, through no side: flow from sources to sinks of least energy.
Column fit_potential(const std::vector<Sample>& samples, const Frame3& frame, const Vec3& axis) {
  std::vector<std::size_t> order(samples.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return axis.dot(samples[a].p_J) < axis.dot(samples[b].p_J);
  });
  Fit fit(3 * samples.size());
  Column right = Column::Zero();
  double before = 0;
  for (const std::size_t i : order) {
    const Sample& s = samples[i];
    fit.add_gradient(s.slopes, s.weight);
    const double middle = before + 0.5 * s.weight;
    before += s.weight;
    const double source = middle < kEndShare ? -1 : (middle > 1 - kEndShare ? 1 : 0);
    if (source != 0) right += source * s.weight * MaterialMap::terms(frame.local(s.p_J));
  }
  return fit.solve(right);
}

/// The part of `direction` across `fibre`, unit.
Vec3 across(const Vec3& direction, const Vec3& fibre) {
  const Vec3 part = direction - fibre * fibre.dot(direction);
  return part.norm() > 0.05 ? Vec3(part.normalized()) : Vec3(fibre.unitOrthogonal());
}

/// The sum of a gradient's conditions for one right side.
Column towards(const std::vector<Sample>& samples, const std::vector<Vec3>& wanted) {
  Column right = Column::Zero();
  for (std::size_t i = 0; i < samples.size(); ++i)
    right += samples[i].weight * samples[i].slopes.transpose() * wanted[i];
  return right;
}

/// Conditions on a coordinate that stays the same along `lines` and has a gradient of its own.
Fit across_lines(const std::vector<Sample>& samples, const std::vector<Vec3>& lines) {
  Fit fit(4 * samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& s = samples[i];
    fit.add(s.slopes.transpose() * lines[i], kFollow * s.weight);
    fit.add_gradient(s.slopes, s.weight);
  }
  return fit;
}

/// The potential whose gradient is the part of `axis` that runs across `down`.
Column fit_along(const std::vector<Sample>& samples, const std::vector<Vec3>& down,
                 const Vec3& axis) {
  Fit fit(3 * samples.size());
  std::vector<Vec3> wanted;
  wanted.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec3 n = down[i].normalized();
    fit.add_gradient(samples[i].slopes, samples[i].weight);
    wanted.push_back(axis - n * n.dot(axis));
  }
  return fit.solve(towards(samples, wanted));
}

}  // namespace

std::optional<MaterialMap> fit_skin_depth(const CompiledJoint& joint) {
  const TetMesh& mesh = joint.mesh;
  if (mesh.tetrahedra.empty()) return std::nullopt;
  std::vector<std::size_t> skin;
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i) {
    if (mesh.interfaces[i].front == kOutside || mesh.interfaces[i].back == kOutside)
      skin.push_back(i);
  }
  if (skin.empty()) return std::nullopt;
  std::vector<Sample> samples;
  std::vector<Vec3> inward;
  std::vector<double> depth;
  for (std::size_t k = 0; k < skin.size(); k += stride_of(skin.size())) {
    const Interface& face = mesh.interfaces[skin[k]];
    const Vec3& a = mesh.vertices[face.vertices[0]];
    const Vec3& b = mesh.vertices[face.vertices[1]];
    const Vec3& c = mesh.vertices[face.vertices[2]];
    const Vec3 area = 0.5 * (b - a).cross(c - a);
    if (area.norm() <= 0) continue;
    const Vec3 in = (face.front == kOutside ? -1 : 1) * area.normalized();
    for (const double d : kDepths) {
      samples.push_back({(a + b + c) / 3 + d * in, area.norm() / (1 + d / kDepths[1])});
      inward.push_back(in);
      depth.push_back(d);
    }
  }
  if (samples.empty()) return std::nullopt;
  const Frame3 frame = frame_around(samples);
  find_slopes(samples, frame);
  Fit stacked(4 * samples.size());
  Column right = towards(samples, inward);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Column terms = MaterialMap::terms(frame.local(samples[i].p_J));
    const double weight = samples[i].weight / (kDepths[1] * kDepths[1]);
    stacked.add(terms, weight);
    stacked.add_gradient(samples[i].slopes, samples[i].weight);
    right += weight * depth[i] * terms;
  }
  MaterialMap::Coefficients coefficients = MaterialMap::Coefficients::Zero();
  coefficients.col(0) = stacked.solve(right);
  const Fit along = across_lines(samples, inward);
  for (int c = 1; c < 3; ++c) {  // along the skin any two directions will do
    std::vector<Vec3> wanted;
    wanted.reserve(inward.size());
    for (const Vec3& in : inward)
      wanted.push_back(across(joint.X_JP_default.linear().col(c - 1), in));
    coefficients.col(c) = along.solve(towards(samples, wanted));
    coefficients(0, c) = 0;  // see fit_fibre_course
  }
  return MaterialMap(frame.centre, frame.scale, coefficients);
}

std::optional<MaterialMap> fit_fibre_course(const CompiledJoint& joint, RegionId region,
                                            const std::optional<MaterialMap>& depth) {
  std::vector<Sample> samples = sample_continued(joint, region);
  if (samples.size() < MaterialMap::kTerms) return std::nullopt;
  Vec3 axis = joint.regions[region].fibre_axis;
  if (axis.squaredNorm() < 0.5) axis = principal_axis(samples);
  const Frame3 frame = frame_around(samples);
  find_slopes(samples, frame);
  MaterialMap::Coefficients coefficients = MaterialMap::Coefficients::Zero();
  std::vector<Vec3> down;
  for (const Sample& s : samples)
    down.push_back(depth ? Vec3(depth->evaluate(s.p_J).gradient.row(0).transpose())
                         : Vec3(joint.X_JP_default.linear().col(2)));
  coefficients.col(2) = joint.regions[region].fibre_course == FibreCourse::layer
                            ? fit_along(samples, down, axis)
                            : fit_potential(samples, frame, axis);
  std::vector<Vec3> fibres;
  std::vector<Vec3> stacked;
  std::vector<Vec3> beside;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec3 flow = samples[i].slopes * coefficients.col(2);
    fibres.push_back(flow.norm() > 1e-12 ? Vec3(flow.normalized()) : axis);
    stacked.push_back(across(down[i], fibres.back()));
    beside.push_back(fibres.back().cross(stacked.back()));
  }
  const Fit fit = across_lines(samples, fibres);
  coefficients.col(0) = fit.solve(towards(samples, stacked));
  coefficients.col(1) = fit.solve(towards(samples, beside));
  for (int c = 0; c < 3; ++c) {  // on the whole one metre a metre
    double speed = 0;
    for (const Sample& s : samples) speed += s.weight * (s.slopes * coefficients.col(c)).norm();
    if (!(speed > 0)) return std::nullopt;
    coefficients.col(c) /= speed;
    // slopes leave the origin open: near the middle, or single precision would not tell places
    // apart
    coefficients(0, c) = 0;
  }
  return MaterialMap(frame.centre, frame.scale, coefficients);
}

}  // namespace artus
