// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "artus/detail/echo/display/frame_measure.h"
#include "artus/echo/frame.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/needle_view.h"
#include "artus/raycast/scene.h"
#include "tests/support/layered_body.h"

namespace artus::test {

/// A layered block, 80 mm x 60 mm, its top in z = 0; `change` edits the joint before it is indexed.
[[nodiscard]] std::shared_ptr<const Scene> make_block_scene(
    std::span<const FlatLayer> layers, const std::function<void(CompiledJoint&)>& change = {});

/// The acoustic values of a tissue of the joint. Requires: there is one of this name.
[[nodiscard]] Acoustic& acoustic_of(CompiledJoint& joint, const std::string& tissue);

using artus::bare_settings;
using artus::decibel;
using artus::envelope_line;
using artus::find_peak;
using artus::mean_intensity;
using artus::raw_settings;

/// A probe on the block's top looking along +z, moved by (x, y, z) m.
[[nodiscard]] Pose probe_at(double x = 0, double y = 0, double z = 0);

/// A needle whose tip is at (x, y, z) of the probe's frame, dipping by `angle` rad toward +x.
[[nodiscard]] NeedleView needle_at(const Pose& X_JP, const Vec3& tip_P, double angle);

}  // namespace artus::test
