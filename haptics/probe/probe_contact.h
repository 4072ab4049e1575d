// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "artus/detail/haptics/guard.h"
#include "artus/detail/haptics/probe/probe_contact_column.h"
#include "artus/detail/haptics/wrench.h"
#include "artus/raycast/scene.h"

namespace artus {

/// The probe's face: a rectangle in the x-y plane of frame P, centred on its origin.
struct ProbeFootprint {
  double length = 0.040;       ///< m along x (lateral); [Alamilla2020] fig. 3-1
  double width = 0.006;        ///< m along y (elevation)
  std::size_t columns_x = 20;  ///< tissue columns along x
  std::size_t columns_y = 3;   ///< and along y
  std::size_t elements = 128;  ///< of the transducer, along x
};

struct ProbeContactParams {
  ProbeFootprint footprint;
  ColumnParams column;
  double column_depth = 0.06;     ///< m below the skin; tissue deeper than this is taken as rigid;
                                  ///< assumed: ten times the footprint's width
  double max_indentation = 0.03;  ///< m, how far the face is looked for inside the body
  bool gel = true;                ///< coupling gel between probe and skin
  double gel_friction = 0.05;     ///< Coulomb coefficient with gel; assumed: lubricated skin
  double dry_friction = 0.5;      ///< without gel; assumed: dry skin on plastic
  double gel_gap = 0.5e-3;        ///< m of gap that gel still couples; assumed
  double shear_stiffness = 2000;  ///< N/m of skin sheared before it slips; assumed
};

/// What the probe feels in one tick.
struct ProbeContact {
  Wrench wrench;                   ///< on the hand, at the footprint's centre, frame J
  double normal_force = 0;         ///< N >= 0, along -z of P
  Vec3 edge_force = Vec3::Zero();  ///< N, part of the wrench: tangential, frame J; what the tissue
                                   ///< under the edges holds against sliding there
  Vec3 turning = Vec3::Zero();     ///< N m, part of the wrench, frame J: of what lies askew below
  Vec3 friction = Vec3::Zero();    ///< N, part of the wrench: tangential, frame J
  double slip = 0;                 ///< m, path slid over the skin since the face touched it
  double stiffness = 0;            ///< N/m, K_c: d normal force / d indentation, for the actuator
  double indentation = 0;          ///< m, of the deepest column
  double contact_share = 0;        ///< of the face that presses on skin, 0..1
  std::uint32_t status = 0;        ///< TickStatus bits
};

/// The probe pressed on the body: a grid of tissue columns under the face, each from the skin along
/// the probe's axis down to bone, pressed in series. The skin's undeformed surface is where the
/// scene has it. Sliding presses the tissue ahead and frees the tissue behind: the edges carry that
/// work. Tilting moves a column's deep parts aside: each sloping interface turns the face. So force
/// and torque are the gradient of one stored energy, and without friction the force on a slope
/// stands on the skin, not on the face. One instance per probe; not thread safe; deterministic.
class ProbeContactModel {
 public:
  /// Requires: a scene; a footprint with positive size, at least one column in each direction and
  /// one element (std::invalid_argument).
  ProbeContactModel(std::shared_ptr<const Scene> scene, const ProbeContactParams& params);

  /// Forgets friction; the next step starts where the probe then is.
  ARTUS_REALTIME void reset() noexcept;

  /// One tick. Off the skin, and for a pose that is not finite or rigid, every force is exactly 0.
  /// Cost: one scene query per column.
  ARTUS_REALTIME const ProbeContact& step(const Pose& X_JP) noexcept;

  /// How much of each element couples to the skin, 0..1 (n_elements), lateral order along +x; valid
  /// until the next step. Between columns the gap is interpolated; where the skin ends, the mask is
  /// exact to half a column.
  [[nodiscard]] std::span<const float> coverage() const noexcept { return coverage_; }

  [[nodiscard]] const ProbeContactParams& params() const noexcept { return params_; }

 private:
  static constexpr std::size_t kMaxIntervals = 64;

  struct Column {
    double x = 0;
    double y = 0;
    double indentation = 0;       // m; negative: gap; -infinity: no skin there
    double energy = 0;            // J/m^2 stored
    Vec3 turning = Vec3::Zero();  // N m/m^2 about the face's axes, of its sloping interfaces
  };
  [[nodiscard]] Vec3 turning_of(const Pose& X_JP, std::span<const TissueInterval> from_skin,
                                std::span<const ColumnLayer> layers,
                                double pressure) const noexcept;
  [[nodiscard]] ColumnResponse probe_column(const Pose& X_JP, Column& column) noexcept;
  void update_coverage() noexcept;
  [[nodiscard]] double indentation_at(std::size_t row, double x) const noexcept;
  void add_edge_force(const Pose& X_JP) noexcept;
  void add_friction(const Pose& X_JP) noexcept;
  void clear(std::uint32_t status) noexcept;

  std::shared_ptr<const Scene> scene_;
  ProbeContactParams params_;
  std::vector<double> modulus_;     // Pa by region
  std::vector<std::uint8_t> hard_;  // by region
  std::vector<Column> columns_;     // (columns_y, columns_x), x fastest
  std::vector<float> coverage_;
  std::array<TissueInterval, kMaxIntervals> intervals_{};
  std::array<ColumnLayer, kMaxIntervals> layers_{};
  ProbeContact contact_;
  bool have_last_ = false;
  Vec3 last_position_ = Vec3::Zero();
  Vec3 shear_ = Vec3::Zero();  // m, how far the skin is dragged along
  double slip_ = 0;            // m
};

}  // namespace artus
