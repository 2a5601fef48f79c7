#pragma once
#include <sys/resource.h>

#include <cstdio>
#include <memory>

#include "camera/host_time.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_vision/camera/fake_camera.hpp"
#include "vibe_vision/camera/frame_source.hpp"

namespace vibe::vision {

constexpr double kForever = 60;  ///< within which anything has to happen on a busy machine [s]

/// Picture k is a gradient whose grey values begin at k.
inline std::shared_ptr<const FrameRing> gradientRing(int width = 320, int height = 200, int count = 20) {
  auto ring = std::make_shared<FrameRing>();
  ring->width = width;
  ring->height = height;
  for (int k = 0; k < count; ++k) {
    std::vector<std::uint8_t> picture(static_cast<std::size_t>(width * height));
    for (int i = 0; i < width * height; ++i) {
      picture[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(k + i % width + 3 * (i / width));
    }
    ring->frames.push_back(std::move(picture));
    ring->truth.emplace_back(1);
    ring->truth.back()[0].slide = k;
  }
  ring->instruments = {"picture"};
  return ring;
}

/// Waits while another test of this computer has the port.
inline std::unique_ptr<FakeCamera> plugIn(const FakeCameraOptions& options = {},
                                          const std::shared_ptr<const FrameRing>& ring = gradientRing()) {
  const double deadline = steadyTime() + kForever;
  while (true) {
    try {
      return std::make_unique<FakeCamera>(ring, options);
    } catch (const Error&) {
      if (steadyTime() > deadline) throw;
    }
    sleepFor(0.2);
  }
}

/// Reads until a frame comes. @return whether one came
inline bool readFrame(FrameSource& source, Frame& frame, double patience = kForever) {
  const double deadline = steadyTime() + patience;
  while (steadyTime() < deadline) {
    if (source.read(frame, 0.1) == ReadResult::Frame) return true;
  }
  return false;
}

/// Reads, and throws frames away, until the condition holds. @return whether it does
template <class Condition>
bool readUntil(FrameSource& source, Condition condition, double patience = kForever) {
  const double deadline = steadyTime() + patience;
  Frame frame;
  while (!condition() && steadyTime() < deadline) source.read(frame, 0.05);
  return condition();
}

/// Of this process [bytes].
inline long residentMemory() {
  long pages = 0, resident = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%ld %ld", &pages, &resident) != 2) resident = 0;
    std::fclose(file);
  }
  return resident * 4096;
}

}  // namespace vibe::vision
