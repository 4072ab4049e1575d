// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/check/misplaced.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "artus/detail/anatomy/compile/labels/region_labels.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr std::size_t kSamples = 400;           // of each surface
constexpr double kClearly = 0.5 * kMillimetre;  // beyond what surfaces that touch differ by
constexpr double kOutsideShare = 0.02;          // of the samples, as compile warns of
constexpr double kAll = 0.99;                   // of the samples
constexpr double kTooMuchOutside = 0.5;    // of its area, assumed: less than half of it is left
constexpr double kSlip = 1 * kMillimetre;  // what metres written as millimetres come to

/// Evenly chosen vertices of a surface that lie in the region of interest.
std::vector<Vec3> samples_of(const SurfaceMesh& mesh, const std::optional<RegionOfInterest>& roi) {
  std::vector<Vec3> in_region;
  for (const Vec3& p : mesh.vertices)
    if (!roi || signed_distance(*roi, p) <= 0) in_region.push_back(p);
  std::vector<Vec3> chosen;
  const std::size_t step = in_region.size() / kSamples + 1;
  for (std::size_t i = 0; i < in_region.size(); i += step) chosen.push_back(in_region[i]);
  return chosen;
}

/// How samples lie to a closed surface.
struct Lie {
  double outside = 0;   // share clearly outside
  double inside = 0;    // share clearly inside
  double farthest = 0;  // m outside
  double least = 0;     // m inside, of all
};

Lie lie_of(const std::vector<Vec3>& samples, const DistanceTree& tree) {
  Lie lie;
  lie.least = 1;
  for (const Vec3& p : samples) {
    const double distance = tree.distance(p, 1);
    const bool is_inside = tree.winding_number(p) > 0.5;
    lie.least = std::min(lie.least, is_inside ? distance : 0.0);
    if (distance < kClearly) continue;
    (is_inside ? lie.inside : lie.outside) += 1.0 / static_cast<double>(samples.size());
    if (!is_inside) lie.farthest = std::max(lie.farthest, distance);
  }
  return lie;
}

Vec3 middle(const DistanceTree& tree) {
  return (tree.lower() + tree.upper()) / 2;
}

class Finder {
 public:
  Finder(const JointFile& file, const PreparedSurfaces& surfaces)
      : file_(file), surfaces_(surfaces) {
    for (const auto& surface : surfaces.structures)
      samples_.push_back(surface ? samples_of(surface->mesh, file.region_of_interest)
                                 : std::vector<Vec3>{});
  }

