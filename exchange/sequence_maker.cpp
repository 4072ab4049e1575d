// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/sequence_maker.h"

#include <utility>

#include "artus/detail/dataset/stored_sweep.h"

namespace artus {

Result<void> SequenceMaker::add(const PlacedPicture& picture, const Transducer& transducer) {
  if (sequence_.frames.empty()) {
    sequence_.width = picture.width;
    sequence_.height = picture.height;
  }
  if (picture.width != sequence_.width || picture.height != sequence_.height)
    return fail(
        ErrorCode::invalid,
        "frame " + std::to_string(sequence_.frames.size()) +
            " has another size (depth or transducer changed): all images of a sequence must have "
            "one size");
  SequenceFrame frame;
  frame.time = picture.time;
  frame.probe_to_reference = reference_.to_reference(picture.X_JP);
  frame.image_to_reference =
      chained(frame.probe_to_reference, image_to_probe(transducer, picture.pixel, picture.height));
  if (picture.X_JN) frame.needle_to_reference = reference_.to_reference(*picture.X_JN);
  frame.grey.assign(picture.grey.begin(), picture.grey.end());
  sequence_.frames.push_back(std::move(frame));
  return {};
}

Result<ImageSequence> sequence_of_sweep(const std::filesystem::path& folder) {
  constexpr double kApart = 0.04;  // s between poses that have no time
  SequenceMaker maker;
  const auto read = read_sweep(folder, [&](const StoredFrame& stored) {
    PlacedPicture picture;
    const auto number = static_cast<double>(maker.sequence().frames.size());
    picture.time = stored.pose.time.value_or(kApart * number);
    picture.X_JP = stored.pose.X_JP;
    picture.X_JN = stored.pose.X_JN;
    picture.pixel = stored.pixel;
    picture.width = stored.width;
    picture.height = stored.height;
    picture.grey = stored.grey;
    return maker.add(picture, stored.transducer);
  });
  ARTUS_TRY(read);
  if (maker.sequence().frames.empty())
    return fail(ErrorCode::invalid, "the sweep has no frame", folder.string());
  return maker.sequence();
}

}  // namespace artus
