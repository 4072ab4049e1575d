// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/core/fields.h"
#include "artus/detail/haptics/needle/needle_params.h"
#include "artus/detail/haptics/passivity.h"

namespace artus {

/// Which law a run takes: for all tissues when set, and exceptions by tissue name. What it leaves
/// open is the tissue's own choice (Haptic::cutting_law, prepuncture_law).
template <class Law>
struct LawChoice {
  std::optional<Law> all;
  std::map<std::string, Law> of_tissue;
};

/// A patient's deviation from the tissue library; each factor multiplies the tissue's value.
struct PatientProfile {
  double cutting = 1;
  double friction = 1;
  double attracted = 1;
  double clamping = 1;
  double puncture = 1;
};
ARTUS_FIELDS(PatientProfile, cutting, friction, attracted, clamping, puncture);

/// What a run changes of how the needle feels; what is not set is as published. The one form in
/// which a choice of force laws travels: from flags or a recording to a session, an experiment or
/// the medical test.
struct NeedleFeel {
  LawChoice<CuttingLaw> cutting;
  LawChoice<PrepunctureLaw> prepuncture;
  PatientProfile patient;
  std::optional<HardLaw> tap;
  std::optional<ClampingLaw> clamping;
  std::optional<LugreParams> friction;
  std::optional<HemisphereParams> workspace;
  std::optional<double> needle_length;  ///< m, hub to tip
  bool passivity_control = false;
};

/// What can be changed; bits, each with a name.
struct FeelKind {
  static constexpr std::uint32_t kCutting = 1U << 0U;
  static constexpr std::uint32_t kPrepuncture = 1U << 1U;
  static constexpr std::uint32_t kTap = 1U << 2U;
  static constexpr std::uint32_t kClamping = 1U << 3U;
  static constexpr std::uint32_t kFriction = 1U << 4U;
  static constexpr std::uint32_t kPatient = 1U << 5U;
  static constexpr std::uint32_t kWorkspace = 1U << 6U;
  static constexpr std::uint32_t kNeedleLength = 1U << 7U;
  static constexpr std::uint32_t kPassivity = 1U << 8U;
  static constexpr std::uint32_t kAll = (1U << 9U) - 1;
};
/// "cutting", "tap", ...: the name of NeedleFeel's member; empty for no kind or several.
[[nodiscard]] std::string_view feel_kind_name(std::uint32_t kind) noexcept;
/// The kinds that `feel` changes.
[[nodiscard]] std::uint32_t changed(const NeedleFeel& feel);

/// Who is to be felt so: a joint with its tissues, or an experiment with its layers.
struct FeelScope {
  std::string what;                      ///< "the joint", "wall-move"
  std::vector<std::string> tissues;      ///< the names that a law can be chosen for
  std::uint32_t takes = FeelKind::kAll;  ///< what may be changed
  std::string why_not;                   ///< why not the rest: "has a tissue that only cuts"
};
[[nodiscard]] FeelScope scope_of(const CompiledJoint& joint);

/// Whether `feel` has values that a tissue, a needle and a hand can have, and changes only what
/// `scope` takes. Errors: invalid (a value, a kind that is not taken), not_found (a tissue);
/// `where` is the kind's name.
[[nodiscard]] Result<void> check(const NeedleFeel& feel, const FeelScope& scope);
/// The values alone.
[[nodiscard]] Result<void> validate(const NeedleFeel& feel);

/// The parameters as `feel` wants them.
void apply(const NeedleFeel& feel, NeedleParams& needle) noexcept;
void apply(const NeedleFeel& feel, PassivityParams& passivity) noexcept;
/// A layer of the tissue `name`: its laws chosen, its values times the patient's factors.
void apply(const NeedleFeel& feel, const std::string& name, LayerHaptics& layer);

/// The layers of a joint as the tick looks them up. Requires: regions that index the tissues.
[[nodiscard]] LayerTable make_layer_table(const CompiledJoint& joint, const NeedleFeel& feel = {});

}  // namespace artus
