#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/gltf_values.hpp"
#include "geometry/mesh_readers.hpp"
#include "geometry/text_lines.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

constexpr std::uint64_t kMostNumbers = 1 << 22;   // of an accessor without data, which costs nothing in the file
constexpr std::size_t kMostTriangles = 20000000;  // of all nodes, which may show one mesh many times; vertices, too

/// Extensions that may be required and change nothing of a surface.
bool isHarmless(const std::string& extension) {
  for (const char* beginning : {"KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_", "KHR_lights_",
                                "EXT_lights_", "KHR_xmp", "KHR_techniques_"})
    if (extension.rfind(beginning, 0) == 0) return true;
  return extension == "KHR_mesh_quantization" || extension == "KHR_animation_pointer";
}

class GltfReader {
 public:
  GltfReader(const GltfParts& parts, const std::function<std::string(const std::string&)>& file)
      : parts_(parts), file_(file) {
    try {
      root_ = Json::parse(parts.json.begin(), parts.json.end());
    } catch (const Json::parse_error& error) {
      if (error.byte > parts.json.size())
        throw Error("ends within its JSON; it may have been cut off while it was written or copied");
      failGltf("its JSON cannot be understood at byte " + std::to_string(error.byte));
    }
    if (!root_.is_object()) failGltf("its JSON is not an object");
  }

  SurfaceMesh read() {
    checkVersion();
    for (const Json& extension : listIn(root_, "extensionsRequired")) {
      const std::string name = extension.is_string() ? extension.get<std::string>() : "";
      if (!isHarmless(name))
        throw Error("requires the extension " + shown(name) + ", which is not supported; export it without");
    }
    readNodes();
    if (!shows_mesh_)
      throw Error("shows no mesh: no node of the scene that is shown has one; export the scene with the surface");
    return std::move(mesh_);
  }

 private:
  void checkVersion() const {
    const Json& asset = objectOf(root_, "asset", "it");
    const std::string version = textOf(asset, "version"), least = textOf(asset, "minVersion");
    if (version.rfind("2.", 0) != 0)
      throw Error("is glTF of version " + shown(version) + ", which is not supported; export it as glTF 2.0");
    if (!least.empty() && least != "2.0")
      throw Error("requires glTF of version " + shown(least) + ", which is not supported; export it as glTF 2.0");
  }

  static std::string nameOf(const char* list, std::uint64_t index) {
    return std::string(list) + "[" + std::to_string(index) + "]";
  }

  const Json& item(const char* list, std::uint64_t index) const {
    const Json& items = listIn(root_, list);
    if (index >= items.size() || !items[index].is_object())
      failGltf("it names " + nameOf(list, index) + ", which is not there");
    return items[index];
  }

  /// The nodes that are shown at the top.
  std::vector<std::uint64_t> roots() const {
    const Json& scenes = listIn(root_, "scenes");
    if (scenes.size() > 1 && root_.find("scene") == root_.end())
      throw Error("has " + std::to_string(scenes.size()) +
                  " scenes and does not say which is shown; state it as 'scene', or export one");
    std::vector<std::uint64_t> top;
    if (!scenes.empty()) {
      const std::uint64_t shown_scene = wholeOf(root_, "scene", "it", 0);
      for (const Json& node : listIn(item("scenes", shown_scene), "nodes")) top.push_back(indexOf(node, "a scene"));
      return top;
    }
    // a file without a scene is a library: everything in it
    std::vector<bool> below(listIn(root_, "nodes").size(), false);
    for (const Json& node : listIn(root_, "nodes"))
      for (const Json& child : listIn(node, "children"))
        if (const std::uint64_t c = indexOf(child, "a node"); c < below.size()) below[c] = true;
    for (std::uint64_t k = 0; k < below.size(); ++k)
      if (!below[k]) top.push_back(k);
    return top;
  }

  static std::uint64_t indexOf(const Json& value, const std::string& where) {
    if (!value.is_number_unsigned()) failGltf("a number in a list of " + where + " is not a whole number from 0");
    return value.get<std::uint64_t>();
  }

