// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/simulation/records.h"
#include "artus/echo/transducer_file.h"
#include "artus/simulation/simulation.h"

struct artus_simulation {
  std::unique_ptr<artus::Simulation> simulation;
  artus::ImageControls controls;
  bool had_image = false;
};

namespace {

/// Of the calling thread: the one state that the interface needs beside its simulations.
std::string& last_error() {
  thread_local std::string text;
  return text;
}

/// Calls `body`; what it throws becomes the last error, and `failed` is returned.
template <class Value, class Body>
Value guarded(Value failed, const Body& body) noexcept {
  try {
    last_error().clear();
    return body();
  } catch (const std::exception& error) {
    try {
      last_error() = error.what();
    } catch (...) {  // no memory for the text: the value says it
    }
    return failed;
  }
}

int refuse(const std::string& why) {
  last_error() = why;
  return -1;
}

artus::Result<artus::SessionParams> params_of(const artus_options& options,
                                              const artus::CompiledJoint& joint) {
  artus::SessionParams params;
  const auto device = artus::find_device(options.device != nullptr ? options.device : "");
  ARTUS_TRY(device);
  params.device = *device;
  const auto preset =
      artus::find_transducer(options.transducer != nullptr ? options.transducer : "");
  ARTUS_TRY(preset);
  params.transducer = preset->transducer;
  params.haptic_rate = options.haptic_rate;
  params.image_rate = options.image_rate;
  params.deform = options.rigid == 0 && artus::gives_way(joint);
  const auto valid = artus::validate(params);
  ARTUS_TRY(valid);
  return params;
}

/// Seven numbers as a pose; nullopt when they are none.
std::optional<artus::Pose> pose_of(const double* numbers) {
  const bool finite = std::all_of(numbers, numbers + 7, [](double v) { return std::isfinite(v); });
  const Eigen::Quaterniond q(numbers[3], numbers[4], numbers[5], numbers[6]);
  if (!finite || !(q.norm() >= 0.9 && q.norm() <= 1.1)) return std::nullopt;
  artus::Pose pose = artus::Pose::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = artus::Vec3(numbers[0], numbers[1], numbers[2]);
  return pose;
}

void put(const artus::Vec3& v, double* out) {
  std::copy_n(v.data(), 3, out);
}

const artus::CompiledJoint& joint_of(const artus_simulation* simulation) {
  return simulation->simulation->joint();
}

artus_felt felt_of(const artus::Simulation& simulation, const artus::Felt& felt) {
  artus_felt out{};
  put(felt.force, out.force);
  put(felt.torque, out.torque);
  put(felt.probe_force, out.probe_force);
  put(felt.probe_torque, out.probe_torque);
  const artus::DeviceFeedback& said = simulation.last().feedback;
  out.thumb_force = felt.thumb_force;
  out.depth = said.depth;
  out.given = said.plunger.given;
  out.region = said.region;
  out.status = felt.status;
  out.image_due = felt.image_due ? 1 : 0;
  return out;
}

}  // namespace

uint32_t artus_api_version(void) {
  return ARTUS_API_VERSION;
}

const char* artus_version(void) {
  return ARTUS_VERSION;
}

const char* artus_last_error(void) {
  return last_error().c_str();
}

void artus_default_options(artus_options* options) {
  if (options == nullptr) return;
  *options = {ARTUS_API_VERSION, 0, 1000, 30, "virtuose_6d_desktop", "linear-6-18"};
}

artus_simulation* artus_open(const char* file, const artus_options* options) {
  return guarded<artus_simulation*>(nullptr, [&]() -> artus_simulation* {
    artus_options chosen{};
    artus_default_options(&chosen);
    if (options != nullptr) chosen = *options;
    if (file == nullptr || chosen.version != ARTUS_API_VERSION) {
      refuse(file == nullptr ? "artus_open needs a file"
                             : "the options are of another ARTUS_API_VERSION");
      return nullptr;
    }
    auto joint = artus::read_compiled_joint(file);
    const auto params =
        joint ? params_of(chosen, *joint)
              : artus::Result<artus::SessionParams>(tl::unexpected<artus::Error>(joint.error()));
    if (!params) {
      refuse(params.error().to_string());
      return nullptr;
    }
    auto made = std::make_unique<artus_simulation>();
    made->simulation = std::make_unique<artus::Simulation>(
        std::make_shared<const artus::Scene>(
            std::make_shared<const artus::CompiledJoint>(std::move(*joint))),
        *params);
    made->controls = artus::controls_of(*params);
    return made.release();
  });
}

void artus_free(artus_simulation* simulation) {
  delete simulation;
}

int artus_is_soft(const artus_simulation* simulation) {
  return simulation != nullptr && simulation->simulation->params().deform &&
                 simulation->simulation->refusal().empty()
             ? 1
             : 0;
}

uint64_t artus_ticks(const artus_simulation* simulation) {
  return simulation != nullptr ? simulation->simulation->ticks() : 0;
}

double artus_time(const artus_simulation* simulation) {
  return simulation != nullptr ? simulation->simulation->time() : 0;
}

