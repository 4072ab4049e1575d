// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cmath>
#include <deque>
#include <vector>

#include "artus/core/geometry.h"
#include "tests/haptics/needle/document_wall.h"

namespace artus::test {

// The needle as a reader would program it from docs/needle-steps.md, "The needle, step by step",
// for flat layers below z = 0, without a look at the engine's. Friction and bone are left out.

struct DocumentTissue {
  double begins, f_r, f_a, k_t, puncture, clamping;
};

struct DocumentForce {
  double axial = 0;              // N along the line: membrane, tear and wall
  Vec3 clamping = Vec3::Zero();  // N
};

// Steps 1 to 5 of the line.
class DocumentLine {
 public:
  Vec3 p0 = Vec3::Zero(), u = Vec3::UnitZ();
  double g = 0, q = 1;

  void begin(const Vec3& p, const Vec3& n, double x) {
    u = u0 = n;
    p0 = p - x * n;
    deepest = x;
    near_skin = std::min(x, 3e-3);
    last_p = p;
    last_n = n;
  }
  double x(const Vec3& p) const { return (p - p0).dot(u); }

  void follow(const Vec3& p, const Vec3& n) {
    g = 0;
    q = 1;
    const int parts = static_cast<int>(std::clamp(std::ceil((p - last_p).norm() / 4e-6), 1., 16.));
    for (int i = 1; i <= parts; ++i) {
      const double share = static_cast<double>(i) / parts;
      part(last_p + share * (p - last_p), (last_n + share * (n - last_n)).normalized());
    }
    last_p = p;
    last_n = n;
  }

 private:
  static double angle(const Vec3& a, const Vec3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
  }
  // `b`, but at most `most` rad from `a`.
  static Vec3 within(const Vec3& a, const Vec3& b, double most) {
    const double between = angle(a, b);
    if (between <= most) return b;
    return (std::sin(between - most) * a + std::sin(most) * b).normalized();
  }
  void place(const Vec3& through, const Vec3& n, double share) {
    u = within(n, u, share * angle(n, u));
    u0 = within(n, u0, share * angle(n, u0));
    p0 = through - through.z() / u.z() * u;  // the skin is z = 0
  }
  void part(const Vec3& p, const Vec3& n) {
    const double before = x(p);
    deepest = std::max(deepest, before);
    near_skin = std::min(3e-3, std::max(near_skin, before - 1e-3));
    if (before > 0 && before < near_skin) {  // let go
      const double share = before / near_skin;
      place(p + share * (p0 + before * u - p), n, share);
      deepest = x(p) + share * (deepest - before);
      near_skin = before;
      q *= share;
    }
    drag(p);
    slide(p, n);
    g += x(p) - before;
  }
  void drag(const Vec3& p) {
    const double before = x(p);
    const double back = std::min(deepest - before, 5e-3);
    if (back <= 0 || before <= 0) return;
    const double band = std::max(0.15e-3, before * M_PI / 180) * std::pow(5e-3 / back, 4) *
                        std::pow(std::max(1.0, 3e-3 / before), 4);
    const double r = (p - p0).norm();
    if ((p - p0 - before * u).norm() <= band) return;
    Vec3 to = within((p - p0) / r, u, std::asin(band / r));
    to = within(u0, to, std::max(std::atan2(0.035 - r, 0.035 + r), angle(u, u0)));
    const double distance = r * angle(u, to);
    if (distance <= 0) return;
    u = to;
    const double withdrawn = deepest - before;
    const double left = std::exp(-distance / 0.5e-3);
    deepest = x(p) + std::min(withdrawn, 6e-3) + std::max(0.0, withdrawn - 6e-3) * left;
    q *= left;
  }
  void slide(const Vec3& p, const Vec3& n) {
    const double before = x(p);
    const double in = std::max(0.0, before);
    const Vec3 foot = p0 + before * u;
    const double off = (foot - p).norm();
    const double turned = angle(n, u);
    const double most = in / 3e-3 * M_PI / 2;
    if (off <= in && turned <= most) return;
    const double slid = std::max(0.0, off - in);
    const double too_far = std::max(0.0, turned - most);
    place(slid > 0 ? Vec3(p + in / off * (foot - p)) : foot, n,
          turned > most ? most / turned : 1.0);
    deepest += x(p) - before;
    q *= std::exp(-(slid + too_far * in) / 0.5e-3);
  }

  Vec3 u0 = Vec3::UnitZ(), last_p = Vec3::Zero(), last_n = Vec3::UnitZ();
  double deepest = 0, near_skin = 0;
};

class DocumentNeedle {
 public:
  DocumentNeedle(std::vector<DocumentTissue> layers, double period)
      : tissues(std::move(layers)), dt(period) {}

