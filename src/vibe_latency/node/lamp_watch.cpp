#include "lamp_watch.hpp"

#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <chrono>
#include <memory>
#include <string>

#include "vibe_core/program/error.hpp"
#include "vibe_ros_utils/wall_clock.hpp"

namespace vibe::latency {
namespace {

constexpr unsigned long kLit = 0x00ff00, kDark = 0xff00ff;
constexpr int kRun = 32;  // so many pixels of the lamp's colour in a row and in a column are the lamp
constexpr std::chrono::milliseconds kReadPeriod(1), kSearchPeriod(200);

struct ImageDeleter {
  void operator()(XImage* image) const { XDestroyImage(image); }
};
using Image = std::unique_ptr<XImage, ImageDeleter>;

bool isLampAt(XImage* image, int x, int y) {
  const std::optional<bool> state = lampState(XGetPixel(image, x, y));
  if (!state) return false;
  for (int k = 1; k < kRun; ++k)
    if (lampState(XGetPixel(image, x + k, y)) != state || lampState(XGetPixel(image, x, y + k)) != state) return false;
  return true;
}

}  // namespace

std::optional<bool> lampState(unsigned long pixel) {
  switch (pixel & 0xffffff) {
    case kLit:
      return true;
    case kDark:
      return false;
    default:
      return std::nullopt;
  }
}

LampWatch::LampWatch(Callback changed) : changed_(std::move(changed)), display_(XOpenDisplay(nullptr)) {
  if (display_ == nullptr)
    throw Error(std::string("No X display to watch answers at DISPLAY='") + XDisplayName(nullptr) +
                "'; set DISPLAY to one that does, or ~screen to false.");
  root_ = DefaultRootWindow(display_);
  if (DefaultDepth(display_, DefaultScreen(display_)) != 24) {
    XCloseDisplay(display_);
    throw Error("The X display has not 24 bits per pixel; start it with that depth.");
  }
  thread_ = std::thread([this] { run(); });
}

LampWatch::~LampWatch() {
  stopping_ = true;
  thread_.join();
  XCloseDisplay(display_);
}

void LampWatch::run() {
  std::optional<bool> last;
  auto next = std::chrono::steady_clock::now();
  while (!stopping_) {
    if (!found_) {
      find();
      if (!found_) std::this_thread::sleep_for(kSearchPeriod);
      next = std::chrono::steady_clock::now();
      continue;
    }
    const std::optional<bool> state = readLamp();
    if (state && state != last) changed_(ros_utils::wallTime(), *state);
    if (state) last = state;
    next = std::max(next + kReadPeriod, std::chrono::steady_clock::now() - kReadPeriod);
    std::this_thread::sleep_until(next);
  }
}

void LampWatch::find() {
  const int screen = DefaultScreen(display_);
  const int width = DisplayWidth(display_, screen), height = DisplayHeight(display_, screen);
  const Image image(XGetImage(display_, root_, 0, 0, static_cast<unsigned>(width), static_cast<unsigned>(height),
                              AllPlanes, ZPixmap));
  if (!image) return;
  for (int y = 0; y + kRun < height; ++y) {
    for (int x = 0; x + kRun < width; ++x) {
      if (!isLampAt(image.get(), x, y)) continue;
      x_ = x + kRun / 2;
      y_ = y + kRun / 2;
      found_ = true;
      return;
    }
  }
}

std::optional<bool> LampWatch::readLamp() {
  const Image image(XGetImage(display_, root_, x_, y_, 1, 1, AllPlanes, ZPixmap));
  if (!image) return std::nullopt;
  return lampState(XGetPixel(image.get(), 0, 0));
}

}  // namespace vibe::latency
