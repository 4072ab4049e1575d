// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <string>
#include <vector>

#include "artus/core/geometry.h"

/// The kit of a webcam and paper: printed markers on a probe mock, a syringe and a sheet under the
/// block, seen by one camera. Lengths are metres, poses X_AB as everywhere; C is the camera's frame
/// (x right, y down, z away from it), S the sheet's (x right, y up the page, z out of the paper), B
/// a body's own.
namespace artus::kit {

/// A square marker on a body: its corners in frame B as they are seen from outside, top left first,
/// then clockwise.
struct Marker {
  int id = 0;
  double side = 0;  ///< m
  std::array<Vec3, 4> corners{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  [[nodiscard]] Vec3 centre() const { return (corners[0] + corners[2]) / 2; }
  /// Out of the marker towards who sees it. Unit.
  [[nodiscard]] Vec3 normal() const;
};

/// A marker by its place and the directions that are right and down to who looks at it.
[[nodiscard]] Marker make_marker(int id, double side, const Vec3& centre, const Vec3& right,
                                 const Vec3& down);
/// Its pose: origin in its middle, x right, y up, z towards who sees it.
[[nodiscard]] Pose pose_of_marker(const Marker& marker);

/// A rigid thing with markers.
struct MarkerBody {
  std::string name;
  std::vector<Marker> markers;
};

/// Whose dominant hand holds the syringe: the parts of the other are mirrored, markers and their
/// numbers are the same.
enum class Hand { right, left };

/// A half-hexagon prism: three faces 40 degrees apart with two rows of markers. Frame B: origin in
/// the middle of the middle face, x right to who looks at it, y towards them, z down along the
/// prism.
struct PrismSize {
  double face = 0;    ///< m, width of a face and pitch of the rows
  double side = 0;    ///< m, of a marker
  double length = 0;  ///< m, along z
};
inline constexpr double kFaceTurn = 0.69813170079773179;        // rad: 40 degrees
inline constexpr PrismSize kSyringePrism{20e-3, 15e-3, 44e-3};  // m
inline constexpr PrismSize kProbePrism{27e-3, 20e-3, 57e-3};    // m
inline constexpr int kProbeId = 0;                              // ids 0 to 5
inline constexpr int kSyringeId = 6;                            // ids 6 to 11
inline constexpr int kPlungerId = 12;
inline constexpr int kSheetId = 13;            // ids 13 to 20
inline constexpr int kBoardId = 21;            // ids 21 to 37
inline constexpr double kPlungerSide = 12e-3;  // m, of its marker
inline constexpr double kStroke = 60e-3;       // m, of the plunger
inline constexpr double kFaceLength = 50e-3;   // m, of the probe mock's face
inline constexpr double kFaceWidth = 12e-3;    // m
inline constexpr double kTouchSpan = 23e-3;    // m from its middle to the marks at its ends
inline constexpr double kDivotsApart = 60e-3;  // m
inline constexpr double kSheetSide = 28e-3;    // m, of the sheet's markers

/// `scale`: printed length over wanted length of the paper, as the ruler shows; it changes the
/// markers' sides, and all of the sheet.
[[nodiscard]] MarkerBody make_probe_body(double scale = 1);
[[nodiscard]] MarkerBody make_syringe_body(double scale = 1);
/// The sheet under the block: eight markers around the place of the block. Frame S.
[[nodiscard]] MarkerBody make_sheet_body(double scale = 1);
/// The plunger's marker in the syringe's frame while the plunger is all the way in; it moves
/// along z.
[[nodiscard]] Marker make_plunger_marker(Hand hand, double scale = 1);

/// As drawn, before anything was calibrated: the needle (tip 90 mm in front of the prism's middle)
/// on the syringe, and the probe's face on the mock.
[[nodiscard]] Pose nominal_needle();
[[nodiscard]] Pose nominal_face(Hand hand);

}  // namespace artus::kit
