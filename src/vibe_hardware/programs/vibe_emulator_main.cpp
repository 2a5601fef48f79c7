// vibe_emulator: both devices without hardware, in wall time. A scripted, recorded or random hand moves them.
#include <csignal>
#include <cstdio>
#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/command_line.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_hardware/emulator/device_server.hpp"
#include "vibe_hardware/emulator/emulator.hpp"
#include "vibe_hardware/emulator/hand.hpp"
#include "vibe_hardware/emulator/recorded_hand.hpp"
#include "vibe_hardware/hid/socket_bus.hpp"

namespace {

using namespace vibe;
using namespace vibe::hardware;

volatile std::sig_atomic_t stopped = 0, toggled = 0;

struct Options {
  std::vector<std::string> hand{"random"};
  std::uint64_t seed = 1;
  std::string config = "package://vibe_hardware/config/devices.yaml";
  std::string folder = defaultSocketFolder(), serial = "EMULATOR", drive = "voltage";
  double duration = 0;
  double clock_error = 0;  // [ppm]
  BlinkSetup blink;
  std::string blink_log;
  bool uhid = false;
};

void addOptions(OptionList& line, Options& o) {
  line.option("--hand", o.hand,
              "who moves the devices: script FILE, recorded FILE, random, or blink [SCRIPT] (default: random)")
      .typeName("KIND [FILE]")
      .expected(1, 2);
  line.option("--seed", o.seed, "of the random hand and of the blinks (default: 1)").typeName("N").check(wholeNumber());
  line.option("--blinks", o.blink.count, "how often the hand blinks (default: 1000)")
      .typeName("N")
      .check(inRange(1, 1000000));
  line.option("--blink-jump", o.blink.step, "by how much tip_left_right jumps (default: 0.03)")
      .typeName("RAD")
      .check(inRange(-1.0, 1.0));
  line.option("--blink-log", o.blink_log, "write when the blinks happened and were reported").typeName("FILE");
  line.option("--clock-error", o.clock_error, "by how much the clock of the devices goes slow (default: 0)")
      .typeName("PPM")
      .check(inRange(-10000.0, 10000.0));
  line.option("--config", o.config, "calibration of the devices (default: " + o.config + ")").typeName("FILE");
  line.option("--folder", o.folder, "of the sockets of the devices (default: " + o.folder + ")").typeName("DIR");
  line.flag("--uhid", o.uhid, "create the devices in the kernel, through /dev/uhid, instead of sockets");
  line.option("--serial", o.serial, "serial number of both devices (default: EMULATOR)").typeName("TEXT");
  line.option("--drive", o.drive, "how the motors are driven: voltage or torque (default: voltage)")
      .check(oneOf({"voltage", "torque"}));
  line.option("--duration", o.duration, "end after so many seconds (default: never)")
      .typeName("S")
      .check(finiteFrom(0));
  line.footer("SIGUSR1 unplugs both devices, and plugs them in again the next time.\n");
}

std::shared_ptr<const Hand> makeBlinkHand(const Options& o) {
  std::shared_ptr<const Hand> script;
  if (o.hand.size() > 1) script = std::make_shared<ScriptedHand>(TraineeScript::load(resolveAddress(o.hand[1])));
  BlinkSetup setup = o.blink;
  setup.seed = o.seed;
  return std::make_shared<BlinkHand>(setup, script);
}

std::shared_ptr<const Hand> makeHand(const Options& o, const Calibration& calibration) {
  const std::string& kind = o.hand[0];
  if (kind == "random") {
    if (o.hand.size() > 1) throw Error("--hand random takes no file; remove '" + o.hand[1] + "'.");
    return std::make_shared<RandomHand>(o.seed);
  }
  if (kind == "blink") return makeBlinkHand(o);
  if (kind != "script" && kind != "recorded")
    throw Error("--hand '" + kind + "' is not known; write script FILE, recorded FILE, random or blink [SCRIPT].");
  if (o.hand.size() < 2) throw Error("--hand " + kind + " needs a file; write --hand " + kind + " FILE.");
  const std::string file = resolveAddress(o.hand[1]);
  if (kind == "script") return std::make_shared<ScriptedHand>(TraineeScript::load(file));
  return std::make_shared<RecordedHand>(RecordedHand::load(file, handLimits(calibration)));
}

/// One device while it is plugged in.
struct Connection {
  Connection(const Options& o, const std::string& name, EmulatedDevice& emulated)
      : device(emulated), usb(emulated.function()) {
    if (o.uhid)
      server = std::make_unique<UhidServer>(usb);
    else
      server = std::make_unique<SocketServer>(o.folder, name, usb);
  }

  /// @return whether a report has left the device
  bool serve() {
    std::uint8_t report[vibe_firmware::kInputReportSize];
    const bool due = device.nextReport(report);
    if (due) server->publish(report, sizeof report);
    server->serve();
    return due;
  }

