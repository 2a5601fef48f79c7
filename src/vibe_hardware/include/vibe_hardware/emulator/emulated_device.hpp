#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "vibe_firmware/core/sample.hpp"
#include "vibe_firmware/protocol/control_endpoint.hpp"
#include "vibe_firmware/protocol/haptic_function.hpp"
#include "vibe_firmware/protocol/input_function.hpp"
#include "vibe_firmware/protocol/reports.hpp"
#include "vibe_hardware/emulator/axis_plant.hpp"

namespace vibe::hardware {

constexpr double kTick = 1e-3;  ///< of the control loop [s]

/// What a person does at a device in one tick.
struct DeviceMotion {
  std::array<double, vibe_firmware::kAxisCount> intended{};  ///< where the hand wants the axes to be [rad]
  std::uint16_t buttons = 0;                                 ///< one bit each
};

/// A device that exists as a model only, with the real firmware in it. It knows no clock: tick() is a millisecond.
class EmulatedDevice {
 public:
  virtual ~EmulatedDevice() = default;

  /// The next millisecond: firmware and mechanics. @param motion  of the hand at the end of the tick
  virtual void tick(const DeviceMotion& motion) = 0;

  /// The input report that is due, if any: every ten ticks. @return whether there is one
  virtual bool nextReport(std::uint8_t (&bytes)[vibe_firmware::kInputReportSize]) = 0;

  /// Its USB side.
  virtual vibe_firmware::HidFunction& function() = 0;

  /// Switches the firmware off and on; the mechanics stay where they are, and counting begins at 0 there. Ends the life
  /// of function().
  virtual void restart() = 0;
};

/// A quadrature encoder with an index pulse, and the counter of a timer that reads it.
class EmulatedEncoder {
 public:
  /// @param counts_per_turn  between two index pulses; 0: without
  /// @param counter_bits     of the timer, 1 to 32
  EmulatedEncoder(std::int32_t counts_per_turn, int counter_bits)
      : counts_per_turn_(counts_per_turn), mask_(counter_bits >= 32 ? ~0U : (1U << counter_bits) - 1) {}

  /// Reads the timer. @param count  where the encoder is now
  vibe_firmware::EncoderSample sample(std::int32_t count);

 private:
  static constexpr std::int32_t kIndexCount = 700;  ///< an index pulse is here (design choice)

  std::int32_t turnOf(std::int32_t count) const;

  std::int32_t counts_per_turn_;
  std::uint32_t mask_;
  std::int32_t last_ = 0;
};

/// A device with the firmware in it: encoders at its axes, and its USB side.
/// @tparam Firmware  vibe_firmware::HapticFunction or InputFunction
/// @tparam Config    of that firmware
template <typename Firmware, typename Config>
class FirmwareDevice : public EmulatedDevice {
 public:
  bool nextReport(std::uint8_t (&bytes)[vibe_firmware::kInputReportSize]) override {
    return firmware_->nextReport(bytes);
  }
  vibe_firmware::HidFunction& function() override { return *firmware_; }
  void restart() override {
    firmware_ = std::make_unique<Firmware>(config_, serial_.c_str());
    ticks_ = 0;
  }

  const Firmware& firmware() const { return *firmware_; }  ///< until restart()

 protected:
  FirmwareDevice(const Config& config, std::string serial)
      : config_(config), serial_(std::move(serial)), firmware_(std::make_unique<Firmware>(config_, serial_.c_str())) {
    for (const vibe_firmware::AxisConfig& axis : config.axes)
      encoders_.emplace_back(static_cast<std::int32_t>(std::lround(axis.counts_per_turn)), config.counter_bits);
  }

  /// What the firmware reads in the next millisecond. @param counts  where the encoders are now
  vibe_firmware::HapticSample sample(const std::array<std::int32_t, vibe_firmware::kAxisCount>& counts,
                                     std::uint16_t buttons) {
    vibe_firmware::HapticSample sample;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const vibe_firmware::EncoderSample read = encoders_[i].sample(counts[i]);
      sample.counter[i] = read.counter;
      sample.index[i] = read.index;
      sample.index_counter[i] = read.index_counter;
    }
    sample.buttons = buttons;
    sample.time_us = 1000 * ticks_++;
    return sample;
  }

  const Config config_;
  const std::string serial_;
  std::vector<EmulatedEncoder> encoders_;
  std::unique_ptr<Firmware> firmware_;

 private:
  std::uint32_t ticks_ = 0;
};

/// The haptic device: two axes with motors, the firmware, and a hand that holds them.
class EmulatedHaptic : public FirmwareDevice<vibe_firmware::HapticFunction, vibe_firmware::HapticConfig> {
 public:
  using Plants = std::array<AxisPlant, vibe_firmware::kAxisCount>;  ///< by axis of the device

  /// @param config  of the firmware. The encoder steps of the plants have to be those of its axes.
  EmulatedHaptic(const vibe_firmware::HapticConfig& config, const Plants& plants, std::string serial)
      : FirmwareDevice(config, std::move(serial)), plants_(plants) {}

  void tick(const DeviceMotion& motion) override;
  void restart() override;

  const AxisPlant& plant(std::size_t axis) const { return plants_[axis]; }  ///< constant mechanics; axis 0 or 1
  /// Its motion after the last tick; axis 0 or 1.
  const AxisPlantState& axis(std::size_t axis) const { return axes_[axis]; }
  /// Torques that the firmware asked for in the last tick [N m].
  const std::array<float, vibe_firmware::kAxisCount>& torques() const { return torques_; }

 private:
  Plants plants_;
  std::array<AxisPlantState, vibe_firmware::kAxisCount> axes_{};
  std::array<float, vibe_firmware::kAxisCount> torques_{};
};

/// The input device: two wheels and buttons. It has no motors, so the wheels are where the hand wants them to be.
class EmulatedInput : public FirmwareDevice<vibe_firmware::InputFunction, vibe_firmware::InputConfig> {
 public:
  /// @param config  of the firmware: resolution of the wheels, period of the reports
  /// @param serial  that it states on USB
  EmulatedInput(const vibe_firmware::InputConfig& config, std::string serial)
      : FirmwareDevice(config, std::move(serial)) {}

  void tick(const DeviceMotion& motion) override;
};

}  // namespace vibe::hardware
