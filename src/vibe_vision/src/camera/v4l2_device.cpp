#include "camera/v4l2_device.hpp"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace vibe::vision {
namespace {

std::string reasonOf(int error) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return "no such camera; plug it in, or choose one of v4l2-ctl --list-devices";
    case EACCES:
    case EPERM:
      return "permission denied; add the user to the group video and log in again";
    case EBUSY:
      return "is used by another program; close it";
    default:
      return std::string("cannot be opened: ") + std::strerror(error);
  }
}

}  // namespace

std::string v4l2Obstacle(const std::string& device) {
  const int file = ::open(device.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return device + ": " + reasonOf(errno);
  v4l2_capability facts{};
  const bool is_video = ::ioctl(file, VIDIOC_QUERYCAP, &facts) == 0;
  ::close(file);
  if (!is_video) return device + ": is not a V4L2 device; choose one of v4l2-ctl --list-devices";
  const __u32 abilities = facts.capabilities & V4L2_CAP_DEVICE_CAPS ? facts.device_caps : facts.capabilities;
  if (abilities & V4L2_CAP_VIDEO_CAPTURE) return "";
  return device + ": takes no pictures (it is another node of the same camera); try the next lower number";
}

}  // namespace vibe::vision
