#pragma once
#include <atomic>

#include "vibe_firmware/core/haptic_device.hpp"
#include "vibe_firmware/protocol/control_endpoint.hpp"
#include "vibe_firmware/protocol/mailbox.hpp"

namespace vibe_firmware {

/// The haptic device as a HID device: the control loop on one side, the host's reports on the other.
///
/// tick() belongs to the control interrupt, everything else to the main loop, and neither masks the other: parameters
/// of the host wait in a mailbox for the next tick, which takes them over as a whole; reports come from the last tick.
/// A program that calls both from several threads needs a lock.
class HapticFunction final : public HidFunction {
 public:
  /// @param serial  ASCII, at most 126 characters; the text must outlive the object
  explicit HapticFunction(const HapticConfig& config, const char* serial = "0");

  /// One tick of the 1 kHz loop. @return torque of each axis [N m], to be written to the motors in the same tick
  std::array<float, kAxisCount> tick(const HapticSample& sample);

  /// A tick began more than 10 % of the period too late. Control interrupt.
  void countLateTick() { late_ticks_.fetch_add(1, std::memory_order_relaxed); }

  /// The host sleeps or has left: the spring fades now instead of after the timeout; new parameters bring it back.
  void hostGone() { host_gone_.store(true, std::memory_order_relaxed); }

  /// The input report, once each HapticConfig::report_ticks: to be called in the main loop as often as possible. If it
  /// is called too rarely, reports are left out, and the sequence number shows it.
  /// @return whether there is one that was not returned yet
  bool nextReport(std::uint8_t (&bytes)[kInputReportSize]);

  const HapticConfig& config() const { return config_; }  ///< as it was given; does not change

  /// Of the control loop. Only between two ticks.
  const HapticState& state() const { return state_; }

  Bytes deviceDescriptor() const override;
  Bytes configurationDescriptor() const override;
  Bytes reportDescriptor() const override;
  Bytes string(std::uint8_t index) const override;
  std::size_t getReport(ReportType type, std::uint8_t id, std::uint8_t* bytes, std::size_t capacity) override;
  bool setReport(ReportType type, std::uint8_t id, const std::uint8_t* bytes, std::size_t size) override;

 private:
  StatusReport status() const;

  const HapticConfig config_;
  const char* const serial_;
  // of the control interrupt
  HapticState state_;
  std::uint32_t ticks_to_report_ = 0;
  // of the main loop
  ParameterReport accepted_{};
  StatusReport status_{};
  std::uint32_t reports_sent_ = 0;
  // between them
  Mailbox<ParameterReport> parameters_;
  Published<InputReport> report_;
  std::atomic<std::uint8_t> flags_{0};  // of the last tick
  std::atomic<std::uint32_t> late_ticks_{0};
  std::atomic<bool> host_gone_{false};
};

}  // namespace vibe_firmware
