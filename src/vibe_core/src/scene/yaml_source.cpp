#include "vibe_core/scene/yaml_source.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

#include "scene/yaml_guard.hpp"
#include "vibe_core/files/foreign_content.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/unit.hpp"
#include "vibe_core/scene/words.hpp"

namespace vibe {
namespace {

constexpr std::size_t kMaxText = 4096;
constexpr std::size_t kMaxMerged = 16;
constexpr int kMaxMerges = 64;  // maps in one map, those that they merge included: their number can grow exponentially

constexpr std::size_t kShown = 60;  // of a user's text in an error message

std::string quoted(const std::string& text) {
  return "'" + printable(text, kShown) + "'";
}

std::string showDegrees(double radians) {
  return formatted("%.4g deg", radians * 180 / M_PI);
}

const char* kindName(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Null:
      return "empty";
    case YAML::NodeType::Sequence:
      return "a list";
    case YAML::NodeType::Map:
      return "a map";
    default:
      return "a single value";
  }
}

int lineOf(const YAML::Node& node) {
  return node.Mark().line + 1;
}

}  // namespace

YamlSource YamlSource::load(const std::string& file, const YamlLimits& limits) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error(file + ": cannot be opened; give the path of an existing, readable YAML file");
  std::string text;
  text.resize(limits.bytes + 1);
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad() || (stream.gcount() == 0 && !stream.eof())) {
    throw Error(file + ": cannot be read; give the path of a readable YAML file, not of a folder or device");
  }
  text.resize(static_cast<std::size_t>(stream.gcount()));
  const std::string foreign = text.empty() ? "" : foreignContent(text);
  if (!foreign.empty()) throw Error(file + ": " + foreign);
  return parse(text, file, limits);
}

YamlSource YamlSource::parse(const std::string& text, const std::string& place, const YamlLimits& limits) {
  YamlSource source;
  source.odd_characters_ = oddCharacters(text);
  checkYaml(text, place, limits, source.odd_characters_);
  source.place_ = place;
  source.root_ = YAML::Load(text);
  if (!source.root_.IsMap()) {
    const auto odd = source.odd_characters_.begin();
    throw Error(
        place + ":1: is " + kindName(source.root_) + " at the top; write 'key: value' lines" +
        (odd == source.odd_characters_.end() ? "" : ": line " + std::to_string(odd->first) + ", " + odd->second));
  }
  return source;
}

YamlField YamlSource::root() const {
  return {"", "", lineOf(root_), root_};
}

void YamlSource::fail(const YamlField& field, const std::string& what_and_remedy) const {
  const std::string path = field.path.empty() ? "" : " " + printable(field.path, kShown) + ":";
  const auto odd = odd_characters_.find(field.line);
  throw Error(place_ + ":" + std::to_string(field.line) + ":" + path + " " + what_and_remedy +
              (odd == odd_characters_.end() ? "" : "; " + odd->second));
}

std::vector<YamlField> YamlSource::map(const YamlField& field) const {
  std::vector<YamlField> fields;
  if (field.value.IsNull()) return fields;
  if (!field.value.IsMap()) {
    fail(field,
         std::string("is ") + kindName(field.value) + ", but a map is needed; write 'key: value' lines below it");
  }
  int merges = 0;
  collect(field, merges, fields);
  return fields;
}

std::vector<YamlField> YamlSource::map(const YamlField& field, const std::vector<std::string>& known,
                                       const std::vector<std::string>& required) const {
  std::vector<YamlField> fields = map(field);
  for (const YamlField& entry : fields)
    if (std::find(known.begin(), known.end(), entry.key) == known.end())
      fail(entry, "is not a known key; " + suggestKey(entry.key, known));
  for (const std::string& key : required)
    if (std::none_of(fields.begin(), fields.end(), [&](const YamlField& entry) { return entry.key == key; }))
      fail(field, "lacks the key '" + key + "'; add it below");
  return fields;
}

void YamlSource::collect(const YamlField& field, int& merges, std::vector<YamlField>& fields) const {
  std::set<std::string> seen;
  YAML::Node merged;
  for (const auto& entry : field.value) {
    if (!entry.first.IsScalar()) {
      fail({"", field.path, lineOf(entry.first), {}}, "has a key that is not a word; write 'key: value'");
    }
    const std::string& key = entry.first.Scalar();
    const std::string path = field.path.empty() ? key : field.path + "." + key;
    YamlField next{key, path, lineOf(entry.first), entry.second};
    if (!seen.insert(key).second) fail(next, "is given a second time; keep one of the two");
    if (entry.second.IsNull() && !key.empty() && key[0] >= '0' && key[0] <= '9')
      fail(next,
           "begins with a digit and has no value; write numbers with a decimal point and without separators, "
           "since within { } a comma begins the next key");
    if (key == "<<") {
      merged.reset(entry.second);
    } else {
      fields.push_back(next);
    }
  }
  if (seen.count("<<") > 0) merge(field, merged, merges, fields);
}

