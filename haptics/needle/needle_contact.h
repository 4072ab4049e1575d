// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "artus/detail/core/units.h"
#include "artus/detail/haptics/needle/insertion_line.h"
#include "artus/detail/haptics/needle/laws/force_model.h"
#include "artus/detail/haptics/needle/laws/motion.h"
#include "artus/detail/haptics/needle/laws/prepuncture.h"
#include "artus/detail/haptics/needle/laws/skin_puncture.h"
#include "artus/raycast/scene.h"

namespace artus {

/// Where the needle is in its insertion.
enum class ContactState : std::uint8_t {
  away,         ///< tip outside the skin
  touching,     ///< a membrane dimples under the tip and still holds
  punctured,    ///< the tick in which a membrane gave way
  inserting,    ///< cutting new tissue
  stopped,      ///< still, inside
  withdrawing,  ///< moving out
  reinserting,  ///< moving in, in the track already cut
  bone          ///< tip on a hard layer
};
[[nodiscard]] const char* to_string(ContactState state) noexcept;

/// What happened in a tick; a bit field.
struct ContactEvent {
  static constexpr std::uint32_t kSkinPunctured = 1U << 0U;
  static constexpr std::uint32_t kMembranePopped = 1U << 1U;
  static constexpr std::uint32_t kRedirected = 1U << 2U;
  static constexpr std::uint32_t kBoneTouched = 1U << 3U;
  static constexpr std::uint32_t kExited = 1U << 4U;
  static constexpr std::uint32_t kAdopted = 1U
                                            << 5U;  ///< found inside after a fault: starts at rest
};

struct ContactParams {
  double needle_length = 0.035;     ///< m, n_L; [Alamilla2020] section 1.6.1: 35 or 25 mm
  LineParams line;                  ///< when and how the line may change
  double behind_skin = 2e-3;        ///< m, query starts this far before the entry
  double lookahead = 0.02;          ///< m, query goes this far beyond the tip
  double approach = 0.06;           ///< m, query behind the tip while no line is stored
  double membrane_margin = 0.1e-3;  ///< m, by which a membrane may lie before the end of the cut
                                    ///< track and still be whole; assumed: above what a trembling
                                    ///< needle moves over a slope in a tick
  double membrane_edge = 0.5e-3;    ///< m farther, over which its strength is lost; assumed: a
                                    ///< needle's width
  double layer_edge = 0.2e-3;       ///< m, path on which the tip goes over from what one soft layer
                                    ///< feels like to the next; assumed: a part of a bevel
  double bevel = 1e-3;  ///< m, path on which a tip that was pressed into bone slides off it at
                        ///< most; assumed: the size of a needle's bevel
  MotionParams motion;
  double velocity_window = 0.01;  ///< s; lag half of it; only for laws that need a velocity
};

/// How the tissue at the tip gave way, m.
struct TipTissue {
  bool gives_way = false;         ///< false: rigid
  double pushed = 0;              ///< along the needle, by its tip
  Vec3 carried_J = Vec3::Zero();  ///< from its rest, by all else
};

/// The needle's contact with the layers: finds the entry, stores the insertion line at the first
/// puncture, keeps what of the track is cut, decides which membrane still holds, and re-takes the
/// line inside the cone alpha(depth). One scene query a tick, by the caller: query_segment gives
/// the segment, update takes its intervals. A pure function of the poses given since reset.
class NeedleContact {
 public:
  /// Requires: dt > 0 s, the fixed period of the loop; table outlives this.
  NeedleContact(const ContactParams& params, const PrepunctureParams& prepuncture,
                const LayerTable& table, double dt) noexcept;

  /// Forgets the insertion. A tip found inside at the next update is taken as resting there.
  ARTUS_REALTIME void reset() noexcept;

  /// A tick in which nothing is known: all stays as it is, and nothing happens.
  ARTUS_REALTIME void hold() noexcept { events_ = 0; }

  /// The line whose tissue intervals update needs, frame J. Requires: a finite, rigid pose.
  [[nodiscard]] ARTUS_REALTIME Segment query_segment(const Pose& X_JN) const noexcept;

