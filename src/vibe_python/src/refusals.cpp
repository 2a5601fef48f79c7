#include <algorithm>
#include <climits>
#include <map>
#include <string>
#include <vector>

#include "bindings.hpp"

// A call that fits no function of the module is answered by pybind11 with all its signatures. Here it is answered with
// one sentence instead. All functions share one C function, which is replaced in each; a call that fits takes no
// longer.

namespace vibe::python {

namespace py = pybind11;

namespace {

constexpr std::size_t kLongest = 40;  // of a value in a sentence [bytes]
constexpr std::size_t kMost = 8;      // arguments that a sentence names

struct Signature {
  std::string name;          // "Simulation.run"
  std::string arguments;     // "(steps: int, **kwargs)"
  bool makes = false;        // its first argument, which is nothing before
  PyObject* type = nullptr;  // of a method, whose first argument is the object; borrowed
};

PyCFunctionWithKeywords pybind_dispatcher = nullptr;

/// By the object that Python hands to the function, which pybind11 makes one of for each.
std::map<PyObject*, Signature>& signatures() {
  static auto* const known = new std::map<PyObject*, Signature>;  // functions outlive static objects
  return *known;
}

std::string without(std::string text, const std::string& part) {
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part)) text.erase(at, part.size());
  return text;
}

// A whole number that not every argument can take.
bool isFarOut(const py::handle& value) {
  int overflow = 0;
  if (!PyLong_Check(value.ptr())) return false;
  const long long number = PyLong_AsLongLongAndOverflow(value.ptr(), &overflow);
  return overflow != 0 || number < 0 || number > INT_MAX;
}

std::string shownValue(const py::handle& value) {
  const std::string type = without(Py_TYPE(value.ptr())->tp_name, "_core.");
  if (value.is_none()) return "None";
  const auto text = py::reinterpret_steal<py::object>(PyObject_ASCII(value.ptr()));
  if (!text) {
    PyErr_Clear();
    return type;
  }
  const std::string shown = py::cast<std::string>(text);
  const bool plain = shown.size() <= kLongest && shown.find('\n') == std::string::npos && shown.front() != '<';
  return plain ? shown + " (" + type + (isFarOut(value) ? ", perhaps out of range)" : ")") : type;
}

std::string shownArguments(const py::handle& given, const py::handle& keywords, bool method) {
  std::string list;
  const auto add = [&list](const std::string& text) { list += (list.empty() ? "" : ", ") + text; };
  const auto positional = py::reinterpret_borrow<py::tuple>(given);
  for (std::size_t k = method ? 1 : 0; k < std::min(kMost, positional.size()); ++k) add(shownValue(positional[k]));
  if (positional.size() > kMost) add(std::to_string(positional.size() - kMost) + " more");
  if (keywords)
    for (const auto& [name, value] : py::reinterpret_borrow<py::dict>(keywords))
      add(py::cast<std::string>(name) + "=" + shownValue(value));
  return list.empty() ? "nothing" : list;
}

bool isCalledOnAnother(const Signature& function, const py::tuple& given) {
  return function.type != nullptr && !given.empty() && PyObject_IsInstance(given[0].ptr(), function.type) == 0;
}

void explain(const Signature& function, PyObject* given, PyObject* keywords) {
  py::error_already_set refused;  // takes the error
  if (std::string(refused.what()).find("incompatible") == std::string::npos) return refused.restore();
  const auto list = py::reinterpret_borrow<py::tuple>(given);
  const std::string called = isCalledOnAnother(function, list)
                                 ? "() cannot be called on " + shownValue(list[0]) + "; its object is no such thing"
                                 : "() cannot be called with " +
                                       shownArguments(given, keywords, function.type != nullptr) + "; it takes " +
                                       function.arguments;
  const std::string sentence = function.name + called + ", see help(vibe." + function.name + ").";
  PyErr_SetString(PyExc_TypeError, sentence.c_str());
}

// Sentences about names with the character 0 would end there, and bytes pass as text with any characters.
bool isNoText(PyObject* value, bool takes_bytes) {
  if (PyUnicode_Check(value)) return PyUnicode_FindChar(value, 0, 0, PyUnicode_GET_LENGTH(value), 1) >= 0;
  return PyBytes_Check(value) && !takes_bytes;
}

bool holdsNoText(PyObject* given, PyObject* keywords, bool takes_bytes) {
  bool found = false;
  for (Py_ssize_t k = 0; k < PyTuple_GET_SIZE(given); ++k)
    found = found || isNoText(PyTuple_GET_ITEM(given, k), takes_bytes);
  PyObject *key = nullptr, *value = nullptr;
  for (Py_ssize_t at = 0; keywords != nullptr && PyDict_Next(keywords, &at, &key, &value);)
    found = found || isNoText(key, takes_bytes) || isNoText(value, takes_bytes);
  return found;
}

