#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/geometry/stomach_axis.hpp"
#include "vibe_core/metrics/surface_section.hpp"

namespace vibe {

/// Size and shape of the organ at one moment. Measures that need an axis or a body have no value without one.
struct OrganMeasures {
  double volume = 0;                        ///< enclosed by the surface of the particles [m^3]
  std::optional<double> length;             ///< along the axis, from the apex of the fundus to the duodenal end [m]
  std::optional<double> greater_curvature;  ///< along the wall on that side, between the same points [m]
  std::optional<double> body_length;        ///< of the part of the axis that the sections below stand for [m]
  std::optional<double> mean_area;  ///< cross-section of the body, mean over body_length: the lumen's area [m^2]
  std::optional<double> min_area;   ///< of the same sections [m^2]
  /// How evenly wide the body is: 1 - standard deviation / mean of the cross-sections along body_length. A tube has 1,
  /// an ellipsoid 0.55, a cone 0.11; can be negative. Our definition, a ratio
  std::optional<double> tubularity;
};

/// Measures an organ as its particles move. The axis runs through the middles of 32 rings of wall (fewer below 512
/// vertices); which wall belongs
/// to which ring is fixed at rest by StomachAxis (an organ without a duodenal end has the straight line from its fundus
/// to its pylorus landmark), so the axis follows the wall when that is pulled together. Sections are planes through the
/// middles of the rings of which more than half is of the region Body, square to the present axis; where a plane also
/// cuts other parts of the organ, these do not count. A fold that hangs into the lumen takes its area away.
///
/// Limitations: the surface is that of the particles, half a wall outside of the mucosa. The sides of the wall pulled
/// together by a suture must not pass through one another, or area counts twice. Where the axis bends sharply, as at
/// the incisura, planes square to it are wider than the lumen is across (areas times lengths along the whole default
/// stomach add up to a tenth more than its volume); a plane that cuts two parts of the organ in one is left out.
class OrganRuler {
 public:
  /// Takes some 40 ms for 3,618 particles (the axis); after it measure() takes 0.3 ms and no memory.
  /// @throws Error if the surface is not closed or the axis cannot be found
  explicit OrganRuler(const Organ& organ);

  /// @param x, y, z  present positions of the vertices, shape (vertices) [m]
  /// @throws Error if they are not as many as the organ has, or not finite
  OrganMeasures measure(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z);

  /// Of the organ as it was given.
  OrganMeasures measureRest();

 private:
  struct Share {
    int ring = 0;       // the vertex belongs to this ring
    double part = 0;    // by so much, and to the next by the rest
    double weight = 0;  // area of wall around the vertex; 0: belongs to none [m^2]
  };
  struct WallPoint {
    std::array<int, 3> corner{};
    Eigen::Vector3d weight = Eigen::Vector3d::Zero();
  };

  void findRings(const Organ& organ, const std::vector<double>& coordinate, const std::vector<bool>& ignored);
  void findCurvature(const Organ& organ, const std::vector<StomachAxis::Station>& stations);
  std::vector<StomachAxis::Station> straightStations(const Organ& organ, const Eigen::Vector3d& direction);
  void placeRings(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z);
  double sectionArea(int ring, const std::vector<double>& x, const std::vector<double>& y,
                     const std::vector<double>& z);
  void measureBody(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z,
                   OrganMeasures& measures);
  double curvature(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z) const;

  SurfaceMesh surface_;
  SurfaceSection section_;
  bool has_axis_ = false;
  int apex_ = 0, outlet_ = 0;          // vertices at the two ends
  std::vector<Share> share_;           // (vertices)
  std::vector<double> label_;          // rings from the start, (vertices); NaN: the oesophagus, part of no ring
  std::vector<double> ring_weight_;    // [m^2]
  std::vector<bool> in_body_;          // (rings)
  std::vector<WallPoint> curvature_;   // on the greater curvature
  std::vector<Eigen::Vector3d> axis_;  // apex, rings, outlet, at the last measurement
};

/// 1 - now / before. Negative if there is more than before; no value without both.
std::optional<double> reduction(std::optional<double> before, std::optional<double> now);

}  // namespace vibe
