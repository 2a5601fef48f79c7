#include "procedure/emit_event.hpp"

#include <cstdio>
#include <utility>

namespace vibe {

namespace {

std::string withUnit(const char* format, double value) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

}  // namespace

void emitEvent(Event::Kind kind, double time, int particle, double value, std::string text,
               std::vector<Event>& events) {
  Event event;
  event.kind = kind;
  event.time = time;
  event.particle = particle;
  event.value = value;
  event.text = std::move(text);
  events.push_back(std::move(event));
}

void reject(int command, double time, std::string reason, std::vector<Event>& events) {
  emitEvent(Event::Kind::Refused, time, -1, command, std::move(reason), events);
}

std::string inMillimetres(double metres) {
  return withUnit("%.1f mm", metres * 1e3);
}

std::string inNewtons(double force) {
  return withUnit("%.2f N", force);
}

std::string inMillilitres(double volume) {
  return withUnit("%.1f ml", volume * 1e6);
}

}  // namespace vibe
