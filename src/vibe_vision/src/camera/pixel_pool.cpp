#include "camera/pixel_pool.hpp"

#include <utility>

namespace vibe::vision {

std::shared_ptr<std::uint8_t> PixelPool::acquire(std::size_t size) {
  auto pixels = std::make_shared<std::vector<std::uint8_t>>();
  {
    const std::lock_guard<std::mutex> lock(store_->mutex);
    if (!store_->spare.empty()) {
      *pixels = std::move(store_->spare.back());
      store_->spare.pop_back();
    }
  }
  pixels->resize(size);
  const std::weak_ptr<Store> weak = store_;
  return {pixels->data(), [pixels, weak](std::uint8_t*) {
            const std::shared_ptr<Store> store = weak.lock();
            if (!store) return;
            const std::lock_guard<std::mutex> lock(store->mutex);
            if (store->spare.size() < kSpare) store->spare.push_back(std::move(*pixels));
          }};
}

}  // namespace vibe::vision
