#include <algorithm>
#include <thread>

#include "camera/aravis_camera.hpp"
#include "camera/frame_timing.hpp"
#include "camera/host_time.hpp"
#include "camera/sources.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_vision/image/camera_model.hpp"

namespace vibe::vision {
namespace {

constexpr double kSilence = 1;           // without any packet after which a camera is opened again [s]
constexpr double kSilentPeriods = 4;     // the same, for cameras of less than 4 Hz
constexpr double kForgiveness = 1;       // without a fault after which it is no longer told [s]
constexpr double kPacketPatience = 0.1;  // between looks at whether the control channel is lost [s]

constexpr bool isCode(PixelFormat format, guint32 code) {
  return static_cast<guint32>(format) == code;
}
static_assert(isCode(PixelFormat::Mono8, ARV_PIXEL_FORMAT_MONO_8) &&
              isCode(PixelFormat::Mono10, ARV_PIXEL_FORMAT_MONO_10) &&
              isCode(PixelFormat::Mono12, ARV_PIXEL_FORMAT_MONO_12) &&
              isCode(PixelFormat::Mono16, ARV_PIXEL_FORMAT_MONO_16) &&
              isCode(PixelFormat::Mono10Packed, ARV_PIXEL_FORMAT_MONO_10_PACKED) &&
              isCode(PixelFormat::Mono12Packed, ARV_PIXEL_FORMAT_MONO_12_PACKED));
static_assert(isCode(PixelFormat::BayerGR8, ARV_PIXEL_FORMAT_BAYER_GR_8) &&
              isCode(PixelFormat::BayerRG8, ARV_PIXEL_FORMAT_BAYER_RG_8) &&
              isCode(PixelFormat::BayerGB8, ARV_PIXEL_FORMAT_BAYER_GB_8) &&
              isCode(PixelFormat::BayerBG8, ARV_PIXEL_FORMAT_BAYER_BG_8) &&
              isCode(PixelFormat::RGB8, ARV_PIXEL_FORMAT_RGB_8_PACKED) &&
              isCode(PixelFormat::BGR8, ARV_PIXEL_FORMAT_BGR_8_PACKED) &&
              isCode(PixelFormat::YUYV, ARV_PIXEL_FORMAT_YUV_422_YUYV_PACKED) &&
              isCode(PixelFormat::UYVY, ARV_PIXEL_FORMAT_YUV_422_PACKED));

class AravisSource : public ReportingSource {
 public:
  AravisSource(const std::string& name, const SourceOptions& options)
      : ReportingSource("gige:" + name + ": not opened yet"), name_(name), options_(options) {}
  ~AravisSource() override {
    if (burial_.joinable()) burial_.join();
  }

  ReadResult read(Frame& frame, double timeout) override {
    if (!camera_) return connect(timeout);
    const double deadline = steadyTime() + timeout;
    const double silence = std::max(kSilence, kSilentPeriods / std::max(camera_->facts().rate, 1e-3));
    do {
      ArvBuffer* buffer = camera_->pop(std::min(kPacketPatience, deadline - steadyTime()));
      const double now = steadyTime();
      if (buffer) {
        last_sign_ = now;
        frame.arrival = hostTime();
        if (accept(buffer, frame)) return ReadResult::Frame;
      }
      if (camera_->isLost()) return disconnect("does not answer any more");
      if (now - last_sign_ > silence) return disconnect("has sent nothing for a second");
    } while (steadyTime() < deadline);
    return ReadResult::Timeout;
  }

 private:
  std::string name_;
  SourceOptions options_;
  std::unique_ptr<AravisCamera> camera_;
  std::thread burial_;  // takes apart the last camera that went
  RetryTimer retry_;
  StampClock clock_;
  SequenceCounter sequence_;
  PixelPool pool_;
  double last_sign_ = 0;           // steady time of the last buffer
  std::uint64_t thrown_away_ = 0;  // buffers since the last complete one
  bool has_connected_ = false;
  bool is_faulty_ = false;  // the status tells of frames that were thrown away
  double last_fault_ = 0;

  ReadResult connect(double timeout) {
    if (!retry_.wait(timeout)) return ReadResult::Gone;
    try {
      camera_ = std::make_unique<AravisCamera>(name_, options_);
    } catch (const Error& error) {
      say(error.what());
      return ReadResult::Gone;
    }
    clock_ = StampClock(options_.clock, camera_->facts().follows_ptp);
    sequence_.restart();
    thrown_away_ = 0;
    last_sign_ = steadyTime();
    say(goodStatus());
    if (has_connected_) count(&SourceStatistics::reconnects);
    has_connected_ = true;
    return ReadResult::Timeout;
  }

  ReadResult disconnect(const std::string& reason) {
    say("gige:" + name_ + ": " + camera_->facts().name + " " + reason +
        "; check power and cable; it is opened again as soon as it answers");
    camera_->abandon();
    // Aravis tries for 7 s to say goodbye to a camera that does not answer
    if (burial_.joinable()) burial_.join();
    burial_ = std::thread([camera = std::shared_ptr<AravisCamera>(std::move(camera_))]() mutable { camera.reset(); });
    return ReadResult::Gone;
  }

