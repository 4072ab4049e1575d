// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>

#include "artus/core/result.h"
#include "artus/exchange/sequence_file.h"

namespace artus {

/// What is said of a series besides its pixels.
struct DicomSeries {
  std::string joint;         ///< of the image's comment
  std::string engine;        ///< version
  std::string side;          ///< of the joint, "left" or "right"; else not said
  double pixel = 0;          ///< m, square
  double frame_time = 0.04;  ///< s from frame to frame
};

/// Writes a sequence as one DICOM Ultrasound Multi-frame Image with its region's calibration. It is
/// DERIVED, of the patient "Simulated", and says "simulated" wherever people read; the needle's
/// truth is not in it. The same sequence has the same bytes and identifiers. Requires: frames of
/// one size. Errors: unreadable (cannot be written), failed (DCMTK's reason). Source [DICOM] PS3.3
/// A.7, C.8.5.5, C.8.5.6.
[[nodiscard]] Result<void> write_dicom(const std::filesystem::path& file,
                                       const ImageSequence& sequence, const DicomSeries& series);

}  // namespace artus
