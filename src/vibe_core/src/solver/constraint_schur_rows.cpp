#include <algorithm>

#include "solver/constraint_schur.hpp"

// Which rows there are, and of what kind; constraint_schur.cpp eliminates them.

namespace vibe {

void ConstraintSchur::addRow(const LinearForm& form, double compliance, const Factor& factor) {
  rows_.addRow(compliance);
  for (std::size_t k = 0; k < form.node.size(); ++k)
    rows_.addTerm(cache_->nodeSlot(factor, form.node[k]), form.coefficient[k]);
}

// Tangents without friction have rows without a term.
void ConstraintSchur::addContact(const ContactRows& contact, const Factor& factor) {
  addRow(contact.form[0], contact.compliance, factor);
  for (std::size_t k = 1; k < 3; ++k)
    if (contact.friction > 0)
      addRow(contact.form[k], 0, factor);
    else
      rows_.addRow(1);
}

// From an attachment point to the next: the same as a form in their nodes, in fewer columns.
void ConstraintSchur::addRun(int attachment, const Eigen::Vector3d& along, double compliance) {
  rows_.addRow(compliance);
  rows_.addTerm(cache_->attachmentSlot(attachment), along);
  rows_.addTerm(cache_->attachmentSlot(attachment + 1), -along);
}

void ConstraintSchur::addThreadRows(const ThreadRows& thread) {
  for (int k = 0; k < thread.count(); ++k)
    addRun(thread.first_attachment + k, thread.segments[k].along, thread.segments[k].compliance);
  for (int k = 0; k < thread.count(); ++k)
    for (int j = 0; j < 2; ++j) {
      const SegmentRows& segment = thread.segments[k];
      if (segment.turn_missing > 0)
        addRun(thread.first_attachment + k, segment.across[j], segment.turn_missing);
      else
        rows_.addRow(1);  // without a term: the factor has it
    }
}

// Of equations and of contacts.
void ConstraintSchur::findNodes(const ConstraintRows& rows) {
  nodes_.clear();
  for (const EquationRow& row : rows.equations) nodes_.insert(nodes_.end(), row.form.node.begin(), row.form.node.end());
  for (std::size_t c = 0; c < rows.counted; ++c) {
    const std::vector<int>& node = rows.contacts[c].form[0].node;
    nodes_.insert(nodes_.end(), node.begin(), node.end());
  }
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
}

void ConstraintSchur::setRows(const ConstraintRows& rows, const Factor& factor, ColumnCache& cache) {
  cache_ = &cache;
  findNodes(rows);
  cache.makeRoom(nodes_);
  rows_.clear();
  for (const EquationRow& equation : rows.equations) addRow(equation.form, equation.compliance, factor);
  for (std::size_t c = 0; c < rows.counted; ++c) addContact(rows.contacts[c], factor);
  for (const ThreadRows& thread : rows.threads) addThreadRows(thread);
  rows_.finish(cache);
  row_value_.setZero(rowCount());
  force_.setZero(rowCount());
  sortRows(rows);
  setYield(rows);
  formed_ = rows_formed_ = false;
  contact_force_.setZero(static_cast<Eigen::Index>(inequalities_.size()));
  for (std::size_t c = 0; c < rows.counted; ++c)
    for (std::size_t k = 0; k < (rows.contacts[c].friction > 0 ? 3U : 1U); ++k)
      contact_force_[contact_list_[c].first + static_cast<Eigen::Index>(k)] = rows.contacts[c].guess[k];
}

void ConstraintSchur::sortRows(const ConstraintRows& rows) {
  equations_.clear(), inequalities_.clear(), contact_list_.clear(), idle_.clear();
  threads_held_ = false;
  // equations, and the turns of threads that the factor does not have: linear
  for (int i = 0; i < static_cast<int>(rows.equations.size()); ++i) equations_.push_back(i);
  for (const ThreadRows& thread : rows.threads)
    for (int k = 0; k < 2 * thread.count(); ++k)
      if (thread.segments[k / 2].turn_missing > 0) equations_.push_back(thread.turnRow(k / 2, k % 2));
  // contacts that count; tangents without friction have a row and no force
  for (std::size_t c = 0; c < rows.counted; ++c) {
    const double friction = rows.contacts[c].friction;
    contact_list_.push_back({static_cast<int>(inequalities_.size()), friction});
    inequalities_.push_back(rows.contactRow(c));
    for (int k = 1; k < 3; ++k) (friction > 0 ? inequalities_ : idle_).push_back(rows.contactRow(c) + k);
  }
  // pulls of threads, which are solved by themselves where no tool touches
  first_pull_ = static_cast<int>(inequalities_.size());
  thread_slides_.clear();
  for (const ThreadRows& thread : rows.threads) {
    thread_slides_.addThread();
    for (int k = 0; k < thread.count(); ++k) {
      inequalities_.push_back(thread.pullRow(k));
      thread_slides_.addSegment(thread.segments[k].capstan, thread.segments[k].spare);
    }
  }
}

void ConstraintSchur::setYield(const ConstraintRows& rows) {
  yields_ = rows.tool_yields;
  pull_.setZero();
  if (!yields_) return;
  yield_.setZero(kYieldDofs, rowCount());
  rows.forEachYield([this](int row, const YieldVector& yield) { yield_.col(row) = yield; });
  tool_compliance_ = rows.tool_compliance;
  given_.resize(kYieldDofs, rowCount());
  for (int i = 0; i < rowCount(); ++i) given_.col(i) = tool_compliance_ * yield_.col(i);
}

}  // namespace vibe
