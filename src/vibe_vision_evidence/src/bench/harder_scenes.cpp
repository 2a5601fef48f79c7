#include "bench/bench_scene.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace vibe::vision::evidence {
namespace {

/// On a square sensor, where the axes fit in every direction.
void turnAxes(SyntheticScene& scene, double angle) {
  enlarge(scene, std::max(scene.camera.width, scene.camera.height), std::max(scene.camera.width, scene.camera.height));
  const Eigen::Vector2d centre(0.5 * (scene.camera.width - 1), 0.5 * (scene.camera.height - 1));
  const Eigen::Rotation2Dd turn(angle);
  for (SyntheticInstrument& instrument : scene.instruments) {
    SlideAxis& axis = instrument.nominal.axis;
    axis.origin = centre + turn * Eigen::Vector2d(axis.origin - centre);
    axis.direction = turn * axis.direction;
  }
}

void setLight(SyntheticScene& scene, double black, double background, double white) {
  scene.black = black;
  scene.background = background;
  scene.white = white;
}

/// Against the stops: the motion is cut off where it would leave its middle part.
void stopAtEnds(SyntheticScene& scene) {
  for (SyntheticInstrument& instrument : scene.instruments) {
    const double lower = 0.5 * instrument.nominal.lower, upper = 0.5 * instrument.nominal.upper;
    const auto slide = instrument.motion.slide;
    instrument.motion.slide = [=](double time) { return std::clamp(slide(time), lower, upper); };
  }
}

/// The rod turns at this speed from another angle for each seed.
void spin(SyntheticScene& scene, double speed, std::uint64_t seed) {
  const double start = 2.4 * static_cast<double>(seed) + 0.9;
  for (SyntheticInstrument& instrument : scene.instruments)
    instrument.motion.rotation = [=](double time) { return start + speed * time; };
}

/// The same marker in full size, at rest beside the axis: only its place tells it from the instrument.
void addTwins(SyntheticScene& scene) {
  const std::size_t count = scene.instruments.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (scene.instruments[i].tag.cells > 0) continue;
    SyntheticInstrument twin = scene.instruments[i];
    twin.lateral = 2e-3 + (std::holds_alternative<SleeveDesign>(twin.nominal.marker) ? 3e-3 : 7e-3);
    const double place = twin.motion.slide(0);
    twin.motion.slide = [=](double) { return place; };
    scene.instruments.push_back(twin);
  }
}

/// The bars the other way round; a thinner ring.
MarkerDesign otherPattern(const MarkerDesign& design) {
  if (const RingDesign* ring = std::get_if<RingDesign>(&design)) {
    RingDesign other = *ring;
    other.inner_diameter = 0.8 * ring->outer_diameter;
    return other;
  }
  SleeveDesign other = std::get<SleeveDesign>(design);
  std::reverse(other.bars.begin(), other.bars.end());
  for (Bar& bar : other.bars) bar = {-bar.end, -bar.begin};
  std::swap(other.helix_begin, other.helix_end);
  other.helix_begin *= -1;
  other.helix_end *= -1;
  return other;
}

/// Another print of the same size at rest on each axis, behind the instruments.
void addDecoys(SyntheticScene& scene) {
  const std::size_t count = scene.instruments.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (scene.instruments[i].tag.cells > 0) continue;
    SyntheticInstrument decoy = scene.instruments[i];
    decoy.nominal.marker = otherPattern(decoy.nominal.marker);
    decoy.motion.slide = [](double) { return 0.012; };
    scene.instruments.push_back(decoy);
  }
}

/// The instruments are not there.
void takeAway(SyntheticScene& scene) {
  for (SyntheticInstrument& instrument : scene.instruments) instrument.lateral = 0.2;
}

/// Half the length of the printed picture along the axis [px].
double halfLength(const InstrumentConfig& instrument) {
  const double scale = instrument.axis.pixels_per_metre / 2;
  if (const RingDesign* ring = std::get_if<RingDesign>(&instrument.marker)) return scale * ring->outer_diameter;
  if (const TagDesign* tag = std::get_if<TagDesign>(&instrument.marker)) return scale * tag->side;
  return scale * std::get<SleeveDesign>(instrument.marker).length;
}

/// A grey bar across the whole image, 2.5 mm wide, that stays at 3 mm beyond slide 0.
void parkBar(const SyntheticScene& scene, RenderedFrame& frame) {
  constexpr double kPlace = 30, kHalfWidth = 12.5;
  std::uint8_t* pixels = ownPixels(frame.frame);
  const double middle = scene.instruments.front().nominal.axis.origin.x() + kPlace;
  const int begin = static_cast<int>(std::ceil(middle - kHalfWidth)), end = static_cast<int>(middle + kHalfWidth);
  for (int y = 0; y < frame.frame.image.height; ++y)
    for (int x = begin; x <= end; ++x)
      pixels[y * frame.frame.image.stride + x] = static_cast<std::uint8_t>(60 + (7 * x + 13 * y) % 9);
  for (std::size_t i = 0; i < frame.truth.size(); ++i) {
    const InstrumentConfig& instrument = scene.instruments[i].nominal;
    const double half = halfLength(instrument);
    const double place = instrument.axis.origin.x() + frame.truth[i].along;
    const double covered = std::min(place + half, middle + kHalfWidth) - std::max(place - half, middle - kHalfWidth);
    frame.truth[i].visible *= 1 - std::clamp(covered / (2 * half), 0.0, 1.0);
  }
}