/// Whether an object of the module was made by __new__() alone: pybind11 would take what is in its memory for the
/// value.
bool isHalfMade(PyObject* value) {
  if (Py_TYPE(Py_TYPE(value)) != py::detail::get_internals().default_metaclass) return false;
  for (const auto& part : py::detail::values_and_holders(reinterpret_cast<py::detail::instance*>(value)))
    if (!part.holder_constructed()) return true;
  return false;
}

/// The first such object among arguments, and in lists of them; null: none.
PyObject* findHalfMade(PyObject* given, PyObject* keywords, bool makes) {
  std::vector<PyObject*> values;
  for (Py_ssize_t k = makes ? 1 : 0; k < PyTuple_GET_SIZE(given); ++k) values.push_back(PyTuple_GET_ITEM(given, k));
  PyObject *key = nullptr, *value = nullptr;
  for (Py_ssize_t at = 0; keywords != nullptr && PyDict_Next(keywords, &at, &key, &value);) values.push_back(value);
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (isHalfMade(values[k])) return values[k];
    if (PyList_Check(values[k]))
      for (Py_ssize_t i = 0; i < PyList_GET_SIZE(values[k]); ++i)
        if (isHalfMade(PyList_GET_ITEM(values[k], i))) return PyList_GET_ITEM(values[k], i);
  }
  return nullptr;
}

PyObject* callOrExplain(PyObject* self, PyObject* given, PyObject* keywords) {
  const auto known = signatures().find(self);
  if (PyObject* const half = findHalfMade(given, keywords, known != signatures().end() && known->second.makes)) {
    const std::string type = without(Py_TYPE(half)->tp_name, "_core.");
    PyErr_Format(PyExc_TypeError, "The %s was made by __new__() alone and is nothing; make it as help(%s) says.",
                 type.c_str(), type.c_str());
    return nullptr;
  }
  const bool takes_bytes = known != signatures().end() && known->second.arguments.find("bytes") != std::string::npos;
  if (holdsNoText(given, keywords, takes_bytes)) {
    PyErr_SetString(PyExc_ValueError, "A text is given as bytes or holds the character 0; give a text without it.");
    return nullptr;
  }
  PyObject* const result = pybind_dispatcher(self, given, keywords);
  if (result != nullptr || !PyErr_ExceptionMatches(PyExc_TypeError)) return result;
  if (known != signatures().end()) try {
      explain(known->second, given, keywords);
    } catch (const std::exception& error) {
      PyErr_SetString(PyExc_TypeError, error.what());
    }
  return nullptr;
}

// From the first line of the docstring: "run(self: vibe._core.Simulation, steps: int, **kwargs) -> List[...]".
std::string argumentsOf(const std::string& documentation) {
  const std::string line = documentation.substr(0, documentation.find('\n'));
  const std::size_t begin = line.find('('), end = line.rfind(") ->");
  if (begin == std::string::npos || end == std::string::npos || end < begin) return "other arguments";
  std::string list = without(line.substr(begin + 1, end - begin - 1), "vibe._core.");
  if (list.rfind("self", 0) == 0)
    list.erase(0, list.find(", ") == std::string::npos ? list.size() : list.find(", ") + 2);
  return list.empty() ? "no arguments" : "(" + list + ")";
}

void watch(PyObject* function, const std::string& name, bool makes, PyObject* type) {
  if (PyInstanceMethod_Check(function)) function = PyInstanceMethod_GET_FUNCTION(function);
  if (!PyCFunction_Check(function)) return;
  PyMethodDef* const definition = reinterpret_cast<PyCFunctionObject*>(function)->m_ml;
  if (definition->ml_flags != (METH_VARARGS | METH_KEYWORDS)) return;  // pybind11 from 3.1 on calls otherwise
  const auto current = reinterpret_cast<PyCFunctionWithKeywords>(reinterpret_cast<void (*)()>(definition->ml_meth));
  if (pybind_dispatcher == nullptr) pybind_dispatcher = current;
  if (current != pybind_dispatcher) return;
  const std::string documentation = definition->ml_doc == nullptr ? "" : definition->ml_doc;
  signatures()[PyCFunction_GET_SELF(function)] = {name, argumentsOf(documentation), makes, type};
  definition->ml_meth = reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(&callOrExplain));
}

void watchClass(const py::handle& type, const std::string& name) {
  const auto members = py::reinterpret_borrow<py::object>(type.attr("__dict__"));
  for (const py::handle member : py::list(members.attr("items")())) {
    const auto [key, value] = py::cast<std::pair<std::string, py::object>>(member);
    const std::string full = key == "__init__" ? name : name + "." + key;
    watch(value.ptr(), full, key == "__init__" || key == "__setstate__", type.ptr());
    if (PyObject_HasAttrString(value.ptr(), "fget")) watch(value.attr("fget").ptr(), full, false, type.ptr());
  }
}

}  // namespace

void explainRefusals(py::module_& module) {
  for (const py::handle member : py::list(module.attr("__dict__").attr("items")())) {
    const auto [name, value] = py::cast<std::pair<std::string, py::object>>(member);
    if (PyType_Check(value.ptr()))
      watchClass(value, name);
    else
      watch(value.ptr(), name, false, nullptr);
  }
}

}  // namespace vibe::python