  EmulatedDevice& device;
  UsbHost usb;
  std::unique_ptr<DeviceServer> server;
};

std::int64_t wallClock() {
  timespec time{};
  ::clock_gettime(CLOCK_REALTIME, &time);
  return 1'000'000'000LL * time.tv_sec + time.tv_nsec;
}

void sleepUntil(double when) {
  timespec time{};
  time.tv_sec = static_cast<time_t>(when);
  time.tv_nsec = static_cast<long>(1e9 * (when - static_cast<double>(time.tv_sec)));
  ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);
}

/// Runs both devices by the wall clock.
class Session {
 public:
  explicit Session(const Options& options) : Session(options, setupOf(options)) {}

  void run() {
    const double start = steadyTime();
    TickSchedule schedule(start, 1e-6 * options_.clock_error);
    while (stopped == 0 && (options_.duration == 0 || emulator_.time() < options_.duration)) {
      const int due = schedule.due(steadyTime());
      for (int i = 0; i < due; ++i) {
        tick();
      }
      if (toggled != 0) toggle();
      report(schedule);
      sleepUntil(schedule.next());
    }
    summarise(schedule);
  }

 private:
  Session(const Options& options, const EmulatorSetup& setup)
      : Session(options, setup, makeHand(options, setup.calibration)) {}

  Session(const Options& options, const EmulatorSetup& setup, const std::shared_ptr<const Hand>& hand)
      : options_(options), emulator_(setup, hand) {
    const auto* blinks = dynamic_cast<const BlinkHand*>(hand.get());
    if (!options.blink_log.empty() && blinks == nullptr)
      throw Error("--blink-log needs a hand that blinks; add --hand blink.");
    if (!options.blink_log.empty()) blink_log_.emplace(options.blink_log, blinks->blinks());
    plug();
  }

  void tick() {
    emulator_.tick();
    if (blink_log_) blink_log_->tick(emulator_.handTime(), wallClock());
    if (!haptic_) return;
    haptic_->serve();
    const std::int64_t now = wallClock();  // the host may have the report before serve() returns
    const bool reported = input_->serve();
    if (blink_log_ && reported) blink_log_->report(now);
  }

  static EmulatorSetup setupOf(const Options& options) {
    EmulatorSetup setup;
    setup.calibration = Calibration::load(options.config);
    setup.serial = options.serial;
    setup.drive = options.drive == "torque" ? Drive::Torque : Drive::Voltage;
    return setup;
  }

  void plug() {
    haptic_ = std::make_unique<Connection>(options_, "haptic", emulator_.haptic());
    input_ = std::make_unique<Connection>(options_, "input", emulator_.input());
    for (const Connection* c : {haptic_.get(), input_.get()})
      std::printf("%s %04x:%04x, serial %s: %s\n", c->usb.name().c_str(), c->usb.vendor(), c->usb.product(),
                  c->usb.serial().c_str(), options_.uhid ? "in the kernel" : options_.folder.c_str());
    std::fflush(stdout);
  }

  void unplug() {
    for (std::unique_ptr<Connection>* connection : {&haptic_, &input_}) {
      dropped_ += (*connection)->server->droppedReports();
      EmulatedDevice& device = (*connection)->device;
      connection->reset();
      device.restart();
    }
    std::printf("unplugged\n");
    std::fflush(stdout);
  }

  void toggle() {
    toggled = 0;
    if (haptic_)
      unplug();
    else
      plug();
  }

  /// Says once a second at most that it is behind, and once that the hand has come to its end.
  void report(const TickSchedule& schedule) {
    if (schedule.behind() && emulator_.time() >= next_warning_) {
      std::fprintf(stderr,
                   "vibe_emulator: %.0f ms behind its 1,000 ticks per second; the machine may be too busy, or have "
                   "stood still.\n",
                   1e3 * schedule.delay());
      next_warning_ = emulator_.time() + 1;
    }
    if (!finished_ && emulator_.finished()) {
      finished_ = true;
      std::printf("the hand has come to its end after %.1f s and holds still\n", emulator_.time());
      std::fflush(stdout);
    }
  }

  void summarise(const TickSchedule& schedule) {
    if (haptic_) dropped_ += haptic_->server->droppedReports() + input_->server->droppedReports();
    std::printf("%.1f s, at most %.1f ms behind, %.1f s dropped, %llu reports not read\n", emulator_.time(),
                1e3 * schedule.worstDelay(), schedule.dropped(), static_cast<unsigned long long>(dropped_));
  }

  const Options& options_;
  Emulator emulator_;
  std::optional<BlinkLog> blink_log_;
  std::unique_ptr<Connection> haptic_, input_;
  std::uint64_t dropped_ = 0;
  double next_warning_ = 0;
  bool finished_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CommandLine line{"Emulates the haptic device and the input device with the firmware in them, in wall time.",
                   "vibe_emulator"};
  addOptions(line, options);
  return runProgram(line, argc, argv, [&options] {
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { stopped = 1; });
    std::signal(SIGUSR1, [](int) { toggled = 1; });
    std::signal(SIGPIPE, SIG_IGN);
    Session(options).run();
  });
}
