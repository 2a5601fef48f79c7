#include "geometry/assimp_reader.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "environment_variable.hpp"
#include "geometry/mesh_stream.hpp"
#include "geometry/mesh_writer.hpp"
#include "geometry/test_surfaces.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe::assimp_reader_test {
namespace {

using test::EnvironmentVariable;
using test::makeBox;
using test::TemporaryFolder;

/// A mesh file, and programs that stand in for the mesh reader.
class MeshReader : public ::testing::Test {
 protected:
  /// A shell script instead of the program; the file is "$1".
  EnvironmentVariable standIn(const std::string& script) const {
    const std::string program = folder.write("stand_in", "#!/bin/sh\n" + script + "\n");
    chmod(program.c_str(), 0700);
    return EnvironmentVariable("VIBE_MESH_READER", program);
  }

  std::string refusal(const WorkLimits& limits = {}) const {
    try {
      readWithAssimp(file, limits);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  std::string sentence(const std::string& clause) const {
    return "geometry.file: " + file + " cannot be read (" + clause + "); export it again";
  }

  // every program has ended and is waited for
  static bool noChildIsLeft() { return waitpid(-1, nullptr, WNOHANG) == -1 && errno == ECHILD; }

  TemporaryFolder folder;
  std::string file = folder.write("mesh.stl", test::toStl(makeBox(0.1, 0.2, 0.3)));
};

TEST_F(MeshReader, readsASurface) {
  const SurfaceMesh mesh = readWithAssimp(file);
  EXPECT_EQ(mesh.triangles.size(), makeBox(0.1, 0.2, 0.3).triangles.size());
  EXPECT_TRUE(noChildIsLeft());
}

/// A tetrahedron as glTF whose numbers are in another file.
std::string toGltf(const std::string& uri) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"buffers":[{"byteLength":72,"uri":")" +
         uri +
         R"("}],"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
         R"({"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}]})";
}

std::string tetrahedron() {
  const float corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::uint16_t faces[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
  return std::string(reinterpret_cast<const char*>(corners), sizeof corners) +
         std::string(reinterpret_cast<const char*>(faces), sizeof faces);
}

TEST_F(MeshReader, readsWhatAGltfNamesInItsFolderOnly) {
  folder.write("numbers.bin", tetrahedron());
  file = folder.write("tetra.gltf", toGltf("numbers.bin"));
  EXPECT_EQ(readWithAssimp(file).triangles.size(), 4U);
  std::filesystem::create_directory(folder.path() + "/below");
  file = folder.write("below/tetra.gltf", toGltf("../numbers.bin"));
  EXPECT_NE(refusal().find("numbers.bin', which is not in its folder"), std::string::npos) << refusal();
}

TEST_F(MeshReader, answersACrashOfTheReaderWithOneSentence) {
  const std::vector<std::string> crashes{"kill -SEGV $$", "kill -ABRT $$", "kill -KILL $$", "exit 3",
                                         "printf VIBEMESH; kill -SEGV $$"};
  for (const std::string& crash : crashes) {
    const EnvironmentVariable reader = standIn(crash);
    EXPECT_EQ(refusal(), sentence("its content stops the reader")) << crash;
  }
  EXPECT_TRUE(noChildIsLeft());
}

TEST_F(MeshReader, endsAReaderThatHangs) {
  for (const std::string hang :
       {"exec sleep 100", "trap '' TERM ALRM; exec sleep 100", "printf VIBEMESH; exec sleep 100"}) {
    const EnvironmentVariable reader = standIn(hang);
    WorkLimits limits;
    limits.seconds = 1;
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(refusal(limits), sentence("it takes more than 1 s")) << hang;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20)) << hang;
  }
  EXPECT_TRUE(noChildIsLeft());
}

