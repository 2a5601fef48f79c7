#include "recording/step_input_reader.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <sstream>

#include "vibe_core/program/error.hpp"
#include "vibe_core/state/state_fields.hpp"

namespace vibe::sim {
namespace {

constexpr int kMaxDepth = 16;     // of messages in messages
constexpr int kMaxLines = 10000;  // of all of them, each as often as it is used: that can grow exponentially

const std::map<std::string, std::size_t> kSizes = {{"bool", 1},    {"byte", 1},  {"char", 1},    {"int8", 1},
                                                   {"uint8", 1},   {"int16", 2}, {"uint16", 2},  {"int32", 4},
                                                   {"uint32", 4},  {"int64", 8}, {"uint64", 8},  {"float32", 4},
                                                   {"float64", 8}, {"time", 8},  {"duration", 8}};

bool isBuiltIn(const std::string& type) {
  return type == "string" || kSizes.count(type) != 0;
}

/// Lines of each message: the first under "", the others under "package/Name" and under "Name".
std::map<std::string, std::vector<std::string>> splitMessages(const std::string& definition) {
  std::map<std::string, std::vector<std::string>> messages;
  std::vector<std::string> names = {""};
  std::istringstream text(definition);
  for (std::string line; std::getline(text, line);) {
    line.erase(std::min(line.find('#'), line.size()));
    if (line.rfind("MSG: ", 0) == 0) {
      std::string name;
      std::istringstream(line.substr(5)) >> name;
      names = {name, name.substr(name.find('/') + 1)};
    } else if (line.rfind("====", 0) != 0) {
      for (const std::string& name : names) messages[name].push_back(line);
    }
  }
  return messages;
}

/// "type[7]" -> "type" and 7.
int takeCount(std::string& type) {
  const std::size_t bracket = type.find('[');
  if (bracket == std::string::npos) return 1;
  const std::string digits = type.substr(bracket + 1, type.find(']') - bracket - 1);
  type.erase(bracket);
  return digits.empty() ? MessageLayout::kVariable : std::atoi(digits.c_str());
}

class Flattener {
 public:
  explicit Flattener(const std::string& definition) : messages_(splitMessages(definition)) {}

  void add(const std::string& message, const std::string& prefix, int depth, std::vector<MessageLayout::Field>& out) {
    const auto found = messages_.find(message);
    if (found == messages_.end() || depth > kMaxDepth)
      throw Error("the message definition lacks the type '" + message + "'.");
    for (const std::string& line : found->second) {
      if (++lines_ > kMaxLines) throw Error("the message definition has more than 10000 lines.");
      if (line.find('=') != std::string::npos) continue;  // a constant
      std::string type, name;
      if (!(std::istringstream(line) >> type >> name)) continue;
      const int count = takeCount(type);
      if (isBuiltIn(type)) {
        out.push_back({prefix + name, type, count, 0});
      } else if (count != 1) {
        throw Error("the message definition has an array of '" + type + "'.");
      } else {
        add(type, prefix + name + ".", depth + 1, out);
      }
    }
  }

 private:
  std::map<std::string, std::vector<std::string>> messages_;
  int lines_ = 0;
};

/// Steps through the bytes of one message.
class Cursor {
 public:
  Cursor(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), size_(size) {}

  std::size_t at() const { return at_; }
  void skip(std::size_t count) {
    if (count > size_ - at_) throw Error("a message ends too early.");
    at_ += count;
  }
  std::uint32_t length() {
    const std::size_t begin = at_;
    skip(sizeof(std::uint32_t));
    std::uint32_t value = 0;
    std::memcpy(&value, bytes_ + begin, sizeof value);
    return value;
  }

 private:
  const std::uint8_t* bytes_;
  std::size_t size_, at_ = 0;
};

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

MessageLayout::MessageLayout(const std::string& definition) {
  Flattener(definition).add("", "", 0, fields_);
}

std::vector<MessageLayout::Field> MessageLayout::locate(const std::uint8_t* bytes, std::size_t size) const {
  std::vector<Field> fields = fields_;
  Cursor cursor(bytes, size);
  for (Field& field : fields) {
    const std::size_t count = field.count == kVariable ? cursor.length() : static_cast<std::size_t>(field.count);
    field.at = cursor.at();
    if (field.type == "string")
      for (std::size_t i = 0; i < count; ++i) cursor.skip(cursor.length());
    else
      cursor.skip(count * kSizes.at(field.type));
  }
  return fields;
}

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
  if (message.has("session")) message.get("session", "uint64", 1, &result.session);
  message.get("step", "uint64", 1, &result.step);
  message.get("joints", "float64", kJointCount, result.input.joints.data());
  message.get("buttons", "uint8", kButtonCount, result.input.buttons.data());
  if (version == 1) return result;
  message.get("pull_particle", "int32", 1, &result.input.pull_particle);
  message.get("pull_target.x", "float64", 1, &result.input.pull_target.x());
  message.get("pull_target.y", "float64", 1, &result.input.pull_target.y());
  message.get("pull_target.z", "float64", 1, &result.input.pull_target.z());
  if (version == 2) return result;
  std::uint8_t breath = 0;
  message.get("breath", "uint8", 1, &breath);
  result.input.breath = breath == 0 ? Breath::Free : Breath::Held;
  return result;
}

}  // namespace vibe::sim
