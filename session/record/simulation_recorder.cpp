// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/record/simulation_recorder.h"

namespace artus {

SimulationRecorder::SimulationRecorder(Simulation& simulation, Recording& recording,
                                       RecordedPictures pictures)
    : simulation_(simulation), recording_(recording), pictures_(pictures) {
  recording.head = make_head(simulation.joint(), simulation.params());
  recording.complete = true;
}

const HapticSnapshot& SimulationRecorder::step(const TickInput& input) {
  const HapticSnapshot& felt = simulation_.step(input);
  if (keeps_) recording_.ticks.push_back(to_record(felt));
  drawn_ = nullptr;
  if (simulation_.due() != nullptr) take_image(felt.input.tick);
  return felt;
}

void SimulationRecorder::take_image(std::uint64_t tick) {
  FrameRecord frame;
  frame.input = *simulation_.due();
  const ImagedBody& body = simulation_.advance();
  if (pictures_ == RecordedPictures::drawn && draws_) {
    drawn_ = &simulation_.render();
    shown_ = frame.input;
    frame = to_record(frame.input, *drawn_, simulation_.transducer());
  }
  if (body.packet) frame.packet = digest_of(*body.packet);
  if (!keeps_) return;
  if (body.packet) recording_.packets.push_back({tick + 1, *body.packet});
  // A picture that nobody draws is of no use where nothing gives way.
  const bool kept = pictures_ == RecordedPictures::drawn ? drawn_ != nullptr || body.packet
                                                         : pictures_ == RecordedPictures::listed;
  if (kept) recording_.frames.push_back(frame);
}

}  // namespace artus
