#pragma once
#include <stdlib.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "vibe_hardware/emulator/device_server.hpp"

namespace vibe::hardware::test {

/// A folder of its own, removed at the end.
class SocketFolder {
 public:
  SocketFolder() {
    char pattern[] = "/tmp/vibe_socket_XXXXXX";
    path_ = ::mkdtemp(pattern);
  }
  ~SocketFolder() { std::filesystem::remove_all(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// A socket server in a thread of its own, which serves about 2,000 times a second.
class ServedDevice {
 public:
  ServedDevice(const std::string& folder, const std::string& name, vibe_firmware::HidFunction& function)
      : host_(function), server_(std::make_unique<SocketServer>(folder, name, host_)), thread_([this] { run(); }) {}
  ~ServedDevice() {
    ends_ = true;
    thread_.join();
  }

  /// Calls `work` with the server while the thread does not use it.
  void with(const std::function<void(SocketServer&)>& work) {
    const std::lock_guard<std::mutex> lock(mutex_);
    work(*server_);
  }

  void publish(const std::vector<std::uint8_t>& report) {
    with([&](SocketServer& server) { server.publish(report.data(), report.size()); });
  }

  std::size_t hostCount() {
    std::size_t count = 0;
    with([&](SocketServer& server) { count = server.hostCount(); });
    return count;
  }

 private:
  void run() {
    while (!ends_) {
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        server_->serve();
      }
      std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
  }

  UsbHost host_;
  std::unique_ptr<SocketServer> server_;
  std::mutex mutex_;
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace vibe::hardware::test
