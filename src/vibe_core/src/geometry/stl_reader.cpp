#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/mesh_readers.hpp"
#include "geometry/text_lines.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

constexpr std::size_t kStlHeader = 84;    // bytes: text and number of triangles
constexpr std::size_t kStlTriangle = 50;  // bytes: normal, corners, attribute

/// The words of a text STL, one after the other.
class StlWords {
 public:
  explicit StlWords(std::string_view text) : lines_(text) {}

  /// The next word in small letters; empty at the end.
  std::string next() {
    while (at_ >= words_.size()) {
      if (!lines_.next()) return "";
      words_ = wordsOf(lines_.line());
      at_ = 0;
    }
    const std::string word = lowered(words_[at_++]);
    return word == "end" && at_ < words_.size() ? word + next() : word;  // some programs write "end loop"
  }

  void expect(const std::string& wanted) {
    const std::string word = next();
    if (word != wanted) fail(word, "'" + wanted + "'");
  }

  double number() {
    const std::string word = next();
    if (word.empty()) fail(word, "a number");
    const std::optional<double> value = realOf(word);
    if (!value) throw Error(noNumber(lines_.number(), word));
    return *value;
  }

  /// Passes over the name of a solid, which may have several words and extends to the end of the line or to a facet.
  void skipName() {
    while (at_ < words_.size()) {
      const std::size_t before = at_;
      if (next() != "facet" || at_ >= words_.size()) continue;
      if (next() != "normal") continue;
      at_ = before;
      return;
    }
  }

  [[noreturn]] void fail(const std::string& word, const std::string& wanted) const {
    if (word.empty())
      throw Error("the text ends where " + wanted +
                  " belongs; it may have been cut off while it was written or copied");
    throw Error("line " + std::to_string(lines_.number()) + ": " + shown(word) + " stands where " + wanted +
                " belongs; correct the line, or write the file anew");
  }

 private:
  TextLines lines_;
  std::vector<std::string_view> words_;
  std::size_t at_ = 0;
};

void readFacet(StlWords& words, SurfaceMesh& mesh) {
  words.expect("normal");
  for (int k = 0; k < 3; ++k)
    if (words.next().empty()) words.fail("", "the normal of a facet");  // not used, so it may be anything
  words.expect("outer");
  words.expect("loop");
  const int first = static_cast<int>(mesh.vertices.size());
  for (int corner = 0; corner < 3; ++corner) {
    words.expect("vertex");
    const double x = words.number(), y = words.number(), z = words.number();
    mesh.vertices.emplace_back(x, y, z);
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  words.expect("endloop");
  words.expect("endfacet");
}

SurfaceMesh readStlText(const std::string& content) {
  StlWords words(content);
  SurfaceMesh mesh;
  for (std::string word = words.next(); !word.empty(); word = words.next()) {
    if (word != "solid") words.fail(word, "'solid'");
    words.skipName();
    for (word = words.next(); word == "facet"; word = words.next()) readFacet(words, mesh);
    if (word != "endsolid") words.fail(word, "'facet' or 'endsolid'");
    words.skipName();
  }
  return mesh;
}

std::uint64_t statedStlSize(const std::string& content) {
  std::uint32_t triangles = 0;
  std::memcpy(&triangles, content.data() + kStlHeader - 4, 4);  // little endian, like the supported processors
  return kStlHeader + kStlTriangle * std::uint64_t{triangles};
}

SurfaceMesh readStlBinary(const std::string& content) {
  SurfaceMesh mesh;
  for (std::size_t at = kStlHeader; at < content.size(); at += kStlTriangle) {
    float corners[9];
    std::memcpy(corners, content.data() + at + 12, sizeof corners);  // the normal before them is not used
    const int first = static_cast<int>(mesh.vertices.size());
    for (int k = 0; k < 3; ++k) mesh.vertices.emplace_back(corners[3 * k], corners[3 * k + 1], corners[3 * k + 2]);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// Text begins with "solid", perhaps after blanks; so do some binary files, which have a zero byte near their
/// beginning.
bool isStlText(const std::string& content) {
  const std::string_view beginning = std::string_view(content).substr(0, 1000);
  TextLines lines(beginning);
  std::vector<std::string_view> words;
  while (words.empty() && lines.next()) words = wordsOf(lines.line());
  if (words.empty() || beginning.find('\0') != std::string_view::npos) return false;
  return lowered(words[0]) == "solid";
}

}  // namespace

SurfaceMesh readStl(const std::string& content) {
  const bool has_header = content.size() >= kStlHeader;
  if (has_header && statedStlSize(content) == content.size()) return readStlBinary(content);
  if (isStlText(content)) return readStlText(content);
  if (!has_header)
    throw Error("has " + std::to_string(content.size()) +
                " bytes and is not text that begins with 'solid', so it is neither text nor binary STL; check that it "
                "is the right file and complete");
  const std::uint64_t stated = statedStlSize(content);
  throw Error("is not text that begins with 'solid'; as binary STL it would state " +
              std::to_string((stated - kStlHeader) / kStlTriangle) + " triangles, which take " +
              std::to_string(stated) + " bytes, but it has " + std::to_string(content.size()) +
              "; check that it is the right file and complete");
}

}  // namespace vibe
