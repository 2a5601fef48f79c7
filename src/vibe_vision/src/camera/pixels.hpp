#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "vibe_vision/image/frame.hpp"

namespace vibe::vision {

/// Layouts of pixels that can be turned into 8-bit grey. Values: EMVA Pixel Format Naming Convention 2.3.
enum class PixelFormat : std::uint32_t {
  Mono8 = 0x01080001,
  Mono10 = 0x01100003,  ///< little-endian 16-bit words, also Mono12 and Mono16
  Mono12 = 0x01100005,
  Mono16 = 0x01100007,
  Mono10Packed = 0x010C0004,  ///< GigE Vision: 2 pixels in 3 bytes, the upper 8 bits of each in a byte of its own
  Mono12Packed = 0x010C0006,
  Mono10p = 0x010A0046,  ///< USB3 Vision: bits in a row, least significant first
  Mono12p = 0x010C0047,
  BayerGR8 = 0x01080008,
  BayerRG8 = 0x01080009,
  BayerGB8 = 0x0108000A,
  BayerBG8 = 0x0108000B,
  RGB8 = 0x02180014,
  BGR8 = 0x02180015,
  YUYV = 0x02100032,  ///< YUV422_8
  UYVY = 0x0210001F,  ///< YUV422_8_UYVY
};

bool isReadable(PixelFormat format);
/// As in the convention, or the number in hexadecimal.
std::string nameOf(PixelFormat format);
/// All that are readable, for messages.
std::string readableFormats();
/// Bytes of an image; rows are not padded. 0 if the format is not readable or a size is not positive.
std::size_t sizeOf(PixelFormat format, int width, int height);

/// Writes width * height grey values. Of more than 8 bits, the upper 8 are kept; colours become 0.299 R + 0.587 G +
/// 0.114 B, Bayer patterns by bilinear interpolation, which moves no edge.
/// @param data  sizeOf() bytes of a readable format
void toMono8(PixelFormat format, const std::uint8_t* data, int width, int height, std::uint8_t* grey);

/// Memory of pixels that is used again as soon as nobody holds it: frames of constant size allocate nothing.
class PixelPool {
 public:
  /// Gives a frame pixels of its own, whose memory returns to the pool with their last owner, who may outlive the pool.
  /// @return where they are to be written
  std::uint8_t* give(Frame& frame, int width, int height);

 private:
  static constexpr std::size_t kSpare = 8;
  struct Store {
    std::mutex mutex;
    std::vector<std::vector<std::uint8_t>> spare;
  };
  std::shared_ptr<Store> store_ = std::make_shared<Store>();
};

}  // namespace vibe::vision
