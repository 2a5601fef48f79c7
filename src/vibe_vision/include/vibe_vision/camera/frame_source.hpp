#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "vibe_vision/image/frame.hpp"

namespace vibe::vision {

/// What went wrong so far; all counts only grow. Every frame that a camera took is in one of the first four.
struct SourceStatistics {
  std::uint64_t frames = 0;      ///< delivered
  std::uint64_t lost = 0;        ///< gaps of the camera's sequence
  std::uint64_t incomplete = 0;  ///< packets missing: thrown away
  std::uint64_t unreadable = 0;  ///< pixel format, size or file that cannot be read: thrown away
  std::uint64_t reconnects = 0;  ///< times that a camera was opened again after it had been gone
};

/// What came of waiting for a frame.
enum class ReadResult {
  Frame,    ///< a new one
  Timeout,  ///< none yet; call again
  Gone,     ///< the camera does not answer; read() tries to open it again, at most once per second
  End,      ///< of a recording
};

/// Where frames come from. One thread reads.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// Waits for the next frame. @param timeout [s]; opening a camera may take some seconds longer
  virtual ReadResult read(Frame& frame, double timeout) = 0;
  virtual SourceStatistics statistics() const = 0;  ///< since the source was made; from any thread
  /// One line for people: what it is, or what is wrong with it and the remedy.
  virtual std::string status() const = 0;
};

/// Which moment a camera's own stamp denotes; see the manual of the camera.
enum class StampPoint { ExposureStart, ExposureEnd };

/// What the clock of a GigE Vision or USB3 Vision camera shows.
enum class CameraClock {
  Auto,  ///< Host if the camera says that it follows PTP and its stamps agree with the host, otherwise Free
  Free,  ///< some time of its own, mapped by the smallest delays between end of exposure and first packet
  Host,  ///< Unix time, or TAI: stamps are taken as they are
};

struct SourceOptions {
  double exposure = 1e-3;  ///< [s]; asked of a camera, taken as given for a recording
  double rate = 147;       ///< [Hz]; asked of a camera, taken as given for a recording without stamps
  /// Asked of a GigE camera; 0: full sensor. A recording: x and y of where it was cut from the sensor.
  int roi_x = 0, roi_y = 0, roi_width = 0, roi_height = 0;
  double gain = -1;    ///< [dB]; -1: leave as it is
  bool paced = false;  ///< recordings only: deliver in real time instead of as fast as they are read
  bool loop = false;   ///< recordings only
  StampPoint stamp_point = StampPoint::ExposureStart;  ///< of the camera's own stamps; V4L2, GigE and USB3 only
  CameraClock clock = CameraClock::Auto;               ///< GigE and USB3 only
  std::string pixel_format;   ///< GigE and USB3 only: of the camera, e.g. "Mono12p"; empty: Mono8 if it can
  int packet_size = 0;        ///< GigE only [bytes]; 0: the largest that the network lets through
  int realtime_priority = 0;  ///< GigE and USB3 only: of the receiving thread, 1 to 99; 0: ordinary
};

/// Opens one by its address:
///   "v4l2:/dev/video0"    a V4L2 camera, through OpenCV
///   "gige:NAME" or "gige:ADDRESS" or "gige:"   a GigE Vision or USB3 Vision camera, through Aravis; the first found
///   "video:FILE"          a recording; with FILE.csv beside it (sequence, stamp, exposure) its stamps are kept
///   "images:GLOB"         single images in the order of their names; stamps as for a recording, from DIR/frames.csv
/// How each source stamps: docs/vision.md, "Camera sources".
/// @throws Error with remedy for an address that cannot be understood or a file that cannot be read; a camera that is
///         not there is no error: read() keeps trying
std::unique_ptr<FrameSource> openSource(const std::string& address, const SourceOptions& options);

/// Whether an address is that of a recording: its stamps are not of today.
inline bool isRecording(const std::string& address) {
  return address.rfind("video:", 0) == 0 || address.rfind("images:", 0) == 0;
}

}  // namespace vibe::vision
