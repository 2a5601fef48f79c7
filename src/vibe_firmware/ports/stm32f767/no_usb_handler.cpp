#include "startup.hpp"

// The USB interrupt of an image without USB is never enabled.
extern "C" void usbHandler() {
  faultHandler();
}
