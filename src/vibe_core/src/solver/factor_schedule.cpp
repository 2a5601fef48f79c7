#include "solver/factor_schedule.hpp"

#include <algorithm>
#include <cstring>

#include "vibe_core/common/error.hpp"

namespace vibe {
namespace {

// Spring at every node over the mean diagonal of the stiffness, so that a free body can be factored without inertia.
// Design choice: the rounding of single precision, in which the solution is stored [1].
constexpr double kShift = 1e-7;

std::uint64_t hashOf(const std::vector<float>& values) {  // FNV-1a over 32-bit words; 1: nothing
  std::uint64_t hash = 1469598103934665603ULL;
  for (float value : values) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 1099511628211ULL;
  }
  return values.empty() ? 1 : hash;
}

void copyPositions(const MotionView& motion, int nodes, std::vector<float>& out) {
  out.resize(3 * static_cast<std::size_t>(nodes));
  for (int i = 0; i < nodes; ++i)
    for (int k = 0; k < 3; ++k) out[3 * static_cast<std::size_t>(i) + k] = static_cast<float>(motion.x[k][i]);
}

// A matrix that is not positive definite gets another chance about rest.
void factorSafely(const ElasticBody& body, const std::vector<float>& positions, double inertia, double margin,
                  BlockMatrix& matrix, Factor& factor) {
  if (factorAt(body, positions, inertia, margin, matrix, factor)) return;
  if (factorAt(body, {}, inertia, margin, matrix, factor)) return;
  throw Error("The stiffness of the body at rest is not positive definite; check its mesh, masses and materials.");
}

}  // namespace

bool factorAt(const ElasticBody& body, const std::vector<float>& positions, double inertia, double margin,
              BlockMatrix& matrix, Factor& factor) {
  const std::size_t n = body.rest.size();
  std::vector<double> displacement(3 * n, 0.0);
  if (!positions.empty())
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        displacement[3 * i + k] =
            static_cast<double>(positions[3 * i + k]) - body.rest[i][static_cast<Eigen::Index>(k)];
  matrix.setZero();
  body.elements->addStiffness(displacement.data(), matrix);
  if (margin != 1) matrix.scale(margin);
  double mean = 0;
  for (std::size_t i = 0; i < n; ++i) mean += matrix.diagonal()[i].trace() / (3 * static_cast<double>(n));
  for (std::size_t i = 0; i < n; ++i) {
    double spring = inertia * body.mass[i] + kShift * mean;
    if (!body.foundation.empty()) spring += body.foundation[i];
    matrix.add(static_cast<int>(i), static_cast<int>(i), spring * Eigen::Matrix3d::Identity());
  }
  for (std::size_t i = 0; i < n; ++i)
    if (body.fixed[i] != 0) matrix.fix(static_cast<int>(i));
  return factor.compute(matrix);
}

void FactorSchedule::nameHere(const ElasticBody& body, const MotionView& motion, StepperMemory& memory) {
  copyPositions(motion, body.nodeCount(), memory.linearization_point);
  memory.linearization_id = hashOf(memory.linearization_point);
  memory.next.clear();
}

void FactorSchedule::advance(const ElasticBody& body, const MotionView& motion, StepperMemory& memory) const {
  if (memory.linearization_id == 0) memory.linearization_id = hashOf(memory.linearization_point);
  if (!memory.next.empty() && memory.steps >= memory.due) {
    memory.linearization_point.swap(memory.next);
    memory.linearization_id = memory.next_id;
    memory.next.clear();
  }
  if (steps == 0 || !memory.next.empty() || !farFrom(body, motion, memory.linearization_point)) return;
  copyPositions(motion, body.nodeCount(), memory.next);
  memory.next_id = hashOf(memory.next);
  memory.due = memory.steps + steps;
}

void FactorSchedule::provide(const ElasticBody& body, const RowList<AttachmentPoint>& attachments,
                             const StepperMemory& memory, StepperScratch& scratch) const {
  if (scratch.factor_id != memory.linearization_id) {
    if (scratch.making.valid()) scratch.making.get();
    if (scratch.next_id == memory.linearization_id) {
      scratch.factor.swap(scratch.next_factor);
      std::swap(scratch.attachments, scratch.next_attachments);
    } else {
      factorSafely(body, memory.linearization_point, inertia, margin, scratch.matrix, *scratch.factor);
      scratch.attachments = AttachmentColumns();
    }
    scratch.next_id = 0;
    scratch.factor_id = memory.linearization_id;
    scratch.schur.reset(*scratch.factor, body.nodeCount());
  }
  if (!memory.next.empty() && scratch.next_id != memory.next_id) makeInBackground(body, attachments, memory, scratch);
  provideAttachments(body, attachments, scratch);
}

// What was not made beside the factor: spots that came since, or after some went.
void FactorSchedule::provideAttachments(const ElasticBody& body, const RowList<AttachmentPoint>& attachments,
                                        StepperScratch& scratch) {
  const std::vector<AttachmentPoint>& known = scratch.attachments.attachments;
  const bool begins = known.size() <= attachments.size() && std::equal(known.begin(), known.end(), attachments.begin());
  if (!begins) scratch.schur.reset(*scratch.factor, body.nodeCount());
  extendAttachmentColumns(*scratch.factor, attachments, scratch.attachments);
}

void FactorSchedule::makeInBackground(const ElasticBody& body, const RowList<AttachmentPoint>& attachments,
                                      const StepperMemory& memory, StepperScratch& scratch) const {
  if (scratch.making.valid()) scratch.making.get();
  scratch.next_id = memory.next_id;
  scratch.making = std::async(std::launch::async, [this, &body, &scratch, positions = memory.next, attachments] {
    factorSafely(body, positions, inertia, margin, scratch.next_matrix, *scratch.next_factor);
    scratch.next_attachments = AttachmentColumns();
    extendAttachmentColumns(*scratch.next_factor, attachments, scratch.next_attachments);
    return true;
  });
}

bool FactorSchedule::farFrom(const ElasticBody& body, const MotionView& motion, const std::vector<float>& about) const {
  for (int i = 0; i < body.nodeCount(); ++i) {
    double distance2 = 0;
    for (int k = 0; k < 3; ++k) {
      const double from =
          about.empty() ? body.rest[i][k] : static_cast<double>(about[3 * static_cast<std::size_t>(i) + k]);
      distance2 += (motion.x[k][i] - from) * (motion.x[k][i] - from);
    }
    if (!(distance2 <= distance * distance)) return true;
  }
  return false;
}

}  // namespace vibe
