#include "vibe_hardware/driver/report_stream.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::hardware {
namespace {

using vibe_firmware::InputReport;

constexpr double kMicrosecond = 1e-6;
constexpr double kAhead = 0.1;       // of the arrival, that a sample cannot be [s]
constexpr double kSameRun = 0.2;     // error of the clock after a replug [s]
constexpr int kNewRun = 10;          // reports that continue each other are a device that has restarted
constexpr double kMonotonic = 1e-6;  // between samples [s]

int sequenceStep(const InputReport& from, const InputReport& to) {
  return static_cast<std::int16_t>(to.sequence - from.sequence);
}

/// Modulo 71.6 min [s]
double timeStep(const InputReport& from, const InputReport& to) {
  return kMicrosecond * static_cast<std::int32_t>(to.time_us - from.time_us);
}

}  // namespace

ReportStream::Result ReportStream::reject(Result result, std::uint64_t& count, const std::string& explanation) {
  ++count;
  explanation_ = explanation;
  return result;
}

ReportStream::Result ReportStream::take(const std::uint8_t* bytes, std::size_t size, double arrival,
                                        DeviceSample& sample) {
  InputReport report;
  if (!vibe_firmware::unpack(bytes, size, report)) {
    const std::string what = size < vibe_firmware::kInputReportSize   ? "truncated"
                             : size > vibe_firmware::kInputReportSize ? "too long"
                                                                      : "of an unknown kind";
    const std::string id = size > 0 ? " with id " + std::to_string(bytes[0]) : "";
    return reject(Result::Malformed, counts_.malformed,
                  "a report of " + std::to_string(size) + " bytes" + id + " is " + what + " (expected are " +
                      std::to_string(vibe_firmware::kInputReportSize) + " bytes with id " +
                      std::to_string(vibe_firmware::kInputReportId) + ")");
  }
  sample.restarted = false;
  if (!started_) {
    begin(report);
    sample.restarted = true;
  } else {
    const Result result = judge(report, arrival);
    const bool new_run = result != Result::Accepted && result != Result::Duplicated && isNewRun(report);
    if (result == Result::Duplicated && !reopened_) return result;
    if (result != Result::Accepted && !new_run && !reopened_) return result;
    if (result != Result::Accepted) {
      ++counts_.restarts;
      begin(report);
      sample.restarted = true;
    }
  }
  accept(report, arrival, sample);
  return Result::Accepted;
}

ReportStream::Result ReportStream::judge(const InputReport& report, double arrival) {
  const int step = sequenceStep(last_, report);
  const double elapsed = timeStep(last_, report);
  const double sampled = clock_.hostTime(device_time_ + elapsed);
  if (reopened_) {
    return elapsed > 0 && std::abs(arrival - sampled) < kSameRun ? Result::Accepted : Result::Implausible;
  }
  const std::string number = "the report with sequence number " + std::to_string(report.sequence);
  const std::string last = std::to_string(last_.sequence);
  if (step == 0) return reject(Result::Duplicated, counts_.duplicated, number + " came a second time");
  if (step < 0) {
    return reject(Result::Reordered, counts_.reordered,
                  number + " came after " + last + ": it was reordered, sent again, or the device began anew");
  }
  if (elapsed <= 0) {
    return reject(Result::Implausible, counts_.implausible, number + " has a device time before that of " + last);
  }
  if (sampled > arrival + kAhead) {
    return reject(Result::Implausible, counts_.implausible, number + " has a device time ahead of the wall clock");
  }
  return Result::Accepted;
}

bool ReportStream::isNewRun(const InputReport& report) {
  const bool continues = suspects_ > 0 && sequenceStep(suspect_, report) == 1 && timeStep(suspect_, report) > 0;
  suspects_ = continues ? suspects_ + 1 : 1;
  suspect_ = report;
  return suspects_ >= kNewRun;
}

void ReportStream::begin(const InputReport& report) {
  started_ = true;
  clock_.clear();
  last_ = report;
  device_time_ = kMicrosecond * report.time_us;
}

void ReportStream::accept(const InputReport& report, double arrival, DeviceSample& sample) {
  const int step = sequenceStep(last_, report);
  if (!reopened_ && !sample.restarted) counts_.lost += static_cast<std::uint64_t>(step - 1);
  device_time_ += timeStep(last_, report);
  clock_.add(device_time_, arrival);
  last_time_ = std::max(std::min(clock_.hostTime(device_time_), arrival), last_time_ + kMonotonic);
  last_ = report;
  reopened_ = false;
  suspects_ = 0;
  arrivals_[counts_.received++ % kRateWindow] = arrival;
  sample.time = last_time_;
  for (std::size_t a = 0; a < sample.position.size(); ++a) {
    sample.position[a] = radians_per_count_[a] * report.counts[a];
    sample.torque[a] = double{vibe_firmware::kTorqueUnit} * report.torque[a];
  }
  sample.buttons = report.buttons;
  sample.flags = report.flags;
  sample.parameter_number = report.parameter_number;
}

double ReportStream::rate(double now) const {
  const std::size_t count = std::min<std::uint64_t>(counts_.received, kRateWindow);
  int recent = 0;
  for (std::size_t i = 0; i < count; ++i) recent += arrivals_[i] > now - 1 ? 1 : 0;
  return recent;
}

}  // namespace vibe::hardware
