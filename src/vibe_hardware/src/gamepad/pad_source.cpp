#include "vibe_hardware/gamepad/pad_source.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include <linux/input-event-codes.h>

#include "gamepad/evdev_pad.hpp"

namespace vibe::hardware {

namespace {

constexpr double kRetryPeriod = 0.5;  // [s]

}  // namespace

std::vector<PadEvent> joyEvents(const std::vector<float>& axes, const std::vector<int>& buttons, const JoyNames& names,
                                PadState& state) {
  constexpr int kEnd = 32767;
  std::vector<PadEvent> events;
  for (std::size_t i = 0; i < std::min(axes.size(), names.axes.size()); ++i) {
    PadAxis& axis = state.axes.try_emplace(names.axes[i], PadAxis{-kEnd, kEnd, 0, false}).first->second;
    const float value = std::isfinite(axes[i]) ? std::clamp(axes[i], -1.0F, 1.0F) : 0.0F;
    const int counts = static_cast<int>(std::lround(-kEnd * value));
    if (counts == axis.value && (axis.is_known || counts == 0)) continue;
    events.push_back({0, EV_ABS, names.axes[i], counts});
  }
  for (std::size_t i = 0; i < std::min(buttons.size(), names.buttons.size()); ++i) {
    const bool is_new = state.buttons.count(names.buttons[i]) == 0;
    PadButton& button = state.buttons[names.buttons[i]];
    const bool down = buttons[i] != 0;
    if (is_new)
      button.down = down;  // counts from its next press on
    else if (down != button.down)
      events.push_back({0, EV_KEY, names.buttons[i], down ? 1 : 0});
  }
  return events;
}

std::string PadLink::poll(double now) {
  if (!pad_) return look(now);
  if (pad_->update(now)) return "";
  const PadInfo info = pad_->info();
  pad_.reset();
  reported_ = true;
  last_try_ = now;
  const std::string what = info.is_recording ? "The recording of the gamepad '" + info.name + "' has ended"
                                             : "The gamepad '" + info.name + "' is gone";
  return what + ": its buttons are released and the joints stay where they are." +
         (info.is_recording ? "" : " Waiting for it.");
}

std::string PadLink::look(double now) {
  if (now - last_try_ < kRetryPeriod) return "";
  last_try_ = now;
  std::string why;
  pad_ = open_(why);
  if (pad_) {
    ++connections_;
    reported_ = false;
    return "Found the gamepad '" + pad_->info().name + "' at " + pad_->info().path + ".";
  }
  if (reported_) return "";
  reported_ = true;
  return why + " Waiting for it.";
}

namespace {

namespace fs = std::filesystem;

/// Paths of event0, event1, ... in the order of their numbers.
std::vector<std::string> eventPaths(const std::string& folder) {
  std::vector<std::pair<long, std::string>> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const bool is_event = name.size() > 5 && name.size() < 12 && name.rfind("event", 0) == 0 &&
                          std::all_of(name.begin() + 5, name.end(), [](unsigned char c) { return std::isdigit(c); });
    if (is_event) found.emplace_back(std::stol(name.substr(5)), entry->path().string());
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> paths;
  for (const auto& [number, path] : found) paths.push_back(path);
  return paths;
}

std::unique_ptr<PadSource> openPath(const std::string& path, std::string& why) {
  EvdevDevice device = openEvdev(path);
  if (device.isOpen()) return std::make_unique<EvdevPad>(std::move(device), path);
  why = "The gamepad '" + path + "' " + device.problem + ".";
  return nullptr;
}

/// Why devices were not taken.
struct Skipped {
  std::size_t seen = 0;    // all of them
  std::size_t scope = 0;   // devices of the scope
  std::size_t closed = 0;  // could not be opened
  std::string problem;     // of the last one that could not
};

std::string explain(const std::string& wanted, const std::string& folder, const Skipped& skipped) {
  std::string why =
      wanted.empty() ? "No gamepad found: " : "No device found with '" + wanted + "' in its name or phys: ";
  if (skipped.seen == 0) return why + "there is no input device in " + folder + ". Plug one in.";
  why += std::to_string(skipped.seen) + " input device" + (skipped.seen == 1 ? " in " : "s in ") + folder;
  const bool has_scope = skipped.scope > 0;
  if (wanted.empty() && has_scope) {
    why += ", " + std::to_string(skipped.scope) +
           " of them from the scope itself (hardware_node reads it; name it to drive with it as a gamepad)";
  }
  if (wanted.empty()) {
    why += std::string(", none of ") + (has_scope ? "the others" : "them") +
           " with two axes and a button of a gamepad or joystick";
  }
  if (skipped.closed > 0) why += "; " + std::to_string(skipped.closed) + " of them " + skipped.problem;
  return why + ". Plug one in.";
}

}  // namespace

std::vector<PadListing> listInputDevices(const std::string& folder) {
  std::vector<PadListing> listings;
  for (const std::string& path : eventPaths(folder)) {
    PadListing listing;
    const EvdevDevice device = openEvdev(path);
    listing.info.path = path;
    listing.problem = device.problem;
    if (device.isOpen()) {
      listing.info = infoOf(*device.handle, path);
      listing.state = stateOf(*device.handle);
      listing.is_pad = isPad(*device.handle);
    }
    listings.push_back(listing);
  }
  return listings;
}

std::unique_ptr<PadSource> openPad(const std::string& wanted, std::string& why, const std::string& folder) {
  if (!wanted.empty() && wanted.front() == '/') return openPath(wanted, why);
  const std::vector<std::string> paths = eventPaths(folder);
  Skipped skipped;
  skipped.seen = paths.size();
  for (const std::string& path : paths) {
    EvdevDevice device = openEvdev(path);
    if (device.isOpen() && isWanted(wanted, *device.handle, path))
      return std::make_unique<EvdevPad>(std::move(device), path);
    if (device.isOpen()) {
      skipped.scope += isScopeDevice(*device.handle) ? 1 : 0;
      continue;
    }
    ++skipped.closed;
    skipped.problem = device.problem;
  }
  why = explain(wanted, folder, skipped);
  return nullptr;
}

}  // namespace vibe::hardware
