#include "tissue/shape_matching.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "tissue/cluster_builder.hpp"
#include "tissue/shape_matching_kernel.hpp"
#include "vibe_core/arithmetic/machine.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

ShapeMatching::ShapeMatching(const Organ& organ, const TissueScene& tissue, const std::vector<double>& masses,
                             const std::vector<double>& areas, double step_period, int at_least)
    : clusters_(buildClusters(organ, tissue, masses, areas)),
      masses_(masses),
      substeps_(tissue.substeps > 0
                    ? tissue.substeps
                    : std::max(at_least, fewestSubsteps(clusters_, step_period, tissue.stiffness_damping))),
      substep_(step_period / substeps_),
      stiffness_ratio_(setGains(clusters_, substep_, tissue.stiffness_damping)) {}

SweepBuffers makeSweepBuffers(const ClusterSet& clusters) {
  const std::size_t slots = static_cast<std::size_t>(clusters.rows()) * ClusterSet::kLanes;
  const std::size_t lanes = static_cast<std::size_t>(clusters.group_count) * ClusterSet::kLanes;
  SweepBuffers buffers;
  for (auto* v : {&buffers.dx, &buffers.dy, &buffers.dz}) v->resize(slots);
  for (auto* v : {&buffers.qx, &buffers.qy, &buffers.qz, &buffers.wx, &buffers.wy, &buffers.wz, &buffers.area_x,
                  &buffers.area_y, &buffers.area_z, &buffers.spread})
    v->assign(lanes, 0);
  buffers.qw.assign(lanes, 1);
  return buffers;
}

void loadOrientations(const ClusterSet& clusters, const State& state, SweepBuffers& b) {
  for (int i = 0; i < clusters.particle_count; ++i) {
    const int lane = clusters.lane_of_particle[i];
    b.qw[lane] = state.qw[i], b.qx[lane] = state.qx[i], b.qy[lane] = state.qy[i], b.qz[lane] = state.qz[i];
    b.wx[lane] = state.wx[i], b.wy[lane] = state.wy[i], b.wz[lane] = state.wz[i];
  }
}

void storeOrientations(const ClusterSet& clusters, const SweepBuffers& b, State& state) {
  for (int i = 0; i < clusters.particle_count; ++i) {
    const int lane = clusters.lane_of_particle[i];
    state.qw[i] = b.qw[lane], state.qx[i] = b.qx[lane], state.qy[i] = b.qy[lane], state.qz[i] = b.qz[lane];
    state.wx[i] = b.wx[lane], state.wy[i] = b.wy[lane], state.wz[i] = b.wz[lane];
  }
}

ClusterSweep bindSweep(const ClusterSet& c, const State& state, SweepBuffers& b) {
  ClusterSweep s{};
  s.row_offset = c.row_offset.data();
  s.particle = c.particle.data();
  s.weight = c.weight.data();
  s.rest_x = c.rest_x.data();
  s.rest_y = c.rest_y.data();
  s.rest_z = c.rest_z.data();
  s.gain = c.gain.data();
  s.orientation_weight = c.orientation_weight.data();
  s.dx = b.dx.data();
  s.dy = b.dy.data();
  s.dz = b.dz.data();
  s.x = state.x.data();
  s.y = state.y.data();
  s.z = state.z.data();
  s.qw = b.qw.data();
  s.qx = b.qx.data();
  s.qy = b.qy.data();
  s.qz = b.qz.data();
  s.wx = b.wx.data();
  s.wy = b.wy.data();
  s.wz = b.wz.data();
  s.area_x = b.area_x.data();
  s.area_y = b.area_y.data();
  s.area_z = b.area_z.data();
  s.spread = b.spread.data();
  return s;
}

namespace {

SweepBuffers sweepAt(const ClusterSet& clusters, const State& state) {
  SweepBuffers buffers = makeSweepBuffers(clusters);
  loadOrientations(clusters, state, buffers);
  const ClusterSweep sweep = bindSweep(clusters, state, buffers);
  chooseClusterSweep()(sweep, 0, clusters.group_count);
  return buffers;
}

}  // namespace

double ShapeMatching::energy(const State& state) const {
  const SweepBuffers buffers = sweepAt(clusters_, state);
  double energy = 0;
  for (int i = 0; i < clusters_.particle_count; ++i) {
    const int lane = clusters_.lane_of_particle[i];
    const int group = lane / ClusterSet::kLanes;
    const double gain = clusters_.gain[lane];
    double square = 0;
    for (int row = clusters_.row_offset[group]; row < clusters_.row_offset[group + 1]; ++row) {
      const int slot = row * ClusterSet::kLanes + lane % ClusterSet::kLanes;
      const double d2 = buffers.dx[slot] * buffers.dx[slot] + buffers.dy[slot] * buffers.dy[slot] +
                        buffers.dz[slot] * buffers.dz[slot];
      square += clusters_.weight[slot] * d2;
    }
    energy += 0.5 * clusters_.cluster_mass[lane] * square / (gain * gain * clusters_.compliance[lane]);
  }
  return energy;
}

void ShapeMatching::addForces(const State& state, double* fx, double* fy, double* fz) const {
  const SweepBuffers buffers = sweepAt(clusters_, state);
  const double inverse_h2 = 1 / (substep_ * substep_);
  for (int i = 0; i < clusters_.particle_count; ++i) {
    const double scale = masses_[i] * inverse_h2;
    for (int k = clusters_.slot_offset[i]; k < clusters_.slot_offset[i + 1]; ++k) {
      fx[i] += scale * buffers.dx[clusters_.slot[k]];
      fy[i] += scale * buffers.dy[clusters_.slot[k]];
      fz[i] += scale * buffers.dz[clusters_.slot[k]];
    }
  }
}

void ShapeMatching::strain(const State& state, float* out) const {
  const SweepBuffers buffers = sweepAt(clusters_, state);
  for (int i = 0; i < clusters_.particle_count; ++i) {
    const int lane = clusters_.lane_of_particle[i];
    out[i] = static_cast<float>(std::sqrt(buffers.spread[lane] / clusters_.rest_spread[lane]) - 1);
  }
}

ClusterSweepFunction chooseClusterSweep() {
  return instructionSet() == InstructionSet::Sse2 ? sweepClustersSse2 : sweepClustersAvx2;
}

}  // namespace vibe
