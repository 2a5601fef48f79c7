#include "vibe_vision/track/tracker.hpp"

#include <variant>

#include "track/instrument_tracker.hpp"
#include "track/tag_tracker.hpp"

namespace vibe::vision {

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

Tracker::Tracker(const VisionConfig& config, const TrackerPolicy& policy) : impl_(std::make_unique<Impl>()) {
  impl_->config = config;
  for (const InstrumentConfig& instrument : config.instruments) {
    checkMarker(instrument.marker, "The marker of instrument '" + instrument.name + "'");
    if (std::holds_alternative<TagDesign>(instrument.marker))
      impl_->instruments.emplace_back(std::in_place_type<TagTracker>, config, instrument, policy);
    else
      impl_->instruments.emplace_back(
          std::in_place_type<InstrumentTracker>, config, instrument,
          makePattern(instrument.marker, instrument.axis.pixels_per_metre, markerView(config.camera, instrument.axis)),
          policy);
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