  void readNodes() {
    struct Visit {
      std::uint64_t node;
      Eigen::Matrix4d parent;
    };
    std::vector<Visit> open;
    for (const std::uint64_t node : roots()) open.push_back({node, Eigen::Matrix4d::Identity()});
    std::vector<bool> seen(listIn(root_, "nodes").size(), false);
    if (seen.empty())
      for (std::uint64_t k = 0; k < listIn(root_, "meshes").size(); ++k)
        addMesh(k, Json::object(), Eigen::Matrix4d::Identity());
    while (!open.empty()) {
      const Visit visit = open.back();
      open.pop_back();
      const Json& node = item("nodes", visit.node);
      if (seen[visit.node]) failGltf(nameOf("nodes", visit.node) + " is below more than one node, or below itself");
      seen[visit.node] = true;
      const Eigen::Matrix4d transform = visit.parent * transformOf(node, nameOf("nodes", visit.node));
      if (node.find("mesh") != node.end()) {
        if (node.find("skin") != node.end())
          throw Error(nameOf("nodes", visit.node) +
                      " has a skin, which is not supported; apply the armature, and export without skins");
        addMesh(wholeOf(node, "mesh", "a node"), node, transform);
      }
      for (const Json& child : listIn(node, "children")) open.push_back({indexOf(child, "a node"), transform});
    }
  }

  static Eigen::Matrix4d transformOf(const Json& node, const std::string& where) {
    const std::vector<double> matrix = numbersIn(node, "matrix", 16, where);
    if (!matrix.empty()) return Eigen::Map<const Eigen::Matrix4d>(matrix.data());  // by columns, as in glTF
    const std::vector<double> t = numbersIn(node, "translation", 3, where), r = numbersIn(node, "rotation", 4, where),
                              s = numbersIn(node, "scale", 3, where);
    Eigen::Affine3d map = Eigen::Affine3d::Identity();
    if (!t.empty()) map.translate(Eigen::Vector3d(t[0], t[1], t[2]));
    if (!r.empty()) map.rotate(Eigen::Quaterniond(r[3], r[0], r[1], r[2]).normalized());
    if (!s.empty()) map.scale(Eigen::Vector3d(s[0], s[1], s[2]));
    return map.matrix();
  }

  void addMesh(std::uint64_t index, const Json& node, const Eigen::Matrix4d& transform) {
    const Json& mesh = item("meshes", index);
    shows_mesh_ = true;
    const Json& weights = node.find("weights") != node.end() ? listIn(node, "weights") : listIn(mesh, "weights");
    int number = 0;
    for (const Json& primitive : listIn(mesh, "primitives")) {
      const std::string where = nameOf("meshes", index) + ".primitives[" + std::to_string(number++) + "]";
      const std::uint64_t mode = wholeOf(primitive, "mode", where, 4);
      if (mode > 6) failGltf(where + " has the mode " + std::to_string(mode) + ", which glTF 2.0 does not have");
      const auto attributes = primitive.find("attributes");
      // points and lines enclose nothing; what has no positions is not shown
      if (mode < 4 || attributes == primitive.end() || attributes->find("POSITION") == attributes->end()) continue;
      addPrimitive(primitive, mode, weights, transform, where);
    }
  }

  void addPrimitive(const Json& primitive, std::uint64_t mode, const Json& weights, const Eigen::Matrix4d& transform,
                    const std::string& where) {
    std::vector<double> p = numbers(wholeOf(primitive.at("attributes"), "POSITION", where), "VEC3");
    addMorphs(primitive, weights, where, p);
    const std::size_t count = p.size() / 3;
    std::vector<double> order;
    if (primitive.find("indices") != primitive.end()) {
      order = numbers(wholeOf(primitive, "indices", where), "SCALAR");
    } else {
      for (std::size_t k = 0; k < count; ++k) order.push_back(static_cast<double>(k));
    }
    for (const double v : order)
      if (!(v < static_cast<double>(count)))
        failGltf(where + " names vertex " + std::to_string(static_cast<std::uint64_t>(v)) + ", but has 0 to " +
                 std::to_string(static_cast<std::int64_t>(count) - 1));
    const int first = static_cast<int>(mesh_.vertices.size());
    for (std::size_t k = 0; k < count; ++k)
      mesh_.vertices.emplace_back((transform * Eigen::Vector4d(p[3 * k], p[3 * k + 1], p[3 * k + 2], 1)).head<3>());
    addTriangles(order, mode, first, transform.topLeftCorner<3, 3>().determinant() < 0, where);
  }

