#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace vibe::hardware {

/// An open /dev/hidraw file, through the kernel's interface alone (linux/hidraw.h). It shares no code with the driver.
class HidrawFile {
 public:
  explicit HidrawFile(const std::string& path);  ///< @throws std::runtime_error
  ~HidrawFile();
  HidrawFile(const HidrawFile&) = delete;
  HidrawFile& operator=(const HidrawFile&) = delete;

  /// Waits for an input report. @param timeout [s]  @return empty: none came in time, or the device is gone
  std::vector<std::uint8_t> read(double timeout);

  /// @return the feature report; empty: refused, see errno
  std::vector<std::uint8_t> getFeature(std::uint8_t id);

  /// @return 0 or the errno of the kernel
  int setFeature(const std::vector<std::uint8_t>& bytes);

  std::vector<std::uint8_t> reportDescriptor() const;
  int descriptor() const { return file_; }

 private:
  int file_;
};

}  // namespace vibe::hardware
