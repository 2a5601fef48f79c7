#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "gradient/gradient_deformation.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe::prototype {

/// A particle inside a tool, and its target on the surface of the tool.
struct Touch {
  int particle = -1;
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< [m]
};

/// A wall that yields to a tool by gradient-domain deformation, in place of a solver step while the wall is marked. The
/// shape is that of the untouched wall, with particles inside the tool moved out of it and the surrounding patch
/// deformed accordingly (see GradientDeformation and its limits). Without contact the wall is unchanged: it returns to
/// its shape immediately and has no memory. Tools push and do not pull.
///
/// Limits: particles inside the tool are searched on the untouched wall. A tool whose centre goes beyond that wall
/// therefore passes through; push no deeper than its radius. When a particle comes into contact, the shape jumps by up
/// to 1 mm.
///
/// The result depends only on the arguments of update(). Allocates when the set of touched particles changes. Not
/// thread-safe.
class GradientTouch {
 public:
  /// Appends the particles inside the tool at these positions [m], each once.
  using FindTouches = std::function<void(const std::vector<double>& x, const std::vector<double>& y,
                                         const std::vector<double>& z, std::vector<Touch>& touches)>;

  /// @param radius  of the patch around the touched particles [m]
  /// @param turns   see GradientDeformation
  explicit GradientTouch(double radius = 0.05, int turns = 1) : radius_(radius), turns_(turns) {}

  /// @param base  the untouched wall
  /// @param find  called a few times, with increasingly accurate positions
  /// @param x, y, z  out: of all particles [m]
  /// @return number of particles that the tool displaces; 0: no contact, and x, y, z are those of the base
  /// @throws Error for triangles of the base without area
  int update(const SurfaceView& base, const FindTouches& find, std::vector<double>& x, std::vector<double>& y,
             std::vector<double>& z);

 private:
  bool takeNew();
  void deform(const SurfaceView& base);
  bool sameBase(const SurfaceView& base) const;

  double radius_;
  int turns_;
  std::vector<Touch> found_;
  std::vector<int> handles_;
  std::vector<Eigen::Vector3d> targets_, positions_;

  // the configuration for which the deformation was built
  std::unique_ptr<GradientDeformation> deformation_;
  std::vector<int> made_for_;
  std::vector<double> base_x_, base_y_, base_z_;
};

}  // namespace vibe::prototype
