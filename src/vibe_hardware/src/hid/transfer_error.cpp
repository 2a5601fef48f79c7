#include "hid/transfer_error.hpp"

#include <cerrno>
#include <cstring>

#include "vibe_hardware/hid/hid_port.hpp"

namespace vibe::hardware {

// A device that was unplugged answers ENODEV or EIO; one that does not know a report stalls the request: EPIPE.
void failTransfer(const std::string& path, int error, const std::string& what) {
  const std::string sentence = path + ": " + what + ": " + std::strerror(error);
  if (error == ETIMEDOUT) throw NoAnswer(sentence);
  if (error == EPIPE || error == EINVAL || error == EOVERFLOW) throw ReportRejected(sentence);
  throw DeviceGone(sentence);
}

}  // namespace vibe::hardware
