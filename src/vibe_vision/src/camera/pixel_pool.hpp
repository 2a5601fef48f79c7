#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace vibe::vision {

/// Memory of pixels that is used again as soon as nobody holds it: frames of constant size allocate nothing.
class PixelPool {
 public:
  /// @return memory that returns to the pool with its last owner, who may outlive the pool
  std::shared_ptr<std::uint8_t> acquire(std::size_t size);

 private:
  static constexpr std::size_t kSpare = 8;
  struct Store {
    std::mutex mutex;
    std::vector<std::vector<std::uint8_t>> spare;
  };
  std::shared_ptr<Store> store_ = std::make_shared<Store>();
};

}  // namespace vibe::vision
