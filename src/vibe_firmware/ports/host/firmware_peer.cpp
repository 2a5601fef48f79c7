#include "firmware_peer.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <thread>

namespace vibe_firmware {
namespace {

constexpr int kTimeoutMs = 30000;

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what + "; is the emulator still running?");
}

// A FIFO opens for writing without waiting only once the other side has opened it for reading.
int openForWriting(const std::string& name) {
  for (int waited = 0; waited < kTimeoutMs; waited += 10) {
    const int file = open(name.c_str(), O_WRONLY | O_NONBLOCK);
    if (file >= 0) return file;
    if (errno != ENXIO) throw std::runtime_error(name + " cannot be opened: " + std::strerror(errno));
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  fail("the firmware did not open " + name + " within 30 s");
}

void waitFor(int file, short events, const char* what) {
  pollfd request{file, events, 0};
  if (poll(&request, 1, kTimeoutMs) <= 0) fail(std::string("the firmware did not ") + what + " for 30 s");
}

}  // namespace

FifoPeer::FifoPeer(const std::string& replies, const std::string& requests) {
  std::signal(SIGPIPE, SIG_IGN);
  replies_ = open(replies.c_str(), O_RDONLY | O_NONBLOCK);
  if (replies_ < 0) throw std::runtime_error(replies + " cannot be opened: " + std::strerror(errno));
  requests_ = openForWriting(requests);
}

FifoPeer::~FifoPeer() {
  CosimRequest stop;
  stop.stop = 1;
  const ssize_t written = write(requests_, &stop, sizeof stop);
  static_cast<void>(written);  // the firmware may have ended by itself
  close(replies_);
  close(requests_);
}

void FifoPeer::send(const CosimRequest& request) {
  waitFor(requests_, POLLOUT, "take a request");
  // below PIPE_BUF, so all or nothing
  if (write(requests_, &request, sizeof request) != sizeof request) fail("the firmware has closed its FIFO");
}

CosimReply FifoPeer::exchange(const CosimRequest& request) {
  send(request);
  CosimReply reply;
  auto* next = reinterpret_cast<char*>(&reply);
  std::size_t left = sizeof reply;
  while (left > 0) {
    waitFor(replies_, POLLIN, "answer");
    const ssize_t got = read(replies_, next, left);
    if (got <= 0) fail("the firmware has ended");
    next += got;
    left -= static_cast<std::size_t>(got);
  }
  return reply;
}

}  // namespace vibe_firmware
