// SPDX-License-Identifier: AGPL-3.0-or-later
// Where liquid opens tissue, and how far.
#include "artus/soft/bolus.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "artus/core/check.h"
#include "artus/soft/cleft.h"
#include "artus/soft/parted_sheet.h"

namespace artus {
namespace {

constexpr double kEllipsoid = 4 * std::numbers::pi / 3;
constexpr double kTipSlide = 0.6;  // of a half length: the tip stays in its own
constexpr double kSlide = 0.5;
constexpr double kLeastSize = 0.35;   // of a full one's length and width
constexpr double kLeastTip = 1.5e-3;  // m, of the tip's own
constexpr double kThickest = 2.5e-3;  // m, half of an opening, before walls are parted
constexpr double kLeastFree = 0.7;    // of an opening that bone leaves
constexpr double kFilm = 0.3e-3;      // m of tissue between two

/// How a tissue is parted.
struct Parting {
  Vec3 full = Vec3::Ones();  // m, semi-axes of one that is full: along fibres, beside, toward skin
  double apart = 0;          // m between sheets; 0: one opens alone
  int rows = 0;              // of them behind each other along the fibres, to either side
  int beside = 0;            // the same beside the fibres
};

Parting parting_of(const CompiledJoint& joint, RegionId region, bool fibrous) {
  const TissueKind kind = joint.tissue_of(region).acoustic.kind;
  if (kind == TissueKind::muscle) return {Vec3(10e-3, 5e-3, 0.7e-3), 2e-3, 2, 1};
  if (kind == TissueKind::nerve) return {Vec3(12e-3, 3e-3, 1e-3), 1.2e-3, 2, 0};
  if (fibrous) return {Vec3(12e-3, 8e-3, 0.6e-3), 0.9e-3, 2, 1};
  return {Vec3(4e-3, 4e-3, 1e-3)};
}

Vec3 way_to_skin(const CompiledJoint& joint, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  Vec3 way = Vec3::UnitZ();
  for (const Interface& f : joint.mesh.interfaces) {
    if (f.front != kOutside && f.back != kOutside) continue;
    const Vec3 to = joint.mesh.vertices[f.vertices[0]] - p;
    if (to.squaredNorm() < least && to.norm() > 0) {
      least = to.squaredNorm();
      way = to.normalized();
    }
  }
  return way;
}

/// Unit, in columns: along the fibres at the tip, beside them, toward the skin. A region's one axis
/// is taken beside the skin: its walls say how it leans.
Eigen::Matrix3d axes_at(const CompiledJoint& joint, RegionId region, const Vec3& tip,
                        const FibreField& fibres, bool& fibrous) {
  constexpr double kUpright = 0.8;  // of fibres that run toward the skin
  const Vec3 skin = way_to_skin(joint, tip);
  Vec3 along = fibres ? fibres(region, tip) : Vec3(Vec3::Zero());
  if (!(along.norm() > 0.5) || std::abs(along.dot(skin)) > kUpright) {
    along = joint.regions[region].fibre_axis;
    along -= along.dot(skin) * skin;
  }
  fibrous = along.norm() > 0.1;
  along = fibrous ? along.normalized() : skin.unitOrthogonal();
  const Vec3 up = (skin - skin.dot(along) * along).normalized();
  Eigen::Matrix3d axes;
  axes << along, up.cross(along), up;
  return axes;
}

/// One on a sheet.
struct Patch {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  // m, along the tip's axes
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  double level = 0;
  Vec3 half = Vec3::Zero();  // m
  [[nodiscard]] Eigen::Vector2d beside() const { return {-along.y(), along.x()}; }
};

/// m from `from` along `way` to where the sheet leaves what it may open.
double reach(const PartedSheet& sheet, const Patch& patch, const Eigen::Vector2d& way,
             double farthest) {
  constexpr double kStride = 0.5e-3;  // m
  double free = 0;
  while (free < farthest && sheet.allows(patch.centre + (free + kStride) * way, patch.level))
    free += kStride;
  return free;
}

bool lies_within(const PartedSheet& sheet, const Patch& patch) {
  constexpr int kPoints = 24;
  for (int k = 0; k < kPoints; ++k) {
    const double turn = 2 * std::numbers::pi * k / kPoints;
    const Eigen::Vector2d rim = patch.half.x() * std::cos(turn) * patch.along +
                                patch.half.y() * std::sin(turn) * patch.beside();
    if (!sheet.allows(patch.centre + rim, patch.level) ||
        !sheet.allows(patch.centre + 0.6 * rim, patch.level))
      return false;
  }
  return true;
}

/// Keeps it within the walls, shifted by at most `slide` of a half length or width. False where its
/// middle is outside, or there is less room than `least`, m.
bool fit_between(const PartedSheet& sheet, double slide, const Eigen::Vector2d& least,
                 Patch& patch) {
  constexpr double kSmaller = 0.9;
  if (!sheet.allows(patch.centre, patch.level)) return false;
  for (const int k : {0, 1}) {
    const Eigen::Vector2d way = k == 0 ? patch.along : patch.beside();
    double& half = patch.half[k];
    const double ahead = reach(sheet, patch, way, 2 * half);
    const double behind = reach(sheet, patch, -way, 2 * half);
    half = std::min(half, (ahead + behind) / 2);
    const double most = slide * half;
    const double shift = std::clamp(std::clamp(0.0, half - behind, ahead - half), -most, most);
    half = std::min({half, ahead - shift, behind + shift});
    if (half < least[k]) return false;
    patch.centre += shift * way;
  }
  while (!lies_within(sheet, patch)) {
    patch.half.head<2>() *= kSmaller;
    if (patch.half.x() < least.x() || patch.half.y() < least.y()) return false;
  }
  return true;
}

/// Where liquid opens a tissue beside the tip, in the order of how far away: m along the tip's
/// axes, the last of them a level. `up`: of what opens; sheets behind it stay as they are.
std::vector<Vec3> places_of(const Parting& parting, double up) {
  constexpr int kSheets = 4;        // to either side of the tip's
  constexpr double kRow = 1.7;      // half lengths from one to the next along the fibres
  constexpr double kAside = 1.6;    // half widths beside them
  constexpr double kStagger = 0.4;  // half lengths by which sheets are shifted, there and back
  std::vector<Vec3> places;
  if (!(parting.apart > 0)) return places;
  for (int m = up > 0.75 ? 0 : -kSheets; m <= (up < 0.25 ? 0 : kSheets); ++m)
    for (int j = -parting.beside; j <= parting.beside; ++j)
      for (int i = -parting.rows; i <= parting.rows; ++i) {
        if (m == 0 && j == 0 && i == 0) continue;
        const double shift = m % 2 == 0 ? 0 : (m > 0 ? kStagger : -kStagger);
        // Neighbours lie half a sheet apart, so that they may overlap.
        const double between = (i + j) % 2 == 0 ? 0 : (up < 0.25 ? -0.5 : 0.5);
        places.emplace_back((kRow * i + shift) * parting.full.x(),
                            (kAside * j + 0.5 * shift) * parting.full.y(),
                            parting.apart * (m + between));
      }
  // A sheet away is as easy as half of a half length, or of a half width, away.
  const Vec3 easy(parting.full.x() / 2, parting.full.y() / 2, parting.apart);
  std::stable_sort(places.begin(), places.end(), [&](const Vec3& a, const Vec3& b) {
    return a.cwiseQuotient(easy).squaredNorm() < b.cwiseQuotient(easy).squaredNorm();
  });
  return places;
}

/// Places of one volume in one tissue.
class Places {
 public:
  Places(const CompiledJoint& joint, RegionId region, const Vec3& tip, const FibreField& fibres)
      : region_(region),
        axes_(axes_at(joint, region, tip, fibres, fibrous_)),
        parting_(parting_of(joint, region, fibrous_)),
        sheet_(joint, region, tip, axes_, fibres),
        bone_(find_bone_points(joint, tip)) {}

