#include "camera/sources.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::vision {
namespace {

constexpr const char* kForms = "v4l2:/dev/video0, gige:ADDRESS, video:FILE or images:GLOB";

void require(bool condition, const std::string& problem) {
  if (!condition) throw Error("camera: " + problem + ".");
}

void check(const SourceOptions& options) {
  require(options.exposure > 0 && options.exposure <= 1, "exposure must be above 0 and at most 1 s");
  require(options.rate > 0 && options.rate <= 1e4, "rate must be above 0 and at most 10000 Hz");
  require(options.roi_x >= 0 && options.roi_y >= 0 && options.roi_width >= 0 && options.roi_height >= 0,
          "the region of interest must not be negative");
  require(options.gain == -1 || (options.gain >= 0 && options.gain <= 100), "gain must be 0 to 100 dB, or -1");
  require(options.packet_size == 0 || (options.packet_size >= 576 && options.packet_size <= 65000),
          "packet size must be 576 to 65000 bytes, or 0");
  require(options.realtime_priority >= 0 && options.realtime_priority <= 99, "real-time priority must be 0 to 99");
}

}  // namespace

std::unique_ptr<FrameSource> openSource(const std::string& address, const SourceOptions& options) {
  check(options);
  const std::size_t colon = address.find(':');
  const std::string kind = address.substr(0, colon);
  const std::string rest = colon == std::string::npos ? "" : address.substr(colon + 1);
  if (kind == "gige" && colon != std::string::npos) return openAravis(rest, options);
  if (!rest.empty()) {
    if (kind == "v4l2") return openV4l2(rest, options);
    if (kind == "video") return openVideo(rest, options);
    if (kind == "images") return openImages(rest, options);
  }
  throw Error("camera address \"" + address + "\" is not understood; write " + kForms + ".");
}

}  // namespace vibe::vision
