// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/display/frame_measure.h"
#include "artus/detail/echo/display/strain_image.h"
#include "artus/detail/evidence/runs/echo_phantom.h"
#include "artus/detail/evidence/validation/soft/soft_gates.h"
#include "artus/detail/raycast/moving_scene.h"
#include "artus/detail/soft/solver/deformed_body.h"
#include "artus/detail/soft/solver/soft_block.h"
#include "artus/detail/soft/solver/soft_solver.h"
#include "artus/echo/labels.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

constexpr double kHalf = 48e-3;         // m, of a block's edges
constexpr double kThick = 48e-3;        // m
constexpr double kBlockYoung = 10e3;    // Pa
constexpr double kSphere = 5e-3;        // m, radius of the stiff ball
constexpr double kRatio = 4;            // of its modulus to the block's
constexpr double kCentreDepth = 20e-3;  // m, of the ball

Vec3 centre() {
  return {0, 0, kCentreDepth};
}

using Field = std::function<Vec3(const Vec3&)>;

/// A block of one tissue that scatters everywhere alike, and a cage to move it by.
struct MovedPhantom {
  std::shared_ptr<const CompiledJoint> joint;
  std::shared_ptr<const BodyMap> map;

  explicit MovedPhantom(std::shared_ptr<const SoftModel> model) {
    const std::array<FlatLayer, 1> layer{{{"tissue_mimic", kThick}}};
    CompiledJoint block =
        subdivided(make_layered_block(make_phantom_tissues(), layer, 2 * kHalf, 2 * kHalf), 5);
    acoustic_of(block, "tissue_mimic").attenuation = 0;
    joint = std::make_shared<const CompiledJoint>(std::move(block));
    map = make_body_map(*joint, Pose::Identity(), std::move(model));
  }
  [[nodiscard]] std::shared_ptr<const Scene> scene(std::span<const Vec3> nodes) const {
    return make_scene(std::make_shared<const DeformedBody>(joint, map, nodes, ContactForce{}));
  }
  [[nodiscard]] std::shared_ptr<const Scene> scene(const Field& u) const {
    std::vector<Vec3> nodes;
    for (const Vec3& p : map->model->cage().nodes()) nodes.push_back(u(p));
    return scene(nodes);
  }
};

std::shared_ptr<const SoftModel> plain_model() {
  SoftBlock block;
  block.half_x = block.half_y = kHalf;
  block.layers = {{kThick, linear_material(kBlockYoung, 0.47)}};
  return make_block_model(block, 6e-3);
}

/// The block with a stiffer ball in it, pressed against the probe by a plate that slides: held
/// along z above and below, and in its planes of symmetry. `strain` of its height.
std::vector<Vec3> press_ball(const std::shared_ptr<const SoftModel>& model, double strain,
                             Gate& gate) {
  SoftSolver solver(model, {});
  std::vector<Vec3> prescribed(model->cage().nodes().size(), Vec3::Zero());
  for (std::size_t n = 0; n < prescribed.size(); ++n)
    if (model->cage().nodes()[n].z() > kThick - 1e-9) prescribed[n].z() = -strain * kThick;
  solver.set_prescribed(std::move(prescribed));
  gate.claims.push_back(
      claim_at_rest("I3: the pressed ball", solver.settle(std::nullopt, 1e-7, 60)));
  return {solver.displacements().begin(), solver.displacements().end()};
}

std::shared_ptr<const SoftModel> ball_model() {
  SoftModelParams params;
  params.cage.low = Vec3(-kHalf, -kHalf, 0);
  params.cage.high = Vec3(kHalf, kHalf, kThick);
  params.cage.cell = 6e-3;
  params.cage.zones = {{centre() - Vec3::Constant(7e-3), centre() + Vec3::Constant(7e-3), 1.5e-3},
                       {centre() - Vec3::Constant(12e-3), centre() + Vec3::Constant(12e-3), 3e-3}};
  params.held = [](const Vec3& p) {
    HeldNode node;
    node.held[0] = std::abs(p.x()) < 1e-9;
    node.held[1] = std::abs(p.y()) < 1e-9;
    node.held[2] = p.z() < 1e-9 || p.z() > kThick - 1e-9;
    return node;
  };
  MaterialField field;
  field.materials = {linear_material(kBlockYoung, 0.49),
                     linear_material(kRatio * kBlockYoung, 0.49)};
  field.at = [](const Vec3& p) {
    const bool inside =
        std::abs(p.x()) <= kHalf && std::abs(p.y()) <= kHalf && p.z() >= 0 && p.z() <= kThick;
    if (!inside) return kNoMaterial;
    return (p - centre()).norm() < kSphere ? 1 : 0;
  };
  return std::make_shared<const SoftModel>(field, params);
}

