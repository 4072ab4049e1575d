// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/bodies.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "artus/detail/training/patient_plans.h"
#include "artus/detail/training/player.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

/// Ends work whose result nobody waits for.
class GivenUp : public std::exception {};

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
  if (watch_->given_up) return;
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
  const std::string key = key_of(scenario);
  if (bodies_.count(key) != 0) return;
  if (!making_.valid())
    begin(scenario);
  else if (making_key_ != key)
    give_up();
}

std::pair<std::string, double> TrainBodies::progress() const {
  if (watch_ == nullptr) return {"", 0};
  const std::lock_guard<std::mutex> lock(watch_->mutex);
  return {watch_->step, watch_->fraction};
}

void TrainBodies::give_up() {
  if (making_.valid() && watch_ != nullptr) watch_->given_up = true;
}

void TrainBodies::forget(const Scenario& scenario) {
  const std::string key = key_of(scenario);
  const auto known = bodies_.find(key);
  if (known == bodies_.end() || known->second) return;
  bodies_.erase(known);
  kept_.erase(std::find(kept_.begin(), kept_.end(), key));
  pictures_.erase(scenario.name);
}

void TrainBodies::begin(const Scenario& scenario) {
  const std::string key = key_of(scenario);
  const auto known = bodies_.find(key);
  const std::optional<Body> body =
      known != bodies_.end() ? std::optional(known->second) : std::nullopt;
  making_key_ = key;
  watch_ = std::make_shared<Watch>();
  making_ = std::async(
      std::launch::async, [scenario, key, body, joint = joint_, load = load_, watch = watch_] {
        const Progress progress = [&watch](std::string_view step, double fraction) {
          if (watch->given_up) throw GivenUp();
          const std::lock_guard<std::mutex> lock(watch->mutex);
          watch->step = step;
          watch->fraction = fraction;
        };
        Made made{key, fail(ErrorCode::failed, "it was given up"), scenario.name, nullptr};
        try {
          made.scene = body ? *body : load(scenario, joint, progress);
          if (made.scene && !watch->given_up) made.picture = draw(scenario, *made.scene);
        } catch (const GivenUp&) {
          return made;
        } catch (const std::exception& e) {
          made.scene = fail(ErrorCode::failed, e.what());
        }
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

Result<std::shared_ptr<const OutsideBody>> TrainBodies::outside(const Scenario& scenario) const {
  if (scenario.gel) return nullptr;
  return read_outside(joint_.empty() ? scenario.body() : joint_);
}

}  // namespace artus
