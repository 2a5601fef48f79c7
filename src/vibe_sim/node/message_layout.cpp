#include "message_layout.hpp"

#include <cstring>
#include <map>
#include <sstream>

#include "vibe_core/common/error.hpp"

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

}  // namespace vibe::sim