ImageSettings settings_of_gate() {
  ImageSettings settings = bare_settings();
  settings.n_threads = 0;
  return settings;
}

/// Before and after: the probe stays, the tissue moves below it.
StrainImage strain_of(const std::shared_ptr<const Scene>& before,
                      const std::shared_ptr<const Scene>& after) {
  Pose X_JP = Pose::Identity();
  X_JP.translation().z() = 1e-3;  // inside, so that a skin that moves away opens no gap
  const ImageSettings settings = settings_of_gate();
  return compute_strain(render_bmode(before, X_JP, std::nullopt, {}, settings),
                        render_bmode(after, X_JP, std::nullopt, {}, settings));
}

/// Mean of the strain that is known within `radius` of (x, z) in the picture.
double mean_strain(const StrainImage& image, double x, double z, double radius) {
  const Transducer probe;
  double sum = 0;
  int n = 0;
  for (int l = 0; l < image.n_lines; ++l) {
    for (int k = 0; k < image.n_depths; ++k) {
      const double dx = (static_cast<double>(l) / (image.n_lines - 1) - 0.5) * probe.width - x;
      const double dz = image.first_depth + k * image.step + 1e-3 - z;
      const float e = image.strain[static_cast<std::size_t>(l * image.n_depths + k)];
      if (std::hypot(dx, dz) > radius || std::isnan(e)) continue;
      sum += e;
      ++n;
    }
  }
  return n > 0 ? sum / n : 0;
}

constexpr double kBorder = 9e-3;  // m, of the layers that gate_border presses

/// What of a border is drawn: its echo without speckle, or the speckle behind it without echo.
enum class BorderShown { echo, speckle };

struct BorderProfile {
  double at = 0;     // m below where the tissue's border is, mean over lines and planes
  double moved = 0;  // m of the border on the middle line
};

std::shared_ptr<const CompiledJoint> border_joint(BorderShown shown) {
  const std::array<FlatLayer, 2> layers{{{"gel", kBorder}, {"tissue_mimic", kThick - kBorder}}};
  CompiledJoint joint =
      subdivided(make_layered_block(make_phantom_tissues(), layers, 2 * kHalf, 2 * kHalf), 5);
  Acoustic& below = acoustic_of(joint, "tissue_mimic");
  Acoustic& above = acoustic_of(joint, "gel");
  below.attenuation = above.attenuation = 0;
  above.backscatter = 0;
  above.speed_of_sound = below.speed_of_sound;
  above.density = below.density;
  // The wall of a liquid would reflect though both sound alike.
  above.kind = below.kind;
  if (shown == BorderShown::echo) {
    below.backscatter = 0;
    above.density *= 0.9;
  }
  return std::make_shared<const CompiledJoint>(std::move(joint));
}

/// Depth below the probe's face, m, at which the border lies on a line at x in the plane at y.
double border_depth(const DeformedBody& body, double x, double y, double face) {
  double low = face;
  double high = kBorder + 5e-3;
  for (int k = 0; k < 40; ++k) {
    const double z = 0.5 * (low + high);
    (body.to_rest({x, y, z}).p_rest.z() < kBorder ? low : high) = z;
  }
  return low - face;
}

/// Power of the lines of many planes around the border, each line by its own border's place.
struct BorderPower {
  static constexpr int kAround = 48;      // samples on both sides of the border
  static constexpr int kPlanes = 4;       // on both sides of the middle one
  static constexpr double kApart = 4e-3;  // m, wider than the beam: each has speckle of its own
  std::vector<double> power = std::vector<double>(2 * kAround + 1, 0.0);
  double to_sample = 0;  // of a depth in m

  /// `speeds`: the display's speed of sound over the tissue's.
  void add_plane(const std::shared_ptr<const DeformedBody>& body, double y, double speeds) {
    Pose X_JP = Pose::Identity();
    X_JP.translation() = Vec3(0, y, body->displacement(Vec3(0, y, 0)).z() + 1e-3);
    const Frame frame = render_bmode(make_scene(body), X_JP, std::nullopt, {}, settings_of_gate());
    to_sample = speeds / frame.sample_depth;
    const Transducer probe;
    for (int l = 24; l < frame.n_lines - 24; ++l) {
      const double x = (static_cast<double>(l) / (frame.n_lines - 1) - 0.5) * probe.width;
      const double at = border_depth(*body, x, y, X_JP.translation().z()) * to_sample;
      const auto line = envelope_line(frame, l);
      for (int k = -kAround; k <= kAround; ++k) {
        const double s = at + k;
        const auto i = static_cast<std::size_t>(s);
        const double share = s - static_cast<double>(i);
        const double value = (1 - share) * line[i] + share * line[i + 1];
        power[static_cast<std::size_t>(k + kAround)] += value * value;
      }
    }
  }

