#include "vibe_hardware/hid/socket_bus.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <filesystem>

#include <sys/socket.h>
#include <unistd.h>

#include "hid/transport.hpp"

namespace vibe::hardware {

namespace {

void appendU16(std::size_t value, Packet& packet) {
  packet.push_back(static_cast<std::uint8_t>(value & 0xFF));
  packet.push_back(static_cast<std::uint8_t>(value >> 8 & 0xFF));
}

template <typename Bytes>
void appendBytes(const Bytes& bytes, Packet& packet) {
  appendU16(bytes.size(), packet);
  packet.insert(packet.end(), bytes.begin(), bytes.end());
}

/// Reads fields one after the other; after the first that is cut off, all fail.
class FieldReader {
 public:
  FieldReader(const std::uint8_t* bytes, std::size_t size) : next_(bytes), left_(size) {}

  std::size_t number(std::size_t size) {
    std::size_t value = 0;
    if (!take(size)) return 0;
    for (std::size_t i = 0; i < size; ++i) value |= static_cast<std::size_t>(next_[i - size]) << 8 * i;
    return value;
  }

  template <typename Bytes>
  Bytes bytes() {
    const std::size_t size = number(2);
    if (!take(size)) return {};
    return Bytes(next_ - size, next_);
  }

  bool complete() const { return good_ && left_ == 0; }

 private:
  bool take(std::size_t size) {
    good_ = good_ && size <= left_;
    if (!good_) return false;
    next_ += size;
    left_ -= size;
    return true;
  }

  const std::uint8_t* next_;
  std::size_t left_;
  bool good_ = true;
};

}  // namespace

Packet packHello(const Hello& hello) {
  Packet packet{kHello, kSocketVersion};
  appendU16(hello.vendor, packet);
  appendU16(hello.product, packet);
  appendBytes(hello.serial, packet);
  appendBytes(hello.name, packet);
  appendBytes(hello.report_descriptor, packet);
  return packet;
}

std::optional<Hello> unpackHello(const std::uint8_t* bytes, std::size_t size) {
  FieldReader reader(bytes, size);
  if (reader.number(1) != kHello || reader.number(1) != kSocketVersion) return {};
  Hello hello;
  hello.vendor = static_cast<std::uint16_t>(reader.number(2));
  hello.product = static_cast<std::uint16_t>(reader.number(2));
  hello.serial = reader.bytes<std::string>();
  hello.name = reader.bytes<std::string>();
  hello.report_descriptor = reader.bytes<std::vector<std::uint8_t>>();
  if (!reader.complete()) return {};
  return hello;
}

namespace {

constexpr double kHelloTimeout = 0.1;  // [s]; a device answers within one tick
constexpr double kReplyTimeout = 1;    // [s]
constexpr std::size_t kMaxWaiting = 256;

using Clock = std::chrono::steady_clock;

double secondsUntil(Clock::time_point end) {
  return std::max(0.0, std::chrono::duration<double>(end - Clock::now()).count());
}

Clock::time_point after(double seconds) {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

/// The next packet. @return empty: none came in time  @throws DeviceGone
Packet receive(int file, const std::string& path, double timeout) {
  if (!waitReadable(file, timeout)) return {};
  Packet packet(kMaxPacket);
  const ssize_t size = ::recv(file, packet.data(), packet.size(), MSG_DONTWAIT);
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) return {};
  if (size <= 0) throw DeviceGone("Device " + path + " is gone: its socket was closed, as when the emulator ends.");
  packet.resize(static_cast<std::size_t>(size));
  return packet;
}

/// What answers is no device of this release.
struct OtherProtocol : DeviceGone {
  using DeviceGone::DeviceGone;
};

/// @throws OtherProtocol; DeviceGone if nothing answers
Hello greet(int file, const std::string& path) {
  const Packet packet = receive(file, path, kHelloTimeout);
  if (packet.empty()) throw DeviceGone("Socket " + path + " does not answer as a device: nothing comes from it.");
  const std::optional<Hello> hello = unpackHello(packet.data(), packet.size());
  if (!hello)
    throw OtherProtocol("Socket " + path +
                        " does not answer as a device of this release; start the emulator of the same release.");
  return *hello;
}

class SocketPort : public HidPort {
 public:
  SocketPort(FileDescriptor file, std::string path, Hello hello)
      : file_(std::move(file)), path_(std::move(path)), hello_(std::move(hello)) {}

  std::size_t read(std::uint8_t* bytes, std::size_t capacity, double timeout) override {
    const auto end = after(timeout);
    while (waiting_.empty()) {
      const double left = secondsUntil(end);
      handle(receive(file_.get(), path_, left));
      if (waiting_.empty() && left == 0) return 0;
    }
    const Packet report = std::move(waiting_.front());
    waiting_.pop_front();
    return copy(report.data() + 1, report.size() - 1, bytes, capacity);
  }

