#pragma once
#include <Eigen/Core>
#include <vector>

#include "vibe_vision/synthetic/renderer.hpp"

namespace vibe::vision {

/// What is black on the markers of a picture, in pixels that are black altogether: from the difference to the picture
/// in which the ink is as white as the paper.
inline std::vector<double> blackPart(SyntheticScene scene, std::uint64_t index) {
  const std::vector<float> picture = Renderer(scene).renderExpected(index);
  const double contrast = scene.white - scene.black;
  scene.black = scene.white;
  const std::vector<float> paper = Renderer(scene).renderExpected(index);
  std::vector<double> black(picture.size());
  for (std::size_t i = 0; i < black.size(); ++i) black[i] = (static_cast<double>(paper[i]) - picture[i]) / contrast;
  return black;
}

struct Moments {
  double area = 0;
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero(), variance = Eigen::Vector2d::Zero();
};

inline Moments momentsOf(const std::vector<double>& picture, int width) {
  Moments m;
  Eigen::Vector2d square = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const Eigen::Vector2d pixel(static_cast<int>(i) % width, static_cast<int>(i) / width);
    m.area += picture[i];
    m.centroid += picture[i] * pixel;
    square += picture[i] * pixel.cwiseAbs2();
  }
  m.centroid /= m.area;
  m.variance = square / m.area - m.centroid.cwiseAbs2();
  return m;
}

/// The standard scene with only one of its instruments, at rest.
inline SyntheticScene restingScene(std::size_t instrument, double slide, double rotation = 0) {
  SyntheticScene scene = standardScene();
  scene.instruments = {scene.instruments.at(instrument)};
  scene.instruments[0].motion.slide = [slide](double) { return slide; };
  scene.instruments[0].motion.rotation = [rotation](double) { return rotation; };
  return scene;
}

/// A lens as in the scene "light".
inline void bendLens(SyntheticScene& scene) {
  scene.camera = namedScene("light").camera;
  scene.degradation.distortion = scene.camera.distortion;
}

}  // namespace vibe::vision
