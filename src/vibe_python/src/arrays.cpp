#include "arrays.hpp"

#include <cmath>

namespace vibe::python {

namespace {

std::string text(const std::vector<py::ssize_t>& shape) {
  std::string list;
  for (const py::ssize_t size : shape) list += (list.empty() ? "" : ", ") + (size < 0 ? "any" : std::to_string(size));
  return shape.size() == 1 ? "(" + list + ",)" : "(" + list + ")";
}

bool fits(const py::array& array, const std::vector<py::ssize_t>& shape) {
  if (array.ndim() != static_cast<py::ssize_t>(shape.size())) return false;
  for (std::size_t k = 0; k < shape.size(); ++k)
    if (shape[k] >= 0 && array.shape(static_cast<py::ssize_t>(k)) != shape[k]) return false;
  return true;
}

}  // namespace

py::array_t<double> numbers(const py::handle& value, const std::string& name, const std::vector<py::ssize_t>& shape) {
  const py::array given = py::array::ensure(value);
  const char kind = given ? given.dtype().kind() : 'O';
  if (kind != 'f' && kind != 'i' && kind != 'u' && kind != 'b') {
    PyErr_Clear();
    throw Error("'" + name + "' is not an array of numbers; give one of the shape " + text(shape) + ".");
  }
  if (!fits(given, shape)) {
    const std::vector<py::ssize_t> found(given.shape(), given.shape() + given.ndim());
    throw Error("'" + name + "' has the shape " + text(found) + "; give one of the shape " + text(shape) + ".");
  }
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
  for (py::ssize_t i = 0; i < array.size(); ++i)
    if (!std::isfinite(array.data()[i]))
      throw Error("'" + name + "' holds a value that is not finite; give numbers in SI units.");
  return array;
}

Eigen::Vector3d vector3(const py::handle& value, const std::string& name) {
  return Eigen::Map<const Eigen::Vector3d>(numbers(value, name, {3}).data());
}

double number(const py::handle& value, const std::string& name) {
  const double found = PyFloat_AsDouble(value.ptr());
  if (PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    throw Error("'" + name + "' is not a number; give one in SI units.");
  }
  if (!std::isfinite(found)) throw Error("'" + name + "' is not finite; give a number in SI units.");
  return found;
}

}  // namespace vibe::python
