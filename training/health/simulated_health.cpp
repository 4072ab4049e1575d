// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/health/simulated_health.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/anatomy/body/find_region.h"
#include "artus/detail/simulation/plain_pose.h"

namespace artus {
namespace {

constexpr double kDrawn = 1e-9;  // m^3, of which a shape is made
constexpr double kAlike = 2e-3;  // of what was given, by which what is drawn may differ
constexpr double kLongest = 4;   // s of images that this may take; shapes follow within three

void add_site(const CompiledJoint& joint, const InjectedSite& site, GivenLiquid& liquid) {
  if (site.volume < kDrawn || site.region >= joint.regions.size()) return;
  if (liquid.volume == 0) liquid.p_J = Vec3(site.p_J[0], site.p_J[1], site.p_J[2]);
  liquid.volume += site.volume;
}

/// The picture of hands that stay as they were in `shown` until all that was given is drawn.
void draw_all(Simulation& simulation, FrameInput shown, double given) {
  const SessionParams& params = simulation.params();
  ImagedBody body;
  const auto follows = [&] {
    const FluidState& fluid = body.fluid;
    return !fluid.shape || fluid.before || !fluid.kept ||
           std::abs(fluid.liquid().given - given) > kAlike * given;
  };
  auto left = static_cast<int>(kLongest * params.image_rate);
  do {
    ++shown.number;
    body = simulation.advance(shown);
  } while (--left > 0 && follows());
  static_cast<void>(simulation.render(shown, body));
}

}  // namespace

void add_drawn(const CompiledJoint& rest, const CompiledJoint& drawn, GivenLiquid& liquid) {
  for (std::size_t r = 0; r < rest.regions.size(); ++r)
    if (drawn.regions[r].tissue != rest.regions[r].tissue)
      liquid.regions.push_back(rest.regions[r].name);
  const auto injected = find_region(drawn, "injected");
  if (!injected) return;
  liquid.regions.emplace_back("injected");
  for (const Interface& f : drawn.mesh.interfaces) {
    if ((f.front == *injected) == (f.back == *injected)) continue;
    const RegionId beside = f.front == *injected ? f.back : f.front;
    liquid.parted.push_back(drawn.regions[beside].name);
  }
  std::sort(liquid.parted.begin(), liquid.parted.end());
  liquid.parted.erase(std::unique(liquid.parted.begin(), liquid.parted.end()), liquid.parted.end());
}

std::optional<HealthQuestion> find_health_question(Simulation& simulation,
                                                   const FrameInput& shown) {
  HealthQuestion question;
  for (std::uint32_t k = 0; k < shown.n_sites; ++k)
    add_site(simulation.joint(), shown.sites[k], question.liquid);
  if (!(question.liquid.volume > 0)) return std::nullopt;
  draw_all(simulation, shown, question.liquid.volume);
  if (simulation.drawn_scene() == simulation.scene()) return std::nullopt;
  question.liquid.volume -= simulation.drawn_liquid().left_out;
  if (!(question.liquid.volume > 0)) return std::nullopt;
  add_drawn(simulation.joint(), simulation.drawn_scene()->joint(), question.liquid);
  question.before = simulation.scene();
  question.after = simulation.drawn_scene();
  question.X_JP = to_pose(shown.X_JP);
  question.transducer = simulation.params().transducer;
  question.settings = simulation.params().image;
  return question;
}

std::optional<HealthQuestion> draw_health_question(Simulation& simulation) {
  const auto sites = simulation.syringe().sites();
  const bool any = std::any_of(sites.begin(), sites.end(),
                               [](const InjectedSite& site) { return site.volume >= kDrawn; });
  if (!any || !simulation.params().deform) return std::nullopt;
  if (simulation.due() != nullptr) simulation.advance();
  return find_health_question(simulation, simulation.shown());
}

}  // namespace artus
