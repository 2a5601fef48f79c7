#pragma once
#include <functional>
#include <memory>
#include <optional>

#include "vibe_sim/model.hpp"
#include "vibe_sim/solver/tool_response.hpp"

namespace vibe {

class MarkingScratch;

/// Scratch memory and threads for stepping one model. Carries nothing from one step to the next; not shared between
/// threads of control.
class Workspace {
 public:
  /// @param threads  used inside a step, 1 or more; the result does not depend on it
  explicit Workspace(const Model& model, int threads = 1);
  ~Workspace();
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  SolverScratch& solverScratch() { return *solver_scratch_; }
  std::vector<Eigen::Isometry3d>& linkPoses() { return link_poses_; }
  /// Output of the last step beside the state: how the tissue answers the tool; nothing while nothing is touched, and
  /// with solvers that cannot tell (shape matching).
  std::optional<ToolResponse>& toolResponse() { return tool_response_; }
  MarkingScratch* marking() { return marking_.get(); }  ///< null in a scene without marking or scope
  int threads() const { return threads_; }

  /// Calls body(first, last) for consecutive pieces of [0, count) of at most `grain`, on the threads of this workspace.
  /// The pieces do not depend on the number of threads.
  void parallelFor(int count, int grain, const std::function<void(int first, int last)>& body);

 private:
  struct Arena;
  int threads_;
  std::unique_ptr<Arena> arena_;  // null with one thread
  std::unique_ptr<SolverScratch> solver_scratch_;
  std::unique_ptr<MarkingScratch> marking_;
  std::vector<Eigen::Isometry3d> link_poses_;
  std::optional<ToolResponse> tool_response_;
};

}  // namespace vibe
