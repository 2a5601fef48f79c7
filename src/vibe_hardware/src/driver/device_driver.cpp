#include "vibe_hardware/driver/device_driver.hpp"

#include <algorithm>
#include <limits>

#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::hardware {

void MessageLimiter::warn(const std::string& kind, const std::string& sentence, double now) {
  const auto [entry, is_new] = kinds_.try_emplace(kind);
  Kind& state = entry->second;
  if (!is_new && now - state.last < kPeriod) {
    ++state.held_back;
    return;
  }
  const std::string more =
      state.held_back > 0 ? " (" + std::to_string(state.held_back) + " more of this kind since the last message)" : "";
  state = {now, 0, sentence};
  sink_(Severity::Warning, sentence + more);
}

void MessageLimiter::warnOnce(const std::string& kind, const std::string& sentence) {
  const auto [entry, is_new] = kinds_.try_emplace(kind);
  if (!is_new && entry->second.sentence == sentence) return;
  entry->second.sentence = sentence;
  sink_(Severity::Warning, sentence);
}

namespace {

constexpr std::size_t kBuffer = 256;  // longer than any report, so that one that is too long is noticed
constexpr int kMostAtOnce = 1000;     // reports in one call of poll(): a device may not keep us for ever
constexpr double kStatusPeriod = 1;   // [s]
constexpr double kMillisecond = 1e-3;

std::string identify(const HidInfo& info) {
  return info.path + (info.serial.empty() ? "" : ", serial number " + info.serial);
}

std::string hexadecimal(std::uint16_t number) {
  return formatted("%04x", number);
}

}  // namespace

const char* stateName(LinkState state) {
  static constexpr const char* kNames[] = {"absent", "unusable", "running", "silent"};
  return kNames[static_cast<int>(state)];
}

DeviceDriver::DeviceDriver(HidBus& bus, DeviceKind kind, DeviceSelection selection, std::function<double()> clock,
                           Callbacks callbacks)
    : bus_(bus),
      kind_(kind),
      selection_(std::move(selection)),
      clock_(std::move(clock)),
      callbacks_(std::move(callbacks)),
      messages_(callbacks_.message) {}

void DeviceDriver::poll(double wait) {
  if (!connection_) {
    if (clock_() >= next_search_) search();
    return;
  }
  try {
    readReports(wait);
    watchSilence();
    refreshStatus();
  } catch (const DeviceGone& gone) {
    drop(gone.what());
  }
}

void DeviceDriver::search() {
  next_search_ = clock_() + kSearchPeriod;
  const std::optional<HidInfo> info = find();
  if (!info) return;
  try {
    connect(*info);
  } catch (const DeviceGone& gone) {  // while it was opened
    countFailure(*info, gone.what());
  } catch (const std::exception& error) {
    setUnusable("The " + std::string(deviceName(kind_)) + " at " + identify(*info) + " cannot be used. " +
                error.what());
  }
}

std::optional<HidInfo> DeviceDriver::find() {
  std::vector<HidInfo> matching;
  try {
    matching = listMatching();
    messages_.forget("bus");
  } catch (const std::exception& error) {
    messages_.warnOnce("bus", error.what());
    state_ = LinkState::Absent;
    return std::nullopt;
  }
  if (matching.empty()) {
    setAbsent();
    return std::nullopt;
  }
  if (matching.size() > 1) {
    messages_.warnOnce("several", std::to_string(matching.size()) + " devices could be the " + deviceName(kind_) +
                                      "; " + identify(matching.front()) +
                                      " is used. Write the serial number of the right one into the calibration.");
  }
  return matching.front();
}

std::vector<HidInfo> DeviceDriver::listMatching() {
  std::vector<HidInfo> matching;
  for (const HidInfo& info : bus_.list()) {
    const bool matches = info.vendor == selection_.vendor && info.product == selection_.product &&
                         (selection_.serial.empty() || info.serial == selection_.serial);
    if (matches) matching.push_back(info);
  }
  const auto by_path = [](const HidInfo& a, const HidInfo& b) { return a.path < b.path; };
  std::sort(matching.begin(), matching.end(), by_path);
  return matching;
}

void DeviceDriver::setAbsent() {
  state_ = LinkState::Absent;
  problem_.clear();
  failures_ = 0;
  if (connections_ > 0) return;  // that it is gone has been said
  const std::string serial = selection_.serial.empty() ? "" : " and serial number " + selection_.serial;
  messages_.warnOnce("absent", std::string("There is no ") + deviceName(kind_) + " with id " +
                                   hexadecimal(selection_.vendor) + ":" + hexadecimal(selection_.product) + serial +
                                   bus_.remedyOfAbsence());
}

void DeviceDriver::connect(const HidInfo& info) {
  connection_ = std::make_unique<DeviceConnection>(bus_.open(info.path), info, kind_);
  const auto& axes = connection_->axes();
  stream_.setResolution({axes[0].radians_per_count, axes[1].radians_per_count});
  stream_.reopen();
  state_ = LinkState::Running;
  problem_.clear();
  ++connections_;
  failures_ = 0;
  flags_ = 0;
  last_good_ = clock_();
  next_status_ = last_good_ + kStatusPeriod;
  for (const char* kind : {"unusable", "silent", "gone", "absent"}) messages_.forget(kind);
  messages_.info("The " + std::string(deviceName(kind_)) + " is connected: " + identify(info) + ", firmware " +
                 connection_->firmwareVersion() + ".");
  callbacks_.connected(*connection_);
}

