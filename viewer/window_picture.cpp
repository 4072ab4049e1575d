// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <utility>

#include <GLFW/glfw3.h>

#include "artus/detail/viewer/input/gamepad.h"
#include "artus/detail/viewer/panels/caption.h"
#include "artus/detail/viewer/window_loop.h"

namespace artus {

// The newest image, or while the scanner is frozen the one that the loop was left at.
void WindowLoop::take_image() {
  if (!session_.frozen()) {
    input_.image = session_.newest_image();
    fresh_image_ = input_.image != nullptr && input_.image->width > 0 &&
                   input_.image->input.number != shown_image_;
    if (fresh_image_) add_to_loop(*input_.image);
  } else {
    fresh_image_ = false;
  }
  input_.cine_size = cine_.size();
  if (cine_.size() > 0) {
    const std::size_t newest = cine_.size() - 1;
    const std::size_t at =
        session_.frozen() ? std::min(state_.cine.value_or(newest), newest) : newest;
    if (session_.frozen()) input_.image = &cine_.at(at);
    input_.cine_age = cine_.age(at);
    if (state_.labels && !state_.expert) input_.labels = cine_.labels(at);
    if (const std::uint64_t number = cine_.at(at).input.number; number != shown_body_image_) {
      shown_body_ = cine_.body(at);
      shown_body_image_ = number;
    }
  }
  upload_image();
  input_.grab = control_.grab();
  input_.gamepad = WindowEvents::gamepad_name();
  if (options_.turn_knobs) options_.turn_knobs(state_.controls);
}

// The picture with what is told of it, all of its own body.
void WindowLoop::add_to_loop(const ImageSnapshot& image) {
  body_ = image.body;
  cine_.add(image,
            find_picture_labels(*body_, to_pose(image.input.X_JP), image.width * image.pixel,
                                image.height * image.pixel, state_.language),
            glfwGetTime());
}

void WindowLoop::show(const ImageSnapshot& image, GlTexture& texture) const {
  if (state_.look.colour)
    texture.set_colour(image.width, image.height, displayed_colour(image, state_.look));
  else
    texture.set_grey(image.width, image.height, displayed_grey(image, state_.look));
}

void WindowLoop::upload_image() {
  if (input_.image == nullptr || input_.image->width == 0) return;
  const ImageSnapshot& image = *input_.image;
  const bool same_look = state_.look == shown_look_;
  state_.controls.motion = state_.look.motion();
  if (image.input.number != shown_image_ || !same_look || image_texture_.width() == 0) {
    show(image, image_texture_);
    shown_image_ = image.input.number;
    shown_look_ = state_.look;
  }
  input_.image_texture = image_texture_.id();
  if (state_.dual && input_.kept == nullptr) {
    kept_ = image;
    kept_.body = nullptr;
    show(image, kept_texture_);
    input_.kept = &kept_;
    input_.kept_texture = kept_texture_.id();
  }
  if (!state_.dual) input_.kept = nullptr;
}

// The body is the picture's, and so are the hands, unless the picture is an old one.
void WindowLoop::draw_joint() {
  constexpr std::int64_t kOld = 250'000'000;  // ns
  HapticSnapshot hands = input_.now;
  const FrameInput* of = input_.image == nullptr ? nullptr : &input_.image->input;
  if (of != nullptr && hands.input.device.time_ns - of->sample_time_ns < kOld) {
    hands.X_JP = of->X_JP;
    hands.X_JN = of->X_JN;
  }
  input_.joint_texture = joint_->draw(area_.width, area_.height,
                                      {hands, needle_pose(hands, input_.needle), shown_body_,
                                       input_.image, image_texture_, input_.entry});
  joint_took_ = joint_->drew() ? joint_->took() : 0;
}

Caption WindowLoop::caption() const {
  Caption caption;
  caption.language = state_.language;
  caption.patient = state_.patient;
  const std::string& side = session_.scene().joint().side;
  if (side == "left" || side == "right")
    caption.side = translate(state_, side == "left" ? msgid("left") : msgid("right"));
  caption.date = date_of_now();
  const auto calipers = state_.calipers.find(input_.image->input.number);
  if (calipers != state_.calipers.end()) caption.calipers = calipers->second;
  caption.look = state_.look;
  caption.mark = &mark_;
  caption.doppler_limit = session_.params().image.doppler_limit;
  return caption;
}

void WindowLoop::save_pictures(double elapsed) {
  if (input_.image == nullptr || input_.image->width == 0) return;
  const ImageSnapshot& image = *input_.image;
  if (std::exchange(state_.wants_screenshot, false))
    say(saver_.save(image, caption(), options_.plain));
  if (saver_.in_clip()) saver_.add_to_clip(image, state_.look, elapsed);
  if (std::string said = saver_.take_written(state_.language); !said.empty()) say(std::move(said));
  if (state_.wants_clip == saver_.in_clip()) return;
  if (state_.wants_clip)
    say(saver_.begin_clip(image, state_.language));
  else
    saver_.end_clip();
  state_.wants_clip = saver_.in_clip();  // it may have been refused
}

}  // namespace artus
