#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace vibe::graphics {

/// Projection of a lens: how the angle theta between a ray and the optical axis gives the distance from the image
/// centre.
enum class LensKind {
  Equidistant,  ///< radius = f theta, as endoscopes are built
  Rectilinear,  ///< radius = f tan theta: straight lines stay straight, as in a pinhole camera
};

constexpr double kDegree = 3.14159265358979323846 / 180;  ///< [rad]

constexpr double kMinFieldOfView = 0.174533;  ///< 10 degrees [rad]
constexpr double kMaxFieldOfView = 2.96706;   ///< 170 degrees; a plane image of 180 degrees would be infinite [rad]

/// A camera whose image is a circle in the centre of a rectangle. Frame: z forward, x right, y down. Pixels: the centre
/// of the first one is (0, 0), x right, y down.
struct RoundCamera {
  LensKind lens = LensKind::Equidistant;  ///< projection
  double field_of_view = 2.443461;        ///< across the circle [rad]
  int width = 640, height = 480;          ///< of the rectangle [px]

  double radius() const { return 0.5 * (width < height ? width : height); }           ///< of the circle [px]
  Eigen::Vector2d middle() const { return {0.5 * (width - 1), 0.5 * (height - 1)}; }  ///< centre of the circle [px]
};

/// Why this camera is impossible, as a sentence without capital and period; empty: it is possible.
std::string problemOf(const RoundCamera& camera);

/// Focal length with which the field of view fills the circle [px].
double focalLength(const RoundCamera& camera);

/// Distance from the centre [px] of a ray at this angle from the axis [rad]; below a right angle for a rectilinear
/// lens.
double radiusAt(const RoundCamera& camera, double angle);
/// The inverse: angle from the axis [rad] at this distance from the centre [px].
double angleAt(const RoundCamera& camera, double radius);

/// Pixel of a point in the camera's frame; not a number for the origin, and with a rectilinear lens behind the camera.
Eigen::Vector2d pixelOf(const RoundCamera& camera, const Eigen::Vector3d& point);
/// Unit vector of the ray through a pixel, which may lie outside of the circle.
Eigen::Vector3d rayOf(const RoundCamera& camera, const Eigen::Vector2d& pixel);

/// Where a picture shows a point of the wall, in the frame of the camera [m]. The tip has no room for tissue: a point
/// within it lies on its face. Such points exist because the shapes that the simulator lets the wall touch are rounder
/// than the face, and the drawn wall is smoother than the simulated one: where the tip presses with some 5 N, the drawn
/// wall may be a few tenths of a millimetre behind the lens. media/mucosa.vert does the same.
Eigen::Vector3d placeOnLens(const Eigen::Vector3d& place);

/// The circular image is computed from plane square images, which is what graphics cards draw.
struct SquareSource {
  double half_width = 0;  ///< tangent of the angle between the axis and the middle of an edge
  int size = 0;           ///< of an edge [px]
};

/// The required size of the square image.
/// @param sharpness  pixels of the source per pixel of the image at the centre; 1: no detail is lost
/// @param max        maximum edge, at the expense of sharpness [px]
SquareSource sourceFor(const RoundCamera& camera, double sharpness, int max);

/// The plane image of a wide equidistant lens is stretched towards its rim: at the angle theta, an image pixel is
/// (1 + tan^2 theta) source pixels long and tan theta / theta wide. So the image is computed from two sources: the
/// middle, and the whole with fewer pixels.
struct LensSources {
  static constexpr double kMiddle = 0.8;        ///< half angle of the middle [rad]; design choice
  static constexpr double kRimSharpness = 0.6;  ///< of the whole; where it begins to show (media/endoscope.frag), 0.73
                                                ///< source pixels per image pixel around, 1.06 along the radius; more
                                                ///< beyond (ratio); design choice
  SquareSource whole;                           ///< the whole field of view
  SquareSource middle;                          ///< size 0: there is none, and the whole has all the sharpness
};

/// @param sharpness, max  as above
LensSources sourcesFor(const RoundCamera& camera, double sharpness, int max);

/// Parameters of a sensor_msgs/CameraInfo.
struct CameraNumbers {
  std::string distortion_model;  ///< of ROS: "equidistant", or "plumb_bob" for a rectilinear lens
  std::vector<double> d;         ///< coefficients of the distortion, in the order of its model
  std::array<double, 9> k, r;    ///< camera matrix [px] and rotation, row by row
  std::array<double, 12> p;      ///< projection matrix, 3 x 4, row by row [px]
};

/// @param baseline  distance to the right of the first camera of a stereo pair [m]; 0: first or only camera
CameraNumbers numbersOf(const RoundCamera& camera, double baseline);

/// The end of a bundle of fibres beside the lens.
struct LightGuide {
  double right, up;     ///< of the lens, as the picture shows right and up [m]
  double strength = 1;  ///< of its light (ratio)
};

/// The light of an endoscope. The defaults are that of the live view.
struct EndoscopeLight {
  std::array<LightGuide, 2> guides{{{0.0035, 0.0012}, {-0.0035, 0.0012}}};  ///< a tip of 9.8 mm holds them
  double sideward = 0.3;                     ///< light of a guide at right angles, as a part of its light ahead
  double temperature = 5800;                 ///< of the colour of the light [K]
  static constexpr double kBalanced = 5800;  ///< for which the processor shows white as white [K]
};

/// Red, green and blue of a white wall in light of this temperature (Planck 1901), when white is balanced for
/// EndoscopeLight::kBalanced. Green is 1.
/// @param temperature  above 1,000 K
Eigen::Vector3d lightColour(double temperature);

/// What the guide shines at right angles (x), and how much more ahead (y): its light in the direction z is x + y z. The
/// guides of the default have 0.15 and 0.35.
Eigen::Vector2d coneOf(const EndoscopeLight& light, const LightGuide& guide);

/// The exposure of a video processor: brings the mean level of the picture to a target, at a limited rate. A function
/// of the levels and stamps it has seen, so the same pictures are exposed in the same way again.
class AutoExposure {
 public:
  static constexpr double kTarget = 0.45;  ///< mean level of the picture, weighted to its centre; design choice (ratio)
  static constexpr double kRate = 4;       ///< fastest change [stops/s]; design choice: about 0.3 s for a usual change
  static constexpr double kGap = 0.5;      ///< after that long without a picture the exposure is found anew [s]
  static constexpr double kFixedGain = 1.6;                ///< without automatic exposure, and at first (ratio)
  static constexpr double kMinGain = 0.02, kMaxGain = 60;  ///< about 6 and 5 stops around; design choice (ratio)

  /// What the radiances of the next picture are to be multiplied with.
  double gain() const { return gain_; }

  /// Tells the mean level of a picture that was taken with gain().
  /// @param level  0 to 1, linear between black and white of the screen
  /// @param time   of the picture [s]
  void see(double level, double time);

  /// Whether the last picture was the first one, or the first after a gap or after time was set back, and its level was
  /// far from the target: it should be taken again with the new gain.
  bool isLost() const { return lost_; }

 private:
  double gain_ = kFixedGain;
  double time_ = 0;
  bool begun_ = false, lost_ = false;
  int tries_ = 0;  ///< of the picture of time_
};

}  // namespace vibe::graphics
