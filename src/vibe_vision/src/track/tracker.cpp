#include "vibe_vision/track/tracker.hpp"

#include <optional>
#include <utility>
#include <variant>

#include "track/instrument_tracker.hpp"
#include "track/noise_meter.hpp"
#include "track/tag_tracker.hpp"

namespace vibe::vision {

struct Tracker::Impl {
  explicit Impl(const VisionConfig& rig) : config(rig), noise(rig.noise) {}

  VisionConfig config;
  NoiseMeter noise;
  std::optional<std::pair<double, std::uint64_t>> last;  // stamp and sequence
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

  /// What is known of a picture beside the place of the marker.
  void describe(std::size_t i) {
    Measurement& m = measurements[i];
    if (m.tracked() && m.doubt == Doubt::None && noise.doubtsStated()) m.doubt = Doubt::Noise;
    if (const auto* own = std::get_if<InstrumentTracker>(&instruments[i])) m.ink = own->ink();
  }

  void measureNoise(const ImageView& image) {
    noise.look(image);
    for (auto& instrument : instruments)
      if (auto* own = std::get_if<InstrumentTracker>(&instrument)) own->setNoise(noise.noise());
  }

  bool fits(const Frame& frame) const {
    const ImageView& image = frame.image;
    return frame.sensor_width == config.camera.width && frame.sensor_height == config.camera.height &&
           frame.offset_x >= 0 && frame.offset_y >= 0 && frame.offset_x + image.width <= frame.sensor_width &&
           frame.offset_y + image.height <= frame.sensor_height && image.stride >= image.width;
  }
};

Tracker::Tracker(const VisionConfig& config, const TrackerPolicy& policy) : impl_(std::make_unique<Impl>(config)) {
  for (const InstrumentConfig& instrument : config.instruments) {
    checkMarker(instrument.marker, "The marker of instrument '" + instrument.name + "'");
    if (std::holds_alternative<TagDesign>(instrument.marker))
      impl_->instruments.emplace_back(std::in_place_type<TagTracker>, config, instrument, policy);
    else
      impl_->instruments.emplace_back(std::in_place_type<InstrumentTracker>, config, instrument, policy);
    impl_->measurements.push_back(
        std::visit([](const auto& tracker) { return tracker.measurement(); }, impl_->instruments.back()));
  }
}

Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;

const Measurements& Tracker::track(const Frame& frame) {
  const bool none = frame.image.empty() || frame.image.data == nullptr;
  const std::pair<double, std::uint64_t> now(frame.stamp, frame.sequence);
  if (!none && impl_->last == now) return impl_->measurements;
  impl_->last = now;
  impl_->shareRowTimes();
  if (!none) impl_->measureNoise(frame.image);
  for (std::size_t i = 0; i < impl_->instruments.size(); ++i) {
    impl_->measurements[i] = std::visit(
        [&](auto& tracker) {
          return none                 ? tracker.lose(LostReason::NoFrame)
                 : impl_->fits(frame) ? tracker.track(frame)
                                      : tracker.lose(LostReason::WrongImage);
        },
        impl_->instruments[i]);
    impl_->describe(i);
  }
  return impl_->measurements;
}

void Tracker::reset() {
  impl_->last.reset();
  for (auto& instrument : impl_->instruments) std::visit([](auto& tracker) { tracker.reset(); }, instrument);
}

const VisionConfig& Tracker::config() const {
  return impl_->config;
}

}  // namespace vibe::vision