  /// m below where the tissue's border is: the echo's peak, or where speckle has half its power.
  [[nodiscard]] double find(BorderShown shown) const {
    double found = 0;
    if (shown == BorderShown::echo) {
      found = static_cast<double>(std::max_element(power.begin(), power.end()) - power.begin());
    } else {
      double plateau = 0;
      for (std::size_t k = 2 * kAround - 23; k < power.size(); ++k) plateau += power[k] / 24;
      std::size_t k = 1;
      while (k + 1 < power.size() && power[k] < 0.5 * plateau) ++k;
      found = static_cast<double>(k) -
              (power[k] - 0.5 * plateau) / std::max(power[k] - power[k - 1], 1e-300);
    }
    return (found - kAround) / to_sample;
  }
};

BorderProfile border_profile(const std::shared_ptr<const SoftModel>& model,
                             std::span<const Vec3> nodes, BorderShown shown) {
  const auto joint = border_joint(shown);
  const auto body = std::make_shared<const DeformedBody>(
      joint, make_body_map(*joint, Pose::Identity(), model), nodes, ContactForce{});
  const double speeds =
      kDisplaySpeedOfSound / joint->tissue_of(kFirstRegion).acoustic.speed_of_sound;
  BorderPower power;
  for (int p = -BorderPower::kPlanes; p <= BorderPower::kPlanes; ++p)
    power.add_plane(body, p * BorderPower::kApart, speeds);
  const double face = body->displacement(Vec3::Zero()).z() + 1e-3;
  return {power.find(shown), border_depth(*body, 0, 0, face) + face - kBorder};
}

}  // namespace

Gate gate_strain_image() {
  Gate gate;
  gate.title = "block matching finds the motion that the picture was drawn with (I1)";
  const MovedPhantom phantom(plain_model());
  for (const double percent : {0.5, 1.0}) {
    const double strain = percent / 100;
    const StrainImage image =
        strain_of(phantom.scene([](const Vec3&) { return Vec3(Vec3::Zero()); }),
                  phantom.scene([&](const Vec3& p) { return Vec3(0, 0, -strain * p.z()); }));
    std::vector<double> errors;
    double correlation = 0;
    for (std::size_t i = 0; i < image.displacement.size(); ++i) {
      const auto k = static_cast<double>(i % static_cast<std::size_t>(image.n_depths));
      // a place at rest z moves to (1 - strain) z; the piece that is matched is the one before
      const double z = 1e-3 + image.first_depth + k * image.step;
      if (z > 0.85 * 40e-3) continue;
      errors.push_back((image.displacement[i] + strain * z) / (40e-3 / 1024));
      correlation += image.correlation[i];
    }
    const Moments moments = moments_of(errors);
    const std::string at = std::to_string(percent).substr(0, 3) + " % strain: ";
    gate.claims.push_back(claim_at_most(ClaimKind::independent, at + "bias of the motion",
                                        std::abs(moments.mean), 0.1, "px"));
    gate.claims.push_back(
        claim_at_most(ClaimKind::independent, at + "its deviation", moments.deviation, 0.2, "px"));
    if (percent < 0.75)
      gate.claims.push_back(claim_at_least(ClaimKind::independent, at + "correlation",
                                           correlation / static_cast<double>(errors.size()), 0.95,
                                           ""));
  }
  return gate;
}

