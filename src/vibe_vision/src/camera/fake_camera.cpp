#include "vibe_vision/camera/fake_camera.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <mutex>
#include <utility>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include "camera/aravis_camera.hpp"
#include "camera/host_time.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_vision/synthetic/renderer.hpp"

namespace vibe::vision {

namespace {

constexpr int kMaxFrames = 5000;
constexpr int kSearched = 3000;  // frames from the beginning of the scene, of which one is the first
constexpr double kSpeedScale = 0.5, kAngularScale = 30;  // of the standard scene [m/s], [rad/s]

/// How fast anything moves at a frame, relative to the speeds of the standard scene.
double restlessness(const SyntheticScene& scene, int frame) {
  const double h = 1e-4, t = frame / scene.rate;
  double most = 0;
  for (const SyntheticInstrument& instrument : scene.instruments) {
    const SyntheticMotion& motion = instrument.motion;
    most = std::max(most, std::abs(motion.slide(t + h) - motion.slide(t - h)) / (2 * h * kSpeedScale));
    most = std::max(most, std::abs(motion.rotation(t + h) - motion.rotation(t - h)) / (2 * h * kAngularScale));
  }
  return most;
}

/// First and last frame, at least half as many as are allowed.
std::pair<int, int> calmEnds(const SyntheticScene& scene, int frames) {
  std::vector<double> cost;
  for (int k = 0; k < kSearched + frames; ++k) cost.push_back(restlessness(scene, k));
  std::pair<int, int> best{0, frames - 1};
  double least = 1e9;
  for (int a = 0; a < kSearched; ++a) {
    if (cost[static_cast<std::size_t>(a)] >= least) continue;
    for (int b = a + frames / 2; b < a + frames; ++b) {
      const double worst = std::max(cost[static_cast<std::size_t>(a)], cost[static_cast<std::size_t>(b)]);
      if (worst >= least) continue;
      least = worst;
      best = {a, b};
    }
  }
  return best;
}

constexpr std::uint16_t kControlPort = 3956;  // GVCP
constexpr guint32 kFirstFrame = 65401;        // of Aravis' simulated camera

/// Aravis' simulated camera runs without a control port if it cannot have it, and nobody would notice.
void requireFree(const std::string& address) {
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_port = htons(kControlPort);
  const bool is_address = ::inet_pton(AF_INET, address.c_str(), &where.sin_addr) == 1;
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool is_free =
      is_address && socket >= 0 && ::bind(socket, reinterpret_cast<const sockaddr*>(&where), sizeof where) == 0;
  const int error = errno;
  if (socket >= 0) ::close(socket);
  if (is_free) return;
  if (is_address && error == EADDRINUSE) {
    throw Error("fake camera: the control port of " + address +
                " is in use, perhaps by another fake camera; stop that, or choose another address.");
  }
  const std::string why = is_address && error != EADDRNOTAVAIL
                              ? std::string(" cannot be used (") + std::strerror(error) + ")"
                              : " is no IPv4 address of this computer";
  throw Error("fake camera: " + address + why + "; choose one of ip address, such as 127.0.0.1.");
}

}  // namespace

FrameRing::Turn FrameRing::turnOf(std::uint64_t k) const {
  const std::size_t count = frames.size();
  if (count < 2) return {};
  const std::size_t i = k % (2 * count - 2);
  return i < count ? Turn{i, false} : Turn{2 * count - 2 - i, true};
}

std::shared_ptr<const FrameRing> renderRing(const SyntheticScene& scene, int frames) {
  if (frames < 1 || frames > kMaxFrames) {
    throw Error("fake camera: " + std::to_string(frames) + " frames; draw 1 to " + std::to_string(kMaxFrames) + ".");
  }
  auto ring = std::make_shared<FrameRing>();
  ring->width = scene.camera.width;
  ring->height = scene.camera.height;
  ring->rate = scene.rate;
  ring->exposure = scene.degradation.exposure;
  for (const SyntheticInstrument& instrument : scene.instruments) ring->instruments.push_back(instrument.nominal.name);
  const Renderer renderer(scene);
  const auto [first, last] = calmEnds(scene, frames);
  for (int k = first; k <= last; ++k) {
    const RenderedFrame drawn = renderer.render(static_cast<std::uint64_t>(k));
    const ImageView& view = drawn.frame.image;
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < view.height; ++y) pixels.insert(pixels.end(), view.row(y), view.row(y) + view.width);
    ring->frames.push_back(std::move(pixels));
    ring->truth.push_back(drawn.truth);
  }
  return ring;
}

struct FakeCamera::Impl {
  std::shared_ptr<const FrameRing> ring;
  FakeCameraOptions options;
  std::ofstream truth, blink_table;  // not whole: logs
  std::size_t blinked = 0;           // blinks that have been shown
  std::atomic<std::uint64_t> sent{0};
  std::mutex mutex;  // of the clock
  double clock_start = 0, clock_at_start = 0;
  AravisPointer<ArvGvFakeCamera> server;  // last: its thread ends before the rest goes
  ArvFakeCamera* camera = nullptr;

