// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/hand_options.h"

#include <utility>

namespace artus {

void add_hand_options(Command* command, HandOptions& options) {
  add_joint_options(command, options.joint);
  add_imaging_options(command, options.view);
  add_feel_options(command, options.feel);
  add_device_option(command, options.device);
  command->add_option("--liquid", options.liquid, "of meshes/liquids.toml")->capture_default_str();
  command->add_option("-o,--out", options.out, "folder for the results")->required();
  command->add_flag("--no-images", options.no_images, "forces alone");
  command->add_flag("--no-video", options.no_video, "pictures of the named moments alone");
  command->add_flag("--json", options.json, "print the summary as JSON");
}

Result<LoadedHand> load_hand(const HandOptions& options) {
  auto loaded = load_view(options.joint, options.view, options.json);
  ARTUS_TRY(loaded);
  FeelOptions feel_options = options.feel;
  feel_options.needle_length_mm = options.view.needle_length_mm;
  const auto feel = make_feel(feel_options, loaded->joint());
  ARTUS_TRY(feel);
  return LoadedHand{std::move(*loaded), *feel};
}

}  // namespace artus
