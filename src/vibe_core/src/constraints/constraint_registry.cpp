#include "vibe_core/constraints/constraint_registry.hpp"

#include <algorithm>
#include <mutex>

#include "constraints/blocks.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

struct Entry {
  std::string name;
  ConstraintFactory make;
};

// A new kind of constraint is one line here, its own two files, and a test. The order is that of the solver's rows and
// of the sums over forces and energies; self-contact is before the tool because it corrects positions first, and
// relaxation before all that moves a held node.
const Entry kBuiltIn[] = {
    {"relaxation", makeRelaxationBlock},  {"self_contact", makeSelfContactBlock}, {"grip", makeGripBlock},
    {"pull_spring", makePullSpringBlock}, {"tool_contact", makeToolContactBlock}, {"thread", makeThreadBlock},
    {"breathing", makeBreathingBlock},    {"peristalsis", makePeristalsisBlock},  {"gas", makeGasBlock},
};

struct Added {
  std::mutex mutex;
  std::vector<Entry> entries;
};

Added& added() {
  static Added instance;
  return instance;
}

std::vector<Entry> addedEntries() {
  const std::lock_guard<std::mutex> lock(added().mutex);
  return added().entries;
}

}  // namespace

void registerConstraint(const std::string& name, ConstraintFactory factory) {
  for (const std::string& known : constraintNames())
    if (known == name) throw Error("The constraint '" + name + "' is registered already; choose another name.");
  const std::lock_guard<std::mutex> lock(added().mutex);
  added().entries.push_back({name, std::move(factory)});
}

void unregisterConstraint(const std::string& name) {
  const std::lock_guard<std::mutex> lock(added().mutex);
  std::vector<Entry>& entries = added().entries;
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&name](const Entry& entry) { return entry.name == name; });
  if (found == entries.end())
    throw Error("The constraint '" + name + "' cannot be removed; only registered ones can, and this one is not.");
  entries.erase(found);
}

std::vector<std::string> constraintNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kBuiltIn) names.push_back(entry.name);
  for (const Entry& entry : addedEntries()) names.push_back(entry.name);
  return names;
}

std::vector<std::unique_ptr<ConstraintBlock>> makeConstraintBlocks(const Model& model) {
  std::vector<std::unique_ptr<ConstraintBlock>> blocks;
  const auto addBlock = [&](const Entry& entry) {
    if (auto block = entry.make(model)) blocks.push_back(std::move(block));
  };
  for (const Entry& entry : kBuiltIn) addBlock(entry);
  for (const Entry& entry : addedEntries()) addBlock(entry);
  return blocks;
}

std::vector<std::unique_ptr<ConstraintBlock>> makeSubstepBlocks(const Model& model) {
  std::vector<std::unique_ptr<ConstraintBlock>> blocks;
  for (const Entry& entry : addedEntries()) {
    auto block = entry.make(model);
    if (!block) continue;
    if (!block->substepLoad())
      throw Error("The constraint '" + entry.name + "' needs the implicit solver; tissue.model '" +
                  model.scene.tissue.model + "' does not use it. Choose tissue.model: shell.");
    blocks.push_back(std::move(block));
  }
  return blocks;
}

}  // namespace vibe
