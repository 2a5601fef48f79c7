#include "scene/yaml_guard.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <iterator>
#include <sstream>

#include "vibe_core/program/error.hpp"

namespace vibe {
namespace {

/// Receives the events of the parser and stops it before its recursion gets too deep.
class DepthWatch : public YAML::EventHandler {
 public:
  DepthWatch(const std::string& place, int limit) : place_(place), limit_(limit) {}

  bool isEmpty() const { return empty_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override { empty_ = false; }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    enter(mark);
  }
  void OnSequenceEnd() override { --depth_; }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    enter(mark);
  }
  void OnMapEnd() override { --depth_; }

 private:
  const std::string& place_;
  int limit_;
  int depth_ = 0;
  bool empty_ = true;

  void enter(const YAML::Mark& mark) {
    empty_ = false;
    if (++depth_ <= limit_) return;
    throw Error(place_ + ":" + std::to_string(mark.line + 1) + ": lists and maps are nested deeper than " +
                std::to_string(limit_) + " levels; write a flatter file");
  }
};

/// True if there was a document.
bool readDocument(YAML::Parser& parser, DepthWatch& watch, const std::string& place,
                  const std::map<int, std::string>& odd_characters) {
  try {
    return parser.HandleNextDocument(watch);
  } catch (const YAML::Exception& error) {
    const int number = error.mark.is_null() ? 1 : error.mark.line + 1;
    const std::string line = std::to_string(number);
    const auto after = odd_characters.upper_bound(number);
    const std::string odd = after == odd_characters.begin()
                                ? ""
                                : "; line " + std::to_string(std::prev(after)->first) + ", " + std::prev(after)->second;
    const std::string column = std::to_string(error.mark.is_null() ? 1 : error.mark.column + 1);
    throw Error(place + ":" + line + ": is not valid YAML at column " + column + " (" + printable(error.msg, 100) +
                "); check indentation, colons, quotes and brackets there" + odd);
  }
}

}  // namespace

void checkYaml(const std::string& text, const std::string& place, const YamlLimits& limits,
               const std::map<int, std::string>& odd_characters) {
  if (text.size() > limits.bytes) {
    throw Error(place + ":1: is larger than " + std::to_string(limits.bytes) + " bytes; is this the right file?");
  }
  if (text.find('\0') != std::string::npos) {
    throw Error(place + ":1: contains NUL bytes, so it is not a text file; save it as UTF-8 text");
  }
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DepthWatch watch(place, limits.depth);
  if (!readDocument(parser, watch, place, odd_characters) || watch.isEmpty()) {
    throw Error(place + ":1: contains nothing; write 'key: value' lines");
  }
  DepthWatch second(place, limits.depth);
  if (readDocument(parser, second, place, odd_characters)) {
    throw Error(place + ":1: contains more than one YAML document; remove the line '---' and what follows");
  }
}

}  // namespace vibe
