#pragma once
#include <string>
#include <variant>
#include <vector>

namespace vibe::vision {

/// A black ring on a white square: slide only. It is printed flat and looks at the camera.
struct RingDesign {
  double outer_diameter = 4e-3;  ///< [m]
  double inner_diameter = 2e-3;  ///< [m]
  double side = 7e-3;            ///< of the white square around it [m]
};

/// Black from `begin` to `end`, distances from the sleeve's centre along its axis [m].
struct Bar {
  double begin = 0, end = 0;  ///< along the axis from the sleeve's centre, `begin` below `end` [m]
};

/// A printed sleeve around a rod: bars around the whole rod give the slide, a helical stripe the rotation. u is the
/// distance along the rod's axis, in the direction of positive slide; the sleeve's centre is on that axis, at u = 0.
/// phi is the angle around the axis on the print, by the right-hand rule about +u. The rotation of the rod is positive
/// by the same rule; at rotation r the camera looks at phi = -r. In the image, with y down, phi grows to the right of
/// the direction of +u: a point of the print is seen at lateral = radius * sin(phi + r). White wherever neither is
/// black.
struct SleeveDesign {
  double diameter = 3e-3;                 ///< [m]
  double length = 10e-3;                  ///< with its white ends [m]
  std::vector<Bar> bars;                  ///< ascending, not periodic: no shift matches two of them except 0
  double helix_begin = 0, helix_end = 0;  ///< where the stripe is [m]
  double helix_pitch = 0;                 ///< advance of the stripe in one turn [m]; positive: u grows with phi
  double helix_duty = 0.5;                ///< black part of a pitch, (0, 1)
  // black where helix_begin < u < helix_end and fract(u / helix_pitch - phi / (2 pi) + helix_duty / 2) < helix_duty:
  // the stripe's centre line passes u = 0, phi = 0. Turning by r moves the picture of the stripe by -helix_pitch r / 2
  // pi
};

/// Whose tags: 36h11 of libapriltag, or the dictionary 4X4_50 of OpenCV's aruco.
enum class TagFamily { AprilTag, Aruco };

/// A square tag of another library: slide only. It is printed flat and looks at the camera; which of its sides is up
/// does not matter. A ring is several times as exact: docs/vision.md, "Tags of other libraries".
struct TagDesign {
  TagFamily family = TagFamily::AprilTag;  ///< where its picture is from
  int id = 0;                              ///< number of the tag in the family
  double side = 0;                         ///< of its black border, without the cell of white around it [m]
};
int tagCells(TagFamily family);               ///< per side, black border included
int tagCount(TagFamily family);               ///< of the family; numbers are from 0
const char* tagFamilyName(TagFamily family);  ///< its key in a configuration
double tagMargin(const TagDesign& tag);       ///< white that must be around it: a cell [m]

using MarkerDesign = std::variant<RingDesign, SleeveDesign, TagDesign>;  ///< what the tracker knows to look for

/// As it is on paper if black reaches beyond each of its edges by `ink` [m]; less than 0: it ends before. No line gets
/// thinner than half of what was designed. A tag stays as it is.
MarkerDesign printed(const MarkerDesign& design, double ink);
/// The sleeve that ships: 3 mm rod.
SleeveDesign defaultSleeve();
/// Everything a printed marker must fulfil. @throws Error with one sentence that names `place`
void checkMarker(const MarkerDesign& design, const std::string& place);
/// 1: white, 0: black, at a point of the ring's plane [m] from its centre.
double reflectance(const RingDesign& design, double x, double y);
/// At u [m] and phi [rad] on the print. What a camera sees at angle phi of a rod turned by r is reflectance(u, phi -
/// r).
double reflectance(const SleeveDesign& design, double u, double phi);

}  // namespace vibe::vision
