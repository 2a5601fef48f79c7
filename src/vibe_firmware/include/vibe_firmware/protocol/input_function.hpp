#pragma once
#include <atomic>

#include "vibe_firmware/core/input_device.hpp"
#include "vibe_firmware/protocol/control_endpoint.hpp"
#include "vibe_firmware/protocol/mailbox.hpp"

namespace vibe_firmware {

/// The input device as a HID device. tick() belongs to the sampling interrupt, everything else to the main loop: see
/// HapticFunction.
class InputFunction final : public HidFunction {
 public:
  /// @param serial  ASCII, at most 126 characters; the text must outlive the object
  explicit InputFunction(const InputConfig& config, const char* serial = "0");

  /// One tick of the 1 kHz sampling.
  void tick(const HapticSample& sample);

  /// A tick began more than 10 % of the period too late. Sampling interrupt.
  void countLateTick() { late_ticks_.fetch_add(1, std::memory_order_relaxed); }

  void hostGone() {}  ///< nothing moves by itself

  /// As HapticFunction::nextReport().
  bool nextReport(std::uint8_t (&bytes)[kInputReportSize]);

  const InputConfig& config() const { return config_; }  ///< as it was given; does not change

  /// Of the sampling. Only between two ticks.
  const InputState& state() const { return state_; }

  Bytes deviceDescriptor() const override;
  Bytes configurationDescriptor() const override;
  Bytes reportDescriptor() const override;
  Bytes string(std::uint8_t index) const override;
  std::size_t getReport(ReportType type, std::uint8_t id, std::uint8_t* bytes, std::size_t capacity) override;

  /// No report can be set.
  bool setReport(ReportType type, std::uint8_t id, const std::uint8_t* bytes, std::size_t size) override;

 private:
  StatusReport status() const;

  const InputConfig config_;
  const char* const serial_;
  // of the sampling interrupt
  InputState state_;
  std::uint32_t ticks_to_report_ = 0;
  // of the main loop
  std::uint32_t reports_sent_ = 0;
  // between them
  Published<InputReport> report_;
  std::atomic<std::uint8_t> flags_{0};  // of the last tick
  std::atomic<std::uint32_t> late_ticks_{0};
};

}  // namespace vibe_firmware
