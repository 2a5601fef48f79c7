#include "step_input_reader.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "vibe_core/common/error.hpp"
#include "vibe_core/input/step_input_fields.hpp"

namespace vibe::sim {
namespace {

const std::string kReads = "this build reads versions 1 to " + std::to_string(kStepInputVersion) +
                           "; replay it with the release that recorded it.";

/// The fields of one message.
class InputFields {
 public:
  InputFields(const MessageLayout& layout, const std::uint8_t* bytes, std::size_t size)
      : bytes_(bytes), fields_(layout.locate(bytes, size)) {}

  bool has(const std::string& name) const { return find(name) != nullptr; }

  template <class T>
  void get(const std::string& name, const std::string& type, int count, T* values) const {
    const MessageLayout::Field* field = find(name);
    if (field == nullptr || field->type != type || field->count != count)
      throw Error("its vibe_msgs/StepInput has no field '" + type +
                  (count > 1 ? "[" + std::to_string(count) + "] " : " ") + name + "'; " + kReads);
    std::memcpy(values, bytes_ + field->at, static_cast<std::size_t>(count) * sizeof(T));
  }

 private:
  const MessageLayout::Field* find(const std::string& name) const {
    const auto found = std::find_if(fields_.begin(), fields_.end(), [&](const auto& f) { return f.name == name; });
    return found == fields_.end() ? nullptr : &*found;
  }

  const std::uint8_t* bytes_;
  std::vector<MessageLayout::Field> fields_;
};

// Messages from before there was the field `version` differ by the pull spring.
std::uint32_t versionOf(const InputFields& message) {
  if (!message.has("version")) return message.has("pull_particle") ? 2 : 1;
  std::uint32_t version = 0;
  message.get("version", "uint32", 1, &version);
  return version;
}

}  // namespace

RecordedStep StepInputReader::read(const std::uint8_t* bytes, std::size_t size) const {
  const InputFields message(layout_, bytes, size);
  const std::uint32_t version = versionOf(message);
  if (version < 1 || version > kStepInputVersion)
    throw Error("its vibe_msgs/StepInput is of version " + std::to_string(version) + ", but " + kReads);
  RecordedStep result;
  if (message.has("header.stamp")) {
    std::array<std::uint32_t, 2> stamp{};  // seconds, nanoseconds
    message.get("header.stamp", "time", 1, &stamp);
    result.stamp = 1'000'000'000LL * stamp[0] + stamp[1];
  }
  result.has_hashes = message.has("state_hash");
  if (result.has_hashes) {
    message.get("run", "uint32", 1, &result.run);
    message.get("input_hash", "uint64", 1, &result.input_hash);
    message.get("state_hash", "uint64", 1, &result.state_hash);
  }
  message.get("step", "uint64", 1, &result.step);
  message.get("joints", "float64", kJointCount, result.input.joints.data());
  message.get("buttons", "uint8", kButtonCount, result.input.buttons.data());
  if (version == 1) return result;
  message.get("pull_particle", "int32", 1, &result.input.pull_particle);
  message.get("pull_target.x", "float64", 1, &result.input.pull_target.x());
  message.get("pull_target.y", "float64", 1, &result.input.pull_target.y());
  message.get("pull_target.z", "float64", 1, &result.input.pull_target.z());
  return result;
}

}  // namespace vibe::sim
