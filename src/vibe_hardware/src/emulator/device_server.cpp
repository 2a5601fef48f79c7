#include "vibe_hardware/emulator/device_server.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include <fcntl.h>
#include <linux/input.h>
#include <linux/uhid.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "hid/transport.hpp"

namespace vibe::hardware {

namespace {

constexpr int kSendBuffer = 16 * 1024;  // of the kernel, per host [bytes]: some ten reports; the rest waits here

void makeFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(std::filesystem::path(folder).parent_path(), error);
  if (::mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST) return;
  throw std::runtime_error("Folder " + folder + " cannot be made (" + std::strerror(errno) +
                           "); choose one that you may write to.");
}

/// @return whether the packet is sent; errno says why not
bool sendNow(int file, const Packet& packet) {
  return ::send(file, packet.data(), packet.size(), MSG_DONTWAIT | MSG_NOSIGNAL) == static_cast<ssize_t>(packet.size());
}

}  // namespace

SocketServer::SocketServer(const std::string& folder, const std::string& name, UsbHost& device) : device_(device) {
  makeFolder(folder);
  path_ = folder + "/" + name + kSocketSuffix;
  listener_ = listenAt(path_);
}

SocketServer::~SocketServer() {
  ::unlink(path_.c_str());
}

void SocketServer::publish(const std::uint8_t* report, std::size_t size) {
  Packet packet{kInput};
  packet.insert(packet.end(), report, report + size);
  for (Host& host : hosts_) {
    if (host.reports.size() == kMaxWaitingReports) {
      host.reports.pop_front();
      ++dropped_;
    }
    host.reports.push_back(packet);
  }
}

