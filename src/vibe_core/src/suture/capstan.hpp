#pragma once
#include <Eigen/Core>

namespace vibe {

/// Angle by which a thread turns at b on its way from a to c [rad], 0 (straight on) to pi (back); 0 where two coincide.
double turningAngle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Largest ratio of the tensions on both sides of an eyelet, e^(friction angle) (Euler, Eytelwein: the capstan).
/// @param friction  Coulomb's, 0 or more; infinity lets nothing slide
/// @param angle     turn at the eyelet [rad], 0 or more
/// @throws Error    if one is below 0 or not a number
double capstanFactor(double friction, double angle);

/// More segments than this are refused. Bites of one suture are counted in single digits.
constexpr int kMaxThreadSegments = 64;
/// An eyelet with this capstan factor or more holds like a knot.
constexpr double kHoldingFactor = 1e4;

/// Where a thread of m segments between m - 1 eyelets comes to rest.
struct ThreadSlide {
  Eigen::VectorXd tension;  ///< of segment k, 0 or more [N], (m)
  Eigen::VectorXd slide;    ///< through eyelet k from segment k to segment k + 1 [m], (m - 1)
  Eigen::VectorXd slack;    ///< by which segment k is longer than its way; 0 where there is tension [m], (m)
  bool converged = false;   ///< all conditions are met to 1e-9; else they are met as far as was found
};

/// Tensions and slides of a weightless thread that runs through eyelets with Coulomb friction: with
///   slack_k = slide_{k-1} - slide_k - lack_k + (C tension)_k,
/// slack and tension are 0 or more and never both above 0; tensions at an eyelet differ by its capstan factor at most;
/// thread slides only where they differ by just that, and towards the greater one. A weightless slack thread slides
/// freely: where one part lacks thread it comes from the parts that the least friction keeps away.
/// The two ends are fixed; shorten the material of the end segment to pull. A weight at an end is a segment of great
/// compliance c whose lack is c times the weight.
/// The result depends on the arguments only, not on what it held before. Exact: the path of solutions from one that is
/// known (frictionless) is followed from one change of sticking or sliding to the next. Unique where C is diagonal; a
/// thread whose eyelets move so that pulling one segment shortens others more than itself may have several.
/// Costs m^3 per change, of which there are about as many as eyelets; allocates only if the sizes of result change.
/// @param lack            way of a segment if nothing pulled, less its thread [m]; below 0: slack, (m)
/// @param compliance      C: shortening of the ways, and stretch of the thread, per tension [m/N], (m x m), symmetric
///                        positive definite
/// @param capstan_factor  of eyelet k, between segments k and k + 1, 1 or more, infinity allowed, (m - 1)
/// @throws Error          if sizes do not fit, m is 0 or above kMaxThreadSegments, or a number makes no sense
void slideThread(const Eigen::Ref<const Eigen::VectorXd>& residual, const Eigen::Ref<const Eigen::MatrixXd>& compliance,
                 const Eigen::Ref<const Eigen::VectorXd>& capstan_factor, ThreadSlide& result);

}  // namespace vibe
