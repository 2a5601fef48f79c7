#pragma once
#include <Eigen/Core>
#include <string>

#include "vibe_graphics/geometry/colour_map.hpp"
#include "vibe_graphics/geometry/coloured_shape.hpp"
#include "vibe_graphics/geometry/suture_drawing.hpp"

namespace vibe::graphics {

/// What the colour of thread tells: its tension, nothing, or to which suture it belongs.
enum class ThreadColour { Tension, One, PerSuture };

/// How sutures are drawn.
struct SutureStyle {
  double thread_diameter = 0.32e-3;                     ///< of 2-0 polypropylene (USP <861>: 0.300 to 0.339 mm) [m]
  double emphasis = 1;                                  ///< factor for the thickness of thread and symbols
  ThreadColour colouring = ThreadColour::Tension;       ///< of the thread
  ColourMap tension_map;                                ///< [N]
  PackedColour slack_colour = packed(0.93, 0.95, 1.0);  ///< of thread without tension, with ThreadColour::Tension
  PackedColour one_colour = packed(0.12, 0.30, 0.85);   ///< of all thread, with ThreadColour::One
  bool bites = true, ends = true, corners = true, links = true;  ///< symbols that are drawn; `ends` are T-tag and cinch
  bool slack_bands = true;                                       ///< slack thread has bands

  double threadRadius() const { return 0.5 * thread_diameter * emphasis; }  ///< as drawn, with the emphasis [m]
};

/// What is there, as an endoscope sees it: no symbols, no data.
SutureStyle naturalSutures();

/// Colour of a suture; twelve consecutive sutures have different colours.
PackedColour sutureColour(std::size_t number);

/// Appends threads, bites, T-tags, cinches and corners. Slack thread has bands of its colour and a darker one, so that
/// it differs from taut thread without relying on colour.
void appendSutures(const SutureDrawing& scene, const SutureStyle& style, ColouredShape& shape);

/// Appends the index groups: a flat dashed band along each link.
void appendLinks(const SutureDrawing& scene, const SutureStyle& style, ColouredShape& shape);

/// Label of a set: its number from 1, the name of the technique with its margin, and faults.
std::string labelOf(const SutureSet& set, std::size_t number);

/// Position of the label: the centroid of the bites, moved into the lumen by `distance` [m].
Eigen::Vector3d labelPlace(const SutureSet& set, double distance);

}  // namespace vibe::graphics
