#include "vibe_core/simulation/snapshot.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>

#include "simulation/state_check.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/files/fnv1a.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/state/state_fields.hpp"

namespace vibe {

namespace {

constexpr std::uint64_t kMaxGrowth = 1 << 16;  // items; memory grows only with what has been read
constexpr char kMagic[7] = {'v', 'i', 'b', 'e', 's', 'n', 'p'};
// In one character: 1 to 9, then from A on.
constexpr char kVersion = static_cast<char>(kStateVersion < 10 ? '0' + kStateVersion : 'A' + kStateVersion - 10);
int numberOf(char version) {
  return version <= '9' ? version - '0' : version - 'A' + 10;
}
static_assert(kVersion <= 'Z', "the version is one character in the first eight bytes");

class Writer {
 public:
  explicit Writer(std::ostream& out) : out_(out) {}
  template <class T>
  void block(const T* data, std::size_t count) {
    out_.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(count * sizeof(T)));
    sum_.add(data, count * sizeof(T));
  }
  /// Of everything so far.
  void checksum() {
    const std::uint64_t sum = sum_.result();
    block(&sum, 1);
  }
  template <class T>
  void list(const std::vector<T>& items) {
    transferList(*this, items);
  }

 private:
  std::ostream& out_;
  Fnv1a sum_;
};

class Reader {
 public:
  Reader(std::istream& in, std::string file) : in_(in), file_(std::move(file)) {}
  template <class T>
  void block(T* data, std::size_t count) {
    in_.read(reinterpret_cast<char*>(data), static_cast<std::streamsize>(count * sizeof(T)));
    if (!in_) throw Error("Snapshot '" + file_ + "' ends too early; save it again.");
    sum_.add(data, count * sizeof(T));
  }
  void checksum() {
    const std::uint64_t sum = sum_.result();
    std::uint64_t written = 0;
    block(&written, 1);
    if (written != sum)
      throw Error("Snapshot '" + file_ + "' is damaged: its checksum does not fit what is in it; save it again.");
  }
  void block(bool* data, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      std::uint8_t byte = 0;
      block(&byte, 1);
      if (byte > 1)
        throw Error("Snapshot '" + file_ + "' is damaged: a flag in it is neither set nor clear; save it again.");
      data[i] = byte == 1;
    }
  }
  // A damaged size must end at the end of the file, not with all memory.
  template <class T>
  void list(std::vector<T>& items) {
    std::uint64_t size = 0;
    block(&size, 1);
    items.clear();
    if constexpr (fields::kPlain<T>) {
      while (items.size() < size) {
        const std::size_t begin = items.size();
        items.resize(begin + std::min<std::uint64_t>(size - begin, kMaxGrowth));
        block(items.data() + begin, items.size() - begin);
      }
    } else {
      for (std::uint64_t i = 0; i < size; ++i) transfer(*this, items.emplace_back());
    }
  }

 private:
  std::istream& in_;
  std::string file_;
  Fnv1a sum_;
};

template <class T>
void add(const std::vector<T>& values, Fnv1a& hash) {
  hash.add(values.data(), values.size() * sizeof(T));
}

void writeHeader(const Model& model, Writer& writer) {
  const std::uint64_t fields = fieldFingerprint<State>();
  const std::uint64_t shape = modelFingerprint(model), scene = sceneFingerprint(model);
  writer.block(kMagic, sizeof kMagic);
  writer.block(&kVersion, 1);
  writer.block(&fields, 1);
  writer.block(&shape, 1);
  writer.block(&scene, 1);
}