TEST_F(MeshReader, endsAReaderThatWritesWithoutEnd) {
  const EnvironmentVariable reader = standIn("exec cat /dev/zero");
  WorkLimits limits;
  limits.memory = 1 << 20;
  EXPECT_EQ(refusal(limits), sentence("its surface needs more than 1048576 bytes"));
  EXPECT_TRUE(noChildIsLeft());
}

TEST_F(MeshReader, refusesAnAnswerThatIsNoSurface) {
  for (const std::string answer :
       {"true", "printf VIBE", "printf VIBEMESH", "echo hello, I am no mesh reader at all"}) {
    const EnvironmentVariable reader = standIn(answer);
    EXPECT_EQ(refusal(), sentence("the reader returns no complete surface")) << answer;
  }
}

TEST_F(MeshReader, handsOnTheReasonTheReaderGives) {
  const EnvironmentVariable reader = standIn("printf 'VIBEFAILno\\nluck'");
  EXPECT_EQ(refusal(), sentence("no luck"));
}

TEST_F(MeshReader, appliesTheLimitOnMemory) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer reserves more address space than any limit allows";
#endif
  // 19800 triangles, which become some megabytes
  const std::string large = folder.write("large.obj", test::toObj(test::makeUvSphere(0.1, 100, 100)));
  WorkLimits limits;
  EXPECT_NO_THROW(readWithAssimp(large, limits));
  limits.memory = 1 << 20;  // less than the program has before it begins
  EXPECT_THROW(readWithAssimp(large, limits), Error);
}

TEST_F(MeshReader, saysSoIfTheProgramIsMissing) {
  const EnvironmentVariable reader("VIBE_MESH_READER", folder.path() + "/none");
  EXPECT_EQ(refusal(), sentence("no process can be started: No such file or directory"));
}

TEST_F(MeshReader, givesTheProgramNoFileOfTheCaller) {
  const EnvironmentVariable reader = standIn("printf VIBEFAIL; ls /proc/self/fd | wc -l");
  const std::ifstream open_here(file);
  // 0, 1, 2 and the folder that ls lists
  EXPECT_EQ(refusal(), sentence("4 "));
}

// The node has threads, some of which hold locks at any moment: a fork without exec could wait for them for ever.
TEST_F(MeshReader, worksInSeveralThreadsAtOnce) {
  std::vector<std::thread> threads;
  std::vector<std::size_t> triangles(4, 0);
  for (std::size_t k = 0; k < triangles.size(); ++k)
    threads.emplace_back([&, k] {
      for (int repeat = 0; repeat < 5; ++repeat) triangles[k] += readWithAssimp(file).triangles.size();
    });
  for (auto& thread : threads) thread.join();
  for (const std::size_t count : triangles) EXPECT_EQ(count, 5 * makeBox(0.1, 0.2, 0.3).triangles.size());
  EXPECT_TRUE(noChildIsLeft());
}

TEST(MeshStream, returnsWhatItIsGiven) {
  SurfaceMesh mesh = makeBox(0.1, 0.2, 0.3);
  mesh.vertices[1].x() = std::numeric_limits<double>::infinity();
  mesh.triangles[2][1] = -7;  // the check of a mesh's numbers comes later and names the place
  const SurfaceMesh back = unpackMesh(packMesh(mesh));
  EXPECT_EQ(back.triangles, mesh.triangles);
  ASSERT_EQ(back.vertices.size(), mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) EXPECT_EQ(back.vertices[v], mesh.vertices[v]);
}

TEST(MeshStream, refusesBytesThatAreTooManyOrTooFew) {
  const std::string bytes = packMesh(makeBox(0.1, 0.2, 0.3));
  EXPECT_NO_THROW(unpackMesh(bytes));  // control
  EXPECT_THROW(unpackMesh(bytes + "x"), Error);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(unpackMesh(bytes.substr(0, size)), Error) << size;
  std::string huge = bytes;
  for (std::size_t at = 8; at < 24; ++at) huge[at] = '\xff';
  EXPECT_THROW(unpackMesh(huge), Error);
}

}  // namespace
}  // namespace vibe::assimp_reader_test
