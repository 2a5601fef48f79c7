#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "tissue/gradient_deformation.hpp"
#include "vibe_core/geometry/surface_view.hpp"

namespace vibe {

/// A particle inside a tool, and where the tool's surface has it instead.
struct Touch {
  int particle = -1;
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< [m]
};

/// A wall that gives way to a tool in the gradient domain, in place of a solver's step while the wall is marked: the
/// shape is that of the wall before it was touched, with what is inside the tool moved out of it and the patch around
/// deformed along (see GradientDeformation and its limits). Where nothing is touched it is the wall as before: it
/// springs back at once and keeps nothing. Tools push and do not pull.
///
/// Limits: what is inside the tool is found on the wall as it was before, so a tool whose middle goes beyond that wall
/// comes through; push no deeper than its radius. Where a particle comes to be touched the shape jumps by up to 1 mm.
///
/// The result depends on the arguments of follow() alone. Allocates when what is touched changes. Not shared between
/// threads of control.
class GradientTouch {
 public:
  /// Appends the particles that are inside the tool at these positions [m], each once.
  using FindTouches = std::function<void(const std::vector<double>& x, const std::vector<double>& y,
                                         const std::vector<double>& z, std::vector<Touch>& touches)>;

  /// @param radius  of the patch around what is touched [m]
  /// @param turns   see GradientDeformation
  explicit GradientTouch(double radius = 0.05, int turns = 1) : radius_(radius), turns_(turns) {}

  /// @param base  the wall before it was touched
  /// @param find  called a few times, with better and better positions
  /// @param x, y, z  out: of all particles [m]
  /// @return particles that the tool holds away; 0: nothing is touched and x, y, z are those of the base
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

  // what the deformation was made for
  std::unique_ptr<GradientDeformation> deformation_;
  std::vector<int> made_for_;
  std::vector<double> base_x_, base_y_, base_z_;
};

}  // namespace vibe
