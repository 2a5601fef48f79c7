// Plugs devices into a virtual machine of QEMU: one usbredir connection for each port of its USB controller. Commands
// come from the guest through a serial port of the machine:
//
//   plug DEVICE | unplug DEVICE           answer: ok
//   lose DEVICE N | repeat DEVICE N       the next N input reports
//   corrupt DEVICE N                      the next N answers to GET_REPORT
//
// DEVICE is haptic, input, spare-haptic or spare-input (the firmware library, powered by the bus: it starts afresh when
// it is plugged in) or image (the firmware image on an emulated board; it is plugged in once).

#include <poll.h>
#include <sys/prctl.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "firmware_device.hpp"
#include "image_device.hpp"
#include "redir_port.hpp"
#include "unix_socket.hpp"

namespace hardware = vibe::hardware;

namespace {

struct Options {
  std::string folder, image_socket;
};

Options parse(int argc, char** argv) {
  Options options;
  CLI::App app{"Plugs the haptic device and the input device into a virtual machine of QEMU (usbredir)"};
  app.add_option("--folder", options.folder, "where the sockets are made: one of each device, commands")->required();
  app.add_option("--image-socket", options.image_socket, "serial port of the board that runs the firmware image");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error));
  }
  return options;
}

class Bridge {
 public:
  explicit Bridge(const Options& options) : options_(options), commands_(options.folder + "/commands") {
    for (const char* device : {"haptic", "input", "spare-haptic", "spare-input", "image"}) {
      ports_.emplace(device, std::make_unique<hardware::RedirPort>(options.folder + "/" + device));
    }
  }

  /// Runs until the virtual machine ends.
  void run() {
    std::printf("ready\n");
    std::fflush(stdout);
    for (bool going = true; going;) {
      wait();
      for (auto& [name, port] : ports_) going = port->service() && going;
      going = commands_.service([this](const std::string& line) { return obey(line); }) && going;
    }
  }

 private:
  void wait() {
    std::vector<pollfd> waits{{commands_.descriptor(), POLLIN, 0}};
    for (const auto& [name, port] : ports_) {
      for (const int descriptor : port->descriptors()) waits.push_back({descriptor, POLLIN, 0});
    }
    if (poll(waits.data(), waits.size(), -1) < 0) throw std::runtime_error("poll failed");
  }

  std::string obey(const std::string& line) {
    std::istringstream words(line);
    std::string verb, name;
    int count = 0;
    words >> verb >> name >> count;
    const auto port = ports_.find(name);
    if (port == ports_.end()) return "error: no device '" + name + "'";
    try {
      return obey(verb, name, count, *port->second) ? "ok" : "error: no command '" + verb + "'";
    } catch (const std::exception& error) {
      return std::string("error: ") + error.what();
    }
  }

  bool obey(const std::string& verb, const std::string& name, int count, hardware::RedirPort& port) {
    if (verb == "plug") {
      port.plug(make(name));
    } else if (verb == "unplug") {
      port.unplug();
    } else if (verb == "lose") {
      port.faults().reports_to_lose = count;
    } else if (verb == "repeat") {
      port.faults().reports_to_repeat = count;
    } else if (verb == "corrupt") {
      port.faults().answers_to_corrupt = count;
    } else {
      return false;
    }
    return true;
  }

  std::unique_ptr<hardware::UsbDevice> make(const std::string& name) const {
    const std::string serial = "bridge-" + name;
    if (name == "haptic" || name == "spare-haptic") return hardware::makeHapticDevice(serial);
    if (name == "input" || name == "spare-input") return hardware::makeInputDevice(serial);
    if (options_.image_socket.empty()) throw std::runtime_error("there is no firmware image; see --image-socket");
    return std::make_unique<hardware::ImageDevice>(options_.image_socket);
  }

  Options options_;
  hardware::CommandChannel commands_;
  std::map<std::string, std::unique_ptr<hardware::RedirPort>> ports_;
};

}  // namespace

int main(int argc, char** argv) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  try {
    Bridge(parse(argc, argv)).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "usb_bridge: %s\n", error.what());
    return 1;
  }
}
