// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/meshes/generate/solids/surfacing.h"

namespace artus {

/// The sizes of a glenohumeral joint, m. Everything scales with the head; the thin layers keep
/// their own thickness.
struct ShoulderSize {
  double head_radius = 24e-3;        ///< bony humeral head
  double cartilage = 1.5e-3;         ///< on the head, and on the glenoid
  double tendon_thickness = 5.6e-3;  ///< supraspinatus over the head
  double bursa = 0.8e-3;             ///< subacromial-subdeltoid
  double peribursal_fat = 0.6e-3;    ///< on each side of the bursa
  double deltoid = 12.5e-3;
  double fat = 6e-3;     ///< between deltoid and skin
  double skin = 1.8e-3;  ///< the joint file makes this layer as a shell of the body surface
};

/// The solids of a right shoulder: `body` (outer skin) first, then bones, cartilage and soft
/// tissue. They overlap; the joint file's priority decides. Frame J is centred on the humeral head,
/// axes LPS (lateral is -x), m. Requires: all sizes > 0.
[[nodiscard]] std::vector<Solid> make_shoulder(const ShoulderSize& size);

/// The parts make_shoulder puts together, for tests: bones with cartilage and labrum; muscles,
/// bursa, capsule and body; nerves and vessels.
[[nodiscard]] std::vector<Solid> make_shoulder_bones(const ShoulderSize& size);
[[nodiscard]] std::vector<Solid> make_shoulder_soft_tissue(const ShoulderSize& size);
[[nodiscard]] std::vector<Solid> make_shoulder_vessels(const ShoulderSize& size);
/// What only some variants of the joint have: deposit, tear, recess, ligaments, the
/// acromioclavicular joint, what lies around the suprascapular nerve.
[[nodiscard]] std::vector<Solid> make_shoulder_variants(const ShoulderSize& size);

/// The cuff: each tendon, which thins to its footprint and into its muscle, and each belly.
[[nodiscard]] std::vector<Solid> make_shoulder_cuff(const ShoulderSize& size);

/// Humerus with tuberosities, facets and bicipital groove.
[[nodiscard]] Field make_humerus(const ShoulderSize& size);

/// Humerus, cuff and sheath of the biceps as one smooth side, on which the bursa lies.
[[nodiscard]] Field make_shoulder_cuff_side(const ShoulderSize& size);

/// The outer skin.
[[nodiscard]] Field make_shoulder_body(const ShoulderSize& size);

}  // namespace artus