  Impl(std::shared_ptr<const FrameRing> r, const FakeCameraOptions& o) : ring(std::move(r)), options(o) {
    if (ring->frames.empty()) throw Error("fake camera: has no pictures to show.");
    requireFree(options.address);
    if (!options.blinks.empty() && ring->frames.size() < 2) throw Error("fake camera: a blink needs two pictures.");
    if (!options.truth_file.empty()) openTruth();
    if (!options.blink_file.empty()) openBlinks();
    clock_start = hostTime();
    clock_at_start = clock_start + options.clock_ahead;
    server.reset(arv_gv_fake_camera_new(options.address.c_str(), options.serial.c_str()));
    if (!arv_gv_fake_camera_is_running(server.get())) {
      throw Error("fake camera: no network interface has the address " + options.address + ".");
    }
    g_object_set(server.get(), "gvsp-lost-ratio", options.lost_ratio, nullptr);
    camera = arv_gv_fake_camera_get_fake_camera(server.get());
    arv_fake_camera_write_register(camera, ARV_FAKE_CAMERA_REGISTER_SENSOR_WIDTH, static_cast<guint32>(ring->width));
    arv_fake_camera_write_register(camera, ARV_FAKE_CAMERA_REGISTER_SENSOR_HEIGHT, static_cast<guint32>(ring->height));
    arv_fake_camera_write_register(camera, ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US,
                                   static_cast<guint32>(1e6 / ring->rate));
    arv_fake_camera_set_fill_pattern(camera, &Impl::onFill, this);
  }

  ~Impl() {
    if (camera) arv_fake_camera_set_fill_pattern(camera, nullptr, nullptr);
  }

  void openTruth() {
    truth.open(options.truth_file);
    if (!truth) throw Error(options.truth_file + ": cannot be written; check the folder and its permissions.");
    truth << kTruthColumns << std::setprecision(17);
  }

  void openBlinks() {
    blink_table.open(options.blink_file);
    blink_table << "blink,event,report" << std::endl;
    if (!blink_table) throw Error(options.blink_file + ": cannot be written; check the folder and its permissions.");
  }

  /// The picture at the middle of an exposure.
  FrameRing::Turn blinkAt(double middle) {
    for (; blinked < options.blinks.size() && options.blinks[blinked] <= middle; ++blinked) {
      if (!blink_table.is_open()) continue;
      blink_table << blinked << ',' << std::llround(1e9 * options.blinks[blinked]) << ',' << std::llround(1e9 * middle)
                  << std::endl;
    }
    FrameRing::Turn turn;
    turn.index = blinked % 2;
    return turn;
  }

  guint32 value(guint64 address) const {
    guint32 content = 0;
    arv_fake_camera_read_register(camera, static_cast<guint32>(address), &content);
    return content;
  }

  double deviceTime(double host) {
    const std::lock_guard<std::mutex> lock(mutex);
    return clock_at_start + (host - clock_start) * (1 + options.clock_drift);
  }

  static void onFill(ArvBuffer* buffer, void* self, guint32 exposure_us, guint32, ArvPixelFormat) {
    static_cast<Impl*>(self)->fill(buffer, exposure_us * 1e-6);
  }

  void fill(ArvBuffer* buffer, double exposure) {
    const std::uint64_t period = std::max<guint32>(value(ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US), 1);
    const std::uint64_t k = static_cast<std::uint64_t>(hostTime() * 1e6) / period;
    const double end = static_cast<double>(k * period) * 1e-6;
    const double start = deviceTime(end) - exposure * (1 + options.clock_drift);
    arv_buffer_set_timestamp(buffer, static_cast<guint64>(std::max(0.0, start) * 1e9));
    const FrameRing::Turn turn = options.blinks.empty() ? ring->turnOf(k) : blinkAt(end - exposure / 2);
    copy(ring->frames[turn.index], buffer);
    if (truth.is_open()) write(end - exposure / 2, turn, 1e6 / static_cast<double>(period));
    ++sent;
  }

  void copy(const std::vector<std::uint8_t>& picture, ArvBuffer* buffer) const {
    const auto width = static_cast<std::size_t>(arv_buffer_get_image_width(buffer));
    const auto height = static_cast<std::size_t>(arv_buffer_get_image_height(buffer));
    auto* to = static_cast<std::uint8_t*>(const_cast<void*>(arv_buffer_get_data(buffer, nullptr)));
    const std::size_t x = value(ARV_FAKE_CAMERA_REGISTER_X_OFFSET), y = value(ARV_FAKE_CAMERA_REGISTER_Y_OFFSET);
    const auto sensor_width = static_cast<std::size_t>(ring->width),
               sensor_height = static_cast<std::size_t>(ring->height);
    for (std::size_t row = 0; row < height; ++row) {
      const std::size_t count = x < sensor_width && y + row < sensor_height ? std::min(width, sensor_width - x) : 0;
      if (count > 0) std::memcpy(to + row * width, &picture[(y + row) * sensor_width + x], count);
      std::memset(to + row * width + count, 0, width - count);
    }
  }

  /// @param rate  at which the pictures are shown: the scene moves more slowly if it was drawn for a higher one
  void write(double stamp, const FrameRing::Turn& turn, double rate) {
    const double pace = (turn.is_backward ? -1 : 1) * rate / ring->rate;
    for (std::size_t i = 0; i < ring->instruments.size(); ++i) {
      SyntheticTruth shown = ring->truth[turn.index][i];
      shown.velocity *= pace;
      writeTruth(truth, kFirstFrame + sent, stamp, ring->instruments[i], shown);
    }
    truth.flush();  // complete whenever somebody looks
  }
};

FakeCamera::FakeCamera(std::shared_ptr<const FrameRing> ring, const FakeCameraOptions& options)
    : impl_(std::make_unique<Impl>(std::move(ring), options)) {}

FakeCamera::~FakeCamera() = default;

std::uint64_t FakeCamera::sent() const {
  return impl_->sent;
}

void FakeCamera::resetClock() {
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  impl_->clock_start = hostTime();
  impl_->clock_at_start = 0;
}

void FakeCamera::announceFormat(std::uint32_t code) {
  arv_fake_camera_write_register(impl_->camera, ARV_FAKE_CAMERA_REGISTER_PIXEL_FORMAT, code);
}

}  // namespace vibe::vision
