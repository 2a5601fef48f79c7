#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"
#include "vibe_core/thermal/thermal_dose.hpp"

namespace vibe {

/// A mark: a set of particles with a grade, connected by triangle edges. A drawn line is one mark.
struct MarkZone {
  int particle = -1;                  ///< the particle with the largest dose; determines wall and region
  int count = 0;                      ///< number of particles
  Wall wall = Wall::Anterior;         ///< of `particle`
  Region region = Region::Body;       ///< of `particle`
  BurnGrade grade = BurnGrade::None;  ///< the worst
  Eigen::Vector3d centre =
      Eigen::Vector3d::Zero();  ///< mean of the particles, in world; off the wall for a long mark [m]
  double area = 0;              ///< of the rest shape [m^2]
  bool in_zone = false;         ///< every particle lies in the working zone
};

/// The marks of one wall in the working zone.
struct WallMarks {
  int count = 0;      ///< number of particles
  double length = 0;  ///< straight distance between the ends in the rest shape; 0: no particle, or one [m]
};

/// Whether the sutures of an endoscopic sleeve gastroplasty are placed there: the body except its lesser curvature.
/// Antrum and fundus are spared (Updates Surg 2022, 10.1007/s13304-022-01385-4); anterior wall, greater curvature and
/// posterior wall are marked (Kumbhari 2017, VideoGIE, 10.1016/j.vgie.2017.01.002; Erden et al., section 2.1.1).
bool inWorkingZone(Region region, Wall wall);

/// Finds the marks. Intended for use after a step in which a grade has risen; takes some tens of microseconds. Holds
/// scratch memory but no state. Not thread-safe.
class MarkFinder {
 public:
  /// @param organ  must outlive this object
  explicit MarkFinder(const Organ& organ);

  /// Marks in ascending order of their lowest particle number.
  const std::vector<MarkZone>& find(const ThermalDose& law, const std::vector<float>& dose, const SurfaceView& wall);

  /// Of the last find(), by Wall.
  const std::array<WallMarks, kWallCount>& walls() const { return walls_; }

 private:
  MarkZone collect(int first, const ThermalDose& law, const std::vector<float>& dose, const SurfaceView& wall);
  int farthest(int from, const std::vector<int>& list, double& distance) const;
  void measureWalls(const ThermalDose& law, const std::vector<float>& dose);

  const Organ& organ_;
  std::vector<double> area_;                  ///< (particles) [m^2]
  std::vector<std::vector<int>> neighbours_;  ///< (particles)
  std::vector<char> seen_;                    ///< (particles)
  std::vector<int> open_;
  std::array<std::vector<int>, kWallCount> marked_;
  std::array<WallMarks, kWallCount> walls_;
  std::vector<MarkZone> zones_;
};

}  // namespace vibe
