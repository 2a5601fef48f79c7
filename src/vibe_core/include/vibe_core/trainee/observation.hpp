#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_core/state/procedure_state.hpp"

namespace vibe {

/// What a trainee perceives at the end of a step: what the simulator publishes, with the precision of its messages. A
/// node makes it from messages, a program without ROS with observe(); both have the same bits.
struct Observation {
  std::int64_t step = 0;  ///< steps taken so far
  double time = 0;        ///< [s]

  /// Particle positions, of single precision, in world [m]; empty if no image of the wall belongs to the step, see
  /// imageInterval().
  std::vector<Eigen::Vector3d> wall;
  std::array<double, kJointCount> joints{};       ///< of the hand, limits applied [m], [rad]
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< position of scope_tip, in world [m]
  Eigen::Quaterniond tip_turn =
      Eigen::Quaterniond::Identity();               ///< its orientation; unit quaternion, from its frame to world
  Eigen::Vector3d helix = Eigen::Vector3d::Zero();  ///< position of the helix' tip, in world [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< tissue on tool, mean over the step, in scope_tip [N]

  double pressure = 0;                                                  ///< of the gas, gauge [Pa]
  bool pressure_reached = false;                                        ///< the insufflator is at its set point
  bool grips = false;                                                   ///< the helix holds tissue
  bool arm_closed = false, needle_on_arm = true, needle_loaded = true;  ///< of the needle, see ProcedureState

  int sets = 0;                               ///< suture sets begun
  int bites = 0;                              ///< of the last one
  Suture::Stage stage = Suture::Stage::Open;  ///< of the last one
  double tension = 0;                         ///< of its first segment [N]

  std::vector<Event> events;  ///< of the step, with kind, time, particle and value only; without warnings about inputs
};

/// Steps from one image of the wall to the next: as many as make 60 images per second of simulated time, at least 1.
int imageInterval(double step_period);

/// Without ROS.
/// @param wall  false: without the image of the wall also where one belongs to the step
Observation observe(const Simulation& simulation, bool wall = true);

/// Whether an image of the wall belongs to the present step.
bool hasImage(const Simulation& simulation);

}  // namespace vibe
