#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/geometry/surface_view.hpp"
#include "vibe_core/thermal/thermal_dose.hpp"

namespace vibe {

/// A mark: particles with a grade, connected by sides of triangles. A drawn line is one mark.
struct MarkZone {
  int particle = -1;  ///< the one with the largest dose; wall and region are its own
  int count = 0;      ///< particles
  Wall wall = Wall::Anterior;
  Region region = Region::Body;
  BurnGrade grade = BurnGrade::None;  ///< the worst
  Eigen::Vector3d centre =
      Eigen::Vector3d::Zero();  ///< mean of the particles, in world; of a long mark off the wall [m]
  double area = 0;              ///< of the rest shape [m^2]
  bool in_zone = false;         ///< every particle lies in the working zone
};

/// The marks of one wall in the working zone.
struct WallMarks {
  int count = 0;      ///< particles
  double length = 0;  ///< from one end to the other in the rest shape, straight; 0: none, or one [m]
};

/// Whether sutures of an endoscopic sleeve gastroplasty go there: the body but for its lesser curvature. Antrum and
/// fundus are spared (Updates Surg 2022, 10.1007/s13304-022-01385-4); anterior wall, greater curvature and posterior
/// wall are marked (Kumbhari 2017, VideoGIE, 10.1016/j.vgie.2017.01.002; Erden et al., section 2.1.1).
bool inWorkingZone(Region region, Wall wall);

/// Finds what is marked. Meant for after a step in which a grade has risen; some tens of microseconds.
/// Holds scratch memory and no state; not shared between threads of control.
class MarkFinder {
 public:
  /// @param organ  must outlive this
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
