#pragma once
#include <memory>
#include <optional>

#include "vibe_core/common/thread_pool.hpp"
#include "vibe_core/haptics/tool_impedance.hpp"
#include "vibe_core/model/model.hpp"

namespace vibe {

class MarkingScratch;

/// Scratch memory, caches and threads for stepping one model. Results do not depend on what a workspace was used for
/// before. One thread of control at a time.
class Workspace {
 public:
  /// @param threads  used inside a step, 1 or more; the result does not depend on it
  explicit Workspace(const Model& model, int threads = 1);
  ~Workspace();
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  SolverWorkspace& solverWorkspace() { return *solver_workspace_; }
  /// Output of the last step beside the state: mechanical impedance of the tissue at the tool. Empty while nothing is
  /// touched, and with solvers that do not estimate it (shape matching).
  std::optional<ToolImpedance>& toolImpedance() { return tool_impedance_; }
  /// Results of the last step beside the state.
  StepReport& report() { return report_; }
  MarkingScratch* marking() { return marking_.get(); }  ///< null in a scene without marking or scope
  int threads() const { return pool_.threads(); }

  ThreadPool& threadPool() { return pool_; }

 private:
  ThreadPool pool_;
  std::unique_ptr<SolverWorkspace> solver_workspace_;
  std::unique_ptr<MarkingScratch> marking_;
  std::optional<ToolImpedance> tool_impedance_;
  StepReport report_;
};

}  // namespace vibe
