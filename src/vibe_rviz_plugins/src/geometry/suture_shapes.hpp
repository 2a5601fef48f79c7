#pragma once
#include <Eigen/Core>
#include <string>

#include "geometry/suture_scene.hpp"
#include "vibe_rviz_plugins/geometry/colour_map.hpp"
#include "vibe_rviz_plugins/geometry/coloured_shape.hpp"

namespace vibe {

enum class ThreadColour { Tension, One, PerSuture };

/// How sutures are drawn.
struct SutureStyle {
  double thread_diameter = 0.32e-3;  ///< of 2-0 polypropylene (USP <861>: 0.300 to 0.339 mm) [m]
  double emphasis = 1;               ///< thread and symbols are this much thicker than they are
  ThreadColour colouring = ThreadColour::Tension;
  ColourMap tension_map;  ///< [N]
  PackedColour slack_colour = packed(0.93, 0.95, 1.0);
  PackedColour one_colour = packed(0.12, 0.30, 0.85);
  bool bites = true, ends = true, corners = true, links = true;

  double threadRadius() const { return 0.5 * thread_diameter * emphasis; }
};

/// A colour of its own for each of twelve sutures that follow each other.
PackedColour sutureColour(std::size_t number);

/// Threads, bites, T-tags, cinches and corners, appended. Slack thread is banded with its colour and a darker one, so
/// that it is told from tense thread also without colours.
void appendSutures(const SutureScene& scene, const SutureStyle& style, ColouredShape& shape);

/// The index groups: a flat broken band along each link, appended.
void appendLinks(const SutureScene& scene, const SutureStyle& style, ColouredShape& shape);

/// What is written at a set: its number from 1, the technique's letter or name with its margin, and whatever is wrong.
std::string labelOf(const SutureSet& set, std::size_t number);

/// Where it is written: the middle of the bites, moved into the lumen by `distance` [m].
Eigen::Vector3d labelPlace(const SutureSet& set, double distance);

}  // namespace vibe
