#include "hid/transport.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include "vibe_hardware/hid/hid_port.hpp"

namespace vibe::hardware {

namespace {

/// @return false if the path is too long for a socket
bool makeAddress(const std::string& path, sockaddr_un& address) {
  address = {};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) return false;
  std::memcpy(address.sun_path, path.data(), path.size());
  return true;
}

FileDescriptor newSocket() {
  return FileDescriptor(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
}

}  // namespace

FileDescriptor connectTo(const std::string& path) {
  sockaddr_un address;
  if (!makeAddress(path, address)) {
    errno = ENAMETOOLONG;
    return FileDescriptor();
  }
  FileDescriptor file = newSocket();
  if (!file || ::connect(file.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return FileDescriptor();
  return file;
}

FileDescriptor listenAt(const std::string& path) {
  sockaddr_un address;
  if (!makeAddress(path, address))
    throw std::runtime_error("Socket " + path + ": the path has more than " +
                             std::to_string(sizeof address.sun_path - 1) + " bytes; choose a shorter folder.");
  if (connectTo(path))
    throw std::runtime_error("Socket " + path +
                             " is served already, by another emulator or program; end that first, or choose another "
                             "folder.");
  struct stat about {};
  if (errno == ECONNREFUSED && ::lstat(path.c_str(), &about) == 0 && S_ISSOCK(about.st_mode))
    ::unlink(path.c_str());  // its server has ended without removing it
  FileDescriptor file = newSocket();
  if (!file || ::bind(file.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(file.get(), 16) != 0)
    throw std::runtime_error("Socket " + path + " cannot be made (" + std::strerror(errno) +
                             "); choose another folder, which you may write to.");
  return file;
}

bool waitReadable(int file, double seconds) {
  pollfd entry{file, POLLIN, 0};
  const int milliseconds = seconds < 0 ? -1 : static_cast<int>(std::ceil(std::min(seconds, 1e6) * 1e3));
  return ::poll(&entry, 1, milliseconds) > 0;
}

// A device that was unplugged answers ENODEV or EIO; one that does not know a report stalls the request: EPIPE.
void failTransfer(const std::string& path, int error, const std::string& what) {
  const std::string sentence = path + ": " + what + ": " + std::strerror(error);
  if (error == ETIMEDOUT) throw NoAnswer(sentence);
  if (error == EPIPE || error == EINVAL || error == EOVERFLOW) throw ReportRejected(sentence);
  throw DeviceGone(sentence);
}

}  // namespace vibe::hardware