  std::vector<Finding> run() {
    tell_landmarks();
    std::size_t n = 0;
    std::size_t n_outside = 0;
    std::vector<Lie> lies(samples_.size());
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (samples_[i].empty()) continue;
      lies[i] = lie_of(samples_[i], surfaces_.body.tree);
      ++n;
      n_outside += lies[i].outside > kAll ? 1U : 0U;
    }
    if (n >= 2 && 5 * n_outside >= 4 * n) {
      tell_frame(n_outside, n);
      return std::move(found_);
    }
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (samples_[i].empty()) {
        tell_beyond(i);
        continue;
      }
      tell_outside(i, lies[i]);
      tell_swallowed(i);
      tell_twin(i);
    }
    return std::move(found_);
  }

 private:
  void add(Verdict verdict, const Structure& s, std::string message) {
    found_.push_back({verdict, "misplaced", s.name, s.line, std::move(message)});
  }

  // Nothing of a structure, or much less than was given: no joint that its author meant.
  void add_lost(std::size_t i, std::string message) {
    const Structure& s = file_.structures[i];
    found_.push_back({Verdict::refused, "lost", s.name, s.line, std::move(message)});
  }

  // Landmarks far from the body: of another unit, or of another frame.
  void tell_landmarks() {
    constexpr double kFar = 20 * kMillimetre;
    constexpr double kMetre = 1000;  // written as millimetres
    const DistanceTree& body = surfaces_.body.tree;
    std::size_t n_far = 0;
    std::size_t n_metres = 0;
    double most = 0;
    for (const Landmark& landmark : file_.landmarks) {
      const auto off = [&](const Vec3& p) {
        return body.winding_number(p) > 0.5 ? 0 : body.distance(p, 10);
      };
      const double distance = off(landmark.position);
      n_far += distance > kFar ? 1U : 0U;
      most = std::max(most, distance);
      if (landmark.position.norm() < kSlip && off(kMetre * landmark.position) <= kFar) ++n_metres;
    }
    Structure all;
    all.name = "landmarks";
    if (n_metres == file_.landmarks.size() && n_metres > 1) {
      add(Verdict::look, all,
          printed("all %zu lie within 1 mm of the origin, and 1000 times as far they lie in the "
                  "body: they are in metres; write them in the unit of the file",
                  n_metres));
    } else if (n_far > 0) {
      add(Verdict::look, all,
          printed("%zu of %zu lie more than 20 mm outside of the skin, up to %.0f mm; check their "
                  "unit and frame",
                  n_far, file_.landmarks.size(), most / kMillimetre));
    }
  }

  void tell_frame(std::size_t n_outside, std::size_t n) {
    Eigen::AlignedBox3d box;
    for (const auto& samples : samples_)
      for (const Vec3& p : samples) box.extend(p);
    const Vec3 away = box.center() - middle(surfaces_.body.tree);
    const Vec3 size = surfaces_.body.tree.upper() - surfaces_.body.tree.lower();
    add(Verdict::refused, file_.body,
        printed(
            "%zu of %zu structures lie outside of it: their middle is (%.0f, %.0f, %.0f) mm from "
            "its own, and it measures %.0f x %.0f x %.0f mm; it is in another frame or unit: "
            "export it with the structures or set its 'units'",
            n_outside, n, away.x() / kMillimetre, away.y() / kMillimetre, away.z() / kMillimetre,
            size.x() / kMillimetre, size.y() / kMillimetre, size.z() / kMillimetre));
  }

  // Far from the region of interest; what only has no vertex in it is not told.
  void tell_beyond(std::size_t i) {
    const auto& roi = file_.region_of_interest;
    if (!roi || !surfaces_.structures[i] || has_region_of_variant(file_.variants)) return;
    const DistanceTree& tree = surfaces_.structures[i]->tree;
    const double reach = roi->half_extent ? roi->half_extent->norm() : roi->radius;
    const double distance = tree.distance(roi->centre, 1);
    if (distance <= reach || tree.winding_number(roi->centre) > 0.5) return;
    add_lost(i,
             printed("all of it lies outside of the region of interest, by %.1f mm or more; none "
                     "of it will be in the joint; check its frame and units, or remove it",
                     (distance - reach) / kMillimetre));
  }

  void tell_outside(std::size_t i, Lie lie) {
    if (!(lie.outside > 0)) return;
    lie = area_outside(i);  // samples only say where to look
    if (lie.outside <= kOutsideShare) return;
    const bool is_lost = lie.outside > kTooMuchOutside;
    const char* rest = "that part is cut off";
    if (is_lost)
      rest = lie.outside > kAll
                 ? "none of it will be in the joint; check its frame and units, or remove it"
                 : "too little of it would be in the joint; check its frame and units; if the body "
                   "ends there, set 'region_of_interest' to where it does, or remove the structure";
    const std::string text =
        printed("%.0f %% of its surface lies outside of the skin, up to %.1f mm; %s",
                100 * lie.outside, lie.farthest / kMillimetre, rest);
    if (is_lost)
      add_lost(i, text);
    else
      add(Verdict::look, file_.structures[i], text);
  }

  /// The share of its area in the region that lies clearly outside of the body, and how far, by
  /// the middles of all its faces.
  [[nodiscard]] Lie area_outside(std::size_t i) const {
    const SurfaceMesh& mesh = surfaces_.structures[i]->mesh;
    const DistanceTree& body = surfaces_.body.tree;
    std::vector<double> area(mesh.triangles.size(), 0);
    std::vector<double> off(mesh.triangles.size(), 0);
    tbb::parallel_for(std::size_t{0}, area.size(), [&](std::size_t k) {
      const Vec3 centre = triangle_centre(mesh, mesh.triangles[k]);
      const auto& roi = file_.region_of_interest;
      if (roi && signed_distance(*roi, centre) > 0) return;
      area[k] = triangle_area(mesh, mesh.triangles[k]);
      if (body.winding_number(centre) <= 0.5) off[k] = body.distance(centre, 1);
    });
    Lie lie;
    double all = 0;
    for (std::size_t k = 0; k < area.size(); ++k) {
      all += area[k];
      if (off[k] >= kClearly) lie.outside += area[k];
      lie.farthest = std::max(lie.farthest, off[k]);
    }
    if (all > 0) lie.outside /= all;
    return lie;
  }

  [[nodiscard]] bool is_hard(const Structure& s) const {
    return std::any_of(file_.tissues.begin(), file_.tissues.end(),
                       [&](const Tissue& t) { return t.name == s.tissue && t.haptic.hard; });
  }

  // Inside a bone, or inside of what stands before it and leaves nothing of it.
  void tell_swallowed(std::size_t i) {
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      if (k == i || !surfaces_.structures[k] || is_twin(i, k)) continue;
      const bool in_bone = is_hard(file_.structures[k]);
      if (!in_bone && k > i) continue;
      const DistanceTree& other = surfaces_.structures[k]->tree;
      if (!other.empty() && (samples_[i].front().array() < other.lower().array()).any()) continue;
      const Lie lie = lie_of(samples_[i], other);
      if (lie.inside <= kAll) continue;
      const char* name = file_.structures[k].name.c_str();
      if (!in_bone) {
        add_lost(
            i,
            printed("all of it lies inside '%s', which stands before it in the file and takes all "
                    "of it: put it before '%s'",
                    name, name));
        return;
      }
      const std::string text = printed(
          "all of it lies inside the bone '%s', %.1f mm or more under its surface; %s", name,
          lie.least / kMillimetre,
          k < i ? "the bone stands before it in the file and takes all of it: put it before "
                  "the bone if it is meant, otherwise check its frame"
                : "check its frame if that is not meant");
      if (k < i)
        add_lost(i, text);
      else
        add(Verdict::look, file_.structures[i], text);
      return;
    }
    tell_shared_out(i);
  }

  // Inside of several that stand before it, or partly outside of the skin: what is left of its
  // surface. Of a layer that stands behind what lies inside of it, all of it is.
  void tell_shared_out(std::size_t i) {
    constexpr double kMuchTaken = 0.75;  // of the samples, assumed: half of cartilage lies in bone
    std::vector<std::size_t> others;
    for (std::size_t k = 0; k < i; ++k)
      if (surfaces_.structures[k] && !is_twin(i, k)) others.push_back(k);
    std::size_t n_taken = 0;
    std::vector<bool> takes(i, false);
    for (const Vec3& p : samples_[i]) {
      const DistanceTree& body = surfaces_.body.tree;
      bool taken = body.winding_number(p) <= 0.5 && body.distance(p, kClearly) >= kClearly;
      for (const std::size_t k : others) {
        const DistanceTree& other = surfaces_.structures[k]->tree;
        if ((p.array() < other.lower().array()).any() || (p.array() > other.upper().array()).any())
          continue;
        if (other.winding_number(p) <= 0.5 || other.distance(p, kClearly) < kClearly) continue;
        takes[k] = true;
        taken = true;
      }
      n_taken += taken ? 1U : 0U;
    }
    const double share = static_cast<double>(n_taken) / static_cast<double>(samples_[i].size());
    if (share < kMuchTaken) return;
    std::string names;
    for (std::size_t k = 0; k < i; ++k)
      if (takes[k]) names += (names.empty() ? "'" : ", '") + file_.structures[k].name + "'";
    if (names.empty()) return;  // what lies outside of the skin alone is told already
    add_lost(i, printed("%.0f %% of its surface lies inside %s, which stand before it in the file "
                        "and take that, or outside of the skin; too little of it would be in the "
                        "joint: put it before them if it is meant, otherwise check its frame",
                        100 * share, names.substr(0, 100).c_str()));
  }

  [[nodiscard]] bool is_twin(std::size_t i, std::size_t k) const {
    constexpr double kSame = 0.02;  // of the volume
    const auto& a = *surfaces_.structures[i];
    const auto& b = *surfaces_.structures[k];
    const double largest = kMillimetre;
    if (((a.tree.lower() - b.tree.lower()).cwiseAbs().maxCoeff() > largest) ||
        ((a.tree.upper() - b.tree.upper()).cwiseAbs().maxCoeff() > largest))
      return false;
    const double volume = signed_volume(a.mesh);
    if (std::abs(volume - signed_volume(b.mesh)) > kSame * volume) return false;
    const auto near = std::count_if(samples_[i].begin(), samples_[i].end(), [&](const Vec3& p) {
      return b.tree.distance(p, kClearly) < kClearly;
    });
    return static_cast<double>(near) >= kAll * static_cast<double>(samples_[i].size());
  }

  void tell_twin(std::size_t i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (!surfaces_.structures[k] || samples_[k].empty() || !is_twin(i, k)) continue;
      add_lost(
          i,
          printed("it is the same surface as '%s' (%.2f and %.2f cm3), which stands before it and "
                  "takes all of it; remove one of them",
                  file_.structures[k].name.c_str(),
                  signed_volume(surfaces_.structures[i]->mesh) / kCubicCentimetre,
                  signed_volume(surfaces_.structures[k]->mesh) / kCubicCentimetre));
      return;
    }
  }

  const JointFile& file_;
  const PreparedSurfaces& surfaces_;
  std::vector<std::vector<Vec3>> samples_;
  std::vector<Finding> found_;
};

}  // namespace

std::vector<Finding> find_misplaced(const JointFile& file, const PreparedSurfaces& surfaces) {
  return Finder(file, surfaces).run();
}

std::vector<Finding> find_foreign_frames(const JointSources& sources) {
  const JointFile& file = sources.joint();
  std::vector<Finding> found;
  const auto look_at = [&](const Structure& s) {
    const auto* surface = std::get_if<SurfaceFile>(&s.shape);
    const auto axes =
        surface == nullptr ? std::string() : sources.declared_axes(*surface).value_or("");
    if (axes.empty() || axes == file.axes) return;
    found.push_back(
        {Verdict::refused, "frame", s.name, s.line,
         printed("the header of %s says SPACE=%s, and joint.toml says axes = \"%s\": it would be "
                 "compiled mirrored to the other side; save it again in %s (3D Slicer: coordinate "
                 "system of the export)",
                 surface->file.c_str(), axes.c_str(), file.axes.c_str(), file.axes.c_str())});
  };
  look_at(file.body);
  for (const Structure& s : file.structures) look_at(s);
  return found;
}

}  // namespace artus
