// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/three_injections_analysis.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kPlateauShare = 0.02;  // the published layer forces hold within this

std::vector<BoneTouch> find_touches(const std::vector<NeedleRow>& rows) {
  std::vector<BoneTouch> touches;
  for (const NeedleRow& row : rows) {
    if ((row.events & ContactEvent::kBoneTouched) != 0 &&
        (touches.empty() || touches.back().pass != row.pass)) {
      touches.push_back({row.pass, row.time, row.incoming_speed, 0, 0});
    }
    if (touches.empty() || touches.back().pass != row.pass || row.forces.hard == 0) continue;
    BoneTouch& touch = touches.back();
    if (row.time - touch.time > 0.1) continue;  // a later touch of the same pass
    touch.peak = std::max(touch.peak, std::abs(row.forces.hard));
    touch.duration = row.time - touch.time;
  }
  return touches;
}

void claim_touches(ThreeInjections& run) {
  run.claims.push_back(claim_at_least({ClaimKind::input, "lines with bone behind the target"},
                                      "injections that touch bone",
                                      static_cast<double>(run.touches.size()), 3, ""));
  if (run.touches.size() != 3) return;
  const double slow = std::max(run.touches[0].peak, run.touches[1].peak);
  run.claims.push_back(claim_at_least({ClaimKind::input, "the hand's speeds, eq. 2.3"},
                                      "tap of injection 3 over the stronger of 1 and 2",
                                      run.touches[2].peak / slow, 1, ""));
}

// A joint that has the target has it crossed; a joint without one is told by the layers' list.
void claim_target(const CompiledJoint& joint, ThreeInjections& run) {
  const auto is_target = [&](RegionId region) {
    return joint.tissue_of(region).name == run.options.target_tissue;
  };
  const bool has_target = std::any_of(joint.mesh.interfaces.begin(), joint.mesh.interfaces.end(),
                                      [&](const Interface& f) {
                                        return (f.front >= kFirstRegion && is_target(f.front)) ||
                                               (f.back >= kFirstRegion && is_target(f.back));
                                      });
  if (!has_target) return;
  std::set<int> crossed;
  for (const NeedleRow& row : run.rows)
    if (row.region >= kFirstRegion && is_target(row.region)) crossed.insert(row.pass);
  run.claims.push_back(claim_at_least({ClaimKind::input, "the plan's lines"},
                                      "injections that reach a " + run.options.target_tissue,
                                      static_cast<double>(crossed.size()), 1, ""));
}

// Every injection that was re-aimed follows a new line.
void claim_redirections(ThreeInjections& run) {
  std::set<int> aimed;
  std::set<int> turned;
  for (const NamedMoment& moment : run.moments)
    if (moment.label == "re-aimed") aimed.insert(moment.pass);
  for (const NeedleRow& row : run.rows)
    if ((row.events & ContactEvent::kRedirected) != 0) turned.insert(row.pass);
  run.claims.push_back(claim_at_least({ClaimKind::input, "the hand's aim, within the cone"},
                                      "injections that took a new line, of those re-aimed",
                                      static_cast<double>(turned.size()),
                                      static_cast<double>(aimed.size()), ""));
}

}  // namespace

void analyze(const CompiledJoint& joint, bool reached, ThreeInjections& run) {
  std::vector<PlateauFinder::Layer> layers;
  for (const Region& region : joint.regions) {
    const Tissue& tissue = joint.tissues[region.tissue];
    layers.push_back({tissue.name, tissue.haptic});
    layers.back().haptic.cutting_force *= run.options.feel.patient.cutting;
  }
  PlateauFinder finder(std::move(layers));
  for (const NeedleRow& row : run.rows) finder.add(row);
  run.plateaus = finder.plateaus();
  run.touches = find_touches(run.rows);
  run.claims.push_back(claim_that({ClaimKind::input, "the operator's plan"},
                                  "every step of the operator met its goal in time", reached));
  for (const LayerPlateau& p : run.plateaus) {
    if (p.rows == 0) continue;  // thinner than its rise: listed, but nothing can be claimed
    run.claims.push_back(claim_near({ClaimKind::input, "f_R of the tissue, table 4.2"},
                                    "mean cutting force on the plateau in " + p.tissue, p.mean,
                                    p.expected, kPlateauShare, "N"));
  }
  claim_target(joint, run);
  claim_touches(run);
  claim_redirections(run);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const NeedleRow& row = run.rows[i];
    if (i + 1 < run.rows.size() && run.rows[i + 1].pass == row.pass) continue;
    run.claims.push_back(claim_at_most(
        {ClaimKind::input, "the laws are built to give none"},
        "injection " + std::to_string(row.pass) + ": energy given to the hand over the whole pass",
        row.energy_to_hand, 0, "J"));
  }
}

}  // namespace artus
