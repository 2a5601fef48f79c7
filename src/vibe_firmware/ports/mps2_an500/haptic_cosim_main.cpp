#include <cstring>

#include "cosim_target.hpp"
#include "semihosting.hpp"
#include "startup.hpp"
#include "tick_timer.hpp"
#include "vibe_firmware/hal/application.hpp"
#include "vibe_firmware/protocol/haptic_function.hpp"

// The haptic device in lock-step with a plant. The command line of the image names two FIFOs: replies go to the first,
// requests come from the second. Opened in this order; the other side has to do the same.

using namespace vibe_firmware;

namespace {

HapticFunction device(HapticConfig{});
CosimTarget target(device.state());
Application application(target, target, device);
int replies = -1;
int requests = -1;
volatile bool tick_has_run = false;

// Splits "IMAGE REPLIES REQUESTS" and opens both. (strtok() of newlib needs a heap.)
bool openFifos() {
  static char line[512];
  if (!semihosting::commandLine(line, sizeof line)) return false;
  char* const to_plant = std::strchr(line, ' ');
  char* const from_plant = to_plant != nullptr ? std::strchr(to_plant + 1, ' ') : nullptr;
  if (from_plant == nullptr) return false;
  *from_plant = 0;
  replies = semihosting::open(to_plant + 1, semihosting::Mode::Write);
  requests = semihosting::open(from_plant + 1, semihosting::Mode::Read);
  return replies >= 0 && requests >= 0;
}

}  // namespace

extern "C" void tick() {
  const std::uint32_t entry_counts = mps2::counts();
  CosimRequest request;
  if (!semihosting::read(requests, &request, sizeof request)) semihosting::exit(51);
  if (request.stop != 0) semihosting::exit(0);
  target.begin(request);
  application.tick();
  CosimReply reply = target.end();
  reply.entry_counts = entry_counts;
  if (!semihosting::write(replies, &reply, sizeof reply)) semihosting::exit(50);
  tick_has_run = true;
}

extern "C" void run() {
  if (!openFifos()) semihosting::exit(40);
  mps2::startTicks();
  // No WFI: QEMU 7.2 with -icount sleep=off then loses every second tick. One poll after each tick, as on the host.
  for (;;) {
    while (!tick_has_run) {
    }
    tick_has_run = false;
    application.poll();
  }
}
