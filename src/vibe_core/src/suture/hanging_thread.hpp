#pragma once
#include <Eigen/Core>
#include <vector>

#include "vibe_core/suture/thread_material.hpp"

namespace vibe {

/// A slack thread in motion: a chain of n links, each as stiff as the thread, with the mass of the thread at the n + 1
/// nodes (half a link's at the ends), no bending stiffness. Constant.
struct HangingThreadModel {
  int links;                ///< n, 1 or more
  double length;            ///< of the thread [m], above 0
  double mass_per_length;   ///< [kg/m], above 0
  double axial_stiffness;   ///< EA: force per strain [N], above 0
  double tip_mass;          ///< at the last node, in addition [kg], 0 or more
  double drag;              ///< velocity fades at this rate against still surroundings [1/s], 0 or more
  double largest_substep;   ///< a step is divided into equal ones no longer than this [s], above 0
  Eigen::Vector3d gravity;  ///< [m/s^2]

  double linkLength() const { return length / links; }  ///< [m]
  double nodeMass(int node) const;                      ///< [kg]
};

/// What holds a thread's ends. An end that is not held hangs free and its position is ignored.
struct ThreadEnds {
  bool first_held, last_held;
  Eigen::Vector3d first, last;  ///< [m]
};

/// State of a hanging thread: plain numbers, copied as they are.
struct HangingThread {
  Eigen::Matrix3Xd position;  ///< of node j [m], (3 x links + 1)
  Eigen::Matrix3Xd velocity;  ///< of node j [m/s], (3 x links + 1)
  Eigen::VectorXd tension;    ///< of the link from node k to k + 1 [N], (links); below 0: it is being compressed
};

/// Room to work in; holds nothing from one call to the next.
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

/// A thread of this material. Links are rigid but for the stretch of the material. Drag: a slow fluid drags a thin
/// thread by 4 pi viscosity / ln(7.4 / Re) per length and speed (Lamb, Hydrodynamics, article 343), 0.9 1/s for 2-0
/// polypropylene in carbon dioxide at 1 cm/s; more where it moves faster, which is left out. Sub-steps of 1/480 s: of a
/// thread of 0.3 m they take from the first swing a tenth of what drag does.
HangingThreadModel hangingThread(const ThreadMaterial& material, double length, int links,
                                 const Eigen::Vector3d& gravity);

/// The thread at rest between its ends: nodes at equal arc lengths of the catenary (see hang()), straight down from an
/// end that is held alone, or from ends.first if none is.
/// @throws Error  if a number of the model or the ends makes no sense
HangingThread threadAtRest(const HangingThreadModel& model, const ThreadEnds& ends);

/// Moves the thread on by dt. Held ends go to where they are held on straight lines at constant speed. Backward Euler
/// in sub-steps, Newton's method on positions and tensions together: stable for any step; motion of angular frequency w
/// fades by the share w^2 h / 2 per second at sub-steps of h, besides drag. Costs links x sub-steps x iterations.
/// Where an end jumps so far that no equilibrium is found, that sub-step keeps the lengths and not the forces.
/// Ends further apart than the thread stretch it, straight, with the tension of its stiffness; breaking is the
/// caller's. Depends on the arguments only; allocates only if scratch was last used for another number of links.
/// @param dt      [s], above 0
/// @throws Error  if state does not fit the model, or anything is not finite; state is then as before
void stepThread(const HangingThreadModel& model, const ThreadEnds& ends, double dt, HangingThread& state,
                HangingThreadScratch& scratch);

/// Force of the thread on what holds its first or last end: of the end's link and the weight of its half [N].
Eigen::Vector3d pullOnFirst(const HangingThreadModel& model, const HangingThread& state);
Eigen::Vector3d pullOnLast(const HangingThreadModel& model, const HangingThread& state);

/// Length of the chain as it is [m].
double chainLength(const HangingThread& state);

}  // namespace vibe
