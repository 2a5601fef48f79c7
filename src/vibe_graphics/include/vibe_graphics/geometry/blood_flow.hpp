#pragma once

#include <vector>

#include <Eigen/Core>

#include "vibe_graphics/geometry/basins.hpp"
#include "vibe_graphics/geometry/blood_colour.hpp"
#include "vibe_graphics/geometry/coloured_shape.hpp"
#include "vibe_graphics/geometry/suture_drawing.hpp"
#include "vibe_graphics/geometry/wall_surface.hpp"

namespace vibe::graphics {

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

/// Blood that lies around a point of the wall.
struct BloodFilm {
  WallPlace at;       ///< its middle, on the wall
  double volume = 0;  ///< [m^3]
  double brown = 0;   ///< 0 to 1
  int number = 0;     ///< of the outline
};

/// Blood that runs down the wall.
struct Rivulet {
  std::vector<WallPlace> line;      ///< to its head, or into its pool; one point is none
  double length = 0;                ///< from its start to its head [m]
  double width = 0, thickness = 0;  ///< of its parabolic section [m]
  double brown = 0;                 ///< 0 to 1
  bool arrived = false;             ///< the wall goes down no more
  int number = 0;                   ///< of its bends
  /// Of the parabolic section along the whole length [m^3].
  double volume() const { return 2.0 / 3 * width * thickness * length; }
};

/// A jet in flight.
struct BloodJet {
  Wound wound;          ///< on the wall, with its direction
  double duration = 0;  ///< of the flight to the wall [s]
};

/// Where the blood of all wounds is. Films, rivulets and pools together are what the wounds have lost. Rivulets from
/// one full hollow to the next, the last ones, are not counted: blood passes through them.
struct BloodFlow {
  std::vector<BloodFilm> films;   ///< blood that stays where it came out or fell
  std::vector<Rivulet> rivulets;  ///< those from hollow to hollow are the last ones
  std::vector<Pool> pools;        ///< what stands in hollows
  std::vector<BloodJet> jets;     ///< those that bleed briskly now
  std::vector<Wound> elsewhere;   ///< wounds with no wall near them
  std::size_t passing = 0;        ///< number of the last rivulets that are not counted
};

/// A function of wounds and wall at one moment. From each wound a film, then a rivulet that follows the steepest
/// descent, as long as age, amount and wall let it be, and what is left stands at its end in the hollows of the wall.
/// The blood of a brisk wound does the same from where its jet lands, and so does what falls from a ceiling.
BloodFlow flowOf(const std::vector<Wound>& wounds, const WallSurface& wall, const BloodStyle& style);

}  // namespace vibe::graphics
