#pragma once
#include <memory>
#include <string>
#include <utility>

#include "vibe_graphics/geometry/coloured_shape.hpp"
#include "vibe_graphics/graphics/shape_visual.hpp"
#include "vibe_rviz_plugins/display_base/message_display.hpp"

namespace vibe::rviz_plugins {

/// A display that draws each message as one shape. A derived class has a constructor without parameters that names the
/// topic and adds properties (with the slot redraw()), and the function makeShape(); it needs no Q_OBJECT. Drawing,
/// subscription, transform and statuses are here. examples/display is a package with such a display.
/// @tparam Message  with a header, whose frame is the frame of the shape
template <class Message>
class MessageShapeDisplay : public MessageDisplay<Message> {
 public:
  /// Appends what a message looks like to an empty shape [m]. Needs no scene, so a test can call it.
  /// @return empty; otherwise one sentence that says what is wrong with the message, and the shape is not used
  virtual std::string makeShape(const Message& message, graphics::ColouredShape& shape) const = 0;

 protected:
  using MessageDisplay<Message>::MessageDisplay;

  void redraw() final {
    if (this->shown() != nullptr) read(*this->shown());
  }

 private:
  void makeVisual() final { visual_ = std::make_unique<graphics::ShapeVisual>(*this->scene_node_); }
  void clear() final { visual_->show({}); }

  MessageReport read(const Message& message) final {
    graphics::ColouredShape shape;
    std::string wrong = makeShape(message, shape);
    if (wrong.empty()) wrong = graphics::problemOf(shape);
    if (!wrong.empty()) return {wrong, false};
    shape_ = std::move(shape);
    changed_ = true;
    return {"The latest message is drawn."};
  }

  bool draw() final {
    if (changed_) visual_->show(shape_);
    return std::exchange(changed_, false);
  }

  std::unique_ptr<graphics::ShapeVisual> visual_;
  graphics::ColouredShape shape_;
  bool changed_ = false;
};

}  // namespace vibe::rviz_plugins
