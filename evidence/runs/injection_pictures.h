// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "artus/detail/evidence/claim.h"
#include "artus/detail/evidence/runs/injection_run.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/needle_view.h"
#include "artus/echo/transducer.h"

namespace artus {

/// What an injection looks like, and what of it can be measured in the body that is drawn.
struct InjectionPictures {
  std::vector<std::string> files;  ///< before.png, during.png, after.png; names in the folder
  double opening = 0;       ///< m by which a space's walls are apart more than before; 0 for tissue
  bool confined = false;    ///< the space is too small for a patch: all of it opens
  double length = 0;        ///< m, twice the farthest from the tip at which they are so by half
  double width = 0;         ///< m across a disc of the area on which they are so by half
  double ray_volume = 0;    ///< m^3 of liquid that parallel rays half a millimetre apart find more
                            ///< than before
  double label_volume = 0;  ///< m^3 of it in the labels of slices a millimetre apart, the same
  double label_area = 0;    ///< m^2 of liquid in the labels after, its space's own included
  double ray_area = 0;      ///< m^2 of the same by rays across the picture's plane
  double beam_opening = 0;  ///< m of liquid, more than before, where that is most along a beam
  double seen_opening =
      0;                  ///< m of the same square to the layer: at the slant at which it is least
  double seen_width = 0;  ///< m across the plane, at that slant, where it is at least half as much
  double drawn_volume = 0;  ///< m^3 that the shapes were made of
  std::vector<std::string>
      overflow;            ///< what a space could not take, and where it went, a line each
  HealthQuestion at_rest;  ///< the body after beside that before
};

struct InjectionPictureOptions {
  Transducer transducer;
  ImageSettings settings;
  NeedleShape needle;
};

/// Draws the plane of the needle before, half way and after, B-mode above the labels. The probe
/// lies on the skin with the needle in its plane. Errors: unreadable.
[[nodiscard]] Result<InjectionPictures> write_injection_pictures(
    const std::shared_ptr<const Scene>& scene, const InjectionRun& run,
    const InjectionPictureOptions& options, const std::filesystem::path& folder);

/// The same plane from two seconds before the thumb pushes until two after, in 36 pictures of four
/// seconds however long it took, with time, volume, force and pressure in each. Returns the file's
/// name in the folder: injection.mp4, or .avi where there is no codec. Errors: invalid (nothing was
/// injected), unreadable, unsupported.
[[nodiscard]] Result<std::string> write_injection_video(const std::shared_ptr<const Scene>& scene,
                                                        const InjectionRun& run,
                                                        const InjectionPictureOptions& options,
                                                        const std::filesystem::path& folder);

/// That rays and labels find what was given, within 5 %.
[[nodiscard]] std::vector<Claim> claims_of(const InjectionPictures& pictures);

/// A bursa after 5 ml beside published ones, which open by 2 to 6 mm over 10 to 30 mm: what this
/// says is true of the model, not of an injection. Empty for other targets and volumes.
[[nodiscard]] std::vector<Claim> compare_with_published(const InjectionRun& run,
                                                        const InjectionPictures& pictures);

}  // namespace artus
