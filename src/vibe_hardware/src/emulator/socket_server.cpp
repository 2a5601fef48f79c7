#include "vibe_hardware/emulator/socket_server.hpp"

#include <sys/socket.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "hid/local_socket.hpp"

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

}  // namespace vibe::hardware
