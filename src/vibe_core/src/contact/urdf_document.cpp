#include "contact/urdf_document.hpp"

#include <console_bridge/console.h>
#include <tinyxml2.h>
#include <urdf_parser/urdf_parser.h>

#include <mutex>

#include "vibe_core/common/error.hpp"

namespace vibe {

namespace {

// urdfdom reports errors through the process-wide console_bridge; this handler stores the first one instead of printing
// it
class LogCatcher : public console_bridge::OutputHandler {
 public:
  LogCatcher() : previous_(console_bridge::getOutputHandler()) { console_bridge::useOutputHandler(this); }
  ~LogCatcher() override { console_bridge::useOutputHandler(previous_); }
  LogCatcher(const LogCatcher&) = delete;
  LogCatcher& operator=(const LogCatcher&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (first_error_.empty() && level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) first_error_ = text;
  }
  const std::string& firstError() const { return first_error_; }

 private:
  console_bridge::OutputHandler* previous_;
  std::string first_error_;
};

// one line without a full stop at its end, for use inside a sentence
std::string asClause(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  while (!text.empty() && (text.back() == '.' || text.back() == ' ')) text.pop_back();
  return text;
}

urdf::ModelInterfaceSharedPtr parseQuietly(const std::string& text, std::string& reason) {
  static std::mutex one_at_a_time;  // the whole process shares the log handler
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  LogCatcher catcher;
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(text);
  } catch (const std::exception& error) {
    reason = asClause(error.what());
  }
  if (reason.empty()) reason = asClause(catcher.firstError());
  if (reason.empty()) reason = "urdfdom gives no reason";
  return model;
}

// the first element <tag name="..."> among `element`, its following siblings and their descendants; null if there is
// none
const tinyxml2::XMLElement* findNamed(const tinyxml2::XMLElement* element, const std::string& tag,
                                      const std::string& name) {
  for (; element != nullptr; element = element->NextSiblingElement()) {
    if (tag == element->Name() && element->Attribute("name", name.c_str()) != nullptr) return element;
    if (const auto* inside = findNamed(element->FirstChildElement(), tag, name)) return inside;
  }
  return nullptr;
}

}  // namespace

UrdfDocument::UrdfDocument(const std::string& text, const std::string& place)
    : lines_(std::make_unique<tinyxml2::XMLDocument>()), place_(place) {
  lines_->Parse(text.c_str(), text.size());
  std::string reason;
  model_ = parseQuietly(text, reason);
  if (model_ && model_->getRoot()) return;
  const bool has_tags = text.find('<') != std::string::npos;
  if (has_tags && lines_->Error())
    throw Error(place + ":" + std::to_string(lines_->ErrorLineNum()) + ": the XML of this URDF is broken here (" +
                reason + "); close what is open and quote every value.");
  throw Error(whereNamedIn(reason) + ": this is not a valid URDF (" + reason + "); correct that element.");
}

// urdfdom writes names in square brackets
std::string UrdfDocument::whereNamedIn(const std::string& message) const {
  std::size_t begin = message.find('[');
  for (; begin != std::string::npos; begin = message.find('[', begin + 1)) {
    const std::size_t end = message.find(']', begin);
    if (end == std::string::npos) break;
    const std::string name = message.substr(begin + 1, end - begin - 1);
    for (const char* tag : {"joint", "link", "material"})
      if (std::string place = where(tag, name); place != place_) return place;
  }
  return place_;
}

UrdfDocument::~UrdfDocument() {
  // a cycle of joints is a cycle of shared pointers, which would never be freed
  for (const auto& entry : model_->links_) {
    entry.second->child_links.clear();
    entry.second->child_joints.clear();
  }
}

std::string UrdfDocument::where(const std::string& tag, const std::string& name) const {
  const tinyxml2::XMLElement* element = findNamed(lines_->RootElement(), tag, name);
  return element == nullptr ? place_ : place_ + ":" + std::to_string(element->GetLineNum());
}

}  // namespace vibe
