// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/support/x_actor.h"

#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

// After all others: these headers define short words as macros.
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>

namespace artus::test {
namespace {

void rest(int ms) {
  std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

}  // namespace

struct XActor::Impl {
  Display* display = nullptr;
};

XActor::XActor(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

std::unique_ptr<XActor> XActor::open() {
  auto impl = std::make_unique<Impl>();
  impl->display = XOpenDisplay(nullptr);
  if (impl->display == nullptr) return nullptr;
  int event = 0;
  int error = 0;
  int major = 0;
  int minor = 0;
  if (XTestQueryExtension(impl->display, &event, &error, &major, &minor) == 0) {
    XCloseDisplay(impl->display);
    return nullptr;
  }
  return std::unique_ptr<XActor>(new XActor(std::move(impl)));
}

XActor::~XActor() {
  XCloseDisplay(impl_->display);
}

void XActor::move(double x, double y) {
  XTestFakeMotionEvent(impl_->display, -1, static_cast<int>(std::lround(x)),
                       static_cast<int>(std::lround(y)), 0);
  XFlush(impl_->display);
}

void XActor::move_by(int dx, int dy) {
  XTestFakeRelativeMotionEvent(impl_->display, dx, dy, 0);
  XFlush(impl_->display);
}

void XActor::button(int which, bool down) {
  XTestFakeButtonEvent(impl_->display, static_cast<unsigned>(which), down ? True : False, 0);
  XFlush(impl_->display);
}

void XActor::click(double x, double y, int ms) {
  move(x, y);
  rest(5);
  button(1, true);
  rest(ms);
  button(1, false);
}

void XActor::drag(double x, double y, double to_x, double to_y) {
  move(x, y);
  rest(60);
  button(1, true);
  for (int i = 1; i <= 10; ++i) {
    rest(20);
    move(x + 0.1 * i * (to_x - x), y + 0.1 * i * (to_y - y));
  }
  rest(60);
  button(1, false);
}

void XActor::wheel(int notches) {
  const int which = notches > 0 ? 4 : 5;
  for (int i = 0; i < std::abs(notches); ++i) {
    button(which, true);
    button(which, false);
    rest(4);
  }
}

void XActor::key(const std::string& name, const std::string& modifier) {
  const auto code = [this](const std::string& key) {
    return XKeysymToKeycode(impl_->display, XStringToKeysym(key.c_str()));
  };
  if (!modifier.empty()) XTestFakeKeyEvent(impl_->display, code(modifier), True, 0);
  XTestFakeKeyEvent(impl_->display, code(name), True, 0);
  XFlush(impl_->display);
  rest(15);
  XTestFakeKeyEvent(impl_->display, code(name), False, 0);
  if (!modifier.empty()) XTestFakeKeyEvent(impl_->display, code(modifier), False, 0);
  XFlush(impl_->display);
  rest(10);
}

void XActor::key_at(int keycode) {
  XTestFakeKeyEvent(impl_->display, static_cast<unsigned>(keycode), True, 0);
  XFlush(impl_->display);
  rest(15);
  XTestFakeKeyEvent(impl_->display, static_cast<unsigned>(keycode), False, 0);
  XFlush(impl_->display);
  rest(10);
}

void XActor::save_screen(const std::filesystem::path& file, int width, int height) {
  XImage* image =
      XGetImage(impl_->display, DefaultRootWindow(impl_->display), 0, 0,
                static_cast<unsigned>(width), static_cast<unsigned>(height), AllPlanes, ZPixmap);
  if (image == nullptr) return;
  const cv::Mat view(height, width, CV_8UC4, image->data,
                     static_cast<std::size_t>(image->bytes_per_line));
  cv::Mat colours;
  std::vector<cv::Mat> planes;
  cv::split(view, planes);
  planes.resize(3);
  cv::merge(planes, colours);
  cv::imwrite(file.string(), colours);
  XDestroyImage(image);
}

}  // namespace artus::test
