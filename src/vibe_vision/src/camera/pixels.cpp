#include "camera/pixels.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "vibe_core/files/number_text.hpp"

namespace vibe::vision {

namespace {

struct Format {
  PixelFormat code;
  const char* name;
  int bits;  // per pixel
  void (*convert)(const Format& format, const std::uint8_t* data, const cv::Size& size, std::uint8_t* grey);
  int detail;  // significant bits, or OpenCV's conversion
};

void bytes(const Format&, const std::uint8_t* data, const cv::Size& size, std::uint8_t* grey) {
  std::copy_n(data, size.area(), grey);
}

void words(const Format& format, const std::uint8_t* data, const cv::Size& size, std::uint8_t* grey) {
  for (int i = 0; i < size.area(); ++i) {
    const unsigned value = data[2 * i] | static_cast<unsigned>(data[2 * i + 1]) << 8;
    grey[i] = static_cast<std::uint8_t>(value >> (format.detail - 8));
  }
}

void packed(const Format&, const std::uint8_t* data, const cv::Size& size, std::uint8_t* grey) {
  for (int i = 0; i < size.area(); ++i) grey[i] = data[3 * (i / 2) + (i % 2 == 0 ? 0 : 2)];
}

void stream(const Format& format, const std::uint8_t* data, const cv::Size& size, std::uint8_t* grey) {
  for (int i = 0; i < size.area(); ++i) {
    const std::size_t bit = static_cast<std::size_t>(i) * static_cast<std::size_t>(format.detail) +
                            static_cast<std::size_t>(format.detail - 8);
    const unsigned low = data[bit / 8], shift = static_cast<unsigned>(bit % 8);
    const unsigned high = shift == 0 ? 0 : data[bit / 8 + 1];  // a pixel ends with its byte if shift is 0
    grey[i] = static_cast<std::uint8_t>((low | high << 8) >> shift);
  }
}

void colour(const Format& format, const std::uint8_t* data, const cv::Size& size, std::uint8_t* grey) {
  const cv::Mat from(size, CV_MAKETYPE(CV_8U, format.bits / 8), const_cast<std::uint8_t*>(data));
  cv::Mat to(size, CV_8U, grey);
  cv::cvtColor(from, to, format.detail);
}

constexpr std::array<Format, 16> kFormats{{
    {PixelFormat::Mono8, "Mono8", 8, bytes, 8},
    {PixelFormat::Mono10, "Mono10", 16, words, 10},
    {PixelFormat::Mono12, "Mono12", 16, words, 12},
    {PixelFormat::Mono16, "Mono16", 16, words, 16},
    {PixelFormat::Mono10Packed, "Mono10Packed", 12, packed, 10},
    {PixelFormat::Mono12Packed, "Mono12Packed", 12, packed, 12},
    {PixelFormat::Mono10p, "Mono10p", 10, stream, 10},
    {PixelFormat::Mono12p, "Mono12p", 12, stream, 12},
    {PixelFormat::BayerGR8, "BayerGR8", 8, colour, cv::COLOR_BayerGRBG2GRAY},
    {PixelFormat::BayerRG8, "BayerRG8", 8, colour, cv::COLOR_BayerRGGB2GRAY},
    {PixelFormat::BayerGB8, "BayerGB8", 8, colour, cv::COLOR_BayerGBRG2GRAY},
    {PixelFormat::BayerBG8, "BayerBG8", 8, colour, cv::COLOR_BayerBGGR2GRAY},
    {PixelFormat::RGB8, "RGB8", 24, colour, cv::COLOR_RGB2GRAY},
    {PixelFormat::BGR8, "BGR8", 24, colour, cv::COLOR_BGR2GRAY},
    {PixelFormat::YUYV, "YUV422_8", 16, colour, cv::COLOR_YUV2GRAY_YUYV},
    {PixelFormat::UYVY, "YUV422_8_UYVY", 16, colour, cv::COLOR_YUV2GRAY_UYVY},
}};

const Format* find(PixelFormat code) {
  for (const Format& format : kFormats) {
    if (format.code == code) return &format;
  }
  return nullptr;
}

}  // namespace

bool isReadable(PixelFormat format) {
  return find(format) != nullptr;
}

std::string nameOf(PixelFormat format) {
  if (const Format* known = find(format)) return known->name;
  return formatted("0x%08X", static_cast<unsigned>(format));
}

std::string readableFormats() {
  std::string names;
  for (const Format& format : kFormats) names += (names.empty() ? "" : ", ") + std::string(format.name);
  return names;
}

std::size_t sizeOf(PixelFormat format, int width, int height) {
  const Format* known = find(format);
  if (!known || width <= 0 || height <= 0) return 0;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  return (pixels * static_cast<std::size_t>(known->bits) + 7) / 8;
}

void toMono8(PixelFormat format, const std::uint8_t* data, int width, int height, std::uint8_t* grey) {
  const Format* known = find(format);
  if (!known || sizeOf(format, width, height) == 0) return;
  known->convert(*known, data, {width, height}, grey);
}

std::uint8_t* PixelPool::give(Frame& frame, int width, int height) {
  auto pixels = std::make_shared<std::vector<std::uint8_t>>();
  {
    const std::lock_guard<std::mutex> lock(store_->mutex);
    if (!store_->spare.empty()) {
      *pixels = std::move(store_->spare.back());
      store_->spare.pop_back();
    }
  }
  pixels->resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  frame.image = {pixels->data(), width, height, width};
  const std::weak_ptr<Store> weak = store_;
  frame.owner = std::shared_ptr<const void>(pixels->data(), [pixels, weak](const void*) {
    const std::shared_ptr<Store> store = weak.lock();
    if (!store) return;
    const std::lock_guard<std::mutex> lock(store->mutex);
    if (store->spare.size() < kSpare) store->spare.push_back(std::move(*pixels));
  });
  return pixels->data();
}

}  // namespace vibe::vision
