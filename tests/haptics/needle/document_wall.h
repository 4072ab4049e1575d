// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cmath>

namespace artus::test {

// The wall as a reader would program it from docs/needle-steps.md, "The wall, step by step",
// without a look at the engine's: the numbers of the steps are the document's.

struct DocumentLayer {
  double f_r, f_a, k_t;
};

struct DocumentTick {
  double dt, x, still;
  DocumentLayer layer;
  double bone_depth, bone_f, bone_k;
  double gain = 0;
  double kept = 1;  // 1: the line did not move
};

class DocumentWall {
 public:
  void begin(double w0, double x0) {
    w = c = w0;
    before = x0;
  }

  double step(const DocumentTick& t) {
    if (t.kept < 1) {  // step 1
      w += t.gain;
      c += t.gain;
      before += t.gain;
      if (c > before) c = before + t.kept * (c - before);
    }
    const double moved = t.x - before;  // step 2
    energy -= last * moved;
    const double b = std::max(0.0, t.x - t.bone_depth);  // step 3
    const double y = t.x - b;
    if (k > 0 && k != t.layer.k_t) {  // step 4
      w = y + (w - y) * k / t.layer.k_t;
      if (w < y) c = std::min(c, w);
    }
    k = t.layer.k_t;
    const double rest = t.still * t.dt;  // step 5
    if (rest > 0) w += (y - w) * (left > rest ? rest / left : 1.0);
    left = std::min(kSettling, std::max(0.0, left - rest + (t.dt - rest) * kSettling / kMoving));
    limit_r = fall(limit_r, t.layer.f_r, t.dt);  // step 6
    limit_a = fall(limit_a, t.layer.f_a, t.dt);
    const double low = y <= c ? y : std::max(c, y - limit_r / k);  // step 7
    w = std::min(std::max(w, low), y + std::min(limit_a / k, std::max(0.0, y)));
    c = std::max(c, std::min(w, y));
    double f = k * (w - y);
    if (b > 0) f = std::max(f - t.bone_k * b, std::min(f, -t.bone_f));  // step 8
    if (t.x < 0) f = 0;
    if (f * moved > 0) {  // step 9
      const double most = std::max(0.0, energy) / (2 * std::abs(moved));
      f = std::min(std::max(f, -most), most);
    }
    before = t.x;
    last = f;
    return f;
  }

 private:
  static constexpr double kSettling = 0.2;   // s
  static constexpr double kMoving = 0.075;   // s
  static constexpr double kFalling = 0.003;  // s
  static double fall(double limit, double to, double dt) {
    return limit > to ? to + (limit - to) * std::exp(-dt / kFalling) : to;
  }
  double w = 0, c = 0, k = 0, left = kSettling, limit_r = 0, limit_a = 0;
  double before = 0, last = 0, energy = 0;
};

}  // namespace artus::test
