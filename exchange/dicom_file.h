// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/exchange/sequence_file.h"

namespace artus {

/// What is said of a series besides its pixels.
struct DicomSeries {
  std::string joint;   ///< of the image's comment
  std::string engine;  ///< version
  std::string side;    ///< of the joint, "left" or "right"; else not said
  double pixel = 0;    ///< m, square
  std::string date{};  ///< of study and content, YYYYMMDD; empty: not said
  std::string time{};  ///< HHMMSS
};

/// Writes a sequence as one DICOM Ultrasound Multi-frame Image with its region's calibration. It is
/// DERIVED, of the patient "Simulated", and says "simulated" wherever people read; the needle's
/// truth is not in it. The same sequence has the same bytes and identifiers. Frames that are evenly
/// apart (within half of a microsecond) have FrameTime; others FrameTimeVector, each the time since
/// the one before; frames without times, as of a sweep, have FrameLabelVector, their numbers, and
/// no rate. PixelSpacing stands beside the region's calibration for readers that know no regions.
/// Requires: frames of one size. Errors: unreadable (cannot be written), failed (DCMTK's reason).
/// Source [DICOM] PS3.3 A.7, C.7.6.5, C.8.5.5, C.8.5.6.
[[nodiscard]] Result<void> write_dicom(const std::filesystem::path& file,
                                       const ImageSequence& sequence, const DicomSeries& series);

/// A page for people: red, green, blue.
struct ReportPage {
  int width = 0;                      ///< pixels
  int height = 0;                     ///< pixels
  std::vector<std::uint8_t> colours;  ///< (height, width, 3), colour fastest
};

/// Writes a page as a DICOM Secondary Capture Image of the same patient and study as `sequence`.
/// Errors: as write_dicom. Source [DICOM] PS3.3 A.8.1, C.8.6.
[[nodiscard]] Result<void> write_dicom_report(const std::filesystem::path& file,
                                              const ReportPage& page, const ImageSequence& sequence,
                                              const DicomSeries& series);

}  // namespace artus
