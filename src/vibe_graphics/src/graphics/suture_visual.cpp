#include "vibe_graphics/graphics/suture_visual.hpp"

#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreTechnique.h>
#include <rviz/ogre_helpers/movable_text.h>

#include "vibe_graphics/graphics/resources.hpp"

namespace vibe::graphics {
namespace {

Ogre::MaterialPtr with(Ogre::MaterialPtr material, const char* parameter, float value) {
  for (Ogre::Technique* technique : material->getTechniques())
    technique->getPass(0)->getFragmentProgramParameters()->setNamedConstant(parameter, value);
  return material;
}

/// Drawn before everything that is sorted by distance; otherwise the order of blood and transparent wall would flicker.
Ogre::MaterialPtr beforeGlass(Ogre::MaterialPtr material) {
  for (Ogre::Technique* technique : material->getTechniques())
    technique->getPass(0)->setTransparentSortingEnabled(false);
  return material;
}

}  // namespace

SutureVisual::SutureVisual(Ogre::SceneNode& parent)
    : parent_(parent),
      solid_material_(copyMaterial("vibe/suture")),
      sign_material_(with(copyMaterial("vibe/solid"), "glow", 1)),
      blood_material_(beforeGlass(copyMaterial("vibe/blood"))),
      solids_(std::make_unique<ShapeView>(parent, solid_material_)),
      signs_(std::make_unique<ShapeView>(parent, sign_material_)),
      blood_(std::make_unique<ShapeView>(parent, blood_material_)) {}

SutureVisual::~SutureVisual() {
  while (!texts_.empty()) removeText();
  solids_.reset(), signs_.reset(), blood_.reset();
  dropMaterial(solid_material_);
  dropMaterial(sign_material_);
  dropMaterial(blood_material_);
}

void SutureVisual::addText(const std::string& text) {
  Text added{parent_.createChildSceneNode(), std::make_unique<rviz::MovableText>(text)};
  added.text->setTextAlignment(rviz::MovableText::H_CENTER, rviz::MovableText::V_CENTER);
  added.text->showOnTop(true);  // legible from outside the organ too
  added.node->attachObject(added.text.get());
  texts_.push_back(std::move(added));
}

void SutureVisual::removeText() {
  texts_.back().node->detachAllObjects();
  parent_.getCreator()->destroySceneNode(texts_.back().node);
  texts_.pop_back();
}

void SutureVisual::showLabels(const std::vector<SutureLabel>& labels, double height) {
  while (texts_.size() > labels.size()) removeText();
  while (texts_.size() < labels.size()) addText(labels[texts_.size()].text);
  for (std::size_t k = 0; k < labels.size(); ++k) {
    texts_[k].node->setPosition(labels[k].place);
    if (texts_[k].text->getCaption() != labels[k].text) texts_[k].text->setCaption(labels[k].text);
    texts_[k].text->setCharacterHeight(static_cast<float>(height));  // no effect if unchanged
    texts_[k].text->setSpaceWidth(static_cast<float>(0.3 * height));
  }
}

void SutureVisual::clear() {
  solids_->clear(), signs_->clear(), blood_->clear();
  showLabels({}, 0);
}

}  // namespace vibe::graphics
