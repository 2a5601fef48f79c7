#pragma once
#include <OgreMaterial.h>
#include <OgreTexture.h>

#include <QImage>
#include <string>
#include <vector>

#include "vibe_graphics/geometry/colour_map.hpp"

namespace Ogre {
class Overlay;
class OverlayContainer;
}  // namespace Ogre

namespace vibe::rviz_plugins {

/// A colour and its meaning.
struct LegendEntry {
  graphics::PackedColour colour;
  std::string text;
};

/// The legend of a colour map: a bar with five numbers.
QImage drawnLegend(const std::string& title, const graphics::ColourMap& map);
/// The legend of a list of colours.
QImage drawnLegend(const std::string& title, const std::vector<LegendEntry>& entries);

/// An image at the edge of the views of rviz. To be used from the thread that renders.
class Legend {
 public:
  enum class Place { BottomLeft, BottomRight, TopLeft, TopCentre, TopRight };
  explicit Legend(Place place);
  ~Legend();
  Legend(const Legend&) = delete;
  Legend& operator=(const Legend&) = delete;

  /// @param shift  how much further from the upper or lower edge [pixels]
  void show(const QImage& image, int shift = 0);
  void hide();

 private:
  void make();
  void fit(const QImage& image);

  Place place_;
  Ogre::Overlay* overlay_ = nullptr;
  Ogre::OverlayContainer* panel_ = nullptr;
  Ogre::MaterialPtr material_;
  Ogre::TexturePtr texture_;
};

}  // namespace vibe::rviz_plugins
