#pragma once
#include <opencv2/core.hpp>
#include <vector>

#include "synthetic/degradation.hpp"
#include "synthetic/random_field.hpp"
#include "synthetic/scene_geometry.hpp"
#include "synthetic/surface.hpp"

namespace vibe::vision {

/// The rectangle with so many pixels more on each side.
cv::Rect grown(const cv::Rect& rect, int by);

/// An exposure: from `begin` to `end` [s].
struct Exposure {
  double begin = 0, end = 0;
  double middle() const { return (begin + end) / 2; }
};

/// Draws a rectangle of the image: all that is in it, layer by layer, at 2 x 2 or 4 x 4 points per pixel and several
/// moments of the exposure; then the optics.
class TileRenderer {
 public:
  explicit TileRenderer(const SyntheticScene& scene);
  ~TileRenderer();

  /// Where object `i` is seen during the exposure, without the blur of the optics.
  cv::Rect boundsOf(std::size_t object, const Exposure& exposure) const;
  std::size_t objectCount() const { return objects_.size(); }
  const PixelKernel& kernel() const { return kernel_; }
  const Background& background() const { return background_; }
  const Occluder& occluder() const { return occluder_; }
  void setObject(std::size_t i, const SyntheticInstrument& object) { objects_[i] = object; }
  /// Of all markers, at full light [DN].
  void setInk(double black, double white) {
    scene_.black = black;
    scene_.white = white;
  }

  /// Mean grey values over the exposure, without vignetting, into image (rows of camera.width).
  void render(const cv::Rect& rect, const Exposure& exposure, float* image) const;

 private:
  struct Layer;   // an object at one moment
  struct Moment;  // all layers at one moment
  struct Grid;    // the sample points of a tile

  double pathLength(std::size_t object, const Exposure& exposure) const;
  cv::Rect boundsAt(std::size_t object, double time) const;
  std::vector<Moment> moments(const cv::Rect& rect, const Exposure& exposure, const Grid& grid) const;
  Grid makeGrid(const cv::Rect& rect, int samples) const;
  bool isSmoothed(const cv::Rect& rect, const Exposure& exposure) const;
  void backgroundRow(const Grid& grid, int sample_row, float* values) const;
  void layerRow(const Layer& layer, const Grid& grid, int sample_row, float* values, float* scratch) const;
  void occluderRow(double time, const Grid& grid, double y, float* values) const;

  SyntheticScene scene_;
  std::vector<SyntheticInstrument> objects_;
  std::vector<Highlights> highlights_;  // of instruments; look-alikes have none
  SensorMap map_;
  Background background_;
  PixelKernel kernel_, fine_kernel_;
  Occluder occluder_;
};

}  // namespace vibe::vision
