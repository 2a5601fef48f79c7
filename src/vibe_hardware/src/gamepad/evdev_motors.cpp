#include "gamepad/evdev_motors.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include "gamepad/force_effects.hpp"

namespace vibe::hardware {

EvdevMotors::~EvdevMotors() {
  erase(rumble_id_);
  erase(spring_id_);
}

bool EvdevMotors::rumble(double strong, double weak) {
  return has_rumble_ && play(rumbleEffect(strong, weak, rumble_id_), rumble_id_);
}

bool EvdevMotors::spring(const std::array<StickSpring, 2>& springs) {
  return has_spring_ && play(springEffect(springs, spring_id_), spring_id_);
}

bool EvdevMotors::play(ff_effect effect, int& id) {
  if (ioctl(fd_, EVIOCSFF, &effect) < 0) return false;
  id = effect.id;
  input_event start{};
  start.type = EV_FF;
  start.code = static_cast<__u16>(id);
  start.value = 1;
  return write(fd_, &start, sizeof start) == static_cast<ssize_t>(sizeof start);
}

void EvdevMotors::erase(int& id) {
  if (id >= 0) ioctl(fd_, EVIOCRMFF, id);  // stops it too; an unplugged device has forgotten it anyway
  id = -1;
}

}  // namespace vibe::hardware
