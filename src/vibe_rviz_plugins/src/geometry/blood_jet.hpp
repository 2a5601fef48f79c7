#pragma once
#include <Eigen/Core>
#include <vector>

#include "geometry/blood_style.hpp"
#include "geometry/suture_drawing.hpp"
#include "vibe_rviz_plugins/geometry/coloured_shape.hpp"

namespace vibe::rviz_plugins {

/// Initial speed of the jet of a brisk wound [m/s].
double jetSpeed(double time);

/// How long blood flies until it has fallen by `drop` [m] below the wound, with the mean initial speed [s].
double jetDuration(const Wound& wound, double drop, const BloodStyle& style);

/// Where blood is on its way with the mean initial speed: 24 points from the wound on, at equal times [m].
std::vector<Eigen::Vector3d> jetPath(const Wound& wound, double duration, const BloodStyle& style);

/// Centre line of the jet: 24 points on the paths of blood that left one after another, each with the speed at that
/// time [m].
std::vector<Eigen::Vector3d> jetLine(const Wound& wound, double duration, const BloodStyle& style);

/// Appends the jet along its line. It is continuous at first and breaks up into drops.
void appendJet(const Wound& wound, const std::vector<Eigen::Vector3d>& line, const BloodStyle& style,
               ColouredShape& shape);

}  // namespace vibe::rviz_plugins
