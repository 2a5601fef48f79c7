#include "overlay/legend.hpp"

#include <OgreHardwarePixelBuffer.h>
#include <OgreMaterialManager.h>
#include <OgrePass.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>
#include <Overlay/OgreOverlay.h>
#include <Overlay/OgreOverlayContainer.h>
#include <Overlay/OgreOverlayManager.h>

#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <cmath>

#include "vibe_graphics/graphics/resources.hpp"

namespace vibe::rviz_plugins {
namespace {

constexpr int kWidth = 170, kMargin = 12, kLine = 20, kTitle = 26, kBar = 18, kBarLength = 130, kMarks = 5;  // [pixels]

QColor opaque(graphics::PackedColour colour) {
  return {static_cast<int>(colour & 255U), static_cast<int>(colour >> 8 & 255U), static_cast<int>(colour >> 16 & 255U)};
}

QImage plate(int height, const std::string& title) {
  QImage image(kWidth, height, QImage::Format_ARGB32);
  image.fill(Qt::transparent);
  QPainter painter(&image);
  painter.setRenderHint(QPainter::Antialiasing);
  QPainterPath outline;
  outline.addRoundedRect(0, 0, kWidth, height, 8, 8);
  painter.fillPath(outline, QColor(16, 20, 26, 190));
  painter.setPen(Qt::white);
  painter.drawText(kMargin, 0, kWidth - 2 * kMargin, kTitle, Qt::AlignVCenter, QString::fromStdString(title));
  return image;
}

bool isAtBottom(Legend::Place place) {
  return place == Legend::Place::BottomLeft || place == Legend::Place::BottomRight;
}

Ogre::GuiHorizontalAlignment sideOf(Legend::Place place) {
  if (place == Legend::Place::TopCentre) return Ogre::GHA_CENTER;
  return place == Legend::Place::BottomLeft || place == Legend::Place::TopLeft ? Ogre::GHA_LEFT : Ogre::GHA_RIGHT;
}

/// Of an image of this width, from where its side is [pixels].
float leftEdge(Legend::Place place, float width) {
  switch (sideOf(place)) {
    case Ogre::GHA_LEFT:
      return kMargin;
    case Ogre::GHA_CENTER:
      return -std::floor(0.5F * width);
    case Ogre::GHA_RIGHT:
      break;
  }
  return -width - kMargin;
}

}  // namespace

QImage drawnLegend(const std::string& title, const graphics::ColourMap& map) {
  QImage image = plate(kTitle + kBarLength + kMargin + kMargin / 2, title);
  QPainter painter(&image);
  painter.setRenderHint(QPainter::Antialiasing);
  const int top = kTitle + kMargin / 2;
  for (int row = 0; row < kBarLength; ++row) {
    const int step = (kBarLength - 1 - row) * (graphics::ColourMap::kSteps - 1) / (kBarLength - 1);
    painter.fillRect(kMargin, top + row, kBar, 1, opaque(map.steps()[static_cast<std::size_t>(step)]));
  }
  painter.setPen(Qt::white);
  for (int k = 0; k < kMarks; ++k) {
    const double part = static_cast<double>(k) / (kMarks - 1), value = map.min() + part * (map.max() - map.min());
    const int y = top + static_cast<int>((1 - part) * (kBarLength - 1));
    painter.drawLine(kMargin + kBar, y, kMargin + kBar + 4, y);
    painter.drawText(kMargin + kBar + 10, y - kLine / 2, kWidth, kLine, Qt::AlignVCenter,
                     QString::number(value, 'g', 3));
  }
  return image;
}

QImage drawnLegend(const std::string& title, const std::vector<LegendEntry>& entries) {
  QImage image = plate(kTitle + kLine * static_cast<int>(entries.size()) + kMargin / 2, title);
  QPainter painter(&image);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::white);
  int y = kTitle;
  for (const LegendEntry& entry : entries) {
    painter.fillRect(kMargin, y + 4, kLine - 8, kLine - 8, opaque(entry.colour));
    painter.drawText(kMargin + kLine, y, kWidth, kLine, Qt::AlignVCenter, QString::fromStdString(entry.text));
    y += kLine;
  }
  return image;
}

Legend::Legend(Place place) : place_(place) {}

Legend::~Legend() {
  if (overlay_ == nullptr) return;
  auto& overlays = Ogre::OverlayManager::getSingleton();
  overlay_->hide();
  overlays.destroyOverlayElement(panel_);
  overlays.destroy(overlay_);
  graphics::dropMaterial(material_);
  if (texture_) Ogre::TextureManager::getSingleton().remove(texture_);
}

void Legend::make() {
  graphics::loadResources();
  auto& overlays = Ogre::OverlayManager::getSingleton();
  material_ = Ogre::MaterialManager::getSingleton().create(graphics::uniqueName("Legend"), graphics::kResourceGroup);
  Ogre::Pass& pass = *material_->getTechnique(0)->getPass(0);
  pass.setLightingEnabled(false);
  pass.setDepthCheckEnabled(false);
  pass.setDepthWriteEnabled(false);
  pass.setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
  pass.createTextureUnitState();
  overlay_ = overlays.create(graphics::uniqueName("Legend"));
  panel_ = static_cast<Ogre::OverlayContainer*>(overlays.createOverlayElement("Panel", graphics::uniqueName("Legend")));
  panel_->setMetricsMode(Ogre::GMM_PIXELS);
  panel_->setVerticalAlignment(isAtBottom(place_) ? Ogre::GVA_BOTTOM : Ogre::GVA_TOP);
  panel_->setHorizontalAlignment(sideOf(place_));
  panel_->setMaterial(material_);
  overlay_->add2D(panel_);
}

void Legend::fit(const QImage& image) {
  const auto width = static_cast<Ogre::uint32>(image.width()), height = static_cast<Ogre::uint32>(image.height());
  if (texture_ && texture_->getWidth() == width && texture_->getHeight() == height) return;
  auto& textures = Ogre::TextureManager::getSingleton();
  if (texture_) textures.remove(texture_);
  texture_ = textures.createManual(graphics::uniqueName("Legend"), graphics::kResourceGroup, Ogre::TEX_TYPE_2D, width,
                                   height, 0, Ogre::PF_A8R8G8B8, Ogre::TU_DEFAULT);
  material_->getTechnique(0)->getPass(0)->getTextureUnitState(0)->setTexture(texture_);
}

void Legend::show(const QImage& image, int shift) {
  if (overlay_ == nullptr) make();
  const QImage pixels = image.convertToFormat(QImage::Format_ARGB32);
  fit(pixels);
  const Ogre::PixelBox box(static_cast<std::uint32_t>(pixels.width()), static_cast<std::uint32_t>(pixels.height()), 1,
                           Ogre::PF_A8R8G8B8, const_cast<uchar*>(pixels.constBits()));  // Ogre reads it only
  texture_->getBuffer()->blitFromMemory(box);
  const auto width = static_cast<float>(pixels.width()), height = static_cast<float>(pixels.height());
  panel_->setDimensions(width, height);
  const auto away = static_cast<float>(kMargin + shift);
  panel_->setPosition(leftEdge(place_, width), isAtBottom(place_) ? -height - away : away);
  overlay_->show();
}

void Legend::hide() {
  if (overlay_ != nullptr) overlay_->hide();
}

}  // namespace vibe::rviz_plugins