void YamlSource::merge(const YamlField& field, const YAML::Node& sources, int& merges,
                       std::vector<YamlField>& fields) const {
  std::vector<YAML::Node> maps;
  if (sources.IsSequence()) {
    if (sources.size() > kMaxMerged) fail(field, "merges too many maps with <<; merge at most 16");
    for (const auto& source : sources) maps.push_back(source);
  } else {
    maps.push_back(sources);
  }
  std::set<std::string> known;
  for (const YamlField& own : fields) known.insert(own.key);
  for (const YAML::Node& source : maps) {
    if (!source.IsMap()) fail(field, "merges something with << that is not a map; merge an alias of a map");
    // These files need no deep or circular merges.
    if (++merges > kMaxMerges) fail(field, "merges maps into each other too deeply with <<; write the keys out");
    std::vector<YamlField> more;
    collect({field.key, field.path, field.line, source}, merges, more);
    for (const YamlField& candidate : more) {
      if (known.insert(candidate.key).second) fields.push_back(candidate);  // keys of the map itself take precedence
    }
  }
}

std::vector<YamlField> YamlSource::list(const YamlField& field) const {
  if (!field.value.IsSequence()) {
    fail(field,
         std::string("is ") + kindName(field.value) + ", but a list is needed; write lines that begin with '- '");
  }
  std::vector<YamlField> items;
  items.reserve(field.value.size());
  for (const auto& item : field.value) {
    items.push_back({"", field.path + "[" + std::to_string(items.size()) + "]", lineOf(item), item});
  }
  return items;
}

std::string YamlSource::scalar(const YamlField& field, const std::string& expected) const {
  if (!field.value.IsScalar()) fail(field, std::string("is ") + kindName(field.value) + ", it must be " + expected);
  const std::string& text = field.value.Scalar();
  if (text.size() > kMaxText) fail(field, "is longer than 4096 characters; shorten it");
  return text;
}

bool YamlSource::boolean(const YamlField& field) const {
  const std::string text = scalar(field, "true or false; write one of them");
  if (text == "true" || text == "True") return true;
  if (text == "false" || text == "False") return false;
  fail(field, quoted(text) + " is neither true nor false; write one of them");
}

std::int64_t YamlSource::integer(const YamlField& field, std::int64_t low, std::int64_t high) const {
  const std::string range = "from " + std::to_string(low) + " to " + std::to_string(high);
  const std::string text = scalar(field, "a whole number; write one " + range);
  const Quantity number = parseNumber(text);
  if (!number.problem.empty() || number.value != std::floor(number.value)) {
    fail(field, quoted(text) + " is not a whole number; write one " + range);
  }
  if (number.value < static_cast<double>(low) || number.value > static_cast<double>(high)) {
    fail(field, quoted(text) + " is out of range; write a whole number " + range);
  }
  return static_cast<std::int64_t>(number.value);
}

double YamlSource::quantity(const YamlField& field, const std::string& si_unit, double low, double high) const {
  const std::string text = scalar(field, describeQuantity(si_unit));
  const Quantity result = parseQuantity(text, si_unit);
  if (!result.problem.empty()) fail(field, quoted(text) + " " + result.problem);
  if (result.value < low || result.value > high) {
    const std::string degrees = si_unit == "rad" ? " (" + showDegrees(low) + " to " + showDegrees(high) + ")" : "";
    fail(field, quoted(text) + " is out of range; write a value from " + showQuantity(low, si_unit) + " to " +
                    showQuantity(high, si_unit) + degrees);
  }
  return result.value;
}

std::vector<double> YamlSource::quantities(const YamlField& field, std::size_t count, const std::string& si_unit,
                                           double low, double high) const {
  const std::string number = std::to_string(count);
  if (!field.value.IsSequence()) {
    fail(field, std::string("is ") + kindName(field.value) + ", it must be a list of " + number + ", each " +
                    describeQuantity(si_unit));
  }
  if (field.value.size() != count) {
    fail(field, "has " + std::to_string(field.value.size()) + " values; write " + number + " in brackets [ , ]");
  }
  std::vector<double> values;
  for (const auto& item : field.value) {
    const std::string path = field.path + "[" + std::to_string(values.size()) + "]";
    values.push_back(quantity({"", path, field.line, item}, si_unit, low, high));
  }
  return values;
}

std::string YamlSource::text(const YamlField& field) const {
  const std::string text = scalar(field, "a text; write one");
  if (text.empty()) fail(field, "is empty; write a text or leave the key out");
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      fail(field, "contains a control character; write printable text on one line");
    }
  }
  return text;
}

std::string YamlSource::choice(const YamlField& field, const std::vector<std::string>& words) const {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  const std::string text = scalar(field, "one of " + list + "; write one of them");
  for (const std::string& word : words) {
    if (text == word) return text;
  }
  fail(field, quoted(text) + " is not known here; " + suggestKey(text, words));
}

std::string showQuantity(double value, const std::string& si_unit) {
  std::string text;
  // The shortest text that reads back as the same number.
  for (int digits = 6; digits <= 17; ++digits) {
    text = formatted("%.*g", digits, value);
    if (parseNumber(text).value == value) break;
  }
  return si_unit == "1" || si_unit.empty() ? text : text + " " + si_unit;
}

}  // namespace vibe
