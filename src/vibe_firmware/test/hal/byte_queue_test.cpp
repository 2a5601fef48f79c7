#include "vibe_firmware/hal/byte_queue.hpp"

#include <gtest/gtest.h>

#include <string>

namespace vibe_firmware::byte_queue_test {
namespace {

template <std::size_t kCapacity>
std::string takeAll(ByteQueue<kCapacity>& queue) {
  std::string text;
  while (!queue.empty()) text += static_cast<char>(queue.take());
  return text;
}

TEST(ByteQueue, GivesBytesInTheirOrder) {
  ByteQueue<16> queue;
  EXPECT_TRUE(queue.empty());
  EXPECT_TRUE(queue.put("abc", 3));
  EXPECT_TRUE(queue.put("de", 2));
  EXPECT_EQ(takeAll(queue), "abcde");
}

TEST(ByteQueue, TakesAllOrNothing) {
  ByteQueue<4> queue;
  EXPECT_TRUE(queue.put("abc", 3));
  EXPECT_FALSE(queue.put("de", 2));
  EXPECT_TRUE(queue.put("d", 1));
  EXPECT_FALSE(queue.put("e", 1));
  EXPECT_TRUE(queue.put("", 0));
  EXPECT_EQ(takeAll(queue), "abcd");
}

TEST(ByteQueue, WrapsAround) {
  ByteQueue<5> queue;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(queue.put("xyz", 3)) << i;
    ASSERT_EQ(takeAll(queue), "xyz") << i;
  }
}

}  // namespace
}  // namespace vibe_firmware::byte_queue_test
