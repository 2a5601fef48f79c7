#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/mesh_readers.hpp"
#include "geometry/polygon.hpp"
#include "geometry/text_lines.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

struct PlyType {
  std::string_view name, other_name;
  std::size_t size;  // bytes
  double (*read)(const char* bytes);
};

constexpr std::array<PlyType, 8> kPlyTypes{{{"char", "int8", 1, littleEndian<std::int8_t>},
                                            {"uchar", "uint8", 1, littleEndian<std::uint8_t>},
                                            {"short", "int16", 2, littleEndian<std::int16_t>},
                                            {"ushort", "uint16", 2, littleEndian<std::uint16_t>},
                                            {"int", "int32", 4, littleEndian<std::int32_t>},
                                            {"uint", "uint32", 4, littleEndian<std::uint32_t>},
                                            {"float", "float32", 4, littleEndian<float>},
                                            {"double", "float64", 8, littleEndian<double>}}};

struct PlyProperty {
  std::string name;
  const PlyType* count = nullptr;  // of a list
  const PlyType* type = nullptr;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// -1 if there is none.
  int find(std::string_view wanted, bool list) const {
    for (std::size_t k = 0; k < properties.size(); ++k)
      if (properties[k].name == wanted && (properties[k].count != nullptr) == list) return static_cast<int>(k);
    return -1;
  }
};

enum class PlyFormat { Ascii, LittleEndian, BigEndian };

struct PlyHeader {
  PlyFormat format = PlyFormat::Ascii;
  bool has_format = false;
  std::vector<PlyElement> elements;
  std::size_t size = 0;  // bytes, with the end of its last line
  int lines = 0;
};

[[noreturn]] void failPly(int line, const std::string& what) {
  throw Error("line " + std::to_string(line) + " of its header " + what +
              "; correct the header, or write the file anew");
}

const PlyType* plyType(std::string_view word, int line) {
  for (const PlyType& type : kPlyTypes)
    if (word == type.name || word == type.other_name) return &type;
  failPly(line, "names the type " + shown(word) + ", which PLY does not have");
}

void takePlyProperty(const std::vector<std::string_view>& words, int line, PlyHeader& header) {
  if (header.elements.empty()) failPly(line, "has a property that belongs to no element");
  PlyProperty property;
  if (words.size() == 5 && words[1] == "list") {
    property.count = plyType(words[2], line);
    property.type = plyType(words[3], line);
    if (property.count->name == "float" || property.count->name == "double")
      failPly(line, "counts the items of a list with a " + std::string(words[2]));
  } else if (words.size() == 3) {
    property.type = plyType(words[1], line);
  } else {
    failPly(line, "is neither 'property TYPE NAME' nor 'property list TYPE TYPE NAME'");
  }
  property.name = words.back();
  header.elements.back().properties.push_back(property);
}

void takePlyElement(const std::vector<std::string_view>& words, int line, PlyHeader& header) {
  const std::optional<double> count = words.size() == 3 ? realOf(words[2]) : std::nullopt;
  if (!count || !(*count >= 0 && *count < 1e15) || *count != std::floor(*count))
    failPly(line, "is not 'element NAME COUNT'");
  if (std::any_of(words[1].begin(), words[1].end(), [](unsigned char c) { return c < 32 || c == 127; }))
    failPly(line, "names the element " + shown(words[1]) + ", whose name has bytes that are no text");
  header.elements.push_back({std::string(words[1]), static_cast<std::uint64_t>(*count), {}});
}

void takePlyFormat(const std::vector<std::string_view>& words, int line, PlyHeader& header) {
  constexpr std::array<std::string_view, 3> kFormats{"ascii", "binary_little_endian", "binary_big_endian"};
  const auto found = words.size() == 3 ? std::find(kFormats.begin(), kFormats.end(), words[1]) : kFormats.end();
  if (found == kFormats.end() || words[2] != "1.0") failPly(line, "names no format of PLY 1.0");
  header.format = static_cast<PlyFormat>(found - kFormats.begin());
  header.has_format = true;
}

