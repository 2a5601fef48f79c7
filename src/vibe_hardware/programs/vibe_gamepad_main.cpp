// vibe_gamepad: lists gamepads, shows what a mapping makes of one, records it, and tries its motors. No ROS.

#include <linux/input-event-codes.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <thread>

#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/input/joint_unit.hpp"
#include "vibe_core/program/command_line.hpp"
#include "vibe_hardware/gamepad/pad_drive.hpp"
#include "vibe_hardware/gamepad/pad_recording.hpp"
#include "vibe_hardware/gamepad/pad_source.hpp"

namespace hardware = vibe::hardware;

namespace {

constexpr double kPeriod = 0.01;        // of sampling [s]
constexpr double kPrintPeriod = 0.1;    // [s]
constexpr double kMotorTestTime = 0.5;  // [s]

volatile sig_atomic_t stopped = 0;

struct Options {
  bool list = false;
  bool test = false;
  std::string pad;
  std::string mapping = "package://vibe_hardware/config/gamepads/two_stick.yaml";
  std::string urdf = "package://vibe_description/urdf/scope.urdf";
  std::string record;
  std::string replay;
  std::string folder = "/dev/input";
  double duration = 0;
};

void addOptions(vibe::OptionList& line, Options& options) {
  line.flag("--list", options.list, "List the input devices of this machine with their axes and buttons, and end");
  line.flag("--test", options.test, "Try the motors: both rumble motors, then the spring in the middle; and end");
  line.option("--pad", options.pad, "Path, or part of the name or phys (default: the first gamepad)");
  line.option("--mapping", options.mapping, "Mapping file or package:// address");
  line.option("--urdf", options.urdf, "URDF with the limits of the joints");
  line.option("--record", options.record, "Write the events to this file (format of evemu)");
  line.option("--replay", options.replay, "Play such a file instead of a gamepad");
  line.option("--folder", options.folder, "Folder of the event devices");
  line.option("--duration", options.duration, "End after these seconds (default: at Ctrl-C)")
      .check(vibe::finiteFrom(0));
}

void pause(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

void printDevice(const hardware::PadListing& listing) {
  const hardware::PadInfo& info = listing.info;
  if (!listing.problem.empty()) {
    std::printf("%s: %s\n", info.path.c_str(), listing.problem.c_str());
    return;
  }
  std::printf("%s: '%s' %04x:%04x phys '%s'%s%s%s\n", info.path.c_str(), info.name.c_str(),
              static_cast<unsigned>(info.vendor), static_cast<unsigned>(info.product), info.phys.c_str(),
              listing.is_pad ? ", a gamepad" : ", no gamepad", info.has_rumble ? ", rumble" : "",
              info.has_spring ? ", spring" : "");
  if (!listing.is_pad) return;
  for (const auto& [code, axis] : listing.state.axes)
    std::printf("  axis %s from %d to %d, now %d\n", hardware::eventCodeName(EV_ABS, code).c_str(), axis.minimum,
                axis.maximum, axis.value);
  std::printf("  buttons");
  for (const auto& [code, button] : listing.state.buttons)
    std::printf(" %s%s", hardware::eventCodeName(EV_KEY, code).c_str(), button.down ? "(down)" : "");
  std::printf("\n");
}

int listDevices(const Options& options) {
  const std::vector<hardware::PadListing> listings = hardware::listInputDevices(options.folder);
  if (listings.empty()) std::printf("There is no input device in %s.\n", options.folder.c_str());
  for (const hardware::PadListing& listing : listings) printDevice(listing);
  return 0;
}

/// Says whether a motor did what it was asked to, and lets it.
bool tryMotor(const char* what, bool accepted) {
  std::printf("%s: %s\n", what, accepted ? "accepted" : "REFUSED by the device");
  std::fflush(stdout);
  pause(kMotorTestTime);
  return accepted;
}

int testMotors(const Options& options) {
  std::string why;
  const std::unique_ptr<hardware::PadSource> pad = hardware::openPad(options.pad, why, options.folder);
  if (!pad) {
    std::fprintf(stderr, "vibe_gamepad: %s\n", why.c_str());
    return 1;
  }
  std::printf("'%s' at %s\n", pad->info().name.c_str(), pad->info().path.c_str());
  hardware::PadMotors* motors = pad->motors();
  bool good = true;
  if (motors != nullptr && motors->hasRumble()) {
    good = tryMotor("strong motor", motors->rumble(1, 0)) && good;
    good = tryMotor("weak motor", motors->rumble(0, 1)) && good;
    good = tryMotor("motors off", motors->rumble(0, 0)) && good;
  } else {
    std::printf("no rumble: the device has none, or it may not be written by this user\n");
  }
  if (motors != nullptr && motors->hasSpring()) {
    good = tryMotor("spring of both axes", motors->spring({{{0, 1}, {0, 1}}})) && good;
    good = tryMotor("spring off", motors->spring({{{0, 0}, {0, 0}}})) && good;
  } else {
    std::printf("no spring\n");
  }
  return good ? 0 : 1;
}

void printCommand(const hardware::DriveState& drive) {
  for (int i = 0; i < vibe::kJointCount; ++i) {
    const auto joint = static_cast<std::size_t>(i);
    const bool length = vibe::isPrismatic(i);
    std::printf("%s %.1f %s  ", vibe::kJointNames[joint], drive.joints[joint] * (length ? 1e3 : 57.29577951308232),
                length ? "mm" : "deg");
  }
  for (std::size_t i = 0; i < vibe::kButtonCount; ++i)
    if (drive.buttons[i] != 0) std::printf("[%s] ", vibe::kButtonNames[i]);
  std::printf("\n");
  std::fflush(stdout);
}

hardware::PadLink makeLink(const Options& options) {
  if (options.replay.empty())
    return hardware::PadLink(
        [&options](std::string& why) { return hardware::openPad(options.pad, why, options.folder); });
  auto recording = std::make_shared<hardware::PadRecording>(hardware::loadPadRecording(options.replay));
  return hardware::PadLink([recording](std::string&) { return hardware::playPadRecording(*recording); });
}

/// Shows what the mapping makes of the pad, from joints at zero.
class LiveView {
 public:
  explicit LiveView(const Options& options)
      : options_(options),
        limits_(hardware::loadToolLimits(options.urdf)),
        mapping_(hardware::loadPadMapping(vibe::resolveAddress(options.mapping), limits_)),
        link_(makeLink(options)),
        drive_(hardware::startDrive({}, mapping_, {})) {
    if (!options.record.empty()) hardware::PadRecorder::checkFile(options.record);
  }

  int run() {
    const double begin = vibe::steadyTime();
    double last = begin;
    while (stopped == 0 && (options_.duration <= 0 || vibe::steadyTime() - begin < options_.duration)) {
      const double now = vibe::steadyTime();
      const bool had = link_.pad() != nullptr;
      const std::string sentence = link_.poll(now);
      if (!sentence.empty()) std::printf("%s\n", sentence.c_str());
      if (!had && link_.pad() != nullptr) begins();
      if (had && link_.pad() == nullptr && ends()) return 0;
      if (link_.pad() != nullptr)
        drive_ = hardware::advance(mapping_, limits_, link_.pad()->state(), drive_, now - last);
      last = now;
      print(now);
      pause(kPeriod);
    }
    return 0;
  }

 private:
  void begins() {
    const std::string missing = hardware::missingControls(mapping_, link_.pad()->state());
    if (!missing.empty()) std::printf("%s\n", missing.c_str());
    if (options_.record.empty() || recorder_) return;
    recorder_ = std::make_unique<hardware::PadRecorder>(options_.record, link_.pad()->info(), link_.pad()->state());
    link_.pad()->setListener([this](const hardware::PadEvent& event) { recorder_->add(event); });
  }

  /// @return whether that was all
  bool ends() {
    drive_ = hardware::releaseDrive(drive_);
    printCommand(drive_);
    return !options_.replay.empty();
  }

  void print(double now) {
    if (now - last_print_ < kPrintPeriod) return;
    last_print_ = now;
    if (drive_.joints == shown_.joints && drive_.buttons == shown_.buttons) return;
    shown_ = drive_;
    printCommand(drive_);
  }

  const Options& options_;
  hardware::ToolLimits limits_;
  hardware::PadMapping mapping_;
  std::unique_ptr<hardware::PadRecorder> recorder_;
  hardware::PadLink link_;
  hardware::DriveState drive_, shown_;
  double last_print_ = -1e9;
};

}  // namespace

int main(int argc, char** argv) {
  vibe::CommandLine line("Lists gamepads, shows live what a mapping makes of one, records it, and tries its motors.",
                         "vibe_gamepad");
  Options options;
  addOptions(line, options);
  return vibe::runProgram(line, argc, argv, [&options] {
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { stopped = 1; });
    if (options.list) return listDevices(options);
    if (options.test) return testMotors(options);
    return LiveView(options).run();
  });
}
