#include "startup.hpp"

// An image that asks for memory. It must not link; a test checks that.

extern "C" void tick() {}

extern "C" void run() {
  volatile int* number = new int(1);
  *number = 2;
}
