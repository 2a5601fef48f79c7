#pragma once
#include <functional>

namespace vibe::hardware {

/// What the kernel tells about devices that come and go (netlink, as udev listens to it).
class KernelEvents {
 public:
  KernelEvents();  ///< @throws std::runtime_error
  ~KernelEvents();
  KernelEvents(const KernelEvents&) = delete;
  KernelEvents& operator=(const KernelEvents&) = delete;

  /// Checks the condition now and after every event.
  /// @param timeout  [s]
  /// @return whether it became true in time
  bool waitUntil(const std::function<bool()>& condition, double timeout);

 private:
  int socket_;
};

}  // namespace vibe::hardware
