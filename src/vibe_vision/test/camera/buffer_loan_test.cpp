#include "camera/aravis_camera.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "camera/fake_rig.hpp"
#include "camera/own_network.hpp"

namespace vibe::vision::buffer_loan_test {

namespace {

const bool kHasOwnNetwork = enterOwnNetwork();  // before any thread starts

ArvBuffer* nextBuffer(AravisCamera& camera) {
  const double deadline = steadyTime() + kForever;
  ArvBuffer* buffer = nullptr;
  while (!buffer && steadyTime() < deadline) buffer = camera.pop(0.1);
  return buffer;
}

}  // namespace

TEST(BufferLoan, LendsSomeAndTakesThemBack) {
  const auto server = plugIn();
  AravisCamera camera("127.0.0.1", {});
  for (int round = 0; round < 3; ++round) {
    std::vector<std::shared_ptr<const void>> lent;
    for (int i = 0; i < BufferLoan::kMost; ++i) {
      ArvBuffer* buffer = nextBuffer(camera);
      ASSERT_NE(buffer, nullptr);
      lent.push_back(camera.loan().lend(buffer));
      ASSERT_NE(lent.back(), nullptr) << i;
    }
    ArvBuffer* buffer = nextBuffer(camera);
    ASSERT_NE(buffer, nullptr) << "the stream has buffers left";
    EXPECT_EQ(camera.loan().lend(buffer), nullptr);
    camera.giveBack(buffer);
  }
}

}  // namespace vibe::vision::buffer_loan_test
