#pragma once
#include <vibe_msgs/SutureArray.h>

#include <string>

#include "geometry/suture_scene.hpp"

namespace vibe {

/// Checks and takes over the threads of a session and what bleeds. An empty answer: the message is right and `scene` is
/// filled; else it is a sentence that says what is wrong, and `scene` is as it was.
///
/// Checked: every place a place in metres, tensions, amounts and rates finite and not below zero, thread_offsets in
/// order and one per bite, lengths and tensions one per piece, stage and technique known, transitions at bites,
/// bleedings at sutures and bites that are there.
///
/// The lumen's side of a wall comes from the bite's wall and region and the axes of the world frame (x anterior, y to
/// the patient's left, z to the head): the anterior wall looks to the back, the greater curvature of the body to the
/// right and up, and so on. It is right to some 30 degrees for a stomach in its usual place.
std::string readSutures(const vibe_msgs::SutureArray& message, SutureScene& scene);

}  // namespace vibe