Gate gate_carried() {
  Gate gate;
  gate.title = "one half of a block moves and gives way, the other stays (I2)";
  const MovedPhantom phantom(plain_model());
  constexpr double kMoves = 6e-3;  // m, x beyond which the whole motion is there
  const auto u = [](const Vec3& p) {
    const double share = std::clamp(p.x() / kMoves, 0.0, 1.0);
    return Vec3(0, 0, share * (0.15e-3 - 0.005 * p.z()));
  };
  const auto rest = phantom.scene([](const Vec3&) { return Vec3(Vec3::Zero()); });
  const auto moved = phantom.scene(u);
  Pose X_JP = Pose::Identity();
  X_JP.translation().z() = 1e-3;
  const ImageSettings settings = settings_of_gate();
  const Frame before = render_bmode(rest, X_JP, std::nullopt, {}, settings);
  const Frame after = render_bmode(moved, X_JP, std::nullopt, {}, settings);
  const StrainImage image = compute_strain(before, after);
  const Transducer probe;
  std::vector<double> errors;
  for (int l = 0; l < image.n_lines; ++l) {
    const double x = (static_cast<double>(l) / (image.n_lines - 1) - 0.5) * probe.width;
    if (x < 9e-3) continue;  // the beam is as wide as that
    for (int k = 0; k < image.n_depths; ++k) {
      const double z = 1e-3 + image.first_depth + k * image.step;
      if (z > 34e-3) break;
      errors.push_back(image.displacement[static_cast<std::size_t>(l * image.n_depths + k)] -
                       u({x, 0, z}).z());
    }
  }
  const Moments moments = moments_of(errors);
  constexpr double kBound = 5 + 0.1 * 40e3 / 1024;  // um and a tenth of a sample
  gate.claims.push_back(claim_at_most(ClaimKind::independent,
                                      "I2: speckle is where its tissue went, mean error",
                                      std::abs(moments.mean) * 1e6, kBound, "um"));
  gate.claims.push_back(claim_at_most(ClaimKind::independent, "I2: deviation of the error",
                                      moments.deviation * 1e6, kBound, "um"));
  bool same = true;
  for (int l = 0; l < before.n_lines; ++l) {
    const double x = (static_cast<double>(l) / (before.n_lines - 1) - 0.5) * probe.width;
    if (x > -0.5 * probe.max_aperture - 1e-3) break;
    const auto a = envelope_line(before, l);
    const auto b = envelope_line(after, l);
    same = same && std::equal(a.begin(), a.end(), b.begin());
  }
  gate.claims.push_back(claim_that(ClaimKind::independent,
                                   "I2: lines whose beams meet nothing that moved keep their bytes",
                                   same));
  return gate;
}

Gate gate_border() {
  Gate gate;
  gate.title =
      "a silent layer over a speckled one, pressed: the border's echo and the speckle's "
      "edge, each drawn alone (I4)";
  const auto model = plain_model();
  SoftSolver solver(model, {});
  std::vector<PointLoad> loads;
  // Alike across the picture's plane, so that what the beam sees beside it is no other depth.
  for (int i = -10; i <= 10; ++i)
    for (int j = -9; j <= 9; ++j)
      loads.push_back({Vec3(2e-3 * i, 5e-3 * j, 0), Vec3(0, 0, (6.0 + 0.3 * i) / 399)});
  solver.set_loads(std::move(loads));
  gate.claims.push_back(
      claim_at_rest("I4: the pressed block", solver.settle(std::nullopt, 1e-7, 60)));
  const BorderProfile echo = border_profile(model, solver.displacements(), BorderShown::echo);
  const BorderProfile edge = border_profile(model, solver.displacements(), BorderShown::speckle);
  const std::vector<Vec3> rest(model->cage().nodes().size(), Vec3::Zero());
  const double echo_rest = border_profile(model, rest, BorderShown::echo).at;
  const double edge_rest = border_profile(model, rest, BorderShown::speckle).at;
  gate.claims.push_back(claim_within(
      ClaimKind::independent, "I4: what the deformation adds to the way between them at rest",
      (edge.at - echo.at - edge_rest + echo_rest) * 1e3, 0, 0.1, "mm"));
  gate.claims.push_back(claim_within(ClaimKind::independent,
                                     "I4: speckle's edge below the border's echo",
                                     (edge.at - echo.at) * 1e3, 0, 0.1, "mm"));
  gate.claims.push_back(claim_within(ClaimKind::independent,
                                     "I4: border's echo below where the tissue has it",
                                     echo.at * 1e3, 0, 0.1, "mm"));
  gate.claims.push_back(claim_at_least({ClaimKind::input, "so much was pressed"},
                                       "I4: the border has moved", echo.moved * 1e3, 1, "mm"));
  return gate;
}

Gate gate_inclusion() {
  Gate gate;
  gate.title = "strain of a ball four times as stiff, from two pictures, against Eshelby (I3)";
  const MovedPhantom phantom(ball_model());
  const std::vector<Vec3> rest(phantom.map->model->cage().nodes().size(), Vec3::Zero());
  const StrainImage image =
      strain_of(phantom.scene(rest), phantom.scene(press_ball(phantom.map->model, 0.01, gate)));
  const double inside = mean_strain(image, 0, kCentreDepth, 0.5 * kSphere);
  const double outside = 0.5 * (mean_strain(image, 15e-3, kCentreDepth, 3e-3) +
                                mean_strain(image, -15e-3, kCentreDepth, 3e-3));
  gate.claims.push_back(claim_near(ClaimKind::independent, "strain inside over strain outside",
                                   inside / outside, 5 / (3 + 2 * kRatio), 0.1, ""));
  return gate;
}

