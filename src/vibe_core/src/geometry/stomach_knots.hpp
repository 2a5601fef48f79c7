#pragma once
#include <string>
#include <vector>

namespace vibe {

/// A point of the axis of an organ and the radius of the lumen there.
struct Knot {
  double x, y, z, radius;  ///< [mm], x anterior, y left, z cranial
};

/// What a procedural stomach is made of, before it is scaled to its volume.
struct StomachKnots {
  double volume;           ///< enclosed by this shape, unscaled [m^3]
  std::vector<Knot> body;  ///< from the fundus down the body, around the bend and up the antrum
  Knot pylorus, duodenum;
  Knot incisura_side;     ///< the incisura is the point of the surface nearest to this one
  Knot junction, gullet;  ///< of the oesophagus with the stomach, and its upper end
};

/// The knots of geometry.shape:
///   sthenic     between the other two; the default
///   j           long, narrow and vertical, with a deep bend, its lowest point well below the pylorus: the stomach of a
///               slender physique, located lower and more vertical (Burdan 2012, Surg Radiol Anat 34:171). Of cadavers
///               58 to 71 % have a J, which is the longest shape (Yesupadam 2016, doi 10.18203/2320-6012.ijrms20162315)
///   steer_horn  high and transverse, tapers evenly from the fundus to the pylorus, its lowest part, without a clear
///               angle: the stomach of a heavily built, hypersthenic physique (Burdan 2012)
/// The numbers are design choices within these descriptions.
/// @throws Error for another word
const StomachKnots& stomachKnots(const std::string& shape);

/// These knots with another fundus and antrum.
/// @param fundus_width  factor on the radius at the apex, falling evenly to 1 at the fifth knot
/// @param antrum_angle  by which what follows the incisura turns about it in the frontal plane, upwards [rad]
/// @throws Error for another word
StomachKnots variedKnots(const std::string& shape, double fundus_width, double antrum_angle);

/// The words of geometry.shape.
const std::vector<std::string>& stomachShapes();

}  // namespace vibe
