#pragma once
#include <optional>

#include "vibe_core/haptics/tool_impedance.hpp"
#include "vibe_hardware/driver/haptic_driver.hpp"
#include "vibe_hardware/driver/scope_joints.hpp"
#include "vibe_hardware/emulator/emulator_bus.hpp"
#include "vibe_hardware/emulator/haptic_loop.hpp"

namespace vibe::hardware {

/// The host's side of the haptic loop: the drivers of both devices, as hardware_node uses them, without a graph.
class LoopHost {
 public:
  /// @param clock  virtual time [s]
  LoopHost(EmulatorBus& bus, const Calibration& calibration, std::function<double()> clock);

  /// Reads what has arrived and sends what is due. Once per tick.
  void poll();

  /// What the simulator is told at a time: the last sample that was taken until then.
  StepInput inputAt(double time) const;
  const StepInput& input() const { return input_; }  ///< of the last sample

  /// The tissue answers like this from now on; empty: nothing is touched.
  void render(const std::optional<ToolImpedance>& impedance, Rendering rendering);

  HapticStatistics statistics() const { return haptic_.statistics(); }

 private:
  struct Stamped {
    double time;
    StepInput input;
  };

  DeviceDriver::Callbacks callbacksOf(DeviceKind kind);
  void take(DeviceKind kind, const DeviceSample& sample);

  ScopeJoints joints_;
  ScopeButtons buttons_;
  std::optional<SuturingDeviceDrive> suturing_device_;
  HapticDriver haptic_;
  DeviceDriver input_driver_;
  StepInput input_;
  double last_time_ = 0;  // of a sample of the input device
  std::vector<Stamped> history_;
  bool touching_ = false;
};

}  // namespace vibe::hardware
