#pragma once
#include <cmath>
#include <functional>
#include <vector>

#include "vibe_vision/synthetic/renderer.hpp"
#include "vibe_vision/track/tracker.hpp"

namespace vibe::vision::test {

/// The needle driver of a named scene alone: a ring.
inline SyntheticScene ringScene(const std::string& name) {
  SyntheticScene scene = namedScene(name);
  scene.instruments = {scene.instruments.at(1)};
  return scene;
}

inline void moveAs(SyntheticScene& scene, std::function<double(double)> slide) {
  scene.instruments[0].motion.slide = std::move(slide);
}

inline void rest(SyntheticScene& scene, double slide) {
  moveAs(scene, [slide](double) { return slide; });
}

/// What a tracker says about the only instrument of a scene, against the truth.
struct RingErrors {
  int frames = 0, visible = 0, tracked = 0, wrong = 0, phantom = 0, lost_visible = 0;
  double sum = 0, squares = 0, normalised = 0;  ///< of the error along [px], [px^2], 1

  double bias() const { return sum / tracked; }
  double rms() const { return std::sqrt(squares / tracked); }
  double nees() const { return normalised / tracked; }

  void add(const Measurement& m, const SyntheticTruth& truth) {
    ++frames;
    const bool whole = truth.visible > 0.95;
    visible += whole ? 1 : 0;
    lost_visible += whole && !m.tracked() ? 1 : 0;
    if (!m.tracked()) return;
    const double error = m.along - truth.along;
    ++tracked;
    phantom += truth.visible < 0.25 ? 1 : 0;
    wrong += std::abs(error) > 5 ? 1 : 0;
    sum += error, squares += error * error, normalised += error * error / m.along_variance;
  }
};

/// @param skip  frames at the beginning that are tracked but not counted
inline RingErrors runRing(const SyntheticScene& scene, int frames, int skip = 0, std::uint64_t first = 0) {
  const Renderer renderer(scene);
  Tracker tracker(nominalConfig(scene));
  RingErrors errors;
  for (int i = 0; i < frames + skip; ++i) {
    const RenderedFrame rendered = renderer.render(first + static_cast<std::uint64_t>(i));
    const Measurement& m = tracker.track(rendered.frame)[0];
    if (i >= skip) errors.add(m, rendered.truth[0]);
  }
  return errors;
}

/// A frame of one grey value.
class PlainFrame {
 public:
  PlainFrame(const CameraModel& camera, std::uint8_t value, double stamp)
      : pixels_(static_cast<std::size_t>(camera.width) * camera.height, value) {
    frame_.image = {pixels_.data(), camera.width, camera.height, camera.width};
    frame_.sensor_width = camera.width, frame_.sensor_height = camera.height;
    frame_.stamp = stamp, frame_.exposure = 1e-3;
  }
  const Frame& frame() const { return frame_; }

 private:
  std::vector<std::uint8_t> pixels_;
  Frame frame_;
};

}  // namespace vibe::vision::test
