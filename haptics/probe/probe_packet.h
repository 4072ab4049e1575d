// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "artus/core/geometry.h"
#include "artus/detail/core/check.h"

namespace artus {

/// A face of the probe and the curve by which the tissue before it answers: at a point of the face
/// that is `d` below the skin, F(d) = k/b (e^(b d) - 1) times the point's share of the face, k the
/// stiffness of the whole face where it touches and b how fast it hardens.
struct TissueCurve {
  double stiffness = 0;    ///< N/m, k; 0: nothing is known
  double hardening = 200;  ///< 1/m, b; assumed before a press was felt: a shoulder's
  double slope_x = 0;      ///< 1/m, of k along x of the face, as a share of k
  double slope_y = 0;      ///< 1/m
};

/// What the tissue of one image tells a probe: the skin before its face as nothing presses it, and
/// the tissue's curve. Plain numbers: handed from thread to thread, and recorded.
struct ProbePacket {
  static constexpr std::size_t kColumns = 13;  ///< of the skin's heights, along x
  static constexpr std::size_t kRows = 7;      ///< along y

  std::uint64_t number = 0;                  ///< grows with every packet; 0: there is none
  std::uint64_t tick = 0;                    ///< of the pose that it answers
  std::array<double, 12> X_JF{};             ///< first three rows of the pose of frame F
  std::array<double, kColumns * kRows> z{};  ///< m, height of the skin along z of F, which points
                                             ///< into the body; about F's origin, x fastest
  double spacing_x = 0;                      ///< m between the heights; 0: no skin is near
  double spacing_y = 0;                      ///< m
  double length = 0;                         ///< m, of the face along x
  double width = 0;                          ///< m, along y
  TissueCurve curve;
};

/// Points of a probe's face, with what the skin of a packet is at each.
class FaceDepths {
 public:
  static constexpr int kColumns = 12;
  static constexpr int kRows = 4;
  static constexpr Eigen::Index kPoints = kColumns * kRows;
  using Row = Eigen::Array<double, kPoints, 1>;

  /// Places of the points in the plane of a face of this size, m.
  ARTUS_REALTIME void set_face(double length, double width) noexcept;
  /// Looks at the skin of `packet` with the face at `X_JP`. Requires: a packet with skin.
  ARTUS_REALTIME void look(const ProbePacket& packet, const Pose& X_JP) noexcept;

  [[nodiscard]] const Row& x() const noexcept { return x_; }          ///< m, frame P
  [[nodiscard]] const Row& y() const noexcept { return y_; }          ///< m, frame P
  [[nodiscard]] const Row& depth() const noexcept { return depth_; }  ///< m below the skin, along F
  [[nodiscard]] const Row& slope_x() const noexcept { return slope_x_; }  ///< of the skin, along F
  [[nodiscard]] const Row& slope_y() const noexcept { return slope_y_; }
  /// Share of each point in the curve's stiffness; their sum is near 1.
  [[nodiscard]] ARTUS_REALTIME Row shares(const TissueCurve& curve) const noexcept;

 private:
  Row x_ = Row::Zero();
  Row y_ = Row::Zero();
  Row depth_ = Row::Zero();
  Row slope_x_ = Row::Zero();
  Row slope_y_ = Row::Zero();
};

/// The pose of a packet's frame F.
[[nodiscard]] ARTUS_REALTIME Pose frame_of(const ProbePacket& packet) noexcept;
/// Whether all its numbers can be: finite, k and b not negative.
[[nodiscard]] ARTUS_REALTIME bool is_packet(const ProbePacket& packet) noexcept;

/// Force, stiffness and energy of a curve of unit stiffness at depth d (m); 0 off the skin. Beyond
/// b d = kStraight it goes on straight: tissue pressed so far is felt as a wall already.
struct UnitCurve {
  static constexpr double kStraight = 4;
  FaceDepths::Row force;      ///< m: N by N/m
  FaceDepths::Row stiffness;  ///< by N/m
  FaceDepths::Row energy;     ///< m^2: J by N/m
};
[[nodiscard]] ARTUS_REALTIME UnitCurve unit_curve(const FaceDepths::Row& depth,
                                                  double hardening) noexcept;

/// What a face at `X_JP` feels of a packet once all has come to rest, along the face's axis.
struct ForceAtRest {
  double force = 0;      ///< N out of the body
  double stiffness = 0;  ///< N/m
};
[[nodiscard]] ARTUS_REALTIME ForceAtRest force_at_rest(const ProbePacket& packet,
                                                       const Pose& X_JP) noexcept;

}  // namespace artus