  /// Triangles, a strip or a fan. A mirrored one faces the other way.
  void addTriangles(const std::vector<double>& order, std::uint64_t mode, int first, bool mirrored,
                    const std::string& where) {
    const std::size_t step = mode == 4 ? 3 : 1;
    if (mode == 4 && order.size() % 3 != 0)
      failGltf(where + " has " + std::to_string(order.size()) + " corners, which is no multiple of three");
    for (std::size_t k = 0; k + 2 < order.size(); k += step) {
      const std::size_t odd = mode == 5 && k % 2 == 1 ? 1 : 0;
      std::array<int, 3> t{first + static_cast<int>(order[mode == 6 ? 0 : k]),
                           first + static_cast<int>(order[k + 1 + odd]), first + static_cast<int>(order[k + 2 - odd])};
      if (mirrored) std::swap(t[1], t[2]);
      mesh_.triangles.push_back(t);
    }
    if (mesh_.triangles.size() > kMostTriangles || mesh_.vertices.size() > kMostTriangles)
      throw Error("shows more than " + std::to_string(kMostTriangles) + " triangles or vertices; reduce the surface");
  }

  void addMorphs(const Json& primitive, const Json& weights, const std::string& where, std::vector<double>& p) {
    const Json& targets = listIn(primitive, "targets");
    for (std::size_t k = 0; k < targets.size() && k < weights.size(); ++k) {
      const double weight = weights[k].is_number() ? weights[k].get<double>() : 0;
      if (weight == 0 || targets[k].find("POSITION") == targets[k].end()) continue;
      const std::vector<double> d = numbers(wholeOf(targets[k], "POSITION", where), "VEC3");
      if (d.size() != p.size()) failGltf("a morph target of " + where + " has another number of vertices");
      for (std::size_t i = 0; i < p.size(); ++i) p[i] += weight * d[i];
    }
  }

  /// The numbers of an accessor: three for each vertex, or one.
  std::vector<double> numbers(std::uint64_t index, const std::string& type) {
    const Json& accessor = item("accessors", index);
    const std::string where = nameOf("accessors", index);
    if (textOf(accessor, "type") != type) failGltf(where + " is not of the type " + type);
    const std::uint64_t component = wholeOf(accessor, "componentType", where);
    if (type == "VEC3" ? component == 5125 : component == 5126 || component == 5120 || component == 5122)
      failGltf(where + " has the componentType " + std::to_string(component) + ", which is not allowed there");
    const std::uint64_t width = type == "VEC3" ? 3 : 1, count = wholeOf(accessor, "count", where);
    std::vector<double> values;
    if (accessor.find("bufferView") != accessor.end()) {
      values = packed(accessor, component, width, count, where);
    } else if (count <= kMostNumbers / width) {
      values.assign(count * width, 0);
    } else {
      failGltf(where + " has " + std::to_string(count) + " elements but no data");
    }
    if (accessor.find("sparse") != accessor.end()) replaceSome(accessor, component, width, values, where);
    const auto normalised = accessor.find("normalized");
    if (normalised != accessor.end() && normalised->is_boolean() && normalised->get<bool>()) {
      const double scale = gltfComponent(component, where).scale;
      for (double& value : values) value = std::max(value / scale, -1.0);
    }
    return values;
  }

  /// `count` elements of `width` numbers in a view of a buffer.
  std::vector<double> packed(const Json& place, std::uint64_t component, std::uint64_t width, std::uint64_t count,
                             const std::string& where) {
    const std::uint64_t view_index = wholeOf(place, "bufferView", where);
    const Json& view = item("bufferViews", view_index);
    const std::string name = nameOf("bufferViews", view_index);
    const GltfComponent stored = gltfComponent(component, where);
    const std::uint64_t size = stored.size;
    const std::uint64_t stride = wholeOf(view, "byteStride", name, static_cast<std::int64_t>(size * width));
    const std::uint64_t offset = wholeOf(place, "byteOffset", where, 0);
    const std::string_view bytes = bytesOf(view, name);
    const bool fits =
        count == 0 ||
        (offset <= bytes.size() && size * width <= bytes.size() - offset &&
         (count == 1 || (stride >= size * width && count - 1 <= (bytes.size() - offset - size * width) / stride)));
    if (!fits) failGltf(where + " reaches beyond " + name + " or has a stride that is too small");
    std::vector<double> values;
    values.reserve(count * width);
    for (std::uint64_t k = 0; k < count; ++k)
      for (std::uint64_t c = 0; c < width; ++c)
        values.push_back(stored.read(bytes.data() + offset + k * stride + c * size));
    return values;
  }