  /// Advances by one period. `intervals` are those of query_segment(X_JN), which is where the
  /// needle is in the material, the tissue at its tip lying as `tissue` says. Layers are met by the
  /// depth in the material; speed and path are those of the hand against what carries the tissue,
  /// and it rests when it does so in space.
  ARTUS_REALTIME void update(const Pose& X_JN, std::span<const TissueInterval> intervals,
                             const TipTissue& tissue = {}) noexcept;

  [[nodiscard]] ContactState state() const noexcept { return state_; }
  [[nodiscard]] std::uint32_t events() const noexcept { return events_; }
  [[nodiscard]] RegionId region() const noexcept { return region_; }  ///< at the tip
  [[nodiscard]] bool inserted() const noexcept { return inserted_; }
  [[nodiscard]] double cone() const noexcept;  ///< alpha at this depth, rad
  /// What the force laws see, with the tip's place and depth in the material; valid until the next
  /// update.
  [[nodiscard]] const NeedleTick& tick() const noexcept { return tick_; }

 private:
  static constexpr std::size_t kMaxLayers = 64;

  void store_layers(std::span<const TissueInterval> intervals, double origin) noexcept;
  void approach(const Pose& X_JN, std::span<const TissueInterval> intervals) noexcept;
  void adopt(const NeedlePlace& now) noexcept;
  void start_line(const NeedlePlace& place) noexcept;
  [[nodiscard]] double gave_way_at(const LayerHaptics& skin, double strength,
                                   double thickness) const noexcept;
  [[nodiscard]] bool still_holds(const LayerHaptics& membrane, double dimple, double force,
                                 double strength) noexcept;
  void tear(double force, double dimple) noexcept;
  void follow_line(const Pose& X_JN) noexcept;
  [[nodiscard]] double clearance() const noexcept;
  [[nodiscard]] double hand_depth() const noexcept { return tick_.depth + tick_.pushed; }
  /// m along the line, whatever the tissue does: a hand rests in space, and tissue that comes onto
  /// its needle as the force fades shall not seem to be a hand that moves.
  [[nodiscard]] double hand_place() const noexcept { return hand_depth() + carried(); }
  [[nodiscard]] double carried() const noexcept { return carried_J_.dot(tick_.axis); }
  void leave_skin(const Vec3& last_tip, double last_clearance) noexcept;
  [[nodiscard]] std::ptrdiff_t last_passed() const noexcept;
  void feel(const ShaftLayer& stretch, bool skin) noexcept;
  [[nodiscard]] double wholeness(double depth) const noexcept;
  double felt_bone(double line_depth) noexcept;
  void find_tip_layers() noexcept;
  void classify() noexcept;
  void update_velocity(const Pose& X_JN) noexcept;
  void leave() noexcept;

  ContactParams params_;
  PrepunctureParams prepuncture_;
  const LayerTable* table_;
  double dt_;
  InsertionLine line_;
  SkinPuncture skin_;
  MotionDetector motion_;
  Vec3 carried_J_ = Vec3::Zero();
  SampleWindow<double> depths_;
  SampleWindow<Eigen::Vector4d> orientations_;

  std::array<ShaftLayer, kMaxLayers> layers_{};
  std::size_t layer_count_ = 0;
  NeedleTick tick_;
  ContactState state_ = ContactState::away;
  std::uint32_t events_ = 0;
  RegionId region_ = kOutside;
  RegionId soft_region_ = kOutside;  // at the tip a tick ago, before bone
  bool inserted_ = false;
  bool adopt_ = true;
  bool on_bone_ = false;
  bool was_outside_ = true;
  bool gives_way_ = false;           // whether tissue does
  double lasting_ = 0;               // m, the dimple that decides whether a membrane holds
  double moved_ = 0;                 // m, the tip in this tick
  double bone_ = 0;                  // m, where bone is felt to begin while the tip is on it
  double held_ = 0;                  // m, how far the tip was in bone when its line last was
  Vec3 held_tip_ = Vec3::Zero();     // the tip there
  RegionId bone_region_ = kOutside;  // that bone
  double clearance_ = 0;             // m, of the tip from the first tissue of its line
  double open_ = 0;                  // m, deepest point of the cut track on this line
};

}  // namespace artus
