// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/anatomy/compile/construct.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <tbb/parallel_for.h>

#include "artus/core/check.h"

namespace artus {
namespace {

using Function = std::function<double(const Vec3&)>;

constexpr double kRimThickness = 0.5;    // of a cap's thickness, where it ends
constexpr double kContactDepth = 1e-3;   // m, vertices this near the deepest one are its contact
constexpr double kContactReach = 10e-3;  // m, and this near it

const DistanceField& field_of(const NamedFields& fields, const std::string& name) {
  const auto found = fields.find(name);
  ARTUS_REQUIRE(found != fields.end(), "no field of '" + name + "'");
  return *found->second;
}

std::vector<const DistanceField*> fields_of(const NamedFields& fields,
                                            const std::vector<std::string>& names) {
  std::vector<const DistanceField*> found;
  found.reserve(names.size());
  for (const std::string& name : names) found.push_back(&field_of(fields, name));
  return found;
}

double nearest(const std::vector<const DistanceField*>& fields, const Vec3& p) {
  double d = std::numeric_limits<double>::infinity();
  for (const DistanceField* f : fields) d = std::min(d, f->value(p));
  return d;
}

Function make_function(const ShellConstruct& shell, const NamedFields& fields) {
  const DistanceField& inside = field_of(fields, shell.inside);
  return [&inside, t = shell.thickness](const Vec3& p) {
    const double d = inside.value(p);
    return std::max(d, -d - t);
  };
}

Function make_function(const CapConstruct& cap, const NamedFields& fields) {
  const DistanceField& on = field_of(fields, cap.on);
  return [&on, near = fields_of(fields, cap.near), cap](const Vec3& p) {
    const double d = on.value(p);
    const double gap = d + nearest(near, p);
    const double inner = std::clamp(2 * (1 - gap / cap.within), 0.0, 1.0);
    const double thickness = cap.thickness * (kRimThickness + (1 - kRimThickness) * inner);
    return std::max({-d, d - std::min(thickness, gap / 2), (gap - cap.within) / 2});
  };
}

Function make_function(const GapConstruct& gap, const NamedFields& fields) {
  return [roof = fields_of(fields, gap.roof), floor = fields_of(fields, gap.floor),
          gap](const Vec3& p) {
    const double in_ball = gap.radius > 0 ? (p - gap.centre).norm() - gap.radius : -gap.within;
    if (in_ball > gap.thickness) return in_ball;
    const double to_roof = nearest(roof, p);
    const double to_floor = nearest(floor, p);
    return std::max({(std::abs(to_roof - to_floor) - gap.thickness) / 2,
                     (to_roof + to_floor - gap.within) / 2, in_ball});
  };
}

Function make_function(const EndConstruct& end, const NamedFields& fields) {
  ARTUS_REQUIRE(end.insertion.has_value(), "the insertion must be known");
  const DistanceField& of = field_of(fields, end.of);
  return [&of, insertion = *end.insertion, within = end.within](const Vec3& p) {
    return std::max(of.value(p), (p - insertion).norm() - within);
  };
}

Function make_function(const SurfaceFile& /*file*/, const NamedFields& /*fields*/) {
  ARTUS_REQUIRE(false, "a surface file is not a construct");
  return {};
}

// Which cells of a grid lie in the largest connected part where a function is negative.
class LargestPart {
 public:
  LargestPart(const Function& f, const Box& box, double spacing)
      : origin_(box.lower), spacing_(spacing) {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto i = static_cast<Eigen::Index>(a);
      n_[a] = static_cast<std::int64_t>(std::max(0.0, (box.upper[i] - box.lower[i]) / spacing)) + 2;
    }
    part_.assign(static_cast<std::size_t>(n_[0] * n_[1] * n_[2]), kOutsidePart);
    tbb::parallel_for(std::int64_t{0}, size(), [&](std::int64_t i) {
      if (f(point(i)) < 0) part_[static_cast<std::size_t>(i)] = kUnseen;
    });
    find_largest();
  }

  // Whether one of the grid points around `p` is in the largest part.
  [[nodiscard]] bool contains(const Vec3& p) const {
    const Vec3 q = (p - origin_) / spacing_;
    for (int corner = 0; corner < 8; ++corner) {
      const std::array<std::int64_t, 3> i{
          static_cast<std::int64_t>(std::floor(q[0])) + (corner & 1),
          static_cast<std::int64_t>(std::floor(q[1])) + (corner >> 1 & 1),
          static_cast<std::int64_t>(std::floor(q[2])) + (corner >> 2 & 1)};
      bool valid = true;
      for (std::size_t a = 0; a < 3; ++a) valid = valid && i[a] >= 0 && i[a] < n_[a];
      if (valid &&
          part_[static_cast<std::size_t>(i[0] + n_[0] * (i[1] + n_[1] * i[2]))] == largest_) {
        return true;
      }
    }
    return false;
  }

