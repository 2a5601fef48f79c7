// Compares the times of the sparse factor with those of CHOLMOD (supernodal), on the stiffness of a stomach and of a
// block.
#include <time.h>

#include <Eigen/CholmodSupport>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <string>

#include "sparse/eigen_matrix.hpp"
#include "sparse/stiffness_worlds.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/common/package_path.hpp"

namespace {

using namespace vibe;

const char kHelp[] =
    "usage: vibe_factor [--scene FILE]\n"
    "Prints thread CPU times of the sparse Cholesky factor and of CHOLMOD: least and median of 15 repeats [ms].\n"
    "  --scene FILE      organ with tissue.model: shell (default: package://vibe_core/scenes/stomach.yaml)\n"
    "  --help            this text\n"
    "analyse: order of elimination, once per mesh; factor: once per linearization point, in the background;\n"
    "solve: several times per step. CHOLMOD calls the BLAS of the system, which decides its times.\n";

constexpr int kRepeats = 15;  // design choice: the median of this many runs is reproducible to a few percent

double threadTime() {  // [s]
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void print(const std::string& matrix, const std::string& method, const std::string& part,
           const std::function<void()>& work) {
  std::vector<double> times;
  for (int i = 0; i < kRepeats; ++i) {
    const double begin = threadTime();
    work();
    times.push_back(1e3 * (threadTime() - begin));
  }
  std::sort(times.begin(), times.end());
  std::printf("%-8s %-14s %-8s %9.3f %9.3f\n", matrix.c_str(), method.c_str(), part.c_str(), times.front(),
              times[kRepeats / 2]);
}

void solve(const Factor& factor, std::vector<float>& nodes4, std::vector<float>& vector) {
  factor.load(nodes4.data(), vector.data());
  factor.forward(vector.data());
  factor.backward(vector.data());
  factor.store(vector.data(), nodes4.data());
}

void printOwn(const std::string& name, const BlockMatrix& matrix) {
  std::shared_ptr<const FactorPlan> plan;
  print(name, "vibe", "analyse", [&] { plan = makeFactorPlan(matrix.pattern()); });
  for (const auto& [storage, method] :
       {std::pair(FactorStorage::Half, "vibe half"), std::pair(FactorStorage::Float, "vibe float")}) {
    Factor factor(plan, storage);
    print(name, method, "factor", [&] { factor.compute(matrix); });
    std::vector<float> nodes4(4 * static_cast<std::size_t>(matrix.pattern().size), 1.0F);
    std::vector<float> vector(static_cast<std::size_t>(factor.rows()) + 16, 0.0F);
    print(name, method, "solve", [&] {
      std::fill(nodes4.begin(), nodes4.end(), 1.0F);
      solve(factor, nodes4, vector);
    });
  }
}

void printCholmod(const std::string& name, const BlockMatrix& matrix) {
  const Eigen::SparseMatrix<double> a = test::eigenMatrix(matrix);
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> cholmod;
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(a.rows());
  Eigen::VectorXd x = b;
  print(name, "CHOLMOD double", "analyse", [&] { cholmod.analyzePattern(a); });
  print(name, "CHOLMOD double", "factor", [&] { cholmod.factorize(a); });
  print(name, "CHOLMOD double", "solve", [&] { x = cholmod.solve(b); });
}

void printTable(const std::string& scene) {
  std::printf("%-8s %-14s %-8s %9s %9s\n", "matrix", "method", "part", "least", "median");
  for (const auto& [name, body] : {std::pair<std::string, ElasticBody>("stomach", test::stomachBody(scene)),
                                   std::pair<std::string, ElasticBody>("block", test::cantilever({14, 10, 8}))}) {
    const BlockMatrix matrix = test::stiffnessOf(body);
    std::printf("# %s: %d nodes\n", name.c_str(), matrix.pattern().size);
    printOwn(name, matrix);
    printCholmod(name, matrix);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    std::string scene = "package://vibe_core/scenes/stomach.yaml";
    for (int i = 1; i < argc; ++i) {
      const std::string option = argv[i];
      if (option == "--help") return std::fputs(kHelp, stdout), 0;
      if (option != "--scene" || i + 1 == argc)
        throw Error("'" + option + "' is no option of vibe_factor; see --help.");
      scene = argv[++i];
    }
    printTable(resolveAddress(scene));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vibe_factor: %s\n", error.what());
    return 2;
  }
  return 0;
}
