#include "vibe_firmware/core/passivity.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vibe_firmware::energy_account_test {
namespace {

TEST(EnergyAccount, AMillionSmallAmountsAreNotLost) {
  EnergyAccount account;
  account.balance = 0.05F;
  float plain = account.balance;
  double exact = account.balance;
  for (int i = 0; i < 1000000; ++i) {
    const float energy = -1.7e-8F * (1 + std::sin(static_cast<float>(i)));
    account.add(energy, 1);
    plain += energy;
    exact += static_cast<double>(energy);
  }
  EXPECT_NEAR(account.balance, exact, 5e-9);
  EXPECT_GT(std::fabs(static_cast<double>(plain) - exact), 1e-6) << "control: a plain sum loses them";
}

TEST(EnergyAccount, NeverHoldsMoreThanItsCapacity) {
  EnergyAccount account;
  account.add(3, 2);
  EXPECT_EQ(account.balance, 2);
  account.add(-0.5F, 2);
  EXPECT_EQ(account.balance, 1.5F);
}

}  // namespace
}  // namespace vibe_firmware::energy_account_test