  void replaceSome(const Json& accessor, std::uint64_t component, std::uint64_t width, std::vector<double>& values,
                   const std::string& where) {
    const std::string name = where + ".sparse";
    const Json& sparse = objectOf(accessor, "sparse", where);
    const std::uint64_t count = wholeOf(sparse, "count", name);
    const Json &at = objectOf(sparse, "indices", name), &with = objectOf(sparse, "values", name);
    const std::vector<double> places = packed(at, wholeOf(at, "componentType", name), 1, count, name);
    const std::vector<double> numbers = packed(with, component, width, count, name);
    for (std::uint64_t k = 0; k < count; ++k) {
      if (!(places[k] >= 0 && places[k] < static_cast<double>(values.size() / width)))
        failGltf(name + " names an element that is not there");
      const auto element = static_cast<std::uint64_t>(places[k]);
      std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(k * width), width,
                  values.begin() + static_cast<std::ptrdiff_t>(element * width));
    }
  }

  std::string_view bytesOf(const Json& view, const std::string& where) {
    const std::uint64_t index = wholeOf(view, "buffer", where), offset = wholeOf(view, "byteOffset", where, 0),
                        length = wholeOf(view, "byteLength", where);
    const std::string_view data = buffer(index);
    if (offset > data.size() || length > data.size() - offset)
      failGltf(where + " reaches beyond " + nameOf("buffers", index));
    return data.substr(offset, length);
  }

  std::string_view buffer(std::uint64_t index) {
    const Json& entry = item("buffers", index);
    const std::string where = nameOf("buffers", index);
    const auto uri = entry.find("uri");
    const bool inside = uri == entry.end() && index == 0 && parts_.has_binary;
    if (!inside && buffers_.count(index) == 0) buffers_[index] = loadBuffer(entry, textOf(entry, "uri"), where);
    const std::string_view data = inside ? parts_.binary : std::string_view(buffers_[index]);
    const std::uint64_t length = wholeOf(entry, "byteLength", where);
    if (length > data.size())
      failGltf(where + " states " + std::to_string(length) + " bytes, but there are " + std::to_string(data.size()));
    return data.substr(0, length);
  }

  std::string loadBuffer(const Json& entry, const std::string& uri, const std::string& where) const {
    if (uri.empty()) {
      const auto extensions = entry.find("extensions");
      const bool named = extensions != entry.end() && extensions->is_object() && !extensions->empty();
      throw Error(where + " has no data" +
                  (named ? ", only those of the extension " + shown(extensions->begin().key()) +
                               ", which is not supported; export it without"
                         : "; write the file anew"));
    }
    if (uri.rfind("data:", 0) == 0) {
      const std::size_t comma = uri.find(',');
      const std::string head = uri.substr(0, comma);
      if (comma == std::string::npos || head.size() < 7 || head.compare(head.size() - 7, 7, ";base64") != 0)
        throw Error("the data URI of " + where + " is not in base64, which alone is supported; write the file anew");
      return decodeBase64(std::string_view(uri).substr(comma + 1), where);
    }
    const std::size_t scheme = uri.find(':');
    if (scheme != std::string::npos && uri.find('/') > scheme)
      throw Error(where + " is at " + shown(uri) +
                  ", which is not a file beside this one; put it there, or export as GLB");
    return file_(decodePercent(uri));
  }

  const GltfParts parts_;
  const std::function<std::string(const std::string&)>& file_;
  Json root_;
  std::map<std::uint64_t, std::string> buffers_;
  SurfaceMesh mesh_;
  bool shows_mesh_ = false;
};

}  // namespace

SurfaceMesh readGltf(const std::string& content, const std::function<std::string(const std::string&)>& file) {
  GltfParts parts;
  if (content.compare(0, 4, "glTF") == 0) {
    parts = partsOfGlb(content);
  } else {
    parts.json = content;
  }
  try {
    return GltfReader(parts, file).read();
  } catch (const Json::exception& error) {
    failGltf("its JSON is not that of glTF 2.0 (" + std::string(error.what()) + ")");
  }
}

}  // namespace vibe
