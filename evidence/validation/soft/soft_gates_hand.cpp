// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "artus/detail/evidence/validation/soft/needled_block.h"
#include "artus/detail/evidence/validation/soft/probe_hands.h"
#include "artus/detail/evidence/validation/soft/soft_gates.h"
#include "artus/detail/haptics/needle/needle_tick_step.h"
#include "artus/detail/haptics/probe/curve_fit.h"
#include "artus/detail/haptics/probe/skin_contact.h"
#include "artus/detail/soft/solver/soft_block.h"
#include "artus/detail/soft/solver/soft_solver.h"

namespace artus {
namespace {

constexpr double kHandTick = 1e-3;      // s
constexpr double kHandSamples = 1000;   // 1/s at which forces of several rates are compared
constexpr double kHandPuncture = 1.5;   // N, of skin in the tissue library
constexpr double kHandCut = 1;          // N, that cuts skin there
constexpr double kHandWall = 1500;      // N/m, K_t of skin there
constexpr double kFarthest = 60e-3;     // m in which the skin must give way
constexpr double kRadius21 = 0.409e-3;  // m, of a 21 G needle
constexpr double kRadius25 = 0.257e-3;  // m, of a 25 G needle

/// Tissue of one kind below z = 0.
struct OneTissue {
  QueryCount find_intervals(const Segment& segment, std::span<TissueInterval> out) const noexcept {
    const double length = (segment.end - segment.start).norm();
    const double skin = std::clamp(-segment.start.z(), 0.0, length);
    QueryCount count;
    if (skin > 0) out[count.size++] = {0, skin, kOutside, Vec3::Zero(), kNoInterface};
    if (skin < length) out[count.size++] = {skin, length, kFirstRegion, -Vec3::UnitZ(), 0};
    return count;
  }
};

/// A needle on a straight way into it, tick by tick.
class Insertion {
 public:
  explicit Insertion(const NeedleCompliance& tissue, double rate = 1 / kHandTick)
      : tick_(table(), params(rate)), dt_(1 / rate) {
    if (tissue.points > 0) tick_.take({{}, tissue});
  }
  const NeedleForces& at(double z) {
    z_ = z;
    time_ += dt_;
    return tick_.step({make_pose(Vec3(0, 0, z), Vec3::UnitZ(), Vec3::UnitX()), time_}, body_)
        .forces;
  }
  void puncture() {
    while (!model().contact().inserted() && z_ < kFarthest) at(z_ + 5e-6);
  }
  void hold(double seconds) {
    for (double t = 0; t < seconds; t += dt_) at(z_);
  }
  void move(double to, double speed) {
    const double from = z_;
    const int n = std::max(1, static_cast<int>(std::lround(std::abs(to - from) / speed / dt_)));
    for (int k = 1; k <= n; ++k) at(from + (to - from) * k / n);
  }
  void take(const NeedleCompliance& tissue) { tick_.take({{}, tissue}); }
  [[nodiscard]] const NeedleModel& model() const { return tick_.model(); }
  [[nodiscard]] double z() const { return z_; }

