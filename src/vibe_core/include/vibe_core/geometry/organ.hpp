#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Parts of the stomach along its length, from the oesophagus to the duodenum. The values are part of the message
/// format.
enum class Region : std::uint8_t { Cardia = 0, Fundus = 1, Body = 2, Antrum = 3, Pylorus = 4 };
constexpr int kRegionCount = 5;  ///< values of Region

/// Sides of the stomach around its axis. The values are part of the message format.
enum class Wall : std::uint8_t { Anterior = 0, GreaterCurvature = 1, Posterior = 2, LesserCurvature = 3 };
constexpr int kWallCount = 4;  ///< values of Wall

/// The neighbouring organ at an end of the stomach. The particles of an end are held in place.
enum class End : std::uint8_t { None = 0, Oesophagus = 1, Duodenum = 2 };

/// Points that define the regions and walls of a stomach surface, in the frame of the mesh after scaling and rotation
/// (x anterior, y to the patient's left, z cranial) [m].
struct Landmarks {
  Eigen::Vector3d oesophagus = Eigen::Vector3d::Zero();  ///< centre of the gastro-oesophageal junction
  Eigen::Vector3d fundus = Eigen::Vector3d::Zero();      ///< apex of the fundus (highest point)
  Eigen::Vector3d incisura = Eigen::Vector3d::Zero();    ///< angular incisure on the lesser curvature
  Eigen::Vector3d pylorus = Eigen::Vector3d::Zero();     ///< centre of the pyloric orifice
  Eigen::Vector3d anterior = Eigen::Vector3d::UnitX();   ///< unit direction towards the patient's front
};

const char* toString(Region region);
const char* toString(Wall wall);
const char* toString(End end);

/// The hollow organ at rest: its mid-surface, whose vertices become the particles, and anatomical labels. All vectors
/// below have one entry per vertex.
struct Organ {
  SurfaceMesh surface;            ///< closed, oriented outwards, evenly meshed
  std::vector<Region> region;     ///< part along the length
  std::vector<Wall> wall;         ///< side around the axis
  std::vector<End> end;           ///< whether the vertex belongs to a held end
  std::vector<double> thickness;  ///< wall thickness [m]
  Landmarks landmarks;            ///< in the frame of `surface`; regions and walls of a stomach follow from them
  Eigen::Vector3d entry = Eigen::Vector3d::Zero();  ///< entry point of the scope: centre of the oesophagus end [m]
  Eigen::Vector3d entry_axis = -Eigen::Vector3d::UnitZ();  ///< unit vector from entry into the lumen
};

}  // namespace vibe
