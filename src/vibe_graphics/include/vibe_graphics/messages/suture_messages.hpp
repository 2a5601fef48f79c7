#pragma once
#include <vibe_msgs/SutureArray.h>

#include <string>

#include "vibe_graphics/geometry/suture_drawing.hpp"

namespace vibe::graphics {

/// Checks and reads the threads and bleeding of a session.
/// @return empty, and `scene` is set; otherwise one sentence that says what is wrong, and `scene` is unchanged
///
/// Checked: valid positions; tensions, amounts and rates finite and not negative; thread_offsets in order and one per
/// bite; lengths and tensions one per piece; known stage and technique; transitions, sutures and bites that exist.
///
/// The direction into the lumen follows from wall and region of a bite and the axes of the world frame (x anterior, y
/// to the patient's left, z to the head): from the anterior wall to posterior, from the greater curvature of the body
/// to the right and up, and so on. It is accurate to about 30 degrees for a stomach in normal position.
std::string readSutures(const vibe_msgs::SutureArray& message, SutureDrawing& scene);

}  // namespace vibe::graphics