  std::size_t getFeature(std::uint8_t id, std::uint8_t* bytes, std::size_t capacity) override {
    const Packet reply = ask({kGet, ++number_, id}, id);
    return copy(reply.data() + 3, reply.size() - 3, bytes, capacity);
  }

  void setFeature(const std::uint8_t* bytes, std::size_t size) override {
    if (size == 0 || size > kMaxPacket - 2)
      throw ReportRejected("A report of " + std::to_string(size) + " bytes is none.");
    Packet packet{kSet, ++number_};
    packet.insert(packet.end(), bytes, bytes + size);
    ask(packet, bytes[0]);
  }

  std::vector<std::uint8_t> reportDescriptor() override { return hello_.report_descriptor; }

 private:
  static std::size_t copy(const std::uint8_t* from, std::size_t size, std::uint8_t* to, std::size_t capacity) {
    const std::size_t count = std::min(size, capacity);
    if (count > 0) std::memcpy(to, from, count);
    return count;
  }

  /// Keeps input reports. @return the packet if it replies to the request under way
  std::optional<Packet> handle(Packet packet) {
    if (packet.empty()) return {};
    if (packet[0] == kReply && packet.size() >= 3) {
      if (packet[1] == number_) return packet;
      return {};  // to a request that was given up
    }
    if (packet[0] != kInput || packet.size() < 2)
      throw DeviceGone(
          "Device " + path_ +
          " sends packets of another protocol; its emulator may be of another release: start that of this one.");
    if (waiting_.size() == kMaxWaiting) waiting_.pop_front();
    waiting_.push_back(std::move(packet));
    return {};
  }

  Packet ask(const Packet& request, std::uint8_t id) {
    const ssize_t sent = ::send(file_.get(), request.data(), request.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent != static_cast<ssize_t>(request.size()))
      throw DeviceGone("Device " + path_ + " takes no requests any more (" + std::strerror(errno) + ").");
    const auto end = after(kReplyTimeout);
    while (true) {
      const double left = secondsUntil(end);
      const std::optional<Packet> reply = handle(receive(file_.get(), path_, left));
      if (reply && (*reply)[2] == 0) return *reply;
      if (reply) throw ReportRejected("Device " + path_ + " rejects report " + std::to_string(id) + ".");
      if (left == 0) throw DeviceGone("Device " + path_ + " does not answer within 1 s.");
    }
  }

  FileDescriptor file_;
  std::string path_;
  Hello hello_;
  std::uint8_t number_ = 0;
  std::deque<Packet> waiting_;  // input packets
};

}  // namespace

std::string defaultSocketFolder() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime != nullptr && runtime[0] == '/') return std::string(runtime) + "/vibe_emulator";
  return "/tmp/vibe_emulator-" + std::to_string(::getuid());
}

std::vector<HidInfo> SocketBus::list() {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::directory_iterator files(folder_, error);
  exists_ = !error;
  serves_ = false;
  if (error == std::errc::no_such_file_or_directory) return {};  // no emulator has been started yet
  if (error)
    throw std::runtime_error("Folder " + folder_ + " cannot be read (" + error.message() +
                             "); choose the folder of the emulator.");
  std::vector<HidInfo> found;
  std::string problem;
  for (const fs::directory_entry& file : files) {
    if (file.path().extension() != kSocketSuffix) continue;
    const std::string path = file.path();
    const FileDescriptor socket = connectTo(path);
    if (!socket) continue;
    try {
      const Hello hello = greet(socket.get(), path);
      found.push_back({path, hello.vendor, hello.product, hello.serial, hello.name});
    } catch (const OtherProtocol& other) {
      problem = other.what();
    } catch (const DeviceGone&) {  // not a device
    }
  }
  serves_ = !found.empty();
  if (found.empty() && !problem.empty()) throw std::runtime_error(problem);
  std::sort(found.begin(), found.end(), [](const HidInfo& a, const HidInfo& b) { return a.path < b.path; });
  return found;
}

std::string SocketBus::remedyOfAbsence() const {
  const std::string start =
      "; start 'vibe_emulator --folder " + folder_ + "', its devices are used as soon as they appear.";
  if (!exists_) return ": the folder " + folder_ + " does not exist" + start;
  if (!serves_) return ": no emulator serves the folder " + folder_ + start;
  return " in the folder " + folder_ + "; compare the id and the serial number with those that its emulator prints.";
}

std::unique_ptr<HidPort> SocketBus::open(const std::string& path) {
  FileDescriptor file = connectTo(path);
  if (!file && errno == EACCES)
    throw std::runtime_error("Socket " + path + " may not be opened; start the emulator as the same user.");
  if (!file) throw DeviceGone("Device " + path + " is gone: nobody serves its socket (" + std::strerror(errno) + ").");
  Hello hello = greet(file.get(), path);
  return std::make_unique<SocketPort>(std::move(file), path, std::move(hello));
}

}  // namespace vibe::hardware
