#include "sparse/factor_plan.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "sparse/elimination.hpp"

namespace vibe {
namespace {

// METIS is asked for several orders, and the one that solves fastest is taken. Design choice: four, since an order is
// made once per model.
constexpr int kFirstSeed = 1, kSeeds = 4;
// A branch has at most this part of the factor. Design choice: small enough that four threads get equal shares, large
// enough that a branch outlasts its start by far.
constexpr int kBranchParts = 10;

class Planner {
 public:
  Planner(std::shared_ptr<const BlockPattern> pattern, const std::vector<NodePair>& pairs,
          const std::vector<Supernode>& supernodes)
      : plan_(std::make_shared<FactorPlan>()), supernodes_(supernodes) {
    plan_->pattern = std::move(pattern);
    plan_->pairs = pairs;
  }

  std::shared_ptr<const FactorPlan> make() {
    numberNodes();
    for (const Supernode& supernode : supernodes_) addStep(supernode);
    for (std::size_t s = 0; s < supernodes_.size(); ++s) addRuns(static_cast<int>(s));
    addEntries();
    cutBranches();
    addTasks();
    measureStacks();
    return plan_;
  }

 private:
  void numberNodes() {
    plan_->position.resize(plan_->pattern->size);
    for (std::size_t s = 0; s < supernodes_.size(); ++s)
      for (const int node : supernodes_[s].nodes) {
        plan_->position[node] = static_cast<int>(plan_->order.size());
        plan_->order.push_back(node);
        plan_->holder.push_back(static_cast<int>(s));
      }
  }

  void addStep(const Supernode& supernode) {
    const int nodes = static_cast<int>(supernode.nodes.size()), below = static_cast<int>(supernode.rows.size());
    const std::int64_t columns = 3 * nodes, rows = columns + 3 * below;
    PanelStep step{};
    step.first_row = 3 * plan_->position[supernode.nodes.front()];
    step.columns = 3 * nodes;
    step.row_blocks = static_cast<int>((rows + kTile - 1) / kTile);
    step.below_nodes = below;
    step.first_index = static_cast<std::int64_t>(plan_->row_index.size());
    step.panel = plan_->panel_size;
    plan_->steps.push_back(step);
    for (const int node : supernode.rows) plan_->row_index.push_back(3 * plan_->position[node]);
    std::sort(plan_->row_index.begin() + step.first_index, plan_->row_index.end());
    plan_->panel_size += (panelSize(step.columns, step.row_blocks) + 63) / 64 * 64;
    plan_->nonzeros += columns * (columns + 1) / 2 + columns * 3 * below;
    plan_->largest_front = std::max(plan_->largest_front, static_cast<int>(rows));
    const auto own = static_cast<double>(columns), rest = static_cast<double>(rows - columns);
    plan_->operations += own * (own * own / 6 + own * rest / 2 + rest * rest / 2);
  }

  // position of a row of the vector (the first of a node) in the front of a supernode
  int rowInFront(int s, int row) const {
    const PanelStep& step = plan_->steps[s];
    if (row < step.first_row + step.columns) return row - step.first_row;
    const auto first = plan_->row_index.begin() + step.first_index;
    const auto found = std::lower_bound(first, first + step.below_nodes, row);
    return step.columns + 3 * static_cast<int>(found - first);
  }

  void addRuns(int s) {
    FactorPlan::Front front;
    front.parent = supernodes_[s].parent;
    front.first_run = static_cast<int>(plan_->runs.size());
    const PanelStep& step = plan_->steps[s];
    for (int i = 0; i < step.below_nodes; ++i) {
      const int to = rowInFront(front.parent, plan_->row_index[step.first_index + i]);
      const bool first = i == 0;
      if (!first && plan_->runs.back().to + plan_->runs.back().count == to)
        plan_->runs.back().count += 3;
      else
        plan_->runs.push_back({3 * i, to, 3});
    }
    front.run_count = static_cast<int>(plan_->runs.size()) - front.first_run;
    plan_->fronts.push_back(front);
  }

  void addEntries() {
    std::vector<std::vector<FactorPlan::Entry>> entries(supernodes_.size());
    const BlockPattern& pattern = *plan_->pattern;
    for (int i = 0; i < pattern.size; ++i) {
      addEntry(entries, -1 - i, i, i);
      for (int k = pattern.start[i]; k < pattern.start[i + 1]; ++k) addEntry(entries, k, i, pattern.column[k]);
    }
    const int known = static_cast<int>(pattern.column.size());
    for (int k = 0; k < static_cast<int>(plan_->pairs.size()); ++k)
      addEntry(entries, known + k, plan_->pairs[k].row, plan_->pairs[k].column);
    for (std::size_t s = 0; s < entries.size(); ++s) {
      plan_->fronts[s].first_entry = static_cast<int>(plan_->entries.size());
      plan_->fronts[s].entry_count = static_cast<int>(entries[s].size());
      plan_->entries.insert(plan_->entries.end(), entries[s].begin(), entries[s].end());
    }
  }

