#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/mesh_readers.hpp"
#include "geometry/polygon.hpp"
#include "geometry/text_lines.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

// Statements of the standard that say nothing about polygons: other vertices, points, lines and curves, groups,
// display.
constexpr std::array<std::string_view, 37> kNoPolygons{
    "vt",    "vn",    "vp",     "p",        "l",        "curv",  "curv2",  "cstype", "deg",        "bmat",
    "step",  "parm",  "trim",   "hole",     "scrv",     "sp",    "end",    "con",    "g",          "s",
    "mg",    "o",     "bevel",  "c_interp", "d_interp", "lod",   "usemtl", "mtllib", "shadow_obj", "trace_obj",
    "ctech", "stech", "usemap", "maplib",   "scmp",     "scmpb", "bmp"};
constexpr std::array<std::string_view, 6> kFreeForms{"surf", "bsp", "bzp", "cdc", "cdp", "res"};

template <std::size_t N>
bool isOneOf(std::string_view word, const std::array<std::string_view, N>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

class ObjReader {
 public:
  SurfaceMesh read(const std::string& content) {
    TextLines lines(content);
    std::string text;
    while (lines.next()) {
      line_ = lines.number();
      text = lines.line();
      while (isContinued(text) && lines.next()) {
        text.back() = ' ';
        text += lines.line();
      }
      const std::vector<std::string_view> words = wordsOf(std::string_view(text).substr(0, text.find('#')));
      if (!words.empty()) take(words);
    }
    addFaces(faces_, 1, "line", mesh_);
    return std::move(mesh_);
  }

 private:
  static bool isContinued(std::string_view text) {
    return !text.empty() && text.back() == '\\' && text.find('#') == std::string_view::npos;
  }

  [[noreturn]] void fail(const std::string& what) const { throw Error("line " + std::to_string(line_) + ": " + what); }

  void take(const std::vector<std::string_view>& words) {
    const std::string_view key = words[0];
    if (key == "v") return takeVertex(words);
    if (key == "f" || key == "fo") return takeFace(words);
    if (isOneOf(key, kNoPolygons)) return;
    if (isOneOf(key, kFreeForms))
      fail("free-form surfaces ('" + std::string(key) + "') are not supported; export the surface as polygons");
    if (key == "call" || key == "csh")
      fail("'" + std::string(key) + "', which runs what is in another file, is not supported; put all into one file");
    fail(shown(key) + " is not a statement of an OBJ file; remove the line if it does not belong to the surface");
  }

  void takeVertex(const std::vector<std::string_view>& words) {
    if (words.size() < 4) fail("the vertex has fewer than three coordinates; write x, y and z");
    Eigen::Vector3d p;
    for (int k = 0; k < 3; ++k) {
      const std::optional<double> value = realOf(words[k + 1]);
      if (!value) throw Error(noNumber(line_, words[k + 1]));
      p[k] = *value;
    }
    mesh_.vertices.push_back(p);
  }

  void takeFace(const std::vector<std::string_view>& words) {
    if (words.size() < 4) fail("the face has fewer than three corners; give it three, or remove the line");
    for (std::size_t k = 1; k < words.size(); ++k) faces_.corners.push_back(corner(words[k]));
    faces_.ends.push_back(faces_.corners.size());
    faces_.places.push_back(line_);
  }

  /// "7/1/3" -> 6; negative numbers count back from the last vertex so far.
  std::int64_t corner(std::string_view word) const {
    const std::string_view digits = word.substr(0, word.find('/'));
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (error != std::errc() || end != digits.data() + digits.size())
      fail("the corner " + shown(word) + " of the face does not begin with the number of a vertex; correct the line");
    if (number == 0) fail("the face names vertex 0, but vertices of OBJ are counted from 1; correct the line");
    const auto so_far = static_cast<std::int64_t>(mesh_.vertices.size());
    if (number > 0) return number - 1;
    if (number < -so_far)
      fail("the face names vertex " + std::to_string(number) + ", but " + std::to_string(so_far) +
           " vertices come before it; correct the line");
    return so_far + number;
  }

  SurfaceMesh mesh_;
  FaceList faces_;
  int line_ = 0;
};

}  // namespace

SurfaceMesh readObj(const std::string& content) {
  return ObjReader().read(content);
}

}  // namespace vibe