 private:
  static LayerTable table() {
    LayerHaptics layer;
    layer.tissue.cutting_force = kHandCut;
    layer.tissue.wall_stiffness = kHandWall;
    layer.tissue.puncture_force = kHandPuncture;
    layer.tissue.friction = 1;
    std::vector<LayerHaptics> regions(kFirstRegion + 1);
    regions.back() = layer;
    return LayerTable(std::move(regions));
  }
  static NeedleRendererParams params(double rate) {
    NeedleRendererParams params;
    params.device = find_device("ideal").value();
    params.rate_hz = rate;
    return params;
  }
  OneTissue body_;
  NeedleTickStep tick_;
  double dt_;
  double z_ = -2e-3;
  double time_ = 0;
};

/// mm that the skin is pushed in when it gives way, and how far the tip then comes into the
/// material with a still hand.
struct Tent {
  double skin = 0;    // m, from touching to giving way
  double height = 0;  // m of it by the tissue below, the rest is the membrane's own
  double jump = 0;
  double let_go = 0;
  double fall_time = 0;  // s, to a tenth of what is let go
  double snap_time = 0;  // s, to a tenth of the way to what the cut still holds
};

Tent tent_of(const NeedleCompliance& tissue) {
  Insertion needle(tissue);
  needle.puncture();
  Tent tent;
  tent.skin = needle.z();
  tent.height = needle.model().coupling().tip_displacement();
  const double depth = needle.model().contact().tick().depth;
  std::vector<double> fall;
  for (int k = 0; k < 1000; ++k) {
    needle.at(needle.z());
    fall.push_back(needle.model().coupling().tip_displacement());
  }
  tent.let_go = tent.height - fall.back();
  tent.jump = needle.model().contact().tick().depth - depth;
  const auto time_to = [&](double level) {
    const auto fallen = std::find_if(fall.begin(), fall.end(), [&](double u) {
      return u - level < 0.1 * (tent.height - level);
    });
    return static_cast<double>(fallen - fall.begin() + 1) * kHandTick;
  };
  tent.fall_time = time_to(fall.back());
  tent.snap_time = time_to(kHandCut * needle.model().coupling().tip_compliance(depth, kHandWall));
  return tent;
}

/// J that the hand got from a trembling way in and out while the compliance changes by a tenth with
/// every packet, above what is metered.
double energy_given(const NeedleCompliance& tissue, double frequency, double rate) {
  NeedleCompliance softer = tissue;
  for (auto& column : softer.by_load)
    for (double& c : column) c *= 1.1;
  Insertion needle(tissue, rate);
  double work = 0;  // by the hand
  const double seconds = std::max(4.0, 2 / frequency);
  const int n = static_cast<int>(seconds * rate);
  const int packet = static_cast<int>(rate / 30);
  for (int k = 0; k < n; ++k) {
    const double t = k / rate;
    const double z = -2e-3 + 20e-3 * std::pow(std::sin(std::numbers::pi * t / seconds), 2) +
                     2e-4 * std::sin(2 * std::numbers::pi * frequency * t);
    if (k % packet == 0) needle.take((k / packet) % 2 == 0 ? tissue : softer);
    const double before = needle.z();
    const double force = needle.model().forces().total.force.z();
    needle.at(z);
    if (k > 0) work -= force * (z - before);
  }
  return -work - needle.model().coupling().given();
}

/// The probe's force by packets of a contact that hardens, against that contact with the same
/// arms, integrated by itself.
struct PacketError {
  double rms = 0;   // of the force's own RMS
  double step = 0;  // of the force, largest from tick to tick beyond the contact's own
};

/// A contact with two arms that forget, pressed along a known course.
class LaggingContact {
 public:
  static double law(double d) { return d > 0 ? 6e3 * std::pow(d, 1.5) : 0; }
  static double stiffness(double d) { return 9e3 * std::sqrt(std::max(0.0, d)); }
  double step(double d, double dt) {
    const SkinContactParams arms;
    const double force =
        (1 + arms.slow + arms.fast) * law(d) - arms.slow * slow_ - arms.fast * fast_;
    slow_ += -std::expm1(-dt / arms.slow_time) * (law(d) - slow_);
    fast_ += -std::expm1(-dt / arms.fast_time) * (law(d) - fast_);
    return force;
  }