  void addEntry(std::vector<std::vector<FactorPlan::Entry>>& entries, int block, int row_node, int column_node) const {
    const int row = plan_->position[row_node], column = plan_->position[column_node];
    const int s = plan_->holder[std::min(row, column)];
    entries[s].push_back(
        {block, rowInFront(s, 3 * std::max(row, column)), rowInFront(s, 3 * std::min(row, column)), row < column});
  }

  // Update matrices are kept on stacks: a supernode pops those of its children, then pushes its own. That of a branch's
  // root stays on the stack of the branch until the trunk takes it.
  void measureStacks() {
    const int count = static_cast<int>(supernodes_.size());
    std::vector<std::size_t> stack_of(static_cast<std::size_t>(count), 0);  // 0: the trunk's
    for (std::size_t b = 0; b < plan_->branches.size(); ++b)
      std::fill(stack_of.begin() + plan_->branches[b].first, stack_of.begin() + plan_->branches[b].last, b + 1);
    std::vector<std::int64_t> used(plan_->branches.size() + 1, 0), most = used, of_children(stack_of.size(), 0);
    for (int s = 0; s < count; ++s) {
      const std::size_t stack = stack_of[s];
      const std::int64_t rows = 3 * plan_->steps[s].below_nodes, size = rows * rows;
      used[stack] += size - of_children[s];
      most[stack] = std::max(most[stack], used[stack]);
      const int parent = plan_->fronts[s].parent;
      if (parent == -1) continue;
      ++plan_->fronts[parent].child_count;
      if (stack_of[parent] == stack) of_children[parent] += size;
    }
    plan_->stack_size = most[0];
    for (std::size_t b = 0; b < plan_->branches.size(); ++b) {
      plan_->branches[b].stack = plan_->stack_size;
      plan_->stack_size += most[b + 1];
    }
  }

  // The largest subtrees that are small enough. Supernodes are in postorder: a subtree ends with its root.
  void cutBranches() {
    const int count = static_cast<int>(supernodes_.size());
    std::vector<int> first(count);
    std::vector<std::int64_t> numbers(count, 0);
    std::iota(first.begin(), first.end(), 0);
    for (int s = 0; s < count; ++s) {
      numbers[s] += panelSize(plan_->steps[s].columns, plan_->steps[s].row_blocks);
      const int parent = plan_->fronts[s].parent;
      if (parent == -1) continue;
      numbers[parent] += numbers[s];
      first[parent] = std::min(first[parent], first[s]);
    }
    const auto isSmall = [&](int s) { return s != -1 && numbers[s] * kBranchParts <= plan_->panel_size; };
    for (int s = 0; s < count; ++s)
      if (isSmall(s) && !isSmall(plan_->fronts[s].parent)) addBranch(first[s], s + 1);
  }

  void addBranch(int first, int last) {
    plan_->branches.push_back({first, last, 0, 0});
    for (int s = first; s < last; ++s) {
      int& largest = plan_->branches.back().largest_front;
      largest = std::max(largest, plan_->steps[s].columns + 3 * plan_->steps[s].below_nodes);
    }
  }

  void addTasks() {
    int next = 0;
    for (const FactorPlan::Branch& branch : plan_->branches) {
      addTrunk(next, branch.first);
      addTask(branch.first, branch.last);
      next = branch.last;
    }
    const int count = static_cast<int>(supernodes_.size());
    addTrunk(next, count);
    if (next < count) {
      plan_->root = plan_->tasks.back();
      plan_->tasks.pop_back();
    }
    addReceipts();
    orderTasks();
  }

  void addTrunk(int first, int last) {
    for (int s = first; s < last; ++s) addTask(s, s + 1);
  }

  void addTask(int first, int last) {
    const PanelStep& end = plan_->steps[last - 1];
    plan_->tasks.push_back({first, last, end.first_row + end.columns, plan_->record_size, -1, 0, 0, 0});
    for (int s = first; s < last; ++s)
      plan_->record_size += 3 * (endOfIndex(s) - indexFrom(s, plan_->tasks.back().end_row));
  }

  std::int64_t endOfIndex(int s) const { return plan_->steps[s].first_index + plan_->steps[s].below_nodes; }

  // @returns index of the first node below a supernode that is not before a row
  std::int64_t indexFrom(int s, std::int32_t row) const {
    const auto begin = plan_->row_index.begin();
    return std::lower_bound(begin + plan_->steps[s].first_index, begin + endOfIndex(s), row) - begin;
  }