  bool accept(ArvBuffer* buffer, Frame& frame) {
    if (arv_buffer_get_status(buffer) != ARV_BUFFER_STATUS_SUCCESS) {
      throwAway(buffer, &SourceStatistics::incomplete,
                "gige:" + name_ +
                    ": frames arrive with packets missing; allow jumbo frames on the network card and a " +
                    "larger net.core.rmem_max, or lower the frame rate");
      return false;
    }
    int width = 0, height = 0;
    const std::string problem = obstacle(buffer, width, height);
    if (!problem.empty()) {
      throwAway(buffer, &SourceStatistics::unreadable, "gige:" + name_ + ": " + problem);
      return false;
    }
    number(buffer, frame);
    stamp(buffer, frame);
    frame.offset_x = camera_->facts().x;
    frame.offset_y = camera_->facts().y;
    frame.sensor_width = camera_->facts().sensor_width;
    frame.sensor_height = camera_->facts().sensor_height;
    keepPixels(buffer, frame, width, height);
    return true;
  }

  /// @return why the frame cannot be read, with the remedy; empty if it can
  std::string obstacle(ArvBuffer* buffer, int& width, int& height) const {
    if (arv_buffer_get_payload_type(buffer) != ARV_BUFFER_PAYLOAD_TYPE_IMAGE) {
      return "the camera sends no images but another type of payload; switch off what changes it, such as chunk data "
             "or "
             "compression";
    }
    const auto format = static_cast<PixelFormat>(arv_buffer_get_image_pixel_format(buffer));
    width = arv_buffer_get_image_width(buffer);
    height = arv_buffer_get_image_height(buffer);
    if (!isReadable(format)) {
      return "the camera sends pixel format " + nameOf(format) +
             ", which cannot be read; set its PixelFormat to one of " + readableFormats();
    }
    std::size_t size = 0;
    arv_buffer_get_data(buffer, &size);
    if (size < sizeOf(format, width, height)) {
      return "the camera announces pixel format " + nameOf(format) + ", but sends fewer bytes than it needs; set its " +
             "PixelFormat to Mono8 before it is opened";
    }
    if (width != camera_->facts().width || height != camera_->facts().height) {
      return "the camera sends " + sizeText(width, height) + " pixels instead of " +
             sizeText(camera_->facts().width, camera_->facts().height) +
             "; another program may have changed its settings: close it";
    }
    return "";
  }

  void number(ArvBuffer* buffer, Frame& frame) {
    const SequenceCounter::Step step = sequence_.advance(arv_buffer_get_frame_id(buffer));
    frame.sequence = step.sequence;
    count(&SourceStatistics::frames);
    if (step.skipped > thrown_away_) count(&SourceStatistics::lost, step.skipped - thrown_away_);
    thrown_away_ = 0;
    if (is_faulty_ && steadyTime() - last_fault_ > kForgiveness) {
      is_faulty_ = false;
      say(goodStatus());
    }
  }

  void stamp(ArvBuffer* buffer, Frame& frame) {
    const double exposure = camera_->facts().exposure;
    const double device = static_cast<double>(arv_buffer_get_timestamp(buffer)) * 1e-9;
    const double first_packet = static_cast<double>(arv_buffer_get_system_timestamp(buffer)) * 1e-9;
    const double device_end = options_.stamp_point == StampPoint::ExposureStart ? device + exposure : device;
    frame.stamp = clock_.map(device_end, first_packet) - exposure / 2;
    frame.exposure = exposure;
  }

  void keepPixels(ArvBuffer* buffer, Frame& frame, int width, int height) {
    const auto format = static_cast<PixelFormat>(arv_buffer_get_image_pixel_format(buffer));
    const auto* data = static_cast<const std::uint8_t*>(arv_buffer_get_data(buffer, nullptr));
    frame.image = {data, width, height, width};
    frame.owner = format == PixelFormat::Mono8 ? camera_->loan().lend(buffer) : nullptr;
    if (frame.owner) return;
    toMono8(format, data, width, height, pool_.give(frame, width, height));
    camera_->giveBack(buffer);
  }

  void throwAway(ArvBuffer* buffer, std::uint64_t SourceStatistics::*fault, const std::string& reason) {
    camera_->giveBack(buffer);
    ++thrown_away_;
    count(fault);
    say(reason);
    is_faulty_ = true;
    last_fault_ = steadyTime();
  }

  std::string goodStatus() const {
    const AravisCamera::Facts& facts = camera_->facts();
    return "gige:" + name_ + ": " + facts.name + ", " + sizeText(facts.width, facts.height) + " at " +
           std::to_string(static_cast<int>(facts.rate + 0.5)) + " Hz" +
           (camera_->lacksPriority() ? "; real-time priority was not given; raise rtprio in /etc/security/limits.conf"
                                     : "") +
           facts.notes;
  }
};

}  // namespace

std::unique_ptr<FrameSource> openAravis(const std::string& name, const SourceOptions& options) {
  return std::make_unique<AravisSource>(name, options);
}

}  // namespace vibe::vision