/// Ten frames of darkness, ten of glare, again and again, with twenty good ones before each.
void spoilFrames(const SyntheticScene&, RenderedFrame& frame) {
  const auto phase = frame.frame.sequence % 60;
  if (phase < 20 || (phase >= 30 && phase < 50)) return;
  std::uint8_t* pixels = ownPixels(frame.frame);
  const std::size_t count =
      static_cast<std::size_t>(frame.frame.image.stride) * static_cast<std::size_t>(frame.frame.image.height);
  std::fill(pixels, pixels + count, static_cast<std::uint8_t>(phase < 30 ? 1 : 255));
  for (SyntheticTruth& truth : frame.truth) truth.visible = 0;
}

/// As a rolling shutter shows it, 10 us per row, whose stamp is that of the row of each marker.
void shearRows(const SyntheticScene&, RenderedFrame& frame) {
  constexpr double kRowTime = 1e-5;  // [s]
  const Frame still = frame.frame;
  std::uint8_t* pixels = ownPixels(frame.frame);
  const int width = still.image.width;
  for (std::size_t i = 0; i < frame.truth.size(); ++i) {
    const int middle = static_cast<int>(frame.truth[i].pixel.y());
    for (int y = std::max(0, middle - 60); y < std::min(still.image.height, middle + 60); ++y)
      for (int x = 0; x < width; ++x) {
        const double from = std::clamp(x - frame.truth[i].velocity * (y - middle) * kRowTime, 0.0, width - 1.001);
        const auto left = static_cast<int>(from);
        const double right = from - left;
        const std::uint8_t* row = still.image.row(y);
        pixels[y * width + x] = static_cast<std::uint8_t>(std::lround((1 - right) * row[left] + right * row[left + 1]));
      }
  }
}

/// A camera that sends a part of its sensor.
void cutOut(const SyntheticScene&, RenderedFrame& frame) {
  constexpr int kLeft = 17, kTop = 5;
  ImageView& view = frame.frame.image;
  view = {view.row(kTop) + kLeft, view.width - 2 * kLeft, view.height - 2 * kTop, view.stride};
  frame.frame.offset_x = kLeft;
  frame.frame.offset_y = kTop;
}

}  // namespace

std::uint8_t* ownPixels(Frame& frame) {
  const ImageView old = frame.image;
  const auto pixels = std::make_shared<std::vector<std::uint8_t>>();
  for (int y = 0; y < old.height; ++y) pixels->insert(pixels->end(), old.row(y), old.row(y) + old.width);
  frame.image = {pixels->data(), old.width, old.height, old.width};
  frame.owner = pixels;
  return pixels->data();
}

const std::vector<HarderScene>& harderScenes() {
  using Scene = SyntheticScene;
  using Seed = std::uint64_t;
  const auto turned = [](double degrees) { return [=](Scene& s, Seed) { turnAxes(s, degrees * M_PI / 180); }; };
  static const std::vector<HarderScene> scenes = {
      {"vertical", "moving", turned(90), {}},
      {"oblique", "moving", turned(30), {}},
      {"reversed", "moving", turned(180), {}},
      {"oblique_all", "all", turned(-20), {}},
      {"dark", "moving", [](Scene& s, Seed) { setLight(s, 12, 30, 55); }, {}},
      {"bright", "moving", [](Scene& s, Seed) { setLight(s, 40, 140, 250); }, {}},
      {"stops", "moving", [](Scene& s, Seed) { stopAtEnds(s); }, {}},
      {"spin", "moving", [](Scene& s, Seed seed) { spin(s, 25, seed); }, {}},
      {"turned_rod", "static", [](Scene& s, Seed seed) { spin(s, 0, seed); }, {}},
      {"60_hz", "moving", [](Scene& s, Seed) { s.rate = 60; }, {}},
      {"twins", "moving", [](Scene& s, Seed) { addTwins(s); }, {}},
      {"sideways",
       "moving",
       [](Scene& s, Seed) {
         for (SyntheticInstrument& i : s.instruments) i.lateral = 3e-4;
       },
       {}},
      {"sharp", "moving", [](Scene& s, Seed) { s.degradation.blur = 0.4; }, {}},
      {"decoys", "moving", [](Scene& s, Seed) { addDecoys(s); }, {}},
      {"only_decoys",
       "moving",
       [](Scene& s, Seed) {
         takeAway(s);
         addDecoys(s);
         for (std::size_t i = 4; i < s.instruments.size(); ++i) s.instruments[i].lateral = 0;
       },
       {}},
      {"absent", "moving", [](Scene& s, Seed) { takeAway(s); }, {}},
      {"spoilt_frames", "moving", [](Scene&, Seed) {}, spoilFrames},
      {"parked_bar", "moving", [](Scene&, Seed) {}, parkBar},
      {"cut_out", "moving", [](Scene&, Seed) {}, cutOut},
      {"rolling", "moving", [](Scene&, Seed) {}, shearRows},
  };
  return scenes;
}

const HarderScene* findHarderScene(const std::string& name) {
  for (const auto* scenes : {&harderScenes(), &faultyScenes()})
    for (const HarderScene& scene : *scenes)
      if (scene.name == name) return &scene;
  return nullptr;
}

}  // namespace vibe::vision::evidence