  // By the supernode that gives, ascending, as one pass adds.
  void addReceipts() {
    std::vector<std::vector<FactorPlan::Receipt>> of(supernodes_.size());
    for (const FactorPlan::Task& task : plan_->tasks) {
      std::int64_t record = task.record;
      for (int s = task.first; s < task.last; ++s)
        for (std::int64_t i = indexFrom(s, task.end_row); i < endOfIndex(s);) {
          const int to = plan_->holder[plan_->row_index[i] / 3];
          const std::int64_t end = indexFrom(s, plan_->steps[to].first_row + plan_->steps[to].columns);
          of[to].push_back({record, i, static_cast<int>(end - i)});
          record += 3 * (end - i);
          i = end;
        }
    }
    const auto receive = [&](FactorPlan::Task& task) {
      task.received = static_cast<int>(plan_->receipts.size());
      for (int s = task.first; s < task.last; ++s)
        plan_->receipts.insert(plan_->receipts.end(), of[s].begin(), of[s].end());
      task.receipts = static_cast<int>(plan_->receipts.size()) - task.received;
    };
    for (FactorPlan::Task& task : plan_->tasks) receive(task);
    receive(plan_->root);
  }

  // Forward, those with the longest way to the root first; backward, branches last, and else those near the root first.
  void orderTasks() {
    std::vector<FactorPlan::Task>& tasks = plan_->tasks;
    const int count = static_cast<int>(tasks.size());
    findParents();
    std::vector<std::int64_t> way(count), later(count), depth(count, 0);
    for (int t = count - 1; t >= 0; --t) {
      const int parent = tasks[t].parent;
      way[t] = size(tasks[t]) + (parent == -1 ? 0 : way[parent]);
      depth[t] = parent == -1 ? 0 : depth[parent] + 1;
      later[t] = tasks[t].children == 0 ? count : depth[t];
    }
    const auto ordered = [&](const auto& key) {
      std::vector<int> order(count);
      std::iota(order.begin(), order.end(), 0);
      std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
      return order;
    };
    const std::vector<int> forward = ordered([&](int t) { return -way[t]; });
    std::vector<int> place(count);
    for (int k = 0; k < count; ++k) place[forward[k]] = k;
    for (const int t : ordered([&](int t) { return std::make_pair(later[t], -size(tasks[t])); }))
      plan_->backward.push_back(place[t]);
    std::vector<FactorPlan::Task> sorted;
    for (const int t : forward) {
      sorted.push_back(tasks[t]);
      if (tasks[t].parent != -1) sorted.back().parent = place[tasks[t].parent];
    }
    tasks.swap(sorted);
  }

  // Of tasks in the order of their supernodes.
  void findParents() {
    std::vector<int> task_of(supernodes_.size(), -1);
    for (std::size_t t = 0; t < plan_->tasks.size(); ++t)
      std::fill(task_of.begin() + plan_->tasks[t].first, task_of.begin() + plan_->tasks[t].last, static_cast<int>(t));
    for (FactorPlan::Task& task : plan_->tasks) {
      const int parent = plan_->fronts[task.last - 1].parent;
      task.parent = parent == -1 ? -1 : task_of[parent];
      if (task.parent != -1) ++plan_->tasks[task.parent].children;
    }
  }

  std::int64_t size(const FactorPlan::Task& task) const {
    return plan_->steps[task.last - 1].panel - plan_->steps[task.first].panel +
           panelSize(plan_->steps[task.last - 1].columns, plan_->steps[task.last - 1].row_blocks);
  }

  std::shared_ptr<FactorPlan> plan_;
  const std::vector<Supernode>& supernodes_;
};

double totalCost(const std::vector<Supernode>& supernodes) {
  double cost = 0;
  for (const Supernode& s : supernodes)
    cost += solveCost(static_cast<int>(s.nodes.size()), static_cast<int>(s.rows.size()));
  return cost;
}

}  // namespace

std::shared_ptr<const FactorPlan> makeFactorPlan(const BlockPattern& pattern) {
  std::vector<Supernode> best;
  for (int seed = kFirstSeed; seed < kFirstSeed + kSeeds; ++seed) {
    std::vector<Supernode> supernodes = amalgamate(symbolicFactor(pattern, nestedDissection(pattern, seed)));
    if (best.empty() || totalCost(supernodes) < totalCost(best)) best = std::move(supernodes);
  }
  return Planner(std::make_shared<const BlockPattern>(pattern), {}, best).make();
}

std::shared_ptr<const FactorPlan> coupledPlan(const std::shared_ptr<const FactorPlan>& base,
                                              const std::vector<NodePair>& pairs) {
  if (pairs.empty()) return base;
  const BlockPattern pattern = extended(*base->pattern, pairs);
  return Planner(base->pattern, pairs, amalgamate(symbolicFactor(pattern, repairedOrder(*base, pairs)))).make();
}

const std::vector<NodePair>& pairsOf(const FactorPlan& plan) {
  return plan.pairs;
}

}  // namespace vibe
