#pragma once
#include <Eigen/Core>

namespace vibe {

/// Angle by which a thread turns at b on its way from a to c [rad], from 0 (straight) to pi (reversal); 0 if two of the
/// points coincide.
double turningAngle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Largest ratio of the tensions on both sides of an eyelet, e^(friction angle) (Euler, Eytelwein: the capstan).
/// @param friction  Coulomb coefficient, 0 or more; infinity prevents sliding
/// @param angle     turn at the eyelet [rad], 0 or more
/// @throws Error    if one is below 0 or not a number
double capstanFactor(double friction, double angle);

/// Larger numbers of segments are rejected. A suture has fewer than ten bites.
constexpr int kMaxThreadSegments = 64;
/// An eyelet with at least this capstan factor holds like a knot.
constexpr double kHoldingFactor = 1e4;

/// Equilibrium of a thread of m segments between m - 1 eyelets.
struct ThreadSlide {
  Eigen::VectorXd tension;  ///< of segment k, 0 or more [N], (m)
  Eigen::VectorXd slide;    ///< through eyelet k from segment k to segment k + 1 [m], (m - 1)
  Eigen::VectorXd slack;    ///< excess length of segment k; 0 where there is tension [m], (m)
  bool converged = false;   ///< all conditions are met to 1e-9; otherwise this is the best solution found
};

/// Tensions and slides of a weightless thread through eyelets with Coulomb friction. With
///   slack_k = slide_{k-1} - slide_k - lack_k + (C tension)_k,
/// slack and tension are 0 or more and never both above 0. The tensions at an eyelet differ at most by its capstan
/// factor. Thread slides only where they differ by exactly this factor, and towards the larger one. A weightless slack
/// thread slides freely: a part that lacks thread takes it from the parts with the least friction in between. The two
/// ends are fixed; to pull, shorten the material of the end segment. A weight at an end is a segment of large
/// compliance c whose lack is c times the weight.
///
/// The result depends only on the arguments, not on the previous content. The method is exact: it follows the solution
/// path from a known (frictionless) solution, from one change of sticking or sliding to the next. The solution is
/// unique if C is diagonal. A thread whose eyelets move so that pulling one segment shortens others more than itself
/// may have several solutions. The cost is m^3 per change, and there are about as many changes as eyelets. Allocates
/// only if the sizes of the result change.
/// @param lack            path length of a segment without tension, minus its thread length [m]; below 0: slack, (m)
/// @param compliance      C: shortening of the paths plus stretch of the thread, per tension [m/N], (m x m), symmetric
///         positive definite
/// @param capstan_factor  of eyelet k, between segments k and k + 1, 1 or more, infinity allowed, (m - 1)
/// @throws Error          if sizes do not match, m is 0 or above kMaxThreadSegments, or an argument is out of range
void slideThread(const Eigen::Ref<const Eigen::VectorXd>& residual, const Eigen::Ref<const Eigen::MatrixXd>& compliance,
                 const Eigen::Ref<const Eigen::VectorXd>& capstan_factor, ThreadSlide& result);

}  // namespace vibe
