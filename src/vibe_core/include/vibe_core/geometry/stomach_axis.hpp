#pragma once
#include <Eigen/Core>
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

struct Organ;

/// The centreline of a stomach from the fundus to the pylorus, with the position of every vertex along and around it.
/// Sections are level sets of the harmonic function between the two ends of the surface, so they follow any bend. The
/// curve joins their centres.
class StomachAxis {
 public:
  /// A cross-section of the organ.
  struct Station {
    double length = 0;                                   ///< along the curve from its start [m]
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< [m]
    Eigen::Vector3d tangent = Eigen::Vector3d::Zero();   ///< unit vector towards the pylorus
    Eigen::Vector3d anterior = Eigen::Vector3d::Zero();  ///< unit vector in the section, towards the front
    Eigen::Vector3d greater = Eigen::Vector3d::Zero();   ///< unit vector in the section, towards the greater curvature
  };

  /// @param mesh     closed, evenly meshed
  /// @param fundus   vertices around the apex of the fundus
  /// @param pylorus  vertices at the far end
  /// @param ignored  one entry per vertex: true for side branches (the oesophagus), which are left out of the section
  ///         centres
  /// @param anterior unit direction towards the patient's front
  StomachAxis(const SurfaceMesh& mesh, const std::vector<int>& fundus, const std::vector<int>& pylorus,
              const std::vector<bool>& ignored, const Eigen::Vector3d& anterior);

  const std::vector<Station>& stations() const { return stations_; }  ///< from the fundus to the pylorus, at least 4
  double length() const { return stations_.back().length; }           ///< [m]

  /// Position of a vertex along the curve, from 0 to length() [m].
  double lengthAt(int vertex) const { return vertex_length_[vertex]; }

  /// Angle of a vertex around the curve: 0 anterior, pi/2 greater curvature, +-pi posterior, -pi/2 lesser curvature
  /// [rad].
  double angleAt(int vertex) const { return vertex_angle_[vertex]; }

 private:
  void placeStations(const SurfaceMesh& mesh, const std::vector<double>& field, const std::vector<bool>& ignored);
  void orientStations(const Eigen::Vector3d& anterior);
  void placeVertices(const SurfaceMesh& mesh, const std::vector<double>& field);

  std::vector<Station> stations_;
  std::vector<double> level_;          ///< harmonic value of each station, ascending
  std::vector<double> vertex_length_;  ///< (vertices)
  std::vector<double> vertex_angle_;   ///< (vertices)
};

/// Axis of an organ whose surface, ends and landmarks are known.
StomachAxis findAxis(const Organ& organ);

}  // namespace vibe