void DeviceDriver::countFailure(const HidInfo& info, const std::string& reason) {
  connection_.reset();
  failures_ = info.path == failed_path_ ? failures_ + 1 : 1;
  failed_path_ = info.path;
  if (failures_ < kMostFailures) {
    state_ = LinkState::Absent;
  } else if (failures_ == kMostFailures || state_ != LinkState::Unusable) {
    setUnusable("The " + std::string(deviceName(kind_)) + " at " + identify(info) +
                " is there, but opening it fails again and again (" + reason +
                "); another program may use it: end that, or check the cable and plug the device in again.");
  }
}

void DeviceDriver::setUnusable(const std::string& what) {
  connection_.reset();
  state_ = LinkState::Unusable;
  problem_ = what;
  messages_.warnOnce("unusable", what);
}

void DeviceDriver::drop(const std::string& reason) {
  if (!connection_) return;
  connection_.reset();
  state_ = LinkState::Absent;
  problem_.clear();
  next_search_ = clock_();
  messages_.warnOnce("gone", "The " + std::string(deviceName(kind_)) + " is gone (" + reason +
                                 "): its buttons count as released and the scope stays where it is until it is back.");
  callbacks_.lost(clock_());
}

void DeviceDriver::readReports(double wait) {
  std::uint8_t bytes[kBuffer];
  for (int i = 0; i < kMostAtOnce; ++i) {
    const std::size_t size = connection_->read(bytes, sizeof bytes, i == 0 ? wait : 0);
    if (size == 0) return;
    takeReport(bytes, std::min(size, sizeof bytes));
  }
}

void DeviceDriver::takeReport(const std::uint8_t* bytes, std::size_t size) {
  const double arrival = clock_();
  DeviceSample sample;
  const ReportStream::Result result = stream_.take(bytes, size, arrival, sample);
  if (result != ReportStream::Result::Accepted) {
    messages_.warn("report " + std::to_string(static_cast<int>(result)),
                   "A report of the " + std::string(deviceName(kind_)) + " is ignored: " + stream_.explanation() +
                       "; check cable and firmware.",
                   arrival);
    return;
  }
  if (state_ == LinkState::Silent) {
    state_ = LinkState::Running;
    problem_.clear();
    messages_.info("The " + std::string(deviceName(kind_)) + " sends reports again.");
    messages_.forget("silent");
  }
  last_good_ = arrival;
  last_sample_ = sample.time;
  reportFlags(sample.flags);
  callbacks_.sample(sample);
}

void DeviceDriver::watchSilence() {
  const double silence = clock_() - last_good_;
  if (state_ != LinkState::Running || silence < kSilence) return;
  state_ = LinkState::Silent;
  problem_ = "The " + std::string(deviceName(kind_)) + " is connected, but no valid report has come for " +
             std::to_string(static_cast<int>(silence / kMillisecond)) +
             " ms: its buttons count as released and the scope stays where it is; check cable and firmware.";
  messages_.warnOnce("silent", problem_);
  callbacks_.lost(clock_());
}

void DeviceDriver::reportFlags(std::uint8_t flags) {
  const int risen = flags & ~flags_;
  if ((risen & vibe_firmware::kDriveFault) != 0) {
    messages_.warn("drive",
                   "The power stage of the " + std::string(deviceName(kind_)) +
                       " has switched the motors off; check their supply and wiring, then restart the device.",
                   clock_());
  }
  if ((risen & vibe_firmware::kEncoderFault) != 0) {
    messages_.warn("encoder",
                   "An encoder of the " + std::string(deviceName(kind_)) +
                       " has jumped: the device has switched its motors off; check the encoder's cable.",
                   clock_());
  }
  flags_ = flags;
}

// Not from a device that is silent: a request that is not answered takes seconds.
void DeviceDriver::refreshStatus() {
  if (state_ != LinkState::Running || sinceReport() > kQuiet || clock_() < next_status_) return;
  next_status_ = clock_() + kStatusPeriod;
  try {
    connection_->refreshStatus();
  } catch (const Error& error) {
    messages_.warn("status", "The " + std::string(deviceName(kind_)) + " does not state its status: " + error.what(),
                   clock_());
  }
}

DeviceStatistics DeviceDriver::statistics() const {
  DeviceStatistics s;
  const double now = clock_();
  s.state = state_;
  s.problem = problem_;
  s.counts = stream_.counts();
  s.rate = stream_.rate(now);
  s.age = last_sample_ < 0 ? std::numeric_limits<double>::infinity() : now - last_sample_;
  s.drift = stream_.clock().drift();
  s.connections = connections_;
  s.flags = flags_;
  if (connection_) {
    s.path = connection_->info().path;
    s.serial = connection_->info().serial;
    s.name = connection_->info().name;
    s.firmware = connection_->firmwareVersion();
    s.late_ticks = connection_->status().late_ticks;
  }
  return s;
}

}  // namespace vibe::hardware