 private:
  double slow_ = 0;
  double fast_ = 0;
};

/// What the contact's tissue would say of a face at `d`, by its tangent there.
ProbePacket packet_at(double d, std::uint64_t number, std::uint64_t tick) {
  ProbePacket packet;
  packet.number = number;
  packet.tick = tick;
  packet.X_JF = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  packet.spacing_x = packet.spacing_y = 5e-3;
  packet.length = 40e-3;
  packet.width = 6e-3;
  PressAtRest press;
  press.X_JP.translation().z() = d;
  press.force.z() = -LaggingContact::law(d);
  press.stiffness = LaggingContact::stiffness(d);
  packet.curve = fit_curve(packet, press, {});
  return packet;
}

PacketError packet_error(double packet_rate, double lost_from, double lost_for) {
  const auto depth = [](double t) {
    return 4e-3 + 2.5e-3 * std::sin(2 * std::numbers::pi * 0.5 * t);
  };
  SkinContactParams params;
  params.friction = 0;
  SkinContact felt(params);
  LaggingContact truth;
  PacketError error;
  double sum = 0;
  double own = 0;
  double last = 0;
  double last_truth = 0;
  int due = 0;
  for (int k = 0; k < 6000; ++k) {
    const double t = k * kHandTick;
    const double d = depth(t);
    const bool lost = t > lost_from && t < lost_from + lost_for;
    if (t * packet_rate >= due) {
      ++due;
      if (!lost)
        felt.take(packet_at(d, static_cast<std::uint64_t>(due), static_cast<std::uint64_t>(k)));
    }
    Pose X_JP = Pose::Identity();
    X_JP.translation().z() = d;
    const double force = -felt.step(X_JP, static_cast<std::uint64_t>(k)).force.z();
    const double wanted = truth.step(d, kHandTick);
    if (k > 500) {
      sum += std::pow(force - wanted, 2);
      own += std::pow(wanted, 2);
      const double change = std::abs(force - last) - std::abs(wanted - last_truth);
      error.step = std::max(error.step, change / wanted);
    }
    last = force;
    last_truth = wanted;
  }
  error.rms = std::sqrt(sum / own);
  return error;
}

/// N per m of a shaft that all points hold: by forces that move them alike.
double shaft_stiffness(const NeedleCompliance& c) {
  const auto n = static_cast<Eigen::Index>(c.points);
  Eigen::MatrixXd C(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      C(i, j) = c.by_load[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  return C.ldlt().solve(Eigen::VectorXd::Ones(n)).sum();
}

/// Force on the hand, N, kHandSamples times a second, of one way in, rest and out with tremor.
std::vector<double> stroke(const NeedleCompliance& tissue, double rate) {
  Insertion needle(tissue, rate);
  std::vector<double> force;
  const int every = static_cast<int>(std::lround(rate / kHandSamples));
  const int n = static_cast<int>(std::lround(6 * rate));
  for (int k = 1; k <= n; ++k) {
    const double t = k / rate;
    const double distance = t < 2 ? t / 2 : t < 4 ? 1 : (6 - t) / 2;
    const double z = -2e-3 + 24e-3 * distance + 1e-4 * std::sin(2 * std::numbers::pi * 9 * t);
    const double now = needle.at(z).total.force.z();
    if (k % every == 0) force.push_back(now);
  }
  return force;
}

}  // namespace

Gate gate_shaft() {
  Gate gate;
  gate.title = "Compliance of a rigid shaft in one tissue by the cubes' size, on and between nodes";
  SoftBlock block;
  block.half_x = block.half_y = 24e-3;
  block.layers = {{36e-3, linear_material(3e3, 0.47)}};
  std::vector<double> found;
  for (const double cube : {2e-3, 3e-3, 4e-3, 6e-3}) {
    SoftSolver solver(make_block_model(block, cube), {});
    solver.refresh();
    NeedleLine track = NeedledBlock::track(kRadius21);
    track.length = 24e-3;
    found.push_back(1 / shaft_stiffness(compute_needle_compliance(solver.factored(), track)));
    track.entry = Vec3(0.5 * cube, 0.5 * cube, 0);
    found.push_back(1 / shaft_stiffness(compute_needle_compliance(solver.factored(), track)));
  }
  const auto [least, most] = std::minmax_element(found.begin(), found.end());
  gate.claims.push_back(claim_near({ClaimKind::independent, "cubes' radius by [Peaceman1978]"},
                                   "N3: most compliant against least, cubes of 2, 3, 4 and 6 mm",
                                   *most * 1e3, *least * 1e3, 0.1, "mm/N"));
  return gate;
}

Gate gate_needle_rates() {
  Gate gate;
  gate.title =
      "In, rest and out with a tremor of 9 Hz in the layered block, tissue giving way: 1, 2, 5 kHz "
      "against 10";
  const NeedleCompliance tissue = NeedledBlock().compliance(kRadius21);
  const std::vector<double> truth = stroke(tissue, 10e3);
  for (const double rate : {1e3, 2e3, 5e3}) {
    const std::vector<double> force = stroke(tissue, rate);
    double off = 0;
    double own = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      off += std::pow(force[i] - truth[i], 2);
      own += std::pow(truth[i], 2);
    }
    gate.claims.push_back(claim_at_most(
        ClaimKind::independent,
        "R1: " + std::to_string(static_cast<int>(rate / 1000)) + " kHz, RMS of the difference",
        std::sqrt(off / own), 0.02, "of the force"));
  }
  return gate;
}

Gate gate_tent() {
  Gate gate;
  gate.title = "Skin before and after the needle goes through: layered block, 1.5 N to give way";
  const NeedledBlock body;
  const Tent thick = tent_of(body.compliance(kRadius21));
  const Tent thin = tent_of(body.compliance(kRadius25));
  const ClaimBasis bound{ClaimKind::fitted, "2 to 5 mm is recalled, no table was found: assumed"};
  gate.claims.push_back(
      claim_within(bound, "H3: tent under a 21 G needle", thick.skin * 1e3, 3.5, 1.5, "mm"));
  gate.claims.push_back(
      claim_within(bound, "H3: tent under a 25 G needle", thin.skin * 1e3, 3.5, 1.5, "mm"));
  gate.claims.push_back(claim_near(ClaimKind::independent,
                                   "H3: tip's way into the material with a still hand",
                                   thick.jump * 1e3, thick.let_go * 1e3, 0.1, "mm"));
  const ClaimBasis time{ClaimKind::fitted, "the relaxation time was chosen for it"};
  gate.claims.push_back(claim_within(
      time, "H4: time of nine tenths of the way from the tent to what the cut still holds",
      thick.snap_time, 0.085, 0.065, "s"));
  gate.claims.push_back(claim_within(
      time, "H4: time in which the whole tent falls to a tenth, the cut's force coming to rest",
      thick.fall_time, 0.085, 0.065, "s"));
  return gate;
}

Gate gate_drag() {
  Gate gate;
  gate.title =
      "Needle 15 mm beyond the skin's tent and out again: tissue dragged, action and reaction, "
      "energy";
  NeedledBlock body;
  const NeedleCompliance tissue = body.compliance(kRadius21);
  Insertion needle(tissue);
  needle.puncture();
  needle.move(needle.z() + 15e-3, 10e-3);
  needle.hold(0.5);
  needle.move(needle.z() - 5e-3, 10e-3);
  const NeedleLoad load = needle.model().coupling().load();
  double sum = 0;
  for (std::size_t i = 0; i < tissue.points; ++i) sum += load.shaft[i];
  gate.claims.push_back(claim_at_most(
      ClaimKind::independent, "H6: shaft's force on the hand and sum of those on the tissue",
      std::abs(needle.model().forces().friction + sum), 1e-9, "N"));
  gate.claims.push_back(claim_at_most({ClaimKind::input, "friction holds while the needle backs"},
                                      "H5: the shaft pulls tissue out while it is drawn back", sum,
                                      -0.05, "N"));
  body.solver->set_loads(
      loads_of(load, NeedledBlock::track(kRadius21), needle.model().coupling().spacing()));
  gate.claims.push_back(claim_at_rest("H6: the block under the needle's load",
                                      body.solver->settle(std::nullopt, 1e-9, 60)));
  const double given = sum + load.tip;
  gate.claims.push_back(claim_near(ClaimKind::independent,
                                   "H6: what holds the body against the needle's load",
                                   -body.solver->reaction().z(), given, 0.01, "N"));
  needle.move(-5e-3, 10e-3);
  needle.hold(5);
  gate.claims.push_back(
      claim_at_most(ClaimKind::independent, "H5: dragged 5 s after the needle left",
                    std::abs(needle.model().coupling().tip_displacement()) * 1e3, 0.1, "mm"));
  double most = -1;
  for (const double rate : {1000.0, 2000.0, 5000.0})
    for (const double frequency : {0.1, 1.0, 5.0, 20.0})
      most = std::max(most, energy_given(tissue, frequency, rate));
  gate.claims.push_back(claim_at_most(
      ClaimKind::independent, "H7: energy to the hand on closed ways beyond what is metered, most",
      most, 1e-6, "J"));
  return gate;
}

Gate gate_packets() {
  Gate gate;
  gate.title = "Probe's force between the tissue's packets, a contact that hardens moved at 0.5 Hz";
  for (const double rate : {30.0, 60.0, 120.0}) {
    const std::string at = "H8: " + std::to_string(static_cast<int>(rate)) + " packets a second, ";
    const PacketError error = packet_error(rate, 1e9, 0);
    gate.claims.push_back(
        claim_at_most(ClaimKind::independent, at + "RMS error", error.rms, 0.02, "of the force"));
    gate.claims.push_back(claim_at_most({ClaimKind::independent, "half of a JND of 7 %, assumed"},
                                        at + "largest step", error.step, 0.035, "of the force"));
  }
  const PacketError lost = packet_error(30, 2.2, 0.2);
  gate.claims.push_back(claim_at_most(ClaimKind::independent,
                                      "H8: packets lost for 0.2 s, RMS error", lost.rms, 0.02,
                                      "of the force"));
  gate.claims.push_back(claim_at_most({ClaimKind::independent, "half of a JND of 7 %, assumed"},
                                      "H8: packets lost for 0.2 s, largest step", lost.step, 0.035,
                                      "of the force"));
  return gate;
}

Gate gate_probe_hands() {
  constexpr std::size_t kEvery = 23;  // cases of 9,600: some seconds
  const std::vector<ProbeHandCase> cases = probe_hand_cases(kEvery);
  Gate gate;
  gate.title =
      std::to_string(cases.size()) +
      " hands of 0.05 to 1 kg, springs of 0 to 2000 N/m, that press, tap, slide, lift and twist a "
      "probe on tissue that answers 5 to 60 times a second, up to 0.18 s late, or not for 0.5 s";
  ProbeHandResult worst;
  for (const ProbeHandCase& c : cases) {
    const ProbeHandResult r = play_probe_hand(c);
    worst.given = std::max(worst.given, r.given);
    worst.off_skin = std::max(worst.off_skin, r.off_skin);
    worst.swing = std::max(worst.swing, r.swing);
    worst.first_touch = std::max(worst.first_touch, r.first_touch);
    worst.first_depth = std::max(worst.first_depth, r.first_depth);
    worst.step = std::max(worst.step, r.step);
    if (c.hand.damping >= 3) worst.settled = std::max(worst.settled, r.settled);
  }
  const auto claim = [&gate](const std::string& what, double value, double bound,
                             const std::string& unit) {
    gate.claims.push_back(claim_at_most(ClaimKind::independent, "C1: " + what, value, bound, unit));
  };
  claim("energy to the hand at any time", worst.given * 1e3, 1e-3, "mJ");
  claim("force more than 0.2 mm off the skin", worst.off_skin, 0, "N");
  claim("swing of a pressed probe that does not fade", worst.swing * 1e3, 0.5, "mm");
  claim("time from the skin to the first force, landing at 0.1 m/s or more",
        worst.first_touch * 1e3, 5, "ms");
  claim("depth of the face at the first force", worst.first_depth * 1e3, 1, "mm");
  claim("change of the force from tick to tick beyond motion's", worst.step, 0.3, "N");
  claim("force at rest against the tissue's", worst.settled, 0.05, "of the force");
  return gate;
}

}  // namespace artus
