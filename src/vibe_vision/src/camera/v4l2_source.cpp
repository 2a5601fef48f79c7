#include <cerrno>
#include <cmath>
#include <cstring>

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <opencv2/videoio.hpp>

#include "camera/frame_timing.hpp"
#include "camera/host_time.hpp"
#include "camera/sources.hpp"

namespace vibe::vision {

namespace {

constexpr double kPlausible = 10;  // between a kernel stamp and its arrival [s]
constexpr double kTooLate = 1e-3;  // by which the two clocks may be read at different moments [s]

std::string lettersOf(int fourcc) {
  std::string text;
  for (int shift = 0; shift < 32; shift += 8) text += static_cast<char>(fourcc >> shift & 0x7f);
  return text;
}

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

class V4l2Source : public ReportingSource {
 public:
  V4l2Source(const std::string& device, const SourceOptions& options)
      : ReportingSource(device + ": not opened yet"), device_(device), options_(options) {}

  ReadResult read(Frame& frame, double timeout) override {
    if (!capture_.isOpened()) return connect(timeout);
    cv::Mat picture;
    if (!capture_.read(picture) || picture.empty()) {
      const std::string obstacle = v4l2Obstacle(device_);
      say(obstacle.empty() ? device_ + ": sends no frames; plug it out and in again" : obstacle);
      capture_.release();
      return ReadResult::Gone;
    }
    frame.arrival = hostTime();
    if (!stamp(frame) || !convert(picture, frame)) return ReadResult::Timeout;
    count(&SourceStatistics::frames);
    say(good_status_);
    return ReadResult::Frame;
  }

 private:
  std::string device_;
  SourceOptions options_;
  cv::VideoCapture capture_;
  PixelFormat format_{};
  bool has_connected_ = false;
  RetryTimer retry_;
  PixelPool pool_;
  IntervalGaps gaps_{1};
  double exposure_ = 0;  // that the driver tells [s]
  std::string good_status_;
  std::uint64_t sequence_ = 0;

  ReadResult connect(double timeout) {
    if (!retry_.wait(timeout)) return ReadResult::Gone;
    const std::string obstacle = v4l2Obstacle(device_);
    if (!obstacle.empty()) {
      say(obstacle);
      return ReadResult::Gone;
    }
    if (!capture_.open(device_, cv::CAP_V4L2)) {
      say(device_ + ": cannot be opened by OpenCV; see which formats v4l2-ctl --list-formats tells");
      return ReadResult::Gone;
    }
    configure();
    if (has_connected_) count(&SourceStatistics::reconnects);
    has_connected_ = true;
    return ReadResult::Timeout;
  }

  void configure() {
    for (const char* letters : {"GREY", "YUYV"}) {
      const int fourcc = cv::VideoWriter::fourcc(letters[0], letters[1], letters[2], letters[3]);
      if (capture_.set(cv::CAP_PROP_FOURCC, fourcc) && capture_.get(cv::CAP_PROP_FOURCC) == fourcc) break;
    }
    if (options_.roi_width > 0) capture_.set(cv::CAP_PROP_FRAME_WIDTH, options_.roi_width);
    if (options_.roi_height > 0) capture_.set(cv::CAP_PROP_FRAME_HEIGHT, options_.roi_height);
    capture_.set(cv::CAP_PROP_FPS, options_.rate);
    capture_.set(cv::CAP_PROP_AUTO_EXPOSURE, 1);                   // V4L2_EXPOSURE_MANUAL
    capture_.set(cv::CAP_PROP_EXPOSURE, options_.exposure * 1e4);  // V4L2_CID_EXPOSURE_ABSOLUTE has units of 100 us
    if (options_.gain >= 0) capture_.set(cv::CAP_PROP_GAIN, options_.gain);
    capture_.set(cv::CAP_PROP_BUFFERSIZE, 2);
    const int fourcc = static_cast<int>(capture_.get(cv::CAP_PROP_FOURCC));
    format_ = v4l2Format(fourcc);
    capture_.set(cv::CAP_PROP_CONVERT_RGB, isReadable(format_) ? 0 : 1);  // OpenCV decodes the others, e.g. MJPG
    const double rate = capture_.get(cv::CAP_PROP_FPS);
    gaps_ = IntervalGaps(1 / (rate > 0 ? rate : options_.rate));
    const double exposure = capture_.get(cv::CAP_PROP_EXPOSURE) * 1e-4;
    exposure_ = exposure > 0 ? exposure : options_.exposure;
    good_status_ = device_ + ": " + lettersOf(fourcc) + " at " + std::to_string(std::lround(rate)) + " Hz";
    say(good_status_);
  }

  bool convert(const cv::Mat& picture, Frame& frame) {
    const PixelFormat format = isReadable(format_) ? format_ : PixelFormat::BGR8;
    // raw pictures of some formats come as one row of bytes
    const bool is_flat = picture.rows == 1;
    const int width = is_flat ? static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_WIDTH)) : picture.cols;
    const int height = is_flat ? static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_HEIGHT)) : picture.rows;
    const std::size_t size = sizeOf(format, width, height);
    if (size == 0 || !picture.isContinuous() || picture.total() * picture.elemSize() < size) {
      throwAway(device_ + ": sends pictures that are smaller than " + nameOf(format) + " needs; choose another format");
      return false;
    }
    toMono8(format, picture.data, width, height, pool_.give(frame, width, height));
    frame.offset_x = frame.offset_y = 0;
    frame.sensor_width = width;
    frame.sensor_height = height;
    return true;
  }

  bool stamp(Frame& frame) {
    const double kernel = unixFromMonotonic(capture_.get(cv::CAP_PROP_POS_MSEC) * 1e-3);
    if (kernel > frame.arrival + kTooLate || kernel < frame.arrival - kPlausible) {
      throwAway(device_ +
                ": the driver gives no stamps; use another camera, since arrival tells nothing about exposure");
      return false;
    }
    const bool is_start = options_.stamp_point == StampPoint::ExposureStart;
    frame.stamp = kernel + (is_start ? 0.5 : -0.5) * exposure_;
    frame.exposure = exposure_;
    const std::uint64_t missed = gaps_.advance(frame.stamp);
    sequence_ += 1 + missed;
    frame.sequence = sequence_;
    count(&SourceStatistics::lost, missed);
    return true;
  }

  void throwAway(const std::string& reason) {
    say(reason);
    count(&SourceStatistics::unreadable);
  }
};

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

double unixFromMonotonic(double monotonic) {
  return monotonic + hostTime() - steadyTime();
}

PixelFormat v4l2Format(int fourcc) {
  const std::string letters = lettersOf(fourcc);
  if (letters == "GREY" || letters == "Y800") return PixelFormat::Mono8;
  if (letters == "Y10 ") return PixelFormat::Mono10;
  if (letters == "Y12 ") return PixelFormat::Mono12;
  if (letters == "Y16 ") return PixelFormat::Mono16;
  if (letters == "YUYV") return PixelFormat::YUYV;
  if (letters == "UYVY") return PixelFormat::UYVY;
  if (letters == "BGR3") return PixelFormat::BGR8;
  if (letters == "RGB3") return PixelFormat::RGB8;
  return PixelFormat{};
}

std::unique_ptr<FrameSource> openV4l2(const std::string& device, const SourceOptions& options) {
  return std::make_unique<V4l2Source>(device, options);
}

}  // namespace vibe::vision
