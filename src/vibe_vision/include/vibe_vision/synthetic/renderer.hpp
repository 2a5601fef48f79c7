#pragma once
#include <memory>
#include <vector>

#include "vibe_vision/image/frame.hpp"
#include "vibe_vision/synthetic/synthetic_scene.hpp"

namespace vibe::vision {

struct RenderedFrame {
  Frame frame;                        ///< owns its pixels
  std::vector<SyntheticTruth> truth;  ///< by instrument
};

/// Draws what the camera of a scene sees: surfaces are sampled finely in space and over the exposure, then blurred by
/// the optics, lit, and read out with noise. It shares no code with the tracker except the marker designs and the
/// camera model. Frame k is the same whenever it is drawn.
class Renderer {
 public:
  /// Prepares the scene, a copy of which is kept.
  explicit Renderer(const SyntheticScene& scene);
  ~Renderer();
  Renderer(Renderer&&) noexcept;  ///< leaves the other unusable
  Renderer& operator=(Renderer&&) noexcept;
  /// @param index  frame number; the middle of its exposure is at start + index / rate
  RenderedFrame render(std::uint64_t index, double start = 0) const;
  /// Expected grey values before noise and rounding, row by row.
  std::vector<float> renderExpected(std::uint64_t index) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vibe::vision
