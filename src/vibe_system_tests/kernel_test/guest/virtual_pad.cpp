#include "virtual_pad.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace vibe::hardware {
namespace {

constexpr int kMaxEffects = 8;
constexpr int kAxes[] = {ABS_X, ABS_Y, ABS_RX, ABS_RY};
constexpr int kButtons[] = {BTN_SOUTH, BTN_EAST, BTN_NORTH, BTN_WEST, BTN_TL, BTN_TR, BTN_SELECT, BTN_START};
constexpr int kEffects[] = {FF_RUMBLE, FF_SPRING};
constexpr int kPatience = 20;  // between two looks at ends_ [ms]

}  // namespace

VirtualPad::VirtualPad(const std::string& name) : file_(open("/dev/uinput", O_RDWR | O_CLOEXEC | O_NONBLOCK)) {
  if (file_ < 0) throw std::runtime_error(std::string("cannot open /dev/uinput: ") + std::strerror(errno));
  declare(name);
  thread_ = std::thread([this] { answerRequests(); });
}

VirtualPad::~VirtualPad() {
  ends_ = true;
  thread_.join();
  ioctl(file_, UI_DEV_DESTROY);
  close(file_);
}

void VirtualPad::declare(const std::string& name) {
  for (const int type : {EV_KEY, EV_ABS, EV_FF}) ioctl(file_, UI_SET_EVBIT, type);
  for (const int button : kButtons) ioctl(file_, UI_SET_KEYBIT, button);
  for (const int effect : kEffects) ioctl(file_, UI_SET_FFBIT, effect);
  for (const int axis : kAxes) {
    uinput_abs_setup setup{};
    setup.code = static_cast<__u16>(axis);
    setup.absinfo.minimum = -kAxisLimit;
    setup.absinfo.maximum = kAxisLimit;
    ioctl(file_, UI_ABS_SETUP, &setup);
  }
  uinput_setup setup{};
  setup.id.bustype = BUS_USB;
  setup.ff_effects_max = kMaxEffects;
  std::strncpy(setup.name, name.c_str(), sizeof setup.name - 1);
  if (ioctl(file_, UI_DEV_SETUP, &setup) != 0 || ioctl(file_, UI_DEV_CREATE) != 0) {
    throw std::runtime_error(std::string("the kernel makes no virtual gamepad: ") + std::strerror(errno));
  }
}

void VirtualPad::write(int type, int code, int value) {
  input_event event{};
  event.type = static_cast<__u16>(type);
  event.code = static_cast<__u16>(code);
  event.value = value;
  if (::write(file_, &event, sizeof event) != sizeof event) throw std::runtime_error("uinput takes no event");
}

void VirtualPad::send(int type, int code, int value) {
  write(type, code, value);
  write(EV_SYN, SYN_REPORT, 0);
}

bool VirtualPad::playing(int type, ff_effect& effect) const {
  const std::lock_guard lock(mutex_);
  for (const auto& [id, uploaded] : effects_) {
    const auto played = playing_.find(id);
    if (uploaded.type != type || played == playing_.end() || !played->second) continue;
    effect = uploaded;
    return true;
  }
  return false;
}

std::string VirtualPad::eventNode() const {
  char name[64] = {};
  if (ioctl(file_, UI_GET_SYSNAME(sizeof name), name) < 0) return {};
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(std::string("/sys/class/input/") + name, error)) {
    const std::string node = entry.path().filename();
    if (node.rfind("event", 0) == 0) return "/dev/input/" + node;
  }
  return {};
}

void VirtualPad::answerRequests() {
  while (!ends_) {
    pollfd wait{file_, POLLIN, 0};
    if (poll(&wait, 1, kPatience) <= 0) continue;
    input_event event{};
    if (read(file_, &event, sizeof event) != sizeof event) continue;
    if (event.type == EV_UINPUT && event.code == UI_FF_UPLOAD) upload(event.value);
    if (event.type == EV_UINPUT && event.code == UI_FF_ERASE) erase(event.value);
    if (event.type == EV_FF) {
      const std::lock_guard lock(mutex_);
      playing_[event.code] = event.value != 0;
    }
  }
}

void VirtualPad::upload(int request) {
  uinput_ff_upload upload{};
  upload.request_id = static_cast<__u32>(request);
  ioctl(file_, UI_BEGIN_FF_UPLOAD, &upload);
  {
    const std::lock_guard lock(mutex_);
    effects_[upload.effect.id] = upload.effect;
  }
  ioctl(file_, UI_END_FF_UPLOAD, &upload);
}

void VirtualPad::erase(int request) {
  uinput_ff_erase erased{};
  erased.request_id = static_cast<__u32>(request);
  ioctl(file_, UI_BEGIN_FF_ERASE, &erased);
  {
    const std::lock_guard lock(mutex_);
    effects_.erase(static_cast<int>(erased.effect_id));
    playing_.erase(static_cast<int>(erased.effect_id));
  }
  ioctl(file_, UI_END_FF_ERASE, &erased);
}

}  // namespace vibe::hardware
