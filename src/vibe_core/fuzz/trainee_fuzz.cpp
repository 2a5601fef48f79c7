// sources: src/trainee/trainee_script.cpp src/trainee/script_reader.cpp src/trainee/skill.cpp src/trainee/protocol.cpp
// sources: src/trainee/suture_pattern.cpp src/input/step_input.cpp
// sources: src/geometry/organ.cpp src/suture/technique.cpp src/suture/technique_patterns.cpp
// sources: src/suture/technique_templates.cpp src/scene/yaml_source.cpp src/scene/yaml_guard.cpp src/scene/unit.cpp
// sources: src/scene/words.cpp src/files/foreign_content.cpp
// sources: src/arithmetic/elementary_*.cpp src/files/number_text.cpp src/arithmetic/symmetric_eigen.cpp
// packages: yaml-cpp bullet
// corpus: trainees
#include <cmath>
#include <cstdlib>
#include <string>

#include "vibe_core/program/error.hpp"
#include "vibe_core/trainee/protocol.hpp"
#include "vibe_core/trainee/trainee_script.hpp"

// Any text as a trainee script and as a protocol: an Error with its sentence; or a script of at most a day with finite
// input at any time; or a protocol with goals that can be described.

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

template <class Read>
void expectOnlyErrors(const Read& read) {
  try {
    read();
  } catch (const vibe::Error& error) {
    require(error.what()[0] != '\0');
  }
}

void readScript(const std::string& text) {
  const vibe::TraineeScript script = vibe::TraineeScript::parse(text, "fuzz.yaml");
  const double end = script.duration();
  require(end >= 0 && end <= 86401 && !script.name().empty());
  for (const double time : {-1.0, 0.0, end / 3, end, end + 1, std::nan("")}) {
    for (const double joint : script.at(time).joints) require(std::isfinite(joint) && std::abs(joint) < 200);
    script.phaseAt(time);
  }
}

void readProtocol(const std::string& text) {
  const vibe::Protocol protocol = vibe::Protocol::parse(text, "fuzz.yaml");
  require(!protocol.name.empty() && !protocol.goals.empty() && protocol.goals.size() <= 10000);
  for (const vibe::Goal& goal : protocol.goals) require(!vibe::describe(goal).empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  expectOnlyErrors([&] { readScript(text); });
  expectOnlyErrors([&] { readProtocol(text); });
  return 0;
}
