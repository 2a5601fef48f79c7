#include "solver/constraint_rows.hpp"

namespace vibe {

void LinearForm::setPoint(const SurfacePoint& point, const Eigen::Vector3d& direction) {
  node.assign(point.node.begin(), point.node.begin() + point.count);
  coefficient.clear();
  for (int k = 0; k < point.count; ++k) coefficient.emplace_back(point.weight[static_cast<std::size_t>(k)] * direction);
}

double LinearForm::value(const std::vector<double>& position4) const {
  double sum = 0;
  for (std::size_t k = 0; k < node.size(); ++k) {
    const double* p = &position4[4 * static_cast<std::size_t>(node[k])];
    sum += coefficient[k].dot(Eigen::Vector3d(p[0], p[1], p[2]));
  }
  return sum;
}

void LinearForm::addForce(double force, std::vector<float>& vector4) const {
  for (std::size_t i = 0; i < node.size(); ++i)
    for (int k = 0; k < 3; ++k)
      vector4[4 * static_cast<std::size_t>(node[i]) + k] += static_cast<float>(force * coefficient[i][k]);
}

void ConstraintRows::clear() {
  equations.clear();
  contacts.clear();
  threads.clear();
  tool_compliance.setZero();
  tool_yields = false;
}

void ConstraintRows::number() {
  int row = contactRow(contacts.size());
  for (ThreadRows& thread : threads) {
    thread.first_row = row;
    row += 3 * thread.count();
  }
}

int ConstraintRows::count() const {
  int sum = contactRow(contacts.size());
  for (const ThreadRows& thread : threads) sum += 3 * thread.count();
  return sum;
}

}  // namespace vibe
