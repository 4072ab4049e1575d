// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/bodies.h"

#include <chrono>
#include <utility>

#include "artus/detail/training/patient_plans.h"
#include "artus/detail/training/player.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

constexpr std::size_t kMaxBodies = 3;  // some 200 MB each

std::shared_ptr<const PagePicture> draw(const Scenario& modelled,
                                        const std::shared_ptr<const Scene>& scene) {
  Scenario scenario = modelled;
  follow_patient(scenario, *scene);
  const auto params = make_session_params(scenario);
  if (!params) return nullptr;
  Renderer renderer(scene, params->transducer, params->image);
  NeedleShape shape = params->needle_shape;
  shape.length = needle_length_of(*params);
  const Frame& frame =
      renderer.render(scenario.X_JP, NeedleView{planned_needle(scenario), shape, Vec3::Zero()});
  return std::make_shared<const PagePicture>(PagePicture{frame.width, frame.height, frame.image});
}

}  // namespace

Pose planned_needle(const Scenario& scenario) {
  const Vec3 displacement = scenario.target.point - scenario.entry.centre;
  return make_pose(scenario.target.point, displacement, Vec3::Zero());
}

std::string TrainBodies::key_of(const Scenario& scenario) const {
  if (!scenario.gel) return (joint_.empty() ? scenario.body() : joint_).string();
  std::string key = "gel " + std::to_string(scenario.gel->width);
  for (const FlatLayer& layer : scenario.gel->layers)
    key += " " + layer.tissue + " " + std::to_string(layer.thickness);
  return key;
}

void TrainBodies::collect() {
  if (!making_.valid() || making_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return;
  Made made = making_.get();
  pictures_.insert_or_assign(made.scenario, made.picture);
  if (bodies_.count(made.body) == 0) kept_.push_back(made.body);
  bodies_.insert_or_assign(made.body, std::move(made.scene));
  if (kept_.size() <= kMaxBodies) return;
  bodies_.erase(kept_.front());
  kept_.pop_front();
}

void TrainBodies::want(const Scenario& scenario) {
  collect();
  if (!making_.valid() && pictures_.count(scenario.name) == 0) begin(scenario);
}

void TrainBodies::prepare(const Scenario& scenario) {
  collect();
  if (!making_.valid() && bodies_.count(key_of(scenario)) == 0) begin(scenario);
}

void TrainBodies::begin(const Scenario& scenario) {
  const std::string key = key_of(scenario);
  const auto known = bodies_.find(key);
  const std::optional<Body> body =
      known != bodies_.end() ? std::optional(known->second) : std::nullopt;
  making_ = std::async(std::launch::async, [scenario, key, body, joint = joint_, load = load_] {
    Made made{key, body ? *body : load(scenario, joint), scenario.name, nullptr};
    if (made.scene) made.picture = draw(scenario, *made.scene);
    return made;
  });
}

bool TrainBodies::ready(const Scenario& scenario) {
  collect();
  return bodies_.count(key_of(scenario)) != 0;
}

std::shared_ptr<const PagePicture> TrainBodies::picture(const Scenario& scenario) {
  collect();
  const auto found = pictures_.find(scenario.name);
  return found == pictures_.end() ? nullptr : found->second;
}

Result<std::shared_ptr<const Scene>> TrainBodies::scene(const Scenario& scenario) {
  return bodies_.at(key_of(scenario));
}

}  // namespace artus
