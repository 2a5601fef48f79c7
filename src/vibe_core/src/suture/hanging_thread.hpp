#pragma once
#include <Eigen/Core>
#include <vector>

#include "vibe_core/suture/thread_material.hpp"

namespace vibe {

/// Dynamic model of a slack thread: a chain of n links, each with the stiffness of the thread, with the mass of the
/// thread at the n + 1 nodes (half a link at each end) and no bending stiffness. Constant.
struct HangingThreadModel {
  int links;                ///< n, 1 or more
  double length;            ///< of the thread [m], above 0
  double mass_per_length;   ///< [kg/m], above 0
  double axial_stiffness;   ///< EA: force per strain [N], above 0
  double tip_mass;          ///< additional mass at the last node [kg], 0 or more
  double drag;              ///< decay rate of the velocity relative to still surroundings [1/s], 0 or more
  double largest_substep;   ///< a step is divided into equal sub-steps no longer than this [s], above 0
  Eigen::Vector3d gravity;  ///< [m/s^2]

  double linkLength() const { return length / links; }  ///< [m]
  double nodeMass(int node) const;                      ///< [kg]
};

/// Constraints of the thread ends. An end that is not held hangs freely, and its position is ignored.
struct ThreadEnds {
  bool first_held, last_held;
  Eigen::Vector3d first, last;  ///< [m]
};

/// State of a hanging thread; plain values.
struct HangingThread {
  Eigen::Matrix3Xd position;  ///< of node j [m], (3 x links + 1)
  Eigen::Matrix3Xd velocity;  ///< of node j [m/s], (3 x links + 1)
  Eigen::VectorXd tension;    ///< of the link from node k to k + 1 [N], (links); below 0: compression
};

/// Scratch memory; holds no state between calls.
struct HangingThreadScratch {
  struct Link {
    Eigen::Vector3d direction, coupling, right;
    Eigen::Matrix3d across, root;
    double pivot, rest, error;
  };
  HangingThread start;
  std::vector<Link> link;
  Eigen::Matrix3Xd target, move, force;
  Eigen::VectorXd tension_change;
};

/// Model of a thread of this material. The links stretch only with the material. Drag: at low Reynolds number a fluid
/// drags a thin thread by 4 pi viscosity / ln(7.4 / Re) per length and speed (Lamb, Hydrodynamics, article 343), which
/// is 0.9 1/s for 2-0 polypropylene in carbon dioxide at 1 cm/s. The increase at higher speed is neglected. With
/// sub-steps of 1/480 s, the numerical damping of the first swing of a thread of 0.3 m is a tenth of that by drag.
HangingThreadModel hangingThread(const ThreadMaterial& material, double length, int links,
                                 const Eigen::Vector3d& gravity);

/// The thread at rest between its ends: nodes at equal arc lengths of the catenary (see hang()). It hangs straight down
/// from an end that is held alone, or from ends.first if none is.
/// @throws Error  if a parameter of the model or the ends is out of range
HangingThread threadAtRest(const HangingThreadModel& model, const ThreadEnds& ends);

/// Advances the thread by dt. Held ends move to their new positions on straight lines at constant speed. Backward Euler
/// in sub-steps, with Newton's method on positions and tensions together, is stable for any step. Besides drag, motion
/// of angular frequency w decays by the fraction w^2 h / 2 per second for sub-steps of h. The cost is proportional to
/// links x sub-steps x iterations. If an end jumps so far that no equilibrium is found, that sub-step preserves the
/// lengths instead of balancing forces. If the ends are farther apart than the thread length, the thread is straight,
/// with the tension that follows from its stiffness; the caller handles breaking. Depends only on the arguments.
/// Allocates only if scratch was last used for another number of links.
/// @param dt      [s], above 0
/// @throws Error  if state does not match the model, or a value is not finite; state is then unchanged
void stepThread(const HangingThreadModel& model, const ThreadEnds& ends, double dt, HangingThread& state,
                HangingThreadScratch& scratch);

/// Force of the thread on the holder of its first or last end: tension of the end link plus the weight of half of it
/// [N].
Eigen::Vector3d pullOnFirst(const HangingThreadModel& model, const HangingThread& state);
Eigen::Vector3d pullOnLast(const HangingThreadModel& model, const HangingThread& state);

/// Current length of the chain [m].
double chainLength(const HangingThread& state);

}  // namespace vibe
