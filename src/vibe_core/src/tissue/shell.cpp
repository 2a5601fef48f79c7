#include "vibe_core/tissue/shell.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Dense>

#include "tissue/shell_fibres.hpp"
#include "tissue/shell_kernel.hpp"
#include "tissue/shell_part.hpp"

namespace vibe {

namespace {

constexpr int kTrianglesPerPiece = 2000;  // with fewer, a second thread does not pay off
constexpr int kTrianglePieces = 8;
constexpr int kReferenceSteps = 12;  // of Newton's method for the stretch across the wall, in double precision

}  // namespace

ShellElements::ShellElements(ShellMesh mesh, const Eigen::Vector3d& origin)
    : ShellElements(std::move(mesh), origin, shellKernel()) {}

ShellElements::ShellElements(ShellMesh mesh, const Eigen::Vector3d& origin, const ShellKernel& kernel)
    : mesh_(std::move(mesh)), origin_(origin), kernel_(std::make_unique<const ShellKernel>(kernel)) {
  checkMesh();
  for (std::size_t m = 0; m < mesh_.materials.size(); ++m) {
    checkMaterial(mesh_.materials[m], "material " + std::to_string(m) + " of the shell");
    constants_.push_back(lawConstants(mesh_.materials[m]));
  }
  findNeighbours();
  measure();
  measureFibres();
  measureMuscle();
  makeBatches();
}

ShellElements::~ShellElements() = default;

const double* ShellElements::rest(std::size_t triangle) const {
  return rest_.data() + triangle * kShellMuscleRows;
}

void ShellElements::makeBatches() {
  constexpr int kRows[] = {kShellRows, kShellGhostRows, kShellMuscleRows};
  std::vector<std::vector<int>> groups(3 * mesh_.materials.size());
  for (std::size_t e = 0; e < mesh_.triangles.size(); ++e) {
    const std::size_t kind = atBoundary(e) ? 1 : hasMuscle(e) ? 2 : 0;
    groups[3 * static_cast<std::size_t>(materialOf(e)) + kind].push_back(static_cast<int>(e));
  }
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (!groups[g].empty()) addRun(groups[g], static_cast<int>(g / 3), kRows[g % 3]);
  piece_count_ = static_cast<int>(mesh_.triangles.size()) > kTrianglesPerPiece ? kTrianglePieces : 1;
}

// Elements adjacent in the mesh are adjacent in its order. They are placed in the same lane of successive batches, not
// in the lanes of one batch: adding to a node that the previous lane has just written would stall.
void ShellElements::addRun(const std::vector<int>& triangles, int material, int rows) {
  const int count = static_cast<int>(triangles.size()), batches = (count + kBatchLanes - 1) / kBatchLanes;
  runs_.push_back({batch_count_, batch_count_ + batches, material, rows, batch_rest_.size()});
  for (int window = 0; window < batches; window += kWindow) {
    const int length = std::min(kWindow, batches - window);
    for (int step = 0; step < length; ++step) {
      std::vector<int> lanes(kBatchLanes);
      for (int lane = 0; lane < kBatchLanes; ++lane) {
        const int slot = window * kBatchLanes + lane * length + step;
        lanes[static_cast<std::size_t>(lane)] = slot < count ? triangles[static_cast<std::size_t>(slot)] : -1;
      }
      addBatch(lanes, rows);
    }
  }
}

void ShellElements::addBatch(const std::vector<int>& triangles, int rows) {
  const int filler = *std::max_element(triangles.begin(), triangles.end());  // -1: the lane is empty
  const std::size_t node = batch_node_.size(), row = batch_rest_.size();
  batch_node_.resize(node + 6);
  batch_rest_.resize(row + static_cast<std::size_t>(rows));
  const std::size_t fibre = batch_fibre_.size();
  if (!fibre_rest_.empty()) batch_fibre_.resize(fibre + kFibreRows);
  for (std::size_t lane = 0; lane < kBatchLanes; ++lane) {
    const bool empty = triangles[lane] < 0;
    const std::size_t e = static_cast<std::size_t>(empty ? filler : triangles[lane]);
    for (int a = 0; a < 6; ++a) {
      // a ghost adds 0 to node 1; in an empty lane all nodes are that one
      const int real = patchNode(e, a) >= 0 && !empty ? patchNode(e, a) : patchNode(e, 0);
      batch_node_[node + static_cast<std::size_t>(a)].lane[lane] = 4 * static_cast<std::uint32_t>(real);
    }
    for (int k = 0; k < rows; ++k)
      batch_rest_[row + static_cast<std::size_t>(k)].lane[lane] = static_cast<float>(rest(e)[k]);
    for (int k = 0; k < kFibreRows && !fibre_rest_.empty(); ++k)
      batch_fibre_[fibre + static_cast<std::size_t>(k)].lane[lane] =
          empty ? 0.0F : static_cast<float>(fibre_rest_[kFibreRows * e + static_cast<std::size_t>(k)]);
    if (!empty) continue;
    // an empty lane has neither size nor energy
    const auto clear = [&](int k) { batch_rest_[row + static_cast<std::size_t>(k)].lane[lane] = 0; };
    for (int k = 0; k < 15; ++k) clear(kShellPatch + k);
    for (int k = 0; k < 3; ++k) clear(kShellSide + 4 * k + 3);
    clear(kShellBend);
  }
  ++batch_count_;
}

int ShellElements::firstBatch(int piece) const {
  return static_cast<int>(static_cast<std::int64_t>(batch_count_) * piece / piece_count_);
}

std::vector<ShellPart> ShellElements::partsOf(int count) const {
  std::vector<ShellPart> parts;
  if (count > piece_count_ || !batch_fibre_.empty()) return parts;
  std::vector<int> place(mesh_.nodes.size(), -1);
  for (int k = 0; k < count; ++k) {
    ShellPart part = makePart(piece_count_ * k / count, piece_count_ * (k + 1) / count, place);
    if (k > 0) parts.push_back(std::move(part));
  }
  return parts;
}

// In the order in which the kernel adds.
// @param place  per node: -1, or that a part before has it
ShellPart ShellElements::makePart(int first_piece, int last_piece, std::vector<int>& place) const {
  constexpr int kTaken = -2;
  const int first = firstBatch(first_piece), last = firstBatch(last_piece);
  ShellPart part{first_piece, last_piece, first, {}, {}, {}};
  part.node.assign(batch_node_.begin() + 6 * first, batch_node_.begin() + 6 * last);
  for (const BatchOffsets& offsets : part.node)
    for (const std::uint32_t offset : offsets.lane) {
      int& at = place[offset / 4];
      if (at != -1) continue;
      at = static_cast<int>(part.own.size());
      part.own.push_back(static_cast<int>(offset / 4));
    }
  for (BatchOffsets& offsets : part.node)
    for (std::uint32_t& offset : offsets.lane) {
      const int at = place[offset / 4];
      const std::size_t slot = at != kTaken ? static_cast<std::size_t>(at) : part.own.size() + part.copies.size();
      if (at == kTaken) part.copies.push_back(static_cast<int>(offset / 4));
      offset = 4 * static_cast<std::uint32_t>(slot);
    }
  for (const int node : part.own) place[static_cast<std::size_t>(node)] = kTaken;
  return part;
}

// What a sweep has to know of a run.
void ShellElements::setRun(const Run& run, ShellSweep& sweep) const {
  const auto material = static_cast<std::size_t>(run.material), rows = static_cast<std::size_t>(run.rows);
  sweep.rest = batch_rest_.data() + run.row + rows * static_cast<std::size_t>(sweep.first - run.first);
  sweep.rows = run.rows;
  sweep.law = mesh_.materials[material].law;
  sweep.poisson_ratio = mesh_.materials[material].poisson_ratio;
  sweep.constants = &constants_[material];
}

// @param first_node_batch  the batch with which the sweep's nodes begin
double ShellElements::evaluateRun(const Run& run, int first_node_batch, ShellSweep& sweep) const {
  setRun(run, sweep);
  if (!batch_fibre_.empty()) sweep.fibre = batch_fibre_.data() + static_cast<std::size_t>(kFibreRows * sweep.first);
  sweep.first -= first_node_batch, sweep.last -= first_node_batch;
  const double energy = kernel_->sweep(sweep);
  if (batch_fibre_.empty()) return energy;
  sweep.fibre_stiffening = mesh_.fibres.stiffening;
  return energy + kernel_->fibres(sweep);
}

double ShellElements::muscleWork(const float* displacement4, const float* contraction) const {
  double energy = 0;
  for (const Run& run : runs_) {
    if (run.rows != kShellMuscleRows) continue;
    ShellSweep sweep{};
    sweep.node = batch_node_.data();
    sweep.displacement4 = displacement4, sweep.next = contraction;
    sweep.first = run.first, sweep.last = run.last;
    setRun(run, sweep);
    energy += kernel_->muscle(sweep);
  }
  return energy;
}

// The sum of a function of the kernel over all runs.
double ShellElements::sweepRuns(double (*function)(ShellSweep&), ShellSweep sweep) const {
  double sum = 0;
  sweep.node = batch_node_.data();
  for (const Run& run : runs_) {
    sweep.first = run.first, sweep.last = run.last;
    setRun(run, sweep);
    if (!batch_fibre_.empty()) sweep.fibre = batch_fibre_.data() + static_cast<std::size_t>(kFibreRows * run.first);
    sweep.fibre_stiffening = mesh_.fibres.stiffening;
    sum += function(sweep);
  }
  return sum;
}

std::size_t ShellElements::stressCount() const {
  return static_cast<std::size_t>(batch_count_) * kStressRows * kBatchLanes;
}

double ShellElements::stress(const float* displacement4, float* out, float* strain) const {
  ShellSweep sweep{};
  sweep.displacement4 = displacement4, sweep.stress_out = out, sweep.strain_out = strain;
  const double energy = sweepRuns(kernel_->stress, sweep);
  return batch_fibre_.empty() ? energy : energy + sweepRuns(kernel_->fibre_stress, sweep);
}

double ShellElements::stressWork(const float* stress, const float* displacement4, float* gradient4) const {
  ShellSweep sweep{};
  sweep.displacement4 = displacement4, sweep.gradient4 = gradient4, sweep.stress = stress;
  return sweepRuns(kernel_->stress_work, sweep);
}

double ShellElements::evaluatePiece(int piece, ShellSweep sweep, int first_node_batch, double* volume,
                                    ConstantStress* beside) const {
  const int first = firstBatch(piece), last = firstBatch(piece + 1);
  if (beside != nullptr && beside->stress != nullptr)
    sweep.stress = beside->stress + first_node_batch * kStressRows * kBatchLanes;
  double energy = 0;
  for (const Run& run : runs_) {
    sweep.first = std::max(first, run.first), sweep.last = std::min(last, run.last);
    if (sweep.first >= sweep.last) continue;
    energy += evaluateRun(run, first_node_batch, sweep);
  }
  if (volume != nullptr) *volume += sweep.volume;
  if (beside != nullptr) beside->work += sweep.stress_work;
  return energy;
}

double ShellElements::evaluate(int piece, const float* displacement4, float* gradient4) const {
  ShellSweep sweep{};
  sweep.node = batch_node_.data();
  sweep.displacement4 = displacement4, sweep.gradient4 = gradient4;
  return evaluatePiece(piece, sweep, 0, nullptr, nullptr);
}

double ShellElements::evaluate(int piece, const float* displacement4, float* gradient4, float* volume_gradient4,
                               double& volume, ConstantStress* beside) const {
  ShellSweep sweep{};
  sweep.node = batch_node_.data();
  sweep.displacement4 = displacement4, sweep.gradient4 = gradient4, sweep.volume_gradient4 = volume_gradient4;
  return evaluatePiece(piece, sweep, 0, &volume, beside);
}

double ShellElements::evaluate(const ShellPart& part, int piece, const float* displacement4, float* gradient4,
                               float* volume_gradient4, double& volume, ConstantStress* beside) const {
  ShellSweep sweep{};
  sweep.node = part.node.data();
  sweep.displacement4 = displacement4, sweep.gradient4 = gradient4, sweep.volume_gradient4 = volume_gradient4;
  return evaluatePiece(piece, sweep, part.first_batch, &volume, beside);
}

void ShellElements::gather(std::size_t triangle, const double* displacement, double (&v)[5][3]) const {
  const double* first = displacement + 3 * patchNode(triangle, 0);
  for (int a = 0; a < 5; ++a) {
    const int node = patchNode(triangle, a + 1);
    for (int r = 0; r < 3; ++r) v[a][r] = node < 0 ? 0 : displacement[3 * node + r] - first[r];
  }
  const double* rows = rest(triangle);
  placeGhosts([rows](int row) { return rows[row]; }, v);
}

double ShellElements::evaluate(const double* displacement, const float* contraction, double* gradient) const {
  std::fill(gradient, gradient + 3 * mesh_.nodes.size(), 0.0);
  double energy = 0;
  for (std::size_t e = 0; e < mesh_.triangles.size(); ++e) {
    const auto material = static_cast<std::size_t>(materialOf(e));
    const Material& m = mesh_.materials[material];
    double u[5][3], bent[5][3], f[5][3], no_work;
    gather(e, displacement, u);
    std::copy(&u[0][0], &u[0][0] + 15, &bent[0][0]);  // shellEnergy clamps the ghosts, which fibres do not see
    const auto rows = [values = rest(e)](int row) { return values[row]; };
    const double shorter = contraction != nullptr ? meanOf(contraction, e) : 0;
    energy += withLaw(m.law, [&](auto tag) {
      constexpr Law law = decltype(tag)::value;
      const WallTerms<double> terms(constants_[material], m.poisson_ratio);
      const NoStress<double> none;
      return hasMuscle(e)
                 ? shellEnergy<law, kReferenceSteps, kShellMuscleRows>(terms, rows, shorter, none, bent, f, no_work)
                 : shellEnergy<law, kReferenceSteps, kShellGhostRows>(terms, rows, 0.0, none, bent, f, no_work);
    });
    if (!fibre_rest_.empty())
      energy += fibreEnergy(
          mesh_.fibres.stiffening, rows, [values = &fibre_rest_[kFibreRows * e]](int row) { return values[row]; }, u,
          f);
    returnGhosts(rows, f);
    for (int a = 0; a < 5; ++a) {
      const int node = patchNode(e, a + 1);
      if (node < 0) continue;
      for (int r = 0; r < 3; ++r) gradient[3 * node + r] += f[a][r], gradient[3 * patchNode(e, 0) + r] -= f[a][r];
    }
  }
  return energy;
}

double ShellElements::volume(const double* displacement, double* gradient) const {
  std::fill(gradient, gradient + 3 * mesh_.nodes.size(), 0.0);
  double sum = 0;
  for (std::size_t e = 0; e < mesh_.triangles.size(); ++e) {
    double u[5][3], first[3], share[3];
    gather(e, displacement, u);
    for (int r = 0; r < 3; ++r) first[r] = displacement[3 * patchNode(e, 0) + r];
    sum += coneVolume([values = rest(e)](int row) { return values[row]; }, u, first, share);
    for (const int node : mesh_.triangles[e])
      for (int r = 0; r < 3; ++r) gradient[3 * node + r] += share[r];
  }
  return sum;
}

std::vector<std::pair<const std::vector<int>*, int>> ShellElements::nodeGroups() const {
  return {{&patch_nodes_, 6}};
}

std::vector<double> ShellElements::lumpedMass(double density) const {
  std::vector<double> mass(mesh_.nodes.size(), 0.0);
  for (std::size_t e = 0; e < mesh_.triangles.size(); ++e)
    for (const int node : mesh_.triangles[e])
      mass[static_cast<std::size_t>(node)] += density * mesh_.thickness[e] * areaOf(e) / 3;
  return mass;
}

void ShellElements::strain(const double* displacement, float* out) const {
  std::vector<double> now(mesh_.nodes.size(), 0.0);
  for (std::size_t e = 0; e < mesh_.triangles.size(); ++e) {
    const auto& t = mesh_.triangles[e];
    Eigen::Vector3d x[3];
    for (std::size_t a = 0; a < 3; ++a)
      x[a] = mesh_.nodes[static_cast<std::size_t>(t[a])] + Eigen::Map<const Eigen::Vector3d>(displacement + 3 * t[a]);
    const double area = (x[1] - x[0]).cross(x[2] - x[0]).norm() / 2;
    for (const int node : t) now[static_cast<std::size_t>(node)] += area;
  }
  for (std::size_t i = 0; i < now.size(); ++i)
    out[i] = rest_area_[i] > 0 ? static_cast<float>(std::sqrt(now[i] / rest_area_[i]) - 1) : 0.0f;
}

ShellKernel shellKernel(KernelPath path) {
  switch (path) {
    case KernelPath::Avx512:
      return shellKernelAvx512();
    case KernelPath::Avx2:
      return shellKernelAvx2();
    case KernelPath::FusedSse2:
      return shellKernelFusedSse2();
    default:
      return shellKernelSse2();
  }
}

}  // namespace vibe
