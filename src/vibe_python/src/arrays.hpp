#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "vibe_core/program/error.hpp"

namespace vibe::python {

namespace py = pybind11;

/// A read-only array on memory of another object, which it keeps.
/// @param owner  of the memory
template <class T, class Owner>
py::array view(const T* data, std::vector<py::ssize_t> shape, std::shared_ptr<Owner> owner) {
  using Kept = std::shared_ptr<Owner>;
  const py::capsule base(new Kept(std::move(owner)), [](void* kept) { delete static_cast<Kept*>(kept); });
  py::array array(py::dtype::of<T>(), std::move(shape), data, base);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

template <class T, class Owner>
py::array view(const std::vector<T>& list, std::shared_ptr<Owner> owner) {
  return view(list.data(), {static_cast<py::ssize_t>(list.size())}, std::move(owner));
}

/// A new array (rows, 3).
inline py::array_t<double> rowsOf(const std::vector<Eigen::Vector3d>& points) {
  py::array_t<double> array({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}});
  double* out = array.mutable_data();
  for (const Eigen::Vector3d& point : points)
    for (int k = 0; k < 3; ++k) *out++ = point[k];
  return array;
}

/// A new array (rows, columns) of a matrix.
template <class Matrix>
py::array_t<double> matrixOf(const Matrix& matrix) {
  py::array_t<double> array({static_cast<py::ssize_t>(matrix.rows()), static_cast<py::ssize_t>(matrix.cols())});
  auto out = array.mutable_unchecked<2>();
  for (int i = 0; i < matrix.rows(); ++i)
    for (int j = 0; j < matrix.cols(); ++j) out(i, j) = matrix(i, j);
  return array;
}

/// A new array of some numbers.
template <class T>
py::array_t<T> listOf(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

/// An argument as finite numbers of a given shape.
/// @param shape  -1: any length
/// @throws Error that names the argument
py::array_t<double> numbers(const py::handle& value, const std::string& name, const std::vector<py::ssize_t>& shape);
/// The same of three numbers.
Eigen::Vector3d vector3(const py::handle& value, const std::string& name);
/// The same of one number.
double number(const py::handle& value, const std::string& name);

}  // namespace vibe::python
