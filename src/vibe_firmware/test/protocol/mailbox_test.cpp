#include "vibe_firmware/protocol/mailbox.hpp"

#include <gtest/gtest.h>

namespace vibe_firmware::mailbox_test {
namespace {

/// A value that is interrupted in the middle of being copied, as by a control interrupt.
struct Interrupted {
  int first = 0, second = 0;
  static inline void (*interrupt)() = nullptr;

  Interrupted() = default;
  Interrupted(int a, int b) : first(a), second(b) {}
  Interrupted& operator=(const Interrupted& other) {
    first = other.first;
    if (interrupt != nullptr) interrupt();
    second = other.second;
    return *this;
  }
};

Mailbox<Interrupted> g_mailbox;
Published<Interrupted> g_published;
int g_taken = 0;

TEST(Mailbox, GivesEachValueOnce) {
  Mailbox<int> mailbox;
  int value = 0;
  EXPECT_FALSE(mailbox.take(value));
  mailbox.put(3);
  mailbox.put(4);
  EXPECT_TRUE(mailbox.take(value));
  EXPECT_EQ(value, 4);
  EXPECT_FALSE(mailbox.take(value));
}

TEST(Mailbox, InterruptInTheMiddleOfPutSeesNothing) {
  g_mailbox.put({1, 1});
  Interrupted::interrupt = [] {
    Interrupted::interrupt = nullptr;
    Interrupted value;
    if (g_mailbox.take(value)) ++g_taken;
  };
  g_mailbox.put({2, 2});
  EXPECT_EQ(g_taken, 0);
  Interrupted value;
  EXPECT_TRUE(g_mailbox.take(value));
  EXPECT_EQ(value.first, 2);
  EXPECT_EQ(value.second, 2);
}

TEST(Published, ReadsAgainWhenTheInterruptComesInBetween) {
  g_published.publish({1, 1});
  Interrupted::interrupt = [] {
    Interrupted::interrupt = nullptr;
    g_published.publish({2, 2});
  };
  Interrupted value;
  EXPECT_EQ(g_published.read(value), 2U);
  EXPECT_EQ(value.first, 2);
  EXPECT_EQ(value.second, 2);
}

}  // namespace
}  // namespace vibe_firmware::mailbox_test
