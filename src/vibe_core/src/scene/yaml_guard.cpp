#include "scene/yaml_guard.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <array>
#include <cstdint>
#include <iterator>
#include <sstream>
#include <string_view>

#include "vibe_core/files/number_text.hpp"
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

namespace {

/// Letters of the Greek and Cyrillic alphabets that look like Latin ones.
struct Alike {
  std::uint32_t code;
  char latin;
};

constexpr std::array<Alike, 52> kAlike{{
    {0x391, 'A'}, {0x392, 'B'},  {0x395, 'E'}, {0x396, 'Z'}, {0x397, 'H'}, {0x399, 'I'}, {0x39a, 'K'}, {0x39c, 'M'},
    {0x39d, 'N'}, {0x39f, 'O'},  {0x3a1, 'P'}, {0x3a4, 'T'}, {0x3a5, 'Y'}, {0x3a7, 'X'}, {0x3b1, 'a'}, {0x3b9, 'i'},
    {0x3bd, 'v'}, {0x3bf, 'o'},  {0x3c1, 'p'}, {0x3c5, 'u'}, {0x405, 'S'}, {0x406, 'I'}, {0x408, 'J'}, {0x410, 'A'},
    {0x412, 'B'}, {0x415, 'E'},  {0x41a, 'K'}, {0x41c, 'M'}, {0x41d, 'H'}, {0x41e, 'O'}, {0x420, 'P'}, {0x421, 'C'},
    {0x422, 'T'}, {0x425, 'X'},  {0x430, 'a'}, {0x435, 'e'}, {0x43a, 'k'}, {0x43c, 'm'}, {0x43e, 'o'}, {0x440, 'p'},
    {0x441, 'c'}, {0x443, 'y'},  {0x445, 'x'}, {0x455, 's'}, {0x456, 'i'}, {0x458, 'j'}, {0x501, 'd'}, {0x51b, 'q'},
    {0x51d, 'w'}, {0x2113, 'l'}, {0x131, 'i'}, {0x261, 'g'},
}};

struct Sign {
  std::uint32_t first, last;  ///< of a range of codes
  const char* name;
  const char* place;  ///< whose place it takes
};

constexpr std::array<Sign, 17> kSigns{{
    {0xa0, 0xa0, "a no-break space", "' '"},
    {0x1680, 0x1680, "a blank of another alphabet", "' '"},
    {0x2000, 0x200a, "a typographic blank", "' '"},
    {0x202f, 0x202f, "a narrow no-break space", "' '"},
    {0x205f, 0x205f, "a typographic blank", "' '"},
    {0x3000, 0x3000, "an ideographic space", "' '"},
    {0xad, 0xad, "a soft hyphen, which is invisible,", "nothing"},
    {0x200b, 0x200f, "an invisible character", "nothing"},
    {0x2060, 0x2060, "an invisible character", "nothing"},
    {0xfeff, 0xfeff, "an invisible character", "nothing"},
    {0x2028, 0x2029, "a separator of lines", "the end of a line"},
    {0x2010, 0x2015, "a dash", "'-'"},
    {0x2212, 0x2212, "a minus sign", "'-'"},
    {0x2018, 0x201b, "a typographic quotation mark", "'"},
    {0x201c, 0x201f, "a typographic quotation mark", "\""},
    {0xab, 0xab, "a typographic quotation mark", "\""},
    {0xbb, 0xbb, "a typographic quotation mark", "\""},
}};

/// The next character of UTF-8 text; a byte that is not UTF-8 counts as 0.
std::uint32_t nextCode(std::string_view text, std::size_t& at) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(k < text.size() ? text[k] : 0); };
  const unsigned char lead = byte(at);
  const std::size_t more = lead < 0x80 ? 0 : lead >= 0xf0 ? 3 : lead >= 0xe0 ? 2 : lead >= 0xc0 ? 1 : 0;
  std::uint32_t code = more == 0 ? lead : lead & (0x3fU >> more);
  for (std::size_t k = 1; k <= more; ++k) {
    if ((byte(at + k) & 0xc0) != 0x80) {
      ++at;
      return 0;
    }
    code = code << 6 | (byte(at + k) & 0x3fU);
  }
  at += more + 1;
  return lead >= 0x80 && more == 0 ? 0 : code;
}

/// "a no-break space (U+00A0) in the place of ' '", or nothing for an ordinary character.
std::string described(std::uint32_t code) {
  const std::string number = formatted(" (U+%04X) in the place of ", code);
  for (const Sign& sign : kSigns)
    if (code >= sign.first && code <= sign.last) return sign.name + number + sign.place;
  for (const Alike& alike : kAlike)
    if (code == alike.code) return "a letter of another alphabet" + number + "'" + alike.latin + "'";
  if (code >= 0xff01 && code <= 0xff5e)
    return "a full-width character" + number + "'" + static_cast<char>(code - 0xff01 + '!') + "'";
  return "";
}

std::string oddIn(std::string_view line) {
  int column = 1;
  bool indented = true;
  char before = ' ';
  for (std::size_t at = 0; at < line.size(); ++column) {
    const char c = line[at];
    if (c == '#' && (before == ' ' || before == '\t')) break;
    if (c == '\t' && indented)
      return "column " + std::to_string(column) + " has a tab, which YAML does not take as indentation";
    indented = indented && c == ' ';
    before = c;
    const std::string what = described(nextCode(line, at));
    if (!what.empty()) return "column " + std::to_string(column) + " has " + what;
  }
  return "";
}

}  // namespace

std::map<int, std::string> oddCharacters(const std::string& text) {
  std::map<int, std::string> odd;
  std::string_view rest(text);
  if (rest.substr(0, 3) == "\xef\xbb\xbf") rest.remove_prefix(3);
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t end = rest.find('\n');
    std::string what = oddIn(rest.substr(0, end));
    if (!what.empty()) odd.emplace(line, std::move(what));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  return odd;
}

}  // namespace vibe
