#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vibe_hardware/driver/device_connection.hpp"
#include "vibe_hardware/driver/report_stream.hpp"

namespace vibe::hardware {

/// Whether a sentence needs attention: a Warning says that something does not work, and the remedy.
enum class Severity : unsigned char { Info, Warning };

/// Where sentences for the user go.
using MessageSink = std::function<void(Severity, const std::string&)>;

/// Passes sentences on, each kind at most once per period; how many were held back is added to the next one.
class MessageLimiter {
 public:
  static constexpr double kPeriod = 10;  ///< [s]

  explicit MessageLimiter(MessageSink sink) : sink_(std::move(sink)) {}  ///< `sink` has to be callable

  void info(const std::string& sentence) const { sink_(Severity::Info, sentence); }  ///< at once, however often
  /// A sentence that may come often. @param kind  word that names what is limited together  @param now  host time [s]
  void warn(const std::string& kind, const std::string& sentence, double now);
  /// A sentence that stays true: said once, and again only after forget().
  void warnOnce(const std::string& kind, const std::string& sentence);
  void forget(const std::string& kind) { kinds_.erase(kind); }  ///< the next sentence of that kind is passed on again

 private:
  struct Kind {
    double last = 0;
    int held_back = 0;
    std::string sentence;
  };

  MessageSink sink_;
  std::map<std::string, Kind> kinds_;
};

/// Which device to use.
struct DeviceSelection {
  std::uint16_t vendor = 0, product = 0;  ///< USB ids, both have to match
  std::string serial;                     ///< empty: any
};

/// Whether a device can be used, as far as its driver knows.
enum class LinkState : unsigned char {
  Absent,    ///< not there
  Unusable,  ///< there, but it cannot be opened or is not of this release
  Running,   ///< reports arrive
  Silent,    ///< open, but its reports have stopped
};
const char* stateName(LinkState state);  ///< "absent", ...

/// For diagnostics.
struct DeviceStatistics {
  LinkState state = LinkState::Absent;  ///< as of the last poll()
  std::string problem;                  ///< one sentence while the state is Unusable or Silent
  StreamCounts counts;                  ///< of its reports, over all connections
  double rate = 0;                      ///< of good reports [Hz]
  double age = 0;                       ///< of the last sample [s]; infinite before the first one
  double drift = 0;                     ///< of the device's clock against the host's [s/s]
  std::uint64_t connections = 0;        ///< times that the device was opened
  /// Of the open device, texts; empty while none is open or where it states none.
  std::string path, serial, name, firmware;
  std::uint8_t flags = 0;        ///< vibe_firmware::DeviceFlag, of the last good report
  std::uint32_t late_ticks = 0;  ///< of the firmware
};

/// Looks for one device, opens it, reads its reports and looks again when it is gone. Not thread-safe: one thread calls
/// poll() all the time.
class DeviceDriver {
 public:
  static constexpr double kSearchPeriod = 0.2;  ///< between searches for a device that is not there [s]
  static constexpr double kSilence = 0.25;      ///< without a good report, after which the device has stopped [s]

  /// Times in a row that a listed device may be gone when it is opened, as while it is unplugged; then it is unusable.
  static constexpr int kMostFailures = 5;

  static constexpr double kQuiet = 0.05;  ///< without a good report, after which nothing is asked of it [s]

  /// What the driver calls, within poll() or drop(); all have to be set.
  struct Callbacks {
    std::function<void(const DeviceSample&)> sample;  ///< one good report, in the order of their times
    /// A device has been opened and its protocol checked; before its first sample.
    std::function<void(const DeviceConnection&)> connected;
    std::function<void(double now)> lost;  ///< unplugged or silent: its buttons count as released
    MessageSink message;                   ///< sentences for the user
  };

  /// @param clock  host time [s], never goes back; that of DeviceSample::time
  DeviceDriver(HidBus& bus, DeviceKind kind, DeviceSelection selection, std::function<double()> clock,
               Callbacks callbacks);

  /// Searches if it is time to, or takes all reports that are there; waits for the first one. @param wait  [s]
  void poll(double wait);

  LinkState state() const { return state_; }  ///< as of the last poll()
  /// The open device; null unless the state is Running or Silent.
  DeviceConnection* connection() { return connection_.get(); }
  DeviceStatistics statistics() const;                          ///< as of now; cheap
  double sinceReport() const { return clock_() - last_good_; }  ///< the last good one, or since opening [s]

  /// Tells the driver that the device has gone while its connection was used outside poll().
  void drop(const std::string& reason);
  MessageLimiter& messages() { return messages_; }  ///< for sentences of those who use the device, too
  double now() const { return clock_(); }           ///< host time of its clock [s]
  DeviceKind kind() const { return kind_; }         ///< which of the two devices it looks for

 private:
  HidBus& bus_;
  DeviceKind kind_;
  DeviceSelection selection_;
  std::function<double()> clock_;
  Callbacks callbacks_;
  MessageLimiter messages_;
  LinkState state_ = LinkState::Absent;
  std::string problem_;
  std::unique_ptr<DeviceConnection> connection_;
  ReportStream stream_;
  double next_search_ = 0;
  double last_good_ = 0;  // arrival of the last good report, or when the device was opened
  double last_sample_ = -1;
  double next_status_ = 0;
  std::uint64_t connections_ = 0;
  std::string failed_path_;  // of the listed device that was gone when it was opened
  int failures_ = 0;         // times in a row
  std::uint8_t flags_ = 0;

  void search();
  std::optional<HidInfo> find();
  std::vector<HidInfo> listMatching();
  void setAbsent();
  void connect(const HidInfo& info);
  void countFailure(const HidInfo& info, const std::string& reason);
  void setUnusable(const std::string& what);
  void readReports(double wait);
  void takeReport(const std::uint8_t* bytes, std::size_t size);
  void watchSilence();
  void reportFlags(std::uint8_t flags);
  void refreshStatus();
};

}  // namespace vibe::hardware
