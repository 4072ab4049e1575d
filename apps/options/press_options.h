// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "artus/detail/apps/options/view_options.h"
#include "artus/detail/soft/solver/press.h"

namespace artus {

/// How hard the probe is pressed; neither: the body is rigid.
struct PressOptions {
  std::optional<double> newtons;
  std::optional<double> millimetres;

  std::string needle_direction;  ///< "in", "out"; empty: the needle drags nothing

  [[nodiscard]] bool wanted() const noexcept { return newtons || millimetres; }
};
void add_press_options(Command* command, PressOptions& options);

/// A probe pressed on a joint until nothing moved, and the body that then is.
struct PressedBody {
  Press press;
  std::shared_ptr<const DeformedBody> tissue;
};

/// Presses at `X_JP` as the flags say. Errors: malformed (force and depth), those of SoftBody and
/// press_with.
[[nodiscard]] Result<PressedBody> press(SoftBody& body, const Pose& X_JP,
                                        const PressOptions& options);

/// The face of a probe that `flag` named. Errors: unsupported, at `flag` (a curved one).
[[nodiscard]] Result<ProbeFace> pressing_face_at(const Transducer& transducer,
                                                 const std::string& flag);

/// A body whose probe has the face of `transducer`: as long as its row of scanlines, as wide as
/// ProbeFace has it. Errors: unsupported (a curved face, which contact does not know), those of
/// SoftBody::make.
[[nodiscard]] Result<SoftBody> make_soft_body(std::shared_ptr<const CompiledJoint> joint,
                                              const Pose& X_JP, const Transducer& transducer);

/// The pressed body with a needle in it that was last moved in `direction` ("out", or in), as
/// lead_to has it; `pressed` is of it from then on. Returns what the needle does, as JSON. Errors:
/// those of lead_to.
[[nodiscard]] Result<nlohmann::json> drag(const std::shared_ptr<const CompiledJoint>& joint,
                                          const Transducer& transducer, const NeedleView& needle,
                                          const std::string& direction, PressedBody& pressed);

/// The flag for commands that draw a needle in the pressed body.
void add_drag_option(Command* command, PressOptions& options);

/// The view of the pressed body: scene and probe pose of that state, the needle dragging what it
/// slides through when that is wanted. Nothing when no press is
/// wanted. Returns what the hand feels, as JSON. Errors: as press.
[[nodiscard]] Result<nlohmann::json> press(LoadedView& view, const PressOptions& options);

[[nodiscard]] nlohmann::json to_json(const Press& press);

/// One line of what `to_json` gives, with a word when the tissue has not come to rest. Nothing when
/// nothing was pressed.
void print_press(const nlohmann::json& press);

}  // namespace artus