/// The first line says how all lines of the header end: what follows the last of them is data, even a byte that could
/// belong to the end of a line.
PlyHeader readPlyHeader(std::string_view content) {
  if (content.substr(0, 3) != "ply" || content.size() < 4 || (content[3] != '\n' && content[3] != '\r'))
    throw Error("does not begin with the line 'ply'; check that it is a PLY file");
  const std::string_view end_of_line = content[3] == '\n' ? "\n" : content[4] == '\n' ? "\r\n" : "\r";
  PlyHeader header;
  std::size_t at = 0;
  for (int line = 1;; ++line) {
    const std::size_t end = content.find(end_of_line, at);
    if (end == std::string_view::npos)
      throw Error("its header has no line 'end_header'; it may have been cut off while it was written or copied");
    const std::vector<std::string_view> words = wordsOf(content.substr(at, end - at));
    at = end + end_of_line.size();
    if (line == 1 || words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    header.size = at;
    header.lines = line;
    if (words[0] == "end_header") break;
    if (words[0] == "format") {
      takePlyFormat(words, line, header);
    } else if (words[0] == "element") {
      takePlyElement(words, line, header);
    } else if (words[0] == "property") {
      takePlyProperty(words, line, header);
    } else {
      failPly(line, "begins with " + shown(words[0]) + ", which PLY does not know");
    }
  }
  if (!header.has_format) throw Error("its header does not state the format; write 'format ascii 1.0' or a binary one");
  return header;
}

/// The values after the header, one after the other.
class PlyValues {
 public:
  PlyValues(const std::string& content, const PlyHeader& header)
      : data_(std::string_view(content).substr(header.size)),
        lines_(data_),
        format_(header.format),
        header_lines_(header.lines) {}

  void beginRow(const PlyElement& element, std::uint64_t number) {
    element_ = &element;
    number_ = number;
    if (format_ != PlyFormat::Ascii) return;
    at_ = 0;
    do {
      if (!lines_.next()) failEnd();
      words_ = wordsOf(lines_.line());
    } while (words_.empty());
  }

  void endRow() const {
    if (format_ == PlyFormat::Ascii && at_ < words_.size())
      throw Error("line " + std::to_string(line()) + ": has " + std::to_string(words_.size()) + " values, but its " +
                  element_->name + " takes " + std::to_string(at_) + "; correct the line, or write the file anew");
  }

  double next(const PlyType& type) { return format_ == PlyFormat::Ascii ? nextWord() : nextBytes(type); }

  /// Fails for a list that is longer than all that is left.
  std::size_t nextCount(const PlyType& type) {
    const double count = next(type);
    const std::size_t left = format_ == PlyFormat::Ascii ? words_.size() - at_ : data_.size() - at_;
    if (!(count >= 0) || count != std::floor(count))
      throw Error(element_->name + " " + std::to_string(number_) +
                  " has a list whose length is not a whole number from 0; correct it, or write the file anew");
    if (count > static_cast<double>(left)) failShort();
    return static_cast<std::size_t>(count);
  }

  /// What follows the last element can only be blanks.
  void finish() {
    if (format_ == PlyFormat::Ascii) {
      while (lines_.next())
        if (!wordsOf(lines_.line()).empty())
          throw Error("line " + std::to_string(line()) +
                      ": follows after the last element that the header announces; correct the numbers of elements in "
                      "the header, or write the file anew");
    } else if (data_.find_first_not_of(" \t\r\n", at_) != std::string_view::npos) {
      throw Error(std::to_string(data_.size() - at_) +
                  " bytes follow after the last element that the header announces; the numbers of elements in the "
                  "header may be wrong, or the file may have passed through a program that changed ends of lines");
    }
  }

 private:
  int line() const { return header_lines_ + lines_.number(); }

  [[noreturn]] void failEnd() const {
    throw Error("ends within " + element_->name + " " + std::to_string(number_) + " of " +
                std::to_string(element_->count) + "; it may have been cut off while it was written or copied");
  }

  [[noreturn]] void failShort() const {
    if (format_ != PlyFormat::Ascii) failEnd();
    throw Error("line " + std::to_string(line()) + ": has too few values for its " + element_->name +
                "; correct the line, or write the file anew");
  }

  double nextWord() {
    if (at_ >= words_.size()) failShort();
    const std::optional<double> value = realOf(words_[at_]);
    if (!value) throw Error(noNumber(line(), words_[at_]));
    ++at_;
    return *value;
  }

  double nextBytes(const PlyType& type) {
    if (data_.size() - at_ < type.size) failEnd();
    char bytes[8];
    std::memcpy(bytes, data_.data() + at_, type.size);
    at_ += type.size;
    if (format_ == PlyFormat::BigEndian) std::reverse(bytes, bytes + type.size);  // supported processors: little endian
    return type.read(bytes);
  }

  std::string_view data_;
  TextLines lines_;
  const PlyFormat format_;
  const int header_lines_;
  const PlyElement* element_ = nullptr;
  std::uint64_t number_ = 0;
  std::vector<std::string_view> words_;
  std::size_t at_ = 0;
};

/// Calls visit(number of the property, value) for all values of an element; the items of a list have its number.
template <class Begin, class Visit, class End>
void readPlyElement(const PlyElement& element, PlyValues& values, const Begin& begin, const Visit& visit,
                    const End& end) {
  if (element.properties.empty()) return;
  for (std::uint64_t k = 0; k < element.count; ++k) {
    values.beginRow(element, k);
    begin();
    for (int p = 0; p < static_cast<int>(element.properties.size()); ++p) {
      const PlyProperty& property = element.properties[p];
      std::size_t items = property.count != nullptr ? values.nextCount(*property.count) : 1;
      for (; items > 0; --items) visit(p, values.next(*property.type));
    }
    values.endRow();
    end(static_cast<int>(k));
  }
}

class PlyReader {
 public:
  SurfaceMesh read(const std::string& content) {
    const PlyHeader header = readPlyHeader(content);
    PlyValues values(content, header);
    for (const PlyElement& element : header.elements) {
      if (element.name == "vertex") {
        readVertices(element, values);
      } else if (element.name == "face") {
        readFaces(element, values);
      } else if (element.name == "tristrips") {
        readStrips(element, values);
      } else {
        readPlyElement(
            element, values, [] {}, [](int, double) {}, [](int) {});
      }
    }
    values.finish();
    addFaces(faces_, 0, "face", mesh_);
    addFaces(strips_, 0, "triangle strip", mesh_);
    return std::move(mesh_);
  }

 private:
  void readVertices(const PlyElement& element, PlyValues& values) {
    const std::array<int, 3> place{element.find("x", false), element.find("y", false), element.find("z", false)};
    if (std::min({place[0], place[1], place[2]}) < 0)
      throw Error("its element 'vertex' lacks a property x, y or z; write the file anew with positions");
    Eigen::Vector3d p;
    const auto keep = [&](int property, double value) {
      for (int k = 0; k < 3; ++k)
        if (place[k] == property) p[k] = value;
    };
    readPlyElement(
        element, values, [] {}, keep, [&](int) { mesh_.vertices.push_back(p); });
  }

  static int listOf(const PlyElement& element) {
    const int list = std::max(element.find("vertex_indices", true), element.find("vertex_index", true));
    if (list < 0 && element.count > 0)
      throw Error("its element '" + element.name +
                  "' has no list 'vertex_indices' or 'vertex_index'; write the file anew with the vertices of faces");
    return list;
  }

  void readFaces(const PlyElement& element, PlyValues& values) {
    const int list = listOf(element);
    const auto keep = [&](int property, double value) {
      if (property == list) faces_.corners.push_back(vertexNumber(value));
    };
    const auto end = [&](int number) {
      faces_.ends.push_back(faces_.corners.size());
      faces_.places.push_back(number);
    };
    readPlyElement(
        element, values, [] {}, keep, end);
  }

  /// Every vertex makes a triangle with the two before it, and every second one faces the other way; -1 begins anew.
  void readStrips(const PlyElement& element, PlyValues& values) {
    const int list = listOf(element);
    std::vector<std::int64_t> strip;
    int number = 0;
    const auto keep = [&](int property, double value) {
      if (property != list) return;
      const std::int64_t v = vertexNumber(value);
      if (v == -1) return strip.clear();
      strip.push_back(v);
      if (strip.size() < 3) return;
      const std::size_t n = strip.size(), odd = n % 2 == 0 ? 1 : 0;
      strips_.corners.insert(strips_.corners.end(), {strip[n - 3 + odd], strip[n - 2 - odd], strip[n - 1]});
      strips_.ends.push_back(strips_.corners.size());
      strips_.places.push_back(number);
    };
    readPlyElement(
        element, values, [&] { strip.clear(); }, keep, [&](int k) { number = k + 1; });
  }

  /// A number of no vertex for a value that is not whole.
  static std::int64_t vertexNumber(double value) {
    return std::abs(value) < 1e15 && value == std::floor(value) ? static_cast<std::int64_t>(value) : std::int64_t{-2};
  }

  SurfaceMesh mesh_;
  FaceList faces_, strips_;
};

}  // namespace

SurfaceMesh readPly(const std::string& content) {
  return PlyReader().read(content);
}

}  // namespace vibe