  DocumentForce step(const Vec3& p, const Vec3& n) {
    const bool punctured = !inserted && puncture(p, n);
    if (!inserted) return {-dimple_force, Vec3::Zero()};
    if (!punctured) line.follow(p, n);
    const double x = line.x(p);
    if (line.q < 1 && open > x - line.g) open = x + line.q * (open - x + line.g);
    if (punctured) open = x;
    DocumentTick t{dt, x, stillness(x, line.g), {}, 1e9, 0, 1};
    t.gain = line.g;
    t.kept = line.q;
    double held = 0;
    DocumentForce out;
    t.layer = layer_at(p, x, held);
    if (punctured) wall.begin(std::max(0.0, gave_way - skin().puncture / skin().k_t), x);
    const double cut = wall.step(t);
    if (punctured) torn += skin().puncture + cut;
    const double tearing = torn * std::clamp((x - torn_at) / torn_dimple, 0.0, 1.0);
    torn *= std::exp(-dt / 3e-3);
    out.axial = cut - held - tearing;
    const Vec3 off = p - line.p0 - x * line.u;
    out.clamping = -clamping * off - 0.5 * growth * off.squaredNorm() * line.u;
    return out;
  }

 private:
  const DocumentTissue& skin() const { return tissues.front(); }
  static double membrane(double puncture, double d) {
    const auto shape = [](double v) {
      return 48 * v + 5200 * v * v;
    };
    return d > 0 ? puncture * shape(d) / shape(0.8e-3) : 0;
  }
  // Whether the skin gives way on the way from the last tick.
  bool puncture(const Vec3& p, const Vec3& n) {
    const double d = p.z() / n.z();
    dimple_force = membrane(skin().puncture, d);
    const bool gives_way = d > 0 && dimple_force >= skin().puncture;
    if (gives_way) {
      const double d_last = std::max(0.0, last_d);
      const double f_last = membrane(skin().puncture, d_last);
      gave_way = d_last + (d - d_last) * (dimple_force > f_last
                                              ? (skin().puncture - f_last) / (dimple_force - f_last)
                                              : 0);
      const double share = (gave_way - last_d) / (d - last_d);
      line.begin(last_p + share * (p - last_p), (last_n + share * (n - last_n)).normalized(),
                 gave_way);
      inserted = true;
      torn_at = 0;
      torn_dimple = line.x(p);
    }
    last_d = d;
    last_p = p;
    last_n = n;
    return gives_way;
  }
  double stillness(double x, double by) {
    for (double& old : past) old += by;
    past.push_back(x);
    const auto window = static_cast<std::size_t>(std::lround(0.11 / dt));
    if (past.size() <= window) return 0;
    while (past.size() > window + 1) past.pop_front();
    const auto [low, high] = std::minmax_element(past.begin(), past.end());
    return std::clamp((0.31e-3 - (*high - *low)) / 0.155e-3, 0.0, 1.0);
  }
  DocumentLayer layer_at(const Vec3& tip, double x, double& held) {
    DocumentLayer felt{skin().f_r, skin().f_a, skin().k_t};
    bool holds = false;
    int now_in = -1;
    clamping = 0;
    for (std::size_t i = 0; i < tissues.size(); ++i) {
      const DocumentTissue& tissue = tissues[i];
      const auto along = [&](double z) {
        return x - (tip.z() - z) / line.u.z();
      };
      const double e = std::max(0.0, along(tissue.begins));
      if (e > x) break;
      const double to = i + 1 < tissues.size() ? std::min(x, along(tissues[i + 1].begins)) : x;
      clamping += tissue.clamping * (to - e) / 0.035;
      const double whole = std::clamp(1 - (open - 0.1e-3 - e) / 0.5e-3, 0.0, 1.0);
      const double strength = i == 0 ? 0 : whole * tissue.puncture;
      if (!holds && strength > 0) {
        const double pushed = membrane(tissue.puncture, x - e);
        if (pushed < strength) {
          holds = true;
          held = pushed;
          if (whole == 1) open = std::min(open, e);
        } else if (static_cast<int>(i) > in) {
          torn += strength;
          torn_at = e;
          torn_dimple = x - e;
          open = std::max(open, e + 0.6e-3);
        }
      }
      if (holds) continue;
      now_in = static_cast<int>(i);
      growth = tissue.clamping / 0.035;
      const double share = i == 0 ? 1 : std::min(1.0, (x - e) / 0.2e-3);
      felt.f_r += share * (tissue.f_r - felt.f_r);
      felt.f_a += share * (tissue.f_a - felt.f_a);
      felt.k_t += share * (tissue.k_t - felt.k_t);
    }
    in = now_in;
    if (!holds) open = std::max(open, x);
    return felt;
  }

  std::vector<DocumentTissue> tissues;
  double dt;
  DocumentLine line;
  DocumentWall wall;
  bool inserted = false;
  int in = -1;  // the layer that the tip was in a tick ago
  double last_d = -1, gave_way = 0, dimple_force = 0;
  Vec3 last_p = Vec3::Zero(), last_n = Vec3::UnitZ();
  double torn = 0, torn_at = 0, torn_dimple = 1, open = 0, clamping = 0, growth = 0;
  std::deque<double> past;
};

}  // namespace artus::test
