#include "vibe_core/sparse/block_matrix.hpp"

#include <algorithm>
#include <string>

#include "vibe_core/program/error.hpp"

namespace vibe {

int BlockPattern::find(int row, int column_wanted) const {
  const auto first = column.begin() + start[row], last = column.begin() + start[row + 1];
  const auto it = std::lower_bound(first, last, column_wanted);
  return it != last && *it == column_wanted ? static_cast<int>(it - column.begin()) : -1;
}

namespace {

void addGroup(const int* member, int count, std::vector<std::vector<int>>& rows) {
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j)
      if (member[j] >= 0 && member[i] > member[j]) rows[member[i]].push_back(member[j]);
}

void checkGroups(int size, const std::vector<int>& nodes, int group_size) {
  if (group_size < 1 || nodes.size() % static_cast<std::size_t>(group_size) != 0)
    throw Error("a list of " + std::to_string(nodes.size()) + " node numbers is no list of groups of " +
                std::to_string(group_size) + ": give whole groups.");
  for (const int node : nodes)
    if (node >= size || node < -1)
      throw Error("node " + std::to_string(node) + " of a group is outside a block matrix of " + std::to_string(size) +
                  " nodes: number nodes from 0, or -1 for none.");
}

}  // namespace

BlockPattern blockPattern(int size, const std::vector<std::pair<const std::vector<int>*, int>>& groups) {
  std::vector<std::vector<int>> rows(size);
  for (const auto& [nodes, group_size] : groups) {
    checkGroups(size, *nodes, group_size);
    for (std::size_t i = 0; i < nodes->size(); i += group_size) addGroup(nodes->data() + i, group_size, rows);
  }
  BlockPattern pattern;
  pattern.size = size;
  pattern.start.assign(1, 0);
  for (std::vector<int>& row : rows) {
    std::sort(row.begin(), row.end());
    pattern.column.insert(pattern.column.end(), row.begin(), std::unique(row.begin(), row.end()));
    pattern.start.push_back(static_cast<int>(pattern.column.size()));
  }
  return pattern;
}

BlockMatrix::BlockMatrix(std::shared_ptr<const BlockPattern> pattern)
    : pattern_(std::move(pattern)),
      diagonal_(pattern_->size, Eigen::Matrix3d::Zero()),
      lower_(pattern_->column.size(), Eigen::Matrix3d::Zero()),
      column_start_(pattern_->size + 1, 0),
      column_block_(pattern_->column.size()) {
  for (const int column : pattern_->column) ++column_start_[column + 1];
  for (int i = 0; i < pattern_->size; ++i) column_start_[i + 1] += column_start_[i];
  std::vector<int> next(column_start_.begin(), column_start_.end() - 1);
  for (std::size_t k = 0; k < pattern_->column.size(); ++k)
    column_block_[next[pattern_->column[k]]++] = static_cast<int>(k);
}

void BlockMatrix::setZero() {
  std::fill(diagonal_.begin(), diagonal_.end(), Eigen::Matrix3d::Zero());
  std::fill(lower_.begin(), lower_.end(), Eigen::Matrix3d::Zero());
  std::fill(coupled_.begin(), coupled_.end(), Eigen::Matrix3d::Zero());
}

void BlockMatrix::couple(const std::vector<NodePair>& pairs) {
  pairs_ = pairs;
  coupled_.assign(pairs_.size(), Eigen::Matrix3d::Zero());
}

void BlockMatrix::scale(double factor) {
  for (Eigen::Matrix3d& block : diagonal_) block *= factor;
  for (Eigen::Matrix3d& block : lower_) block *= factor;
  for (Eigen::Matrix3d& block : coupled_) block *= factor;
}

namespace {

[[noreturn]] void throwMissing(int row, int column) {
  throw Error("block (" + std::to_string(row) + ", " + std::to_string(column) +
              ") is not in the pattern of its matrix: give blockPattern a group that holds both nodes.");
}

}  // namespace

Eigen::Matrix3d& BlockMatrix::below(int row, int column) {
  const int index = pattern_->find(row, column);
  if (index >= 0) return lower_[index];
  const auto pair = std::lower_bound(pairs_.begin(), pairs_.end(), NodePair{row, column});
  if (pair == pairs_.end() || !(*pair == NodePair{row, column})) throwMissing(row, column);
  return coupled_[static_cast<std::size_t>(pair - pairs_.begin())];
}

void BlockMatrix::add(int row, int column, const Eigen::Matrix3d& block) {
  if (row == column)
    diagonal_[row] += block;
  else if (row > column)
    below(row, column) += block;
  else
    below(column, row) += block.transpose();
}

int BlockMatrix::placeOf(int row, int column) const {
  if (row < 0 || column < 0) return kNowhere;
  if (row == column) return -1 - row;
  const int index = pattern_->find(std::max(row, column), std::min(row, column));
  if (index < 0) throwMissing(row, column);
  return 2 * index + (row < column ? 1 : 0);
}

const std::vector<int>& BlockMatrix::placesOf(const std::vector<int>& groups, int group_size) {
  for (const Places& known : places_)
    if (known.group_size == group_size && known.groups == groups) return known.place;
  Places places{groups, {}, group_size};
  for (std::size_t first = 0; first < groups.size(); first += group_size)
    for (int a = 0; a < group_size; ++a)
      for (int b = 0; b <= a; ++b) places.place.push_back(placeOf(groups[first + a], groups[first + b]));
  places_.push_back(std::move(places));
  return places_.back().place;
}

void BlockMatrix::fix(int node) {
  diagonal_[node].setIdentity();
  for (int k = pattern_->start[node]; k < pattern_->start[node + 1]; ++k) lower_[k].setZero();
  for (int k = column_start_[node]; k < column_start_[node + 1]; ++k) lower_[column_block_[k]].setZero();
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    if (pairs_[k].row == node || pairs_[k].column == node) coupled_[k].setZero();
}

void BlockMatrix::multiply(const double* x, double* out) const {
  using Vector = Eigen::Map<Eigen::Vector3d>;
  using ConstVector = Eigen::Map<const Eigen::Vector3d>;
  for (int i = 0; i < pattern_->size; ++i) {
    const ConstVector own(x + 3 * i);
    Eigen::Vector3d sum = diagonal_[i] * own;
    for (int k = pattern_->start[i]; k < pattern_->start[i + 1]; ++k) {
      const int j = pattern_->column[k];
      sum += lower_[k] * ConstVector(x + 3 * j);
      Vector(out + 3 * j) += lower_[k].transpose() * own;  // column < row: already written
    }
    Vector(out + 3 * i) = sum;
  }
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    Vector(out + 3 * pairs_[k].row) += coupled_[k] * ConstVector(x + 3 * pairs_[k].column);
    Vector(out + 3 * pairs_[k].column) += coupled_[k].transpose() * ConstVector(x + 3 * pairs_[k].row);
  }
}

}  // namespace vibe
