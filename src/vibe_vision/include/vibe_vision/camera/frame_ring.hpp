#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "vibe_vision/synthetic/synthetic_scene.hpp"

namespace vibe::vision {

/// Pictures that a simulated camera shows in turn, forward and backward, so that nothing jumps. All have one size.
struct FrameRing {
  int width = 0, height = 0;                       ///< of the sensor [px]
  double rate = 147;                               ///< [Hz]
  double exposure = 1e-3;                          ///< with which they were drawn [s]
  std::vector<std::vector<std::uint8_t>> frames;   ///< grey values row by row
  std::vector<std::string> instruments;            ///< names; may be empty
  std::vector<std::vector<SyntheticTruth>> truth;  ///< by picture and instrument

  struct Turn {
    std::size_t index = 0;
    bool is_backward = false;
  };
  /// Of frame k since the beginning.
  Turn turnOf(std::uint64_t k) const;
};

/// Draws the pictures of a scene. The first and the last are chosen where the instruments hardly move, so that they
/// turn there without a jump of their speed. @param frames  at most; 0.4 MB each at 728 x 544
std::shared_ptr<const FrameRing> renderRing(const SyntheticScene& scene, int frames);

}  // namespace vibe::vision
