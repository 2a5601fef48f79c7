// sources: node/recording/step_input_reader.cpp
#include <cstdlib>
#include <string>
#include <vector>

#include "recording/step_input_reader.hpp"
#include "vibe_core/program/error.hpp"

// Any text up to a zero byte as the definition of a recorded message, and any bytes behind it as the message: an Error
// with its sentence, or a step.

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string all(data, data + size);
  const std::string definition = all.substr(0, all.find('\0'));
  const std::size_t begin = std::min(definition.size() + 1, size);
  const std::vector<std::uint8_t> message(data + begin, data + size);  // a copy, so that the sanitizer sees its end
  try {
    vibe::sim::StepInputReader(definition).read(message.data(), message.size());
  } catch (const vibe::Error& error) {
    require(error.what()[0] != '\0');
  }
  return 0;
}