// @returns whether the snapshot is of this very scene
bool readHeader(const Model& model, const std::string& file, OtherScene other, Reader& reader) {
  char magic[sizeof kMagic] = {}, version = 0;
  reader.block(magic, sizeof magic);
  reader.block(&version, 1);
  if (std::memcmp(magic, kMagic, sizeof kMagic) != 0 || version < '1' || version > 'Z')
    throw Error("'" + file + "' is not a snapshot; check the path.");
  if (version != kVersion)
    throw Error("Snapshot '" + file + "' is of version " + std::to_string(numberOf(version)) +
                ", but this build reads version " + std::to_string(kStateVersion) + "; save it again with this build.");
  std::uint64_t fields = 0, shape = 0, scene = 0;
  reader.block(&fields, 1);
  if (fields != fieldFingerprint<State>())
    throw Error("Snapshot '" + file + "' is of version " + std::to_string(numberOf(version)) +
                " but has other fields than this build; save it again with this build.");
  reader.block(&shape, 1);
  reader.block(&scene, 1);
  if (shape != modelFingerprint(model))
    throw Error("Snapshot '" + file + "' belongs to another scene; load the scene it was saved with first.");
  if (other == OtherScene::Refused && scene != sceneFingerprint(model))
    throw Error("Snapshot '" + file +
                "' is of the same organ but of a scene with other values; load the scene it was saved with first, or "
                "take it as one of another scene.");
  return scene == sceneFingerprint(model);
}

State readSnapshot(const Model& model, std::istream& in, const std::string& file, OtherScene other) {
  Reader reader(in, file);
  const bool same_scene = readHeader(model, file, other, reader);
  State state;
  transfer(reader, state);
  const std::string damage = findDamage(state, model);
  if (!damage.empty()) throw Error("Snapshot '" + file + "' is damaged: " + damage + "; save it again.");
  reader.checksum();
  if (in.peek() != std::istream::traits_type::eof())
    throw Error("Snapshot '" + file + "' is longer than a state; save it again.");
  if (!same_scene) state.hold = {};  // tool or wall may have another thickness
  return state;
}

}  // namespace

std::uint64_t modelFingerprint(const Model& model) {
  Fnv1a hash;
  for (const Eigen::Vector3d& p : model.organ.surface.vertices) hash.add(p.data(), 3 * sizeof(double));
  add(model.mass, hash);
  add(model.inverse_mass, hash);
  hash.add(&model.scene.step_period, sizeof model.scene.step_period);
  hash.add(&model.substeps, sizeof model.substeps);
  hash.add(model.scene.tissue.model.data(), model.scene.tissue.model.size());
  for (bool part : {model.scene.scope.has_value(), model.scene.helix.has_value(), model.scene.suture.has_value(),
                    model.scene.marking.has_value()})
    hash.add(&part, sizeof part);
  return hash.result();
}

std::uint64_t sceneFingerprint(const Model& model) {
  Scene scene = model.scene;
  scene.name = Scene().name;
  scene.seed = Scene().seed;  // the state holds the generator
  scene.render_surface = false;
  scene.geometry = GeometryScene();  // modelFingerprint() has what was made of it, wherever the files are
  if (scene.scope) scene.scope->urdf = "";
  Fnv1a hash;
  const std::string text = toYaml(scene);
  hash.add(text.data(), text.size());
  if (model.tool) hash.add(model.tool->limits().data(), sizeof model.tool->limits());
  hash.add(model.tool_base.data(), sizeof(double) * 16);
  return hash.result();
}

std::string encodeSnapshot(const Model& model, const State& state) {
  std::ostringstream out;
  Writer writer(out);
  writeHeader(model, writer);
  transfer(writer, state);
  writer.checksum();
  return out.str();
}

void saveSnapshot(const Model& model, const State& state, const std::string& file) {
  writeFile(file, encodeSnapshot(model, state), "Snapshot");
}

State decodeSnapshot(const Model& model, const std::string& bytes, const std::string& place, OtherScene other) {
  std::istringstream in(bytes);
  return readSnapshot(model, in, place, other);
}

State loadSnapshot(const Model& model, const std::string& file, OtherScene other) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error("Snapshot '" + file + "' cannot be opened; check the path.");
  return readSnapshot(model, in, file, other);
}

}  // namespace vibe
