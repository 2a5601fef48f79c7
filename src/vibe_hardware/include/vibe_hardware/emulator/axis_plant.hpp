#pragma once
#include <cstdint>

// The mechanics of one axis of a device with the hand that holds it: a pure function of model, state and input.
// Angles [rad] and torques [N m] are at the shaft after the transmission.

namespace vibe::hardware {

/// A DC motor behind an H-bridge. Defaults: Faulhaber 1524-012SR, data sheet. The inductance is left out: the
/// electrical time constant is shorter than a substep.
struct Motor {
  double torque_constant = 11.5e-3;  ///< [N m/A]
  double resistance = 19.8;          ///< [ohm]
  double inertia = 5.6e-8;           ///< of the rotor [kg m^2]
  double friction = 0.08e-3;         ///< of brushes and bearings [N m]
  double supply = 9;                 ///< of the bridge, a DRV8833 [V]; stall torque at the shaft: 0.052 N m
};

/// How the bridge drives the motor.
enum class Drive {
  Voltage,  ///< the winding is always closed: back-EMF brakes
  Torque,   ///< a current loop, or a winding that is left open in between: it does not
};

/// Hand and arm at the shaft: a mass that a spring and a damper pull to where the person wants it to be. The
/// second-order form is the usual one (Hogan 1989; Hasser and Cutkosky 2002 for a knob between two fingers; Speich,
/// Shao and Goldfarb 2005, who add a second spring and damper). All zero: nobody holds the device.
struct HandImpedance {
  double inertia = 0;    ///< [kg m^2]
  double damping = 0;    ///< [N m s/rad]
  double stiffness = 0;  ///< [N m/rad]
};

/// The same for a hand that pushes a slide over a roller.
/// @param mass [kg], damping [N s/m], stiffness [N/m], radius of the roller [m]
HandImpedance handOnSlide(double mass, double damping, double stiffness, double radius);

/// Everything that is constant.
struct AxisPlant {
  Motor motor;                    ///< that drives the shaft
  Drive drive = Drive::Voltage;   ///< what back-EMF does
  double ratio = 10;              ///< of the capstan: turns of the motor per turn of the shaft
  double inertia = 5e-6;          ///< of drum and shaft, without motor (design choice) [kg m^2]
  double viscous = 0;             ///< friction beside back-EMF [N m s/rad]
  double coulomb = 0;             ///< friction beside that of the motor [N m]
  double breakaway = 1;           ///< friction at rest over friction in motion, at least 1 (ratio)
  double encoder_step = 3.07e-4;  ///< angle of one count [rad]
  double output_delay = 50e-6;    ///< from sampling the encoder to the new torque; multiple of substep [s]
  double substep = 50e-6;         ///< of the integration [s]
  HandImpedance hand;             ///< that holds the shaft
};

/// Viscous friction that the shaft feels, back-EMF included [N m s/rad].
double viscousFriction(const AxisPlant& plant);
/// Coulomb friction that the shaft feels in motion [N m].
double coulombFriction(const AxisPlant& plant);
/// Inertia of motor, shaft and hand [kg m^2].
double totalInertia(const AxisPlant& plant);

/// Work since the start [J]. motor + hand = kinetic energy + viscous + coulomb, to rounding.
struct AxisEnergy {
  double motor = 0;    ///< done by the torque that the current makes
  double hand = 0;     ///< done by the person's spring and damper on the moving mass
  double viscous = 0;  ///< lost in viscous friction and back-EMF
  double coulomb = 0;  ///< lost in Coulomb friction
};

/// Everything that changes.
struct AxisPlantState {
  double position = 0;  ///< [rad]
  double velocity = 0;  ///< [rad/s]
  double torque = 0;    ///< made by the current, without back-EMF [N m]
  double intended = 0;  ///< where the hand wants to be [rad]
  AxisEnergy energy;    ///< since the start [J]
};

/// Advances by one period. The torque of the last period acts until output_delay has passed. The midpoint rule keeps
/// the energy balance exact; friction at rest holds without creep.
/// @param command   torque that the controller asks for [N m]; with Drive::Voltage limited by the supply
/// @param intended  where the hand wants to be at the end; it goes there evenly [rad]
/// @param period    multiple of plant.substep [s]
void step(const AxisPlant& plant, double command, double intended, double period, AxisPlantState& state);

/// Reading of the encoder: counts, rounded down.
std::int32_t encoderCount(const AxisPlant& plant, const AxisPlantState& state);

/// Kinetic energy of motor, shaft and hand [J].
double kineticEnergy(const AxisPlant& plant, const AxisPlantState& state);

}  // namespace vibe::hardware