Gate gate_thinning() {
  Gate gate;
  gate.title = "layers of a pressed block: by the picture's labels and by the tissue (I5)";
  SoftBlock block;
  block.half_x = block.half_y = kHalf;
  block.layers = {{9e-3, linear_material(3e3, 0.47)},
                  {12e-3, linear_material(8e3, 0.47)},
                  {27e-3, linear_material(100e3, 0.47)}};
  const auto model =
      make_block_model(block, 6e-3, {{Vec3(-27e-3, -12e-3, 0), Vec3(27e-3, 12e-3, 24e-3), 3e-3}});
  const std::array<FlatLayer, 3> layers{{{"fat", 9e-3}, {"muscle", 12e-3}, {"tendon", 27e-3}}};
  const auto tissues = read_bundled_tissues().value();
  const auto joint = std::make_shared<const CompiledJoint>(
      subdivided(make_layered_block(tissues, layers, 2 * kHalf, 2 * kHalf), 5));
  const auto map = make_body_map(*joint, Pose::Identity(), model);
  SoftSolver solver(model, {});
  std::vector<PointLoad> loads;
  for (int i = -10; i <= 10; ++i)
    for (int j = -2; j <= 2; ++j)
      loads.push_back({Vec3(2e-3 * i, 1.2e-3 * j, 0), Vec3(0, 0, 0.4 / 105)});
  solver.set_loads(std::move(loads));
  gate.claims.push_back(
      claim_at_rest("I5: the pressed block", solver.settle(std::nullopt, 1e-7, 60)));
  const auto body =
      std::make_shared<const DeformedBody>(joint, map, solver.displacements(), ContactForce{});
  const auto now = layer_thicknesses(block, *model, solver.displacements(), 0, 0);
  ImageSettings settings = settings_of_gate();
  settings.pixel = 0.05e-3;
  Pose X_JP = Pose::Identity();
  X_JP.translation().z() = body->displacement(Vec3::Zero()).z();
  const LabelImage labels = render_labels(*make_scene(body), X_JP, {}, settings);
  std::array<int, 2> pixels{};
  for (int y = 0; y < labels.height; ++y) {
    const auto region =
        labels.regions[static_cast<std::size_t>(y * labels.width + labels.width / 2)];
    for (std::size_t k = 0; k < 2; ++k)
      if (region == kFirstRegion + k) ++pixels[k];
  }
  const std::array<const char*, 2> names{"fat", "muscle"};
  for (std::size_t k = 0; k < 2; ++k)
    gate.claims.push_back(claim_within(
        ClaimKind::independent, std::string("I5: thickness of ") + names[k] + " in the picture",
        pixels[k] * 0.05, now[k] * 1e3, 0.1, "mm"));
  const double fat = 1 - now[0] / 9e-3;
  const double muscle = 1 - now[1] / 12e-3;
  gate.claims.push_back(claim_that({ClaimKind::input, "fat is given the lowest stiffness"},
                                   "I5: fat thins more than muscle, muscle more than tendon",
                                   fat > muscle && muscle > 1 - now[2] / 27e-3));
  return gate;
}

Gate gate_speckle_pressed() {
  Gate gate;
  gate.title = "speckle of tissue compressed by 30 % (I6)";
  const MovedPhantom phantom(plain_model());
  Pose X_JP = Pose::Identity();
  X_JP.translation().z() = 1e-3;
  const auto scene = phantom.scene(
      [](const Vec3& p) { return Vec3(0.19 * p.x(), 0.19 * p.y(), -0.3 * (p.z() - 1e-3)); });
  const Frame frame = render_bmode(scene, X_JP, std::nullopt, {}, settings_of_gate());
  std::vector<double> envelope;
  for (int l = 24; l < frame.n_lines - 24; l += 4)
    for (int i = 200; i < 700; i += 8)
      envelope.push_back(envelope_line(frame, l)[static_cast<std::size_t>(i)]);
  const Moments moments = moments_of(envelope);
  gate.claims.push_back(claim_near(ClaimKind::independent, "mean over deviation of the envelope",
                                   moments.mean / moments.deviation, 1.913, 0.05, ""));
  gate.claims.push_back(claim_at_most(ClaimKind::independent, "distance from Rayleigh",
                                      rayleigh_distance(envelope), 0.03, ""));
  return gate;
}

}  // namespace artus
