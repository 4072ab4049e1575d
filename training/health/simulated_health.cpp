// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/health/simulated_health.h"

#include <algorithm>

#include "artus/detail/anatomy/body/find_region.h"
#include "artus/detail/simulation/plain_pose.h"

namespace artus {
namespace {

constexpr double kDrawn = 1e-9;  // m^3, of which a shape is made
constexpr double kShown = 0.9;   // of what was given that is at least to be drawn while more comes

void add_site(const CompiledJoint& joint, const InjectedSite& site, GivenLiquid& liquid) {
  if (site.volume < kDrawn || site.region >= joint.regions.size()) return;
  if (liquid.volume == 0) liquid.p_J = Vec3(site.p_J[0], site.p_J[1], site.p_J[2]);
  liquid.volume += site.volume;
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

std::optional<HealthQuestion> find_health_question(const Simulation& simulation,
                                                   std::span<const InjectedSite> sites,
                                                   const Pose& X_JP) {
  if (simulation.drawn_scene() == simulation.scene()) return std::nullopt;
  HealthQuestion question;
  for (const InjectedSite& site : sites) add_site(simulation.joint(), site, question.liquid);
  const DrawnLiquid drawn = simulation.drawn_liquid();
  question.liquid.volume = std::max(drawn.given, kShown * question.liquid.volume) - drawn.left_out;
  if (!(question.liquid.volume > 0)) return std::nullopt;
  add_drawn(simulation.joint(), simulation.drawn_scene()->joint(), question.liquid);
  question.before = simulation.scene();
  question.after = simulation.drawn_scene();
  question.X_JP = X_JP;
  question.transducer = simulation.params().transducer;
  question.settings = simulation.params().image;
  return question;
}

std::optional<HealthQuestion> draw_health_question(Simulation& simulation) {
  const auto sites = simulation.syringe().sites();
  const bool any = std::any_of(sites.begin(), sites.end(),
                               [](const InjectedSite& site) { return site.volume >= kDrawn; });
  if (!any || !simulation.params().deform) return std::nullopt;
  static_cast<void>(simulation.render());
  return find_health_question(simulation, sites, to_pose(simulation.last().X_JP));
}

}  // namespace artus