void SocketServer::serve() {
  accept();
  for (std::size_t i = 0; i < hosts_.size();) {
    const Outcome outcome = serveHost(hosts_[i]);
    expelled_ += outcome == Outcome::Expelled ? 1 : 0;
    if (outcome == Outcome::Stays)
      ++i;
    else
      hosts_.erase(hosts_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

void SocketServer::accept() {
  while (true) {
    FileDescriptor file(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!file) return;
    if (hosts_.size() == kMaxHosts) continue;  // which closes it
    ::setsockopt(file.get(), SOL_SOCKET, SO_SNDBUF, &kSendBuffer, sizeof kSendBuffer);
    Host host;
    host.file = std::move(file);
    host.replies.push_back(
        packHello({device_.vendor(), device_.product(), device_.serial(), device_.name(), device_.reportDescriptor()}));
    hosts_.push_back(std::move(host));
  }
}

SocketServer::Outcome SocketServer::serveHost(Host& host) {
  const Outcome outcome = readRequests(host);
  return outcome == Outcome::Stays ? flush(host) : outcome;
}

SocketServer::Outcome SocketServer::readRequests(Host& host) {
  Packet packet;
  for (int i = 0; i < kMaxRequestsPerServe; ++i) {
    packet.resize(kMaxPacket + 1);
    const ssize_t size = ::recv(host.file.get(), packet.data(), packet.size(), MSG_DONTWAIT);
    if (size < 0 && (errno == EAGAIN || errno == EINTR)) return Outcome::Stays;
    if (size <= 0) return Outcome::Leaves;
    packet.resize(static_cast<std::size_t>(size));
    if (!answer(packet, host)) return Outcome::Expelled;
  }
  return Outcome::Stays;
}

/// @return false if the packet is not of the protocol, or the host does not read its replies
bool SocketServer::answer(const Packet& request, Host& host) {
  if (request.size() < 3 || request.size() > kMaxPacket || host.replies.size() == kMaxWaitingReplies) return false;
  Packet reply{kReply, request[1], 0};
  if (request[0] == kGet && request.size() == 3) {
    const std::vector<std::uint8_t> report = device_.getFeature(request[2]);
    reply[2] = report.empty() ? 1 : 0;
    reply.insert(reply.end(), report.begin(), report.end());
  } else if (request[0] == kSet) {
    reply[2] = device_.setFeature(request.data() + 2, request.size() - 2) ? 0 : 1;
  } else {
    return false;
  }
  host.replies.push_back(std::move(reply));
  return true;
}

SocketServer::Outcome SocketServer::flush(Host& host) {
  for (std::deque<Packet>* packets : {&host.replies, &host.reports})
    for (; !packets->empty(); packets->pop_front()) {
      if (sendNow(host.file.get(), packets->front())) continue;
      return errno == EAGAIN || errno == EINTR || errno == ENOBUFS ? Outcome::Stays : Outcome::Leaves;
    }
  return Outcome::Stays;
}

namespace {

constexpr const char* kPath = "/dev/uhid";
constexpr int kMaxEventsPerServe = 16;

template <std::size_t size>
void copyText(const std::string& text, __u8 (&field)[size]) {
  std::memcpy(field, text.data(), std::min(text.size(), size - 1));
}

}  // namespace

UhidServer::UhidServer(UsbHost& device) : device_(device), file_(::open(kPath, O_RDWR | O_NONBLOCK | O_CLOEXEC)) {
  if (!file_)
    throw std::runtime_error(std::string(kPath) + " cannot be opened (" + std::strerror(errno) +
                             (errno == EACCES || errno == EPERM ? "); give your user write access to the file."
                                                                : "); load the kernel module uhid."));
  create();
}

UhidServer::~UhidServer() {
  uhid_event event{};
  event.type = UHID_DESTROY;
  writeEvent(&event);
}

bool UhidServer::writeEvent(const void* event) {
  return ::write(file_.get(), event, sizeof(uhid_event)) == static_cast<ssize_t>(sizeof(uhid_event));
}

void UhidServer::create() {
  uhid_event event{};
  event.type = UHID_CREATE2;
  uhid_create2_req& request = event.u.create2;
  copyText(device_.name(), request.name);
  copyText(device_.serial(), request.uniq);
  request.bus = BUS_USB;
  request.vendor = device_.vendor();
  request.product = device_.product();
  const std::vector<std::uint8_t>& descriptor = device_.reportDescriptor();
  request.rd_size = static_cast<__u16>(descriptor.size());
  std::copy(descriptor.begin(), descriptor.end(), request.rd_data);
  if (!writeEvent(&event))
    throw std::runtime_error(std::string(kPath) + " does not take the device (" + std::strerror(errno) +
                             "); look for the reason in the kernel log.");
}

void UhidServer::publish(const std::uint8_t* report, std::size_t size) {
  uhid_event event{};
  event.type = UHID_INPUT2;
  event.u.input2.size = static_cast<__u16>(size);
  std::copy_n(report, size, event.u.input2.data);
  dropped_ += writeEvent(&event) ? 0 : 1;
}

void UhidServer::serve() {
  for (int i = 0; i < kMaxEventsPerServe; ++i) {
    uhid_event event{}, reply{};
    if (::read(file_.get(), &event, sizeof event) <= 0) return;
    if (event.type == UHID_GET_REPORT) {
      const std::vector<std::uint8_t> report = event.u.get_report.rtype == UHID_FEATURE_REPORT
                                                   ? device_.getFeature(event.u.get_report.rnum)
                                                   : std::vector<std::uint8_t>();
      reply.type = UHID_GET_REPORT_REPLY;
      reply.u.get_report_reply.id = event.u.get_report.id;
      reply.u.get_report_reply.err = report.empty() ? EIO : 0;
      reply.u.get_report_reply.size = static_cast<__u16>(report.size());
      std::copy(report.begin(), report.end(), reply.u.get_report_reply.data);
    } else if (event.type == UHID_SET_REPORT) {
      const uhid_set_report_req& request = event.u.set_report;
      const bool taken = request.rtype == UHID_FEATURE_REPORT && device_.setFeature(request.data, request.size);
      reply.type = UHID_SET_REPORT_REPLY;
      reply.u.set_report_reply.id = request.id;
      reply.u.set_report_reply.err = taken ? 0 : EIO;
    } else {
      continue;  // opened, closed, started
    }
    writeEvent(&reply);
  }
}

}  // namespace vibe::hardware