 private:
  static constexpr std::int32_t kOutsidePart = -1;
  static constexpr std::int32_t kUnseen = -2;

  [[nodiscard]] std::int64_t size() const { return static_cast<std::int64_t>(part_.size()); }
  [[nodiscard]] Vec3 point(std::int64_t i) const {
    const std::int64_t y = i / n_[0] % n_[1];
    const std::int64_t z = i / (n_[0] * n_[1]);
    return origin_ + spacing_ * Vec3(static_cast<double>(i % n_[0]), static_cast<double>(y),
                                     static_cast<double>(z));
  }

  // Marks the part that holds point `start`; returns its size.
  std::size_t mark(std::int64_t start, std::int32_t id) {
    const std::array<std::int64_t, 3> strides{1, n_[0], n_[0] * n_[1]};
    std::vector<std::int64_t> stack{start};
    part_[static_cast<std::size_t>(start)] = id;
    std::size_t count = 0;
    while (!stack.empty()) {
      const std::int64_t i = stack.back();
      stack.pop_back();
      ++count;
      for (std::size_t a = 0; a < 3; ++a) {
        const std::int64_t along = i / strides[a] % n_[a];
        for (const int side : {-1, 1}) {
          if (along + side < 0 || along + side >= n_[a]) continue;
          const std::int64_t j = i + side * strides[a];
          if (part_[static_cast<std::size_t>(j)] != kUnseen) continue;
          part_[static_cast<std::size_t>(j)] = id;
          stack.push_back(j);
        }
      }
    }
    return count;
  }

  void find_largest() {
    std::size_t best = 0;
    std::int32_t id = 0;
    for (std::int64_t i = 0; i < size(); ++i) {
      if (part_[static_cast<std::size_t>(i)] != kUnseen) continue;
      const std::size_t count = mark(i, id);
      if (count > best) {
        best = count;
        largest_ = id;
      }
      ++id;
    }
  }

  Vec3 origin_;
  double spacing_;
  std::array<std::int64_t, 3> n_{};
  std::vector<std::int32_t> part_;
  std::int32_t largest_ = 0;
};

Function keep_largest_part(const Function& f, const FieldSampling& sampling) {
  return [f, part = std::make_shared<const LargestPart>(f, sampling.box, sampling.spacing)](
             const Vec3& p) {
    const double d = f(p);
    return d >= 0 || part->contains(p) ? d : -d;
  };
}

}  // namespace

std::map<std::string, double> construct_bands(const JointFile& joint) {
  std::map<std::string, double> bands;
  const auto need = [&bands](const std::string& name, double band) {
    double& known = bands[name];
    known = std::max(known, band);
  };
  for (const Structure& s : joint.structures) {
    if (const auto* shell = std::get_if<ShellConstruct>(&s.shape)) {
      need(shell->inside, 1.5 * shell->thickness);
    } else if (const auto* cap = std::get_if<CapConstruct>(&s.shape)) {
      need(cap->on, cap->within);
      for (const std::string& name : cap->near) need(name, cap->within);
    } else if (const auto* gap = std::get_if<GapConstruct>(&s.shape)) {
      for (const std::string& name : gap->roof) need(name, gap->within + gap->thickness);
      for (const std::string& name : gap->floor) need(name, gap->within + gap->thickness);
    } else if (const auto* end = std::get_if<EndConstruct>(&s.shape)) {
      need(end->toward, 2 * kContactReach);
    }
  }
  return bands;
}

DistanceField make_construct_field(const Structure& structure, const NamedFields& fields,
                                   const FieldSampling& sampling) {
  const Function f =
      std::visit([&](const auto& shape) { return make_function(shape, fields); }, structure.shape);
  const auto* gap = std::get_if<GapConstruct>(&structure.shape);
  if (gap == nullptr) return DistanceField::compute(f, sampling);
  FieldSampling cut = sampling;
  if (gap->radius > 0) {
    const Vec3 reach = Vec3::Constant(gap->radius + 2 * sampling.spacing);
    cut.box.lower = cut.box.lower.cwiseMax(gap->centre - reach);
    cut.box.upper = cut.box.upper.cwiseMin(gap->centre + reach);
  }
  return DistanceField::compute(keep_largest_part(f, cut), cut);
}

Vec3 find_insertion(const SurfaceMesh& muscle, const DistanceField& bone) {
  Vec3 deepest = Vec3::Zero();
  double depth = std::numeric_limits<double>::infinity();
  for (const Vec3& v : muscle.vertices) {
    const double d = bone.value(v);
    if (d < depth) {
      depth = d;
      deepest = v;
    }
  }
  Vec3 sum = Vec3::Zero();
  double count = 0;
  for (const Vec3& v : muscle.vertices) {
    if ((v - deepest).norm() > kContactReach) continue;
    if (bone.value(v) > std::max(depth, 0.0) + kContactDepth) continue;
    sum += v;
    count += 1;
  }
  return count > 0 ? Vec3(sum / count) : deepest;
}

}  // namespace artus