uint32_t artus_region_count(const artus_simulation* simulation) {
  return simulation != nullptr ? static_cast<uint32_t>(joint_of(simulation).regions.size()) : 0;
}

const char* artus_region_name(const artus_simulation* simulation, uint32_t region) {
  if (region >= artus_region_count(simulation)) return nullptr;
  return joint_of(simulation).regions[region].name.c_str();
}

int artus_default_probe(const artus_simulation* simulation, double pose[7]) {
  return guarded(-1, [&] {
    if (simulation == nullptr || pose == nullptr) return refuse("a pointer is NULL");
    const artus::Pose& X_JP = joint_of(simulation).X_JP_default;
    const Eigen::Quaterniond q(X_JP.linear());
    put(X_JP.translation(), pose);
    const double rotation[4] = {q.w(), q.x(), q.y(), q.z()};
    std::copy_n(rotation, 4, pose + 3);
    return 0;
  });
}

uint32_t artus_plan_count(const artus_simulation* simulation) {
  return simulation != nullptr ? static_cast<uint32_t>(joint_of(simulation).injections.size()) : 0;
}

const char* artus_plan_name(const artus_simulation* simulation, uint32_t plan) {
  if (plan >= artus_plan_count(simulation)) return nullptr;
  return joint_of(simulation).injections[plan].name.c_str();
}

int artus_plan(const artus_simulation* simulation, uint32_t plan, double entry[3],
               double target[3]) {
  return guarded(-1, [&] {
    if (plan >= artus_plan_count(simulation) || entry == nullptr || target == nullptr)
      return refuse("there is no such plan, or a pointer is NULL");
    put(joint_of(simulation).injections[plan].entry, entry);
    put(joint_of(simulation).injections[plan].target, target);
    return 0;
  });
}

int artus_mesh_size(const artus_simulation* simulation, uint32_t* vertices, uint32_t* triangles) {
  return guarded(-1, [&] {
    if (simulation == nullptr || vertices == nullptr || triangles == nullptr)
      return refuse("a pointer is NULL");
    *vertices = static_cast<uint32_t>(joint_of(simulation).mesh.vertices.size());
    *triangles = static_cast<uint32_t>(joint_of(simulation).mesh.interfaces.size());
    return 0;
  });
}

int artus_mesh(const artus_simulation* simulation, float* vertices, uint32_t* triangles,
               uint32_t* regions) {
  return guarded(-1, [&] {
    if (simulation == nullptr || vertices == nullptr || triangles == nullptr)
      return refuse("a pointer is NULL");
    const artus::TetMesh& mesh = joint_of(simulation).mesh;
    for (const artus::Vec3& vertex : mesh.vertices)
      for (int i = 0; i < 3; ++i) *vertices++ = static_cast<float>(vertex[i]);
    for (const artus::Interface& interface : mesh.interfaces) {
      for (const std::uint32_t vertex : interface.vertices) *triangles++ = vertex;
      if (regions == nullptr) continue;
      *regions++ = interface.front;
      *regions++ = interface.back;
    }
    return 0;
  });
}

int artus_step(artus_simulation* simulation, const double* needle, const double* probe,
               double thumb, artus_felt* felt) {
  return guarded(-1, [&] {
    if (simulation == nullptr || felt == nullptr) return refuse("a pointer is NULL");
    artus::Hands hands;
    if (needle != nullptr && !(hands.X_WN = pose_of(needle)))
      return refuse("the needle's pose is not finite, or its quaternion's norm is not 1");
    if (probe != nullptr && !(hands.X_WP = pose_of(probe)))
      return refuse("the probe's pose is not finite, or its quaternion's norm is not 1");
    if (!std::isfinite(thumb)) return refuse("the thumb's force is not finite");
    hands.thumb = thumb;
    *felt = felt_of(*simulation->simulation, simulation->simulation->step(hands));
    simulation->had_image = simulation->had_image || felt->image_due != 0;
    return 0;
  });
}

int artus_render(artus_simulation* simulation, artus_image* image) {
  return guarded(-1, [&] {
    if (simulation == nullptr || image == nullptr) return refuse("a pointer is NULL");
    if (!simulation->had_image) return refuse("no image was due yet: step until image_due is 1");
    const artus::Frame& frame = simulation->simulation->render();
    *image = {frame.image.data(), static_cast<uint32_t>(frame.width),
              static_cast<uint32_t>(frame.height), frame.pixel};
    return 0;
  });
}

int artus_set_image(artus_simulation* simulation, double depth, double gain_db) {
  return guarded(-1, [&] {
    if (simulation == nullptr) return refuse("a pointer is NULL");
    if (!(depth >= 0.01 && depth <= 0.2) || !(gain_db >= -40 && gain_db <= 60))
      return refuse("the depth must be 0.01 to 0.2 m, the gain -40 to 60 dB");
    simulation->controls.depth = depth;
    simulation->controls.gain_db = gain_db;
    simulation->simulation->set_controls(simulation->controls);
    return 0;
  });
}
