// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/probe/probe_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "artus/detail/core/rigid.h"

namespace artus {
namespace {

constexpr double kNoSkin = -std::numeric_limits<double>::infinity();

std::uint32_t check_pose(const Pose& X_JP) noexcept {
  if (!X_JP.matrix().allFinite()) return TickStatus::kNotFinite;
  return is_rigid(X_JP) ? TickStatus::kOk : TickStatus::kNotRigid;
}

}  // namespace

ProbeContactModel::ProbeContactModel(std::shared_ptr<const Scene> scene,
                                     const ProbeContactParams& params)
    : scene_(std::move(scene)), params_(params) {
  const ProbeFootprint& f = params_.footprint;
  ARTUS_REQUIRE(scene_ != nullptr, "there must be a scene");
  ARTUS_REQUIRE(f.length > 0 && f.width > 0, "the footprint must have a size");
  ARTUS_REQUIRE(f.columns_x > 0 && f.columns_y > 0 && f.elements > 0,
                "the footprint needs columns and elements");
  const CompiledJoint& joint = scene_->joint();
  for (const Region& region : joint.regions) {
    const Tissue& tissue = joint.tissues[region.tissue];
    modulus_.push_back(tissue.mechanical.youngs_modulus);
    hard_.push_back(tissue.haptic.hard ? 1 : 0);
  }
  for (std::size_t j = 0; j < f.columns_y; ++j) {
    for (std::size_t i = 0; i < f.columns_x; ++i) {
      const auto share = [](std::size_t k, std::size_t n) {
        return (static_cast<double>(k) + 0.5) / static_cast<double>(n) - 0.5;
      };
      columns_.push_back({f.length * share(i, f.columns_x), f.width * share(j, f.columns_y),
                          kNoSkin, 0, Vec3::Zero()});
    }
  }
  coverage_.resize(f.elements);
}

void ProbeContactModel::reset() noexcept {
  have_last_ = false;
  shear_.setZero();
  slip_ = 0;
}

void ProbeContactModel::clear(std::uint32_t status) noexcept {
  contact_ = {};
  contact_.status = status;
}

/// The torque on the face, per area, of what lies askew under one column. An interface at depth z
/// (m, along the axis from the face) that falls away by `slope` moves by slope z per radian of
/// tilt; the energy follows by its derivative over the interface's depth.
Vec3 ProbeContactModel::turning_of(const Pose& X_JP, std::span<const TissueInterval> from_skin,
                                   std::span<const ColumnLayer> layers,
                                   double pressure) const noexcept {
  constexpr double kSteepest = 5;  // slope beyond which a column sees an interface's edge, not it
  const double back = params_.max_indentation;
  Vec3 turning = Vec3::Zero();
  double above = pressure;
  for (std::size_t k = 0; k <= layers.size(); ++k) {
    // Where the column ends by its own length, the end follows the skin.
    const bool has_end =
        k < from_skin.size() && from_skin[k].entry - from_skin[0].entry < params_.column_depth;
    const Vec3 normal = X_JP.linear().transpose() * from_skin[has_end ? k : 0].entry_normal;
    const double depth =
        has_end ? from_skin[k].entry - back : from_skin[0].entry + params_.column_depth - back;
    const double below =
        k < layers.size() ? complementary_energy(params_.column, layers[k], pressure) : 0;
    const double energy_over_depth = below - above;
    above = below;
    if (!(normal.z() < 0)) continue;
    Eigen::Vector2d slope(-normal.x() / normal.z(), -normal.y() / normal.z());
    if (slope.norm() > kSteepest) slope *= kSteepest / slope.norm();
    const Eigen::Vector2d force = -energy_over_depth * slope;
    turning += depth * Vec3(-force.y(), force.x(), 0);
  }
  return turning;
}

ColumnResponse ProbeContactModel::probe_column(const Pose& X_JP, Column& column) noexcept {
  const double back = params_.max_indentation;
  const Segment segment{X_JP * Vec3(column.x, column.y, -back),
                        X_JP * Vec3(column.x, column.y, params_.column_depth)};
  const QueryCount count = scene_->find_intervals(segment, intervals_);
  const std::span<const TissueInterval> all(intervals_.data(), count.size);
  const auto skin = std::find_if(all.begin(), all.end(),
                                 [](const TissueInterval& t) { return t.region != kOutside; });
  column.indentation = kNoSkin;
  column.energy = 0;
  column.turning.setZero();
  if (skin == all.end() || skin->region == kBeyond) return {};
  column.indentation = back - skin->entry;
  if (!(column.indentation > 0)) return {};

  const double end = skin->entry + params_.column_depth;
  std::size_t n = 0;
  for (auto t = skin; t != all.end() && t->entry < end; ++t) {
    const bool known = t->region != kOutside && t->region != kBeyond;
    if (!known || hard_[t->region] != 0) break;
    layers_[n++] = {std::min(t->exit, end) - t->entry, modulus_[t->region]};
  }
  const ColumnResponse response = compress_column(
      params_.column, std::span<const ColumnLayer>(layers_.data(), n), column.indentation);
  column.energy = response.energy;
  column.turning = turning_of(X_JP, std::span(skin, all.end()),
                              std::span<const ColumnLayer>(layers_.data(), n), response.pressure);
  return response;
}

double ProbeContactModel::indentation_at(std::size_t row, double x) const noexcept {
  const ProbeFootprint& f = params_.footprint;
  const Column* columns = &columns_[row * f.columns_x];
  if (f.columns_x == 1) return columns[0].indentation;
  const double place = (x / f.length + 0.5) * static_cast<double>(f.columns_x) - 0.5;
  const double floor = std::clamp(std::floor(place), 0.0, static_cast<double>(f.columns_x - 2));
  const auto i = static_cast<std::size_t>(floor);
  const double a = columns[i].indentation;
  const double b = columns[i + 1].indentation;
  const double w = place - floor;
  if (!std::isfinite(a) || !std::isfinite(b)) return w < 0.5 ? a : b;
  return a + w * (b - a);
}

void ProbeContactModel::update_coverage() noexcept {
  const ProbeFootprint& f = params_.footprint;
  const double gap = params_.gel ? params_.gel_gap : 0;
  for (std::size_t e = 0; e < f.elements; ++e) {
    const double x =
        f.length * ((static_cast<double>(e) + 0.5) / static_cast<double>(f.elements) - 0.5);
    std::size_t touching = 0;
    for (std::size_t row = 0; row < f.columns_y; ++row) {
      if (indentation_at(row, x) >= -gap) ++touching;
    }
    coverage_[e] = static_cast<float>(touching) / static_cast<float>(f.columns_y);
  }
}

void ProbeContactModel::add_edge_force(const Pose& X_JP) noexcept {
  const ProbeFootprint& f = params_.footprint;
  // At the edge itself, half a column beyond the last one's middle.
  const auto at_edge = [](const Column& last, const Column& before) {
    return std::max(0.0, 1.5 * last.energy - 0.5 * before.energy);
  };
  const auto column = [&](std::size_t i, std::size_t j) -> const Column& {
    return columns_[j * f.columns_x + i];
  };
  const auto pull = [&](const Column& at, const Vec3& force) {
    const Vec3 in_J = X_JP.linear() * force;
    contact_.edge_force += in_J;
    contact_.wrench.torque += (X_JP.linear() * Vec3(at.x, at.y, 0)).cross(in_J);
  };
  const std::size_t nx = f.columns_x;
  const std::size_t ny = f.columns_y;
  const double piece_x = f.length / static_cast<double>(nx);
  const double piece_y = f.width / static_cast<double>(ny);
  for (std::size_t j = 0; nx > 1 && j < ny; ++j) {
    const double left = at_edge(column(0, j), column(1, j));
    const double right = at_edge(column(nx - 1, j), column(nx - 2, j));
    pull({-f.length / 2, column(0, j).y}, Vec3(left * piece_y, 0, 0));
    pull({f.length / 2, column(0, j).y}, Vec3(-right * piece_y, 0, 0));
  }
  for (std::size_t i = 0; ny > 1 && i < nx; ++i) {
    const double near = at_edge(column(i, 0), column(i, 1));
    const double far = at_edge(column(i, ny - 1), column(i, ny - 2));
    pull({column(i, 0).x, -f.width / 2}, Vec3(0, near * piece_x, 0));
    pull({column(i, 0).x, f.width / 2}, Vec3(0, -far * piece_x, 0));
  }
  contact_.wrench.force += contact_.edge_force;
}

void ProbeContactModel::add_friction(const Pose& X_JP) noexcept {
  const Vec3 axis = X_JP.linear().col(2);
  const Vec3 position = X_JP.translation();
  if (have_last_) shear_ += position - last_position_;
  have_last_ = true;
  last_position_ = position;
  shear_ -= axis * axis.dot(shear_);
  const double coefficient = params_.gel ? params_.gel_friction : params_.dry_friction;
  const double max = coefficient * contact_.normal_force / params_.shear_stiffness;
  const double dragged = shear_.norm();
  if (dragged > max) {
    shear_ *= max / dragged;
    slip_ += dragged - max;
  }
  contact_.slip = slip_;
  contact_.friction = -params_.shear_stiffness * shear_;
  contact_.wrench.force += contact_.friction;
}

const ProbeContact& ProbeContactModel::step(const Pose& X_JP) noexcept {
  clear(check_pose(X_JP));
  if (contact_.status != 0) {
    reset();
    std::fill(coverage_.begin(), coverage_.end(), 0.0F);
    return contact_;
  }
  const ProbeFootprint& f = params_.footprint;
  const double area = f.length * f.width / static_cast<double>(columns_.size());
  const Vec3 axis = X_JP.linear().col(2);
  std::size_t pressed = 0;
  for (Column& column : columns_) {
    const ColumnResponse response = probe_column(X_JP, column);
    if (!(column.indentation > 0)) continue;
    ++pressed;
    const double force = response.pressure * area;
    const Vec3 arm = X_JP.linear() * Vec3(column.x, column.y, 0);
    contact_.normal_force += force;
    contact_.stiffness += response.stiffness * area;
    contact_.indentation = std::max(contact_.indentation, column.indentation);
    contact_.wrench.torque -= arm.cross(axis) * force;
    contact_.turning += X_JP.linear() * column.turning * area;
  }
  contact_.contact_share = static_cast<double>(pressed) / static_cast<double>(columns_.size());
  update_coverage();
  if (pressed == 0) {
    reset();
    return contact_;
  }
  contact_.wrench.force = -contact_.normal_force * axis;
  contact_.wrench.torque += contact_.turning;
  add_edge_force(X_JP);
  add_friction(X_JP);
  return contact_;
}

}  // namespace artus
