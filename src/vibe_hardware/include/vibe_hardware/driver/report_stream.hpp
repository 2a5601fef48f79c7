#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "vibe_core/clocks/device_clock.hpp"
#include "vibe_firmware/protocol/reports.hpp"

namespace vibe::hardware {

/// A report of a device in the units of its axes.
struct DeviceSample {
  double time = 0;  ///< at which it was taken, host clock; later than that of the sample before [s]
  std::array<double, vibe_firmware::kAxisCount> position{};  ///< [rad]
  std::array<double, vibe_firmware::kAxisCount> torque{};    ///< commanded [N m]
  std::uint16_t buttons = 0;                                 ///< one bit each; 1 while pressed
  std::uint8_t flags = 0;                                    ///< vibe_firmware::DeviceFlag
  std::uint16_t parameter_number = 0;                        ///< of the set of parameters in force; 0: none yet
  bool restarted = false;  ///< first sample after the device has started anew: its counts begin at 0
};

/// Counts since the driver has started.
struct StreamCounts {
  std::uint64_t received = 0;     ///< good ones
  std::uint64_t lost = 0;         ///< sequence numbers that never came
  std::uint64_t duplicated = 0;   ///< the same sequence number again
  std::uint64_t reordered = 0;    ///< older than one that came before: reordered or replayed
  std::uint64_t malformed = 0;    ///< wrong size or id
  std::uint64_t implausible = 0;  ///< device time that does not go with sequence number and arrival
  std::uint64_t restarts = 0;     ///< of the device
};

/// Takes the input reports of one device in the order of their arrival: checks them, unwraps sequence number and time,
/// maps the time to the host's and counts what is wrong. Any bytes may come.
class ReportStream {
 public:
  /// What became of a report: Accepted, or why not. StreamCounts says what each reason means.
  enum class Result : std::uint8_t { Accepted, Malformed, Duplicated, Reordered, Implausible };

  /// Resolution of the encoders [rad]; both finite, not 0.
  void setResolution(const std::array<double, vibe_firmware::kAxisCount>& radians_per_count) {
    radians_per_count_ = radians_per_count;
  }

  /// The port was opened again: the next report may be of the same run of the device or of a new one.
  void reopen() { reopened_ = true; }

  /// @param arrival  host time [s]  @param sample  set if the result is Accepted
  /// @return if not Accepted, explanation() says why
  Result take(const std::uint8_t* bytes, std::size_t size, double arrival, DeviceSample& sample);

  const std::string& explanation() const { return explanation_; }  ///< one sentence on the last report not accepted
  const StreamCounts& counts() const { return counts_; }  ///< of all reports so far, over restarts and reopening
  /// Relation of the device's time to the host's; learnt anew when the device restarts.
  const DeviceClock& clock() const { return clock_; }
  double rate(double now) const;  ///< accepted reports in the last second, 256 at most [Hz]

 private:
  static constexpr std::size_t kRateWindow = 256;

  std::array<double, vibe_firmware::kAxisCount> radians_per_count_{1, 1};
  StreamCounts counts_;
  DeviceClock clock_;
  std::string explanation_;
  bool started_ = false;
  bool reopened_ = false;
  vibe_firmware::InputReport last_{};
  double device_time_ = 0;                // of last_, unwrapped [s]
  double last_time_ = 0;                  // of last_, on the host's clock [s]
  vibe_firmware::InputReport suspect_{};  // the last one rejected for its number or time
  int suspects_ = 0;                      // in a row that continue each other
  std::array<double, kRateWindow> arrivals_{};

  Result reject(Result result, std::uint64_t& count, const std::string& explanation);
  Result judge(const vibe_firmware::InputReport& report, double arrival);
  bool isNewRun(const vibe_firmware::InputReport& report);
  void begin(const vibe_firmware::InputReport& report);
  void accept(const vibe_firmware::InputReport& report, double arrival, DeviceSample& sample);
};

}  // namespace vibe::hardware