  [[nodiscard]] std::vector<Bolus> open(double volume);

 private:
  [[nodiscard]] Bolus bolus_of(const Patch& patch, double up) const;
  [[nodiscard]] double choose_side(const Patch& patch) const;
  [[nodiscard]] Patch tip_patch(double volume) const;
  [[nodiscard]] bool fits(Patch& patch) const;
  [[nodiscard]] double up_of(const Patch& patch) const;
  void grow(double volume);

  RegionId region_;
  bool fibrous_ = false;
  Eigen::Matrix3d axes_;
  Parting parting_;
  PartedSheet sheet_;
  std::vector<Vec3> bone_;
  double side_ = 0.5;  // share of an opening that goes up
  std::vector<Patch> patches_;
};

Bolus Places::bolus_of(const Patch& patch, double up) const {
  Bolus bolus{region_,    sheet_.point(patch.centre, patch.level), axes_,
              patch.half, kEllipsoid * patch.half.prod(),          up};
  Eigen::Matrix2d turn;
  turn << patch.along, patch.beside();
  bolus.axes.leftCols<2>() = axes_.leftCols<2>() * turn;
  bolus.slope = turn.transpose() * sheet_.slope(patch.centre);
  bolus.bend = turn.transpose() * sheet_.bend() * turn;
  return bolus;
}

/// Both ways where no bone lies on either, else the way that it leaves more free.
double Places::choose_side(const Patch& patch) const {
  constexpr double kAll = 0.99;
  const Cleft cleft(bolus_of(patch, 0.5), bone_);
  const double up = cleft.free_share(true);
  const double down = cleft.free_share(false);
  if (up > kAll && down > kAll) return 0.5;
  return up >= down ? 1 : 0;
}

/// The tip's own: so that after it opened the tip is in its middle.
Patch Places::tip_patch(double volume) const {
  Patch patch;
  patch.half = parting_.full;
  const double share = volume / (kEllipsoid * parting_.full.prod());
  if (!(parting_.apart > 0)) patch.half *= std::cbrt(share);
  const double half = patch.half.z() * (parting_.apart > 0 ? std::cbrt(std::min(1.0, share)) : 1);
  patch.level = sheet_.nearest_level((1 - 2 * side_) * half);
  patch.along = sheet_.along(patch.centre, patch.level);
  Patch fitted = patch;
  const Eigen::Vector2d least(kLeastTip, kLeastTip);
  return fit_between(sheet_, kTipSlide, least, fitted) ? fitted : patch;
}

bool Places::fits(Patch& patch) const {
  if (!fit_between(sheet_, kSlide, kLeastSize * parting_.full.head<2>(), patch)) return false;
  for (const Patch& other : patches_) {
    if (std::abs(other.level - patch.level) >= kFilm) continue;
    const Eigen::Vector2d way = patch.centre - other.centre;
    const double u = way.dot(patch.along) / (patch.half.x() + other.half.x());
    const double v = way.dot(patch.beside()) / (patch.half.y() + other.half.y());
    if (u * u + v * v < 1) return false;
  }
  const Cleft cleft(bolus_of(patch, up_of(patch)), bone_);
  return (up_of(patch) == 0 || cleft.free_share(true) > kLeastFree) &&
         (up_of(patch) == 1 || cleft.free_share(false) > kLeastFree);
}

/// What lies above the tip's sheet goes up and what lies below goes down, unless bone is there.
double Places::up_of(const Patch& patch) const {
  if (side_ != 0.5 || patches_.empty()) return side_;
  const double above = patch.level - patches_.front().level;
  return above == 0 ? 0.5 : (above > 0 ? 1 : 0);
}

/// No room for more: all become thicker, and where that is not enough wider.
void Places::grow(double volume) {
  double held = 0;
  for (const Patch& patch : patches_) held += kEllipsoid * patch.half.prod();
  const double growth = volume / held;
  const double half = patches_.front().half.z();
  const double thicker = std::min(growth, std::max(2 * half, kThickest) / half);
  const double wider = std::sqrt(growth / thicker);
  for (Patch& patch : patches_) patch.half = patch.half.cwiseProduct(Vec3(wider, wider, thicker));
}

std::vector<Bolus> Places::open(double volume) {
  side_ = choose_side(tip_patch(volume));
  patches_ = {tip_patch(volume)};
  double held = kEllipsoid * patches_.front().half.prod();
  for (const Vec3& place : places_of(parting_, side_)) {
    if (held >= volume) break;
    Patch patch;
    patch.half = parting_.full;
    patch.centre = place.head<2>();
    patch.level = patches_.front().level + place.z();
    patch.along = sheet_.along(patch.centre, patch.level);
    if (!fits(patch)) continue;
    held += kEllipsoid * patch.half.prod();
    patches_.push_back(patch);
  }
  if (held < volume) grow(volume);
  std::vector<Bolus> boluses;
  for (const Patch& patch : patches_) boluses.push_back(bolus_of(patch, up_of(patch)));
  boluses.back().volume -= std::max(0.0, held - volume);
  // Outermost first: a sheet that opens lies in tissue that nothing has moved yet.
  const auto farther = [&](std::size_t a, std::size_t b) {
    const double own = patches_.front().level;
    return std::abs(patches_[a].level - own) > std::abs(patches_[b].level - own);
  };
  std::vector<std::size_t> order;
  for (std::size_t k = patches_.size(); k-- > 0;) order.push_back(k);
  std::stable_sort(order.begin(), order.end(), farther);
  std::vector<Bolus> ordered;
  for (const std::size_t k : order) ordered.push_back(boluses[k]);
  return ordered;
}

}  // namespace

std::vector<Bolus> make_boluses(const CompiledJoint& joint, RegionId region, const Vec3& tip,
                                double volume, const FibreField& fibres) {
  ARTUS_REQUIRE(volume > 0, "a volume above 0");
  return Places(joint, region, tip, fibres).open(volume);
}

}  // namespace artus
