// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>

#include <opencv2/core.hpp>

#include "artus/detail/evidence/gate.h"
#include "artus/echo/image_io.h"

/// Gates of the image's physics, one function each, measured on rendered frames with the default
/// transducer; gates.h runs them by name. "Reference" is the wave model or the literature that
/// docs/echography.md names for each bound. Cost: 0.1 to a few s each.
namespace artus {

/// A picture that goes with a gate.
inline void add_picture(Gate& gate, const std::string& name, const cv::Mat& image) {
  gate.files.push_back(
      {"pictures/" + name + "-image.png", [image](const std::filesystem::path& file) {
         return write_image(image, file);
       }});
}

/// Envelope statistics of a homogeneous block against fully developed speckle.
[[nodiscard]] Gate gate_speckle();
/// Width of point targets beside the axis against 0.97 wavelengths times the F-number.
[[nodiscard]] Gate gate_lateral_width();
/// Width of point targets across the plane against the wave model, by element height and depth.
[[nodiscard]] Gate gate_slice_width();
/// Fall of the speckle with depth against twice the attenuation.
[[nodiscard]] Gate gate_attenuation();
/// Two tissues of one impedance: no echo between them.
[[nodiscard]] Gate gate_matched_impedance();
/// Echo levels of tissue pairs against their impedance step.
[[nodiscard]] Gate gate_interfaces();
/// A layer of fat shifts what lies below it.
[[nodiscard]] Gate gate_fat_shift();
/// A layer of fluid brightens what lies below it.
[[nodiscard]] Gate gate_enhancement();
/// Tendon against muscle by the beam's tilt.
[[nodiscard]] Gate gate_tendon();
/// Spacing of the lines below a 22 G needle.
[[nodiscard]] Gate gate_needle_rings();
/// Brightness of a needle by its angle to the face.
[[nodiscard]] Gate gate_needle_angle();
/// Brightness of a needle beside the plane.
[[nodiscard]] Gate gate_needle_offset();
/// Rigid motion, sideways motion, thread count.
[[nodiscard]] Gate gate_motion();

}  // namespace artus
