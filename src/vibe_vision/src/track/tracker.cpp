#include "vibe_vision/track/tracker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>

#include "track/outcome.hpp"

namespace vibe::vision {
namespace {

// Design choices.
constexpr int kAcross = 16, kDown = 12, kWidth = 34, kHeight = 8;  // tiles, and their pixels
constexpr int kFirstPictures = 4, kEveryPicture = 16;              // pictures that are measured
constexpr double kNoiseMemory = 0.8;
constexpr double kDarkTile = 4, kBrightTile = 245;           // mean grey values of tiles that are cut off
constexpr double kNoticeableNoise = 1.3, kWrongNoise = 1.6;  // ratio of variances
// Of a normal variable with unit variance: mean of |x|; of its second difference: standard deviation.
const double kMeanDifference = std::sqrt(2 / M_PI) * std::sqrt(6.0);

}  // namespace

/// Measures the noise of pictures: the second differences of neighbouring pixels in the smoothest quarter of small
/// tiles. What a picture shows bends slowly there, so that noise is what is left (Immerkaer, "Fast noise variance
/// estimation", Computer Vision and Image Understanding 64, 1996). The tiles are as many in every picture.
class NoiseMeter {
 public:
  explicit NoiseMeter(const PixelNoise& stated) : stated_(stated) {}

  /// Measures a picture, or leaves it out: every 16th is enough, and the first ones.
  void look(const ImageView& image);
  /// The stated noise, or more if pictures show more.
  PixelNoise noise() const {
    const double more = ratio_ > kNoticeableNoise ? ratio_ : 1;
    return {stated_.gain * more, stated_.read * std::sqrt(more)};
  }
  /// The stated noise is clearly too small.
  bool doubtsStated() const { return ratio_ > kWrongNoise; }

 private:
  /// Of the variance in a tile to the stated one; negative where a tile tells nothing.
  double ratioOf(const ImageView& image, int left, int top) const;

  PixelNoise stated_;
  int frames_ = 0;
  double ratio_ = 0;  ///< of the variance to the stated one; 0: nothing was measured
};

double NoiseMeter::ratioOf(const ImageView& image, int left, int top) const {
  int differences = 0, values = 0;
  for (int y = top; y < top + kHeight; ++y) {
    const std::uint8_t* p = image.row(y) + left;
    for (int x = 1; x + 1 < kWidth; ++x) {
      differences += std::abs(p[x - 1] - 2 * p[x] + p[x + 1]);
      values += p[x];
    }
  }
  constexpr double kCount = (kWidth - 2) * kHeight;
  const double mean = values / kCount, deviation = differences / kCount / kMeanDifference;
  if (mean < kDarkTile || mean > kBrightTile) return -1;
  return deviation * deviation / (stated_.gain * mean + stated_.read * stated_.read);
}

void NoiseMeter::look(const ImageView& image) {
  const bool now = frames_ < kFirstPictures || frames_ % kEveryPicture == 0;
  ++frames_;
  if (!now || image.width < kWidth || image.height < kHeight) return;
  std::array<double, kAcross * kDown> ratios{};
  int count = 0;
  for (int j = 0; j < kDown; ++j)
    for (int i = 0; i < kAcross; ++i) {
      const double ratio =
          ratioOf(image, (image.width - kWidth) * i / (kAcross - 1), (image.height - kHeight) * j / (kDown - 1));
      if (ratio >= 0) ratios[static_cast<std::size_t>(count++)] = ratio;
    }
  if (count == 0) return;
  const auto quarter = ratios.begin() + count / 4;
  std::nth_element(ratios.begin(), quarter, ratios.begin() + count);
  ratio_ = ratio_ == 0 ? *quarter : kNoiseMemory * ratio_ + (1 - kNoiseMemory) * *quarter;
}

struct Tracker::Impl {
  explicit Impl(const VisionConfig& rig) : config(rig), noise(rig.noise) {}

  VisionConfig config;
  NoiseMeter noise;
  std::optional<std::pair<double, std::uint64_t>> last;  // stamp and sequence
  std::vector<std::unique_ptr<MarkerTracker>> instruments;
  Measurements measurements;

  /// All markers are seen by one shutter.
  void shareRowTimes() {
    if (instruments.size() < 2) return;
    CalibrationDoubts::RowTime all;
    for (const auto& instrument : instruments) {
      const CalibrationDoubts::RowTime seen = instrument->doubts().rowTimeSeen();
      all.information += seen.information, all.sum += seen.sum;
    }
    for (const auto& instrument : instruments) {
      const CalibrationDoubts::RowTime own = instrument->doubts().rowTimeSeen();
      instrument->doubts().addRowTime({all.information - own.information, all.sum - own.sum});
    }
  }

  void measureNoise(const ImageView& image) {
    noise.look(image);
    for (const auto& instrument : instruments) instrument->setNoise(noise.noise());
  }

  const Measurement& look(MarkerTracker& instrument, const Frame& frame) const {
    if (isEmpty(frame)) return instrument.lose(LostReason::NoFrame);
    return fits(frame) ? instrument.track(frame) : instrument.lose(LostReason::WrongImage);
  }

  static bool isEmpty(const Frame& frame) { return frame.image.empty() || frame.image.data == nullptr; }

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
    const auto make = std::holds_alternative<TagDesign>(instrument.marker) ? makeTagTracker : makeInstrumentTracker;
    impl_->instruments.push_back(make(config, instrument, policy));
    impl_->measurements.push_back(impl_->instruments.back()->measurement());
  }
}

Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;

const Measurements& Tracker::track(const Frame& frame) {
  const bool none = Impl::isEmpty(frame);
  const std::pair<double, std::uint64_t> now(frame.stamp, frame.sequence);
  if (!none && impl_->last == now) return impl_->measurements;
  impl_->last = now;
  impl_->shareRowTimes();
  if (!none) impl_->measureNoise(frame.image);
  for (std::size_t i = 0; i < impl_->instruments.size(); ++i) {
    Measurement& m = impl_->measurements[i];
    m = impl_->look(*impl_->instruments[i], frame);
    m.ink = impl_->instruments[i]->ink();
    if (m.tracked() && m.doubt == Doubt::None && impl_->noise.doubtsStated()) m.doubt = Doubt::Noise;
  }
  return impl_->measurements;
}

void Tracker::reset() {
  impl_->last.reset();
  for (const auto& instrument : impl_->instruments) instrument->reset();
}

const VisionConfig& Tracker::config() const {
  return impl_->config;
}

}  // namespace vibe::vision
