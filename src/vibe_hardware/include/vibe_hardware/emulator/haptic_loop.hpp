#pragma once
#include <memory>
#include <vector>

#include "vibe_core/scene/scene.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_hardware/emulator/emulator.hpp"

namespace vibe::hardware {

/// What the device renders between two messages of the simulator.
enum class Rendering {
  Spring,  ///< force, stiffness and damping of haptic/parameters
  Held,    ///< the force alone, constant until the next message
};

/// One millisecond of the loop. Forces act in the direction of the insertion: those of a wall that is pressed are
/// negative.
struct HapticLoopSample {
  double time = 0;        ///< at its end [s]
  double insertion = 0;   ///< of the device [m]
  double rendered = 0;    ///< force of the motor, as the firmware commands it [N]
  double felt = 0;        ///< force of the device on the hand, friction and inertia included [N]
  double frame = 0;       ///< force in the simulator's last frame [N]
  double reference = 0;   ///< force of a simulation with steps of 1 ms along the same motion [N]
  double motor = 0;       ///< energy that the motor has given to the axis since the start, friction not taken off [J]
  bool measured = false;  ///< whether there is a reference
};

/// Error of a force against the reference, over all samples that are measured.
struct RenderingError {
  double change = 0;    ///< root mean square of the reference about its mean [N]
  double rendered = 0;  ///< root mean square error of the rendered force [N]
  double felt = 0;      ///< the same of the force on the hand [N]
  double delay = 0;     ///< by which the rendered force follows the reference: maximum of the cross-correlation [s]
  double tissue_energy = 0;  ///< that the reference gives to the hand on this motion [J]
  double motor_energy = 0;   ///< that the motor gives to the hand on this motion [J]
  double most_energy = 0;    ///< the most that the motor has given since the start of the measurement, at any time [J]
};

/// Measures a motion; the samples that are not measured are left out. All zero if none is.
RenderingError renderingError(const std::vector<HapticLoopSample>& samples);

/// Who moves the device, how forces are rendered and how long.
struct HapticLoopSettings {
  EmulatorSetup setup;                      ///< devices; the insertion has to be on the haptic one
  std::shared_ptr<const Hand> hand;         ///< not null
  Rendering rendering = Rendering::Spring;  ///< of the forces on the device
  double latency = 5e-3;    ///< from the end of a frame to its parameters in the device: step, messages, USB [s]
  double measure_from = 0;  ///< the reference begins here with the state of the frames [s]
  double duration = 1;      ///< [s]
};

/// The motion and what happened to the parameters on the way.
struct HapticLoopResult {
  std::vector<HapticLoopSample> samples;      ///< one per millisecond
  int parameter_sets = 0;                     ///< sent to the device
  int clamped = 0;                            ///< frames whose spring was lowered to what is passive on the device
  int refused = 0;                            ///< sets, by the device
  int mismatched = 0;                         ///< sets that read back differently
  int passivity_acts = 0;                     ///< ticks in which the passivity controller acted
  double thread_tension = 0;                  ///< of the threads at the end, the highest; 0 without any [N]
  double max_stiffness = 0, max_damping = 0;  ///< of the insertion, as the simulator asked for them [N/m], [N s/m]
};

/// The closed loop simulator -> parameters -> driver -> firmware -> hand -> driver -> simulator, in virtual time. As in
/// a session in wall time, the simulator computes a frame when it has ended, from the joints that were reported before
/// it began; the parameters reach the device `latency` later.
/// @param scene  with a scope; its step period is that of the frames
/// @throws Error if the scene cannot be built
HapticLoopResult runHapticLoop(const Scene& scene, const HapticLoopSettings& settings);

}  // namespace vibe::hardware
