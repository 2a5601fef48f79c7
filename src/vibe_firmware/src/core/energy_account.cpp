#include "vibe_firmware/core/energy_account.hpp"

namespace vibe_firmware {

void EnergyAccount::add(float energy, float capacity) {
  const float term = energy + error;
  const float sum = balance + term;
  const float part = sum - balance;
  error = (balance - (sum - part)) + (term - part);
  balance = sum;
  if (balance < capacity) return;
  balance = capacity;
  error = 0;
}

}  // namespace vibe_firmware
