// Reads a mesh file with the Open Asset Import Library and writes its triangles to standard output, in the layout of
// geometry/mesh_stream.hpp. The simulator runs it as a process of its own, because damaged files can crash that
// library.
#include <assimp/scene.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <assimp/DefaultIOSystem.h>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>

#include "geometry/mesh_stream.hpp"
#include "vibe_core/common/error.hpp"

namespace {

using namespace vibe;

const char kHelp[] =
    "Usage: vibe_mesh_reader FILE SECONDS BYTES\n"
    "Writes the triangles of a mesh file to standard output, in the binary layout of geometry/mesh_stream.hpp.\n"
    "The simulator calls it to read meshes. It ends itself after SECONDS (at least 1) and uses at most BYTES of "
    "address\n"
    "space. Status 0: a surface, or the reason why the file cannot be read. Status 2: wrong call.\n";

void append(SurfaceMesh& mesh, const aiMesh& part, const aiMatrix4x4& transform) {
  const int first = static_cast<int>(mesh.vertices.size());
  for (unsigned v = 0; v < part.mNumVertices; ++v) {
    const aiVector3D p = transform * part.mVertices[v];
    mesh.vertices.emplace_back(p.x, p.y, p.z);
  }
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    // polygons become fans; points and lines have none
    for (unsigned k = 2; k < face.mNumIndices; ++k) {
      mesh.triangles.push_back({first + static_cast<int>(face.mIndices[0]),
                                first + static_cast<int>(face.mIndices[k - 1]),
                                first + static_cast<int>(face.mIndices[k])});
    }
  }
}

void append(SurfaceMesh& mesh, const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent) {
  const aiMatrix4x4 transform = parent * node.mTransformation;
  for (unsigned k = 0; k < node.mNumMeshes; ++k) append(mesh, *scene.mMeshes[node.mMeshes[k]], transform);
  for (unsigned k = 0; k < node.mNumChildren; ++k) append(mesh, scene, *node.mChildren[k], transform);
}

/// Opens files in the folder of the mesh and below only: a file from elsewhere may name any other of this machine.
class FolderFiles : public Assimp::DefaultIOSystem {
 public:
  explicit FolderFiles(const std::string& mesh) : folder_(std::filesystem::weakly_canonical(mesh).parent_path()) {}

  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (isInside(file)) return DefaultIOSystem::Open(file, mode);
    refused_ = file;
    return nullptr;
  }

  const std::string& refused() const { return refused_; }

 private:
  bool isInside(const char* file) const {
    const std::filesystem::path path = std::filesystem::weakly_canonical(file);
    return std::mismatch(folder_.begin(), folder_.end(), path.begin(), path.end()).first == folder_.end();
  }

  const std::filesystem::path folder_;
  std::string refused_;  // the last one
};

SurfaceMesh readHere(const std::string& path) {
  Assimp::Importer importer;
  auto* files = new FolderFiles(path);
  importer.SetIOHandler(files);  // owns it
  const aiScene* scene = importer.ReadFile(path, 0);
  const bool failed = scene == nullptr || scene->mRootNode == nullptr;
  // materials may be elsewhere; they are not needed
  if (failed && !files->refused().empty())
    throw Error("it names '" + files->refused() + "', which is not in its folder");
  if (failed) throw Error(importer.GetErrorString());
  SurfaceMesh mesh;
  append(mesh, *scene, *scene->mRootNode, aiMatrix4x4());
  return mesh;
}

/// A number above zero, or 0 if the text is none.
unsigned long long toNumber(const char* text) {
  char* end = nullptr;
  const unsigned long long value = std::strtoull(text, &end, 10);
  return *text == '\0' || *text == '-' || *end != '\0' ? 0 : value;
}

/// No core file, a limit on memory, and an end even if the caller is gone.
void applyLimits(unsigned seconds, rlim_t bytes) {
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
#ifdef __SANITIZE_ADDRESS__
  (void)bytes;  // the sanitizer reserves more address space than any limit allows
#else
  const rlimit memory{bytes, bytes};
  setrlimit(RLIMIT_AS, &memory);
#endif
  alarm(seconds);
}

/// Standard output as a file of its own; what the import library prints does not get into the answer.
int takeOutput() {
  const int output = dup(STDOUT_FILENO);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  return output;
}

bool writeAll(int output, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = write(output, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno != EINTR) return false;
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  return true;
}

std::string answerFor(const std::string& path) {
  try {
    return packMesh(readHere(path));
  } catch (const std::exception& error) {
    return packFailure(error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string(argv[1]) == "--help") return std::fputs(kHelp, stdout) < 0 ? 1 : 0;
  const auto seconds = argc == 4 ? toNumber(argv[2]) : 0;
  const auto bytes = argc == 4 ? toNumber(argv[3]) : 0;
  if (seconds == 0 || bytes == 0 || seconds > 86400) {
    std::fputs("vibe_mesh_reader: give a file, a number of seconds and a number of bytes; see --help.\n", stderr);
    return 2;
  }
  applyLimits(static_cast<unsigned>(seconds), static_cast<rlim_t>(bytes));
  const int output = takeOutput();
  const bool written = writeAll(output, answerFor(argv[1]));
  _exit(written ? 0 : 1);  // a damaged file may have left the import library unable to clean up
}
