#include "vibe_vision/track/tracker.hpp"

#include <variant>

#include "tag/tag_tracker.hpp"
#include "track/instrument_tracker.hpp"

namespace vibe::vision {

const char* toText(LostReason reason) {
  switch (reason) {
    case LostReason::None:
      return "tracked";
    case LostReason::NotFound:
      return "nothing along the axis looks like the marker";
    case LostReason::Occluded:
      return "too little of the marker is visible";
    case LostReason::Saturated:
      return "the image is too bright";
    case LostReason::Dark:
      return "the image is too dark";
    case LostReason::Mismatch:
      return "pattern, size or tilt is not that of the marker";
    case LostReason::Jump:
      return "it would have moved faster than the instrument can";
    case LostReason::OutOfView:
      return "the marker leaves the image";
    case LostReason::WrongImage:
      return "the image does not have the size of the calibration";
    case LostReason::NoFrame:
      return "no image";
  }
  return "unknown";
}

const char* toText(Doubt doubt) {
  switch (doubt) {
    case Doubt::None:
      return "";
    case Doubt::Size:
      return "the marker is not as large as calibrated: the camera may have moved or have another lens, or the print "
             "another size; calibrate the axis anew, or correct the size";
    case Doubt::Shutter:
      return "the picture of the moving marker is sheared, as by a rolling shutter; use a camera with a global shutter";
    case Doubt::Unchecked:
      return "too few fast frames have been seen to exclude a rolling shutter; move the instrument to and fro";
    case Doubt::Askew:
      return "the tilt of the sleeve's bars changes with its rotation: it may be glued askew, which moves its slide "
             "with "
             "the rotation; glue it anew, its ends at right angles to the rod";
    case Doubt::Bent:
      return "the marker is bent or its ends stand off: a ring is shortened towards two of its sides, or the ends of a "
             "marker are not as far from the camera as its middle; glue it anew, a ring on something flat";
    case Doubt::Response:
      return "the grey values do not grow with the light as configured: set camera.gamma to the camera's response, or "
             "switch its gamma correction off";
  }
  return "unknown";
}

struct Tracker::Impl {
  VisionConfig config;
  std::vector<std::variant<InstrumentTracker, TagTracker>> instruments;
  Measurements measurements;

  /// All markers are seen by one shutter.
  void shareRowTimes() {
    if (instruments.size() < 2) return;
    CalibrationDoubts::RowTime all;
    const auto doubtsOf = [](auto& instrument) -> CalibrationDoubts& {
      return std::visit([](auto& tracker) -> CalibrationDoubts& { return tracker.doubts(); }, instrument);
    };
    for (auto& instrument : instruments) {
      const CalibrationDoubts::RowTime seen = doubtsOf(instrument).rowTimeSeen();
      all.information += seen.information, all.sum += seen.sum;
    }
    for (auto& instrument : instruments) {
      const CalibrationDoubts::RowTime own = doubtsOf(instrument).rowTimeSeen();
      doubtsOf(instrument).addRowTime({all.information - own.information, all.sum - own.sum});
    }
  }

  bool fits(const Frame& frame) const {
    const ImageView& image = frame.image;
    return frame.sensor_width == config.camera.width && frame.sensor_height == config.camera.height &&
           frame.offset_x >= 0 && frame.offset_y >= 0 && frame.offset_x + image.width <= frame.sensor_width &&
           frame.offset_y + image.height <= frame.sensor_height && image.stride >= image.width;
  }
};

Tracker::Tracker(const VisionConfig& config) : impl_(std::make_unique<Impl>()) {
  impl_->config = config;
  for (const InstrumentConfig& instrument : config.instruments) {
    checkMarker(instrument.marker, "The marker of instrument '" + instrument.name + "'");
    if (std::holds_alternative<TagDesign>(instrument.marker))
      impl_->instruments.emplace_back(std::in_place_type<TagTracker>, config, instrument);
    else
      impl_->instruments.emplace_back(
          std::in_place_type<InstrumentTracker>, config, instrument,
          makePattern(instrument.marker, instrument.axis.pixels_per_metre, markerView(config.camera, instrument.axis)));
    impl_->measurements.push_back(
        std::visit([](const auto& tracker) { return tracker.measurement(); }, impl_->instruments.back()));
  }
}

Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;

const Measurements& Tracker::track(const Frame& frame) {
  impl_->shareRowTimes();
  const bool none = frame.image.empty() || frame.image.data == nullptr;
  for (std::size_t i = 0; i < impl_->instruments.size(); ++i) {
    impl_->measurements[i] = std::visit(
        [&](auto& tracker) {
          return none                 ? tracker.lose(LostReason::NoFrame)
                 : impl_->fits(frame) ? tracker.track(frame)
                                      : tracker.lose(LostReason::WrongImage);
        },
        impl_->instruments[i]);
  }
  return impl_->measurements;
}

void Tracker::reset() {
  for (auto& instrument : impl_->instruments) std::visit([](auto& tracker) { tracker.reset(); }, instrument);
}

const VisionConfig& Tracker::config() const {
  return impl_->config;
}

}  // namespace vibe::vision
