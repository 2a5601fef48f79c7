#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "bindings.hpp"

namespace vibe::python {

namespace {

// Arrays with a row per contact, which are filled one after the other.
class Rows {
 public:
  explicit Rows(std::size_t count) : count_(static_cast<py::ssize_t>(count)) {}

  template <class T, class Function>
  void add(const char* name, Function of) {
    py::array_t<T> array(count_);
    for (py::ssize_t i = 0; i < count_; ++i) array.mutable_at(i) = static_cast<T>(of(static_cast<std::size_t>(i)));
    found_[name] = std::move(array);
  }
  /// Rows of something that has operator[].
  template <class T, class Function>
  void add(const char* name, py::ssize_t columns, Function of) {
    py::array_t<T> array({count_, columns});
    for (py::ssize_t i = 0; i < count_; ++i)
      for (py::ssize_t k = 0; k < columns; ++k) array.mutable_at(i, k) = of(static_cast<std::size_t>(i))[k];
    found_[name] = std::move(array);
  }
  template <class Function>
  void addNames(const char* name, Function of) {
    py::list names;
    for (py::ssize_t i = 0; i < count_; ++i) names.append(of(static_cast<std::size_t>(i)));
    found_[name] = std::move(names);
  }
  py::dict take() { return std::move(found_); }

 private:
  py::ssize_t count_;
  py::dict found_;
};

py::dict contacts(SimulationHandle& handle) {
  const Use use(handle);
  const std::vector<ToolContact>& c = use->simulation.contacts();
  Rows rows(c.size());
  rows.add<double>("point", 3, [&](std::size_t i) { return c[i].point; });
  rows.add<double>("normal", 3, [&](std::size_t i) { return c[i].normal; });
  rows.add<double>("gap", [&](std::size_t i) { return c[i].gap; });
  rows.add<double>("force", 3, [&](std::size_t i) { return c[i].force; });
  rows.add<double>("normal_force", [&](std::size_t i) { return c[i].normalForce(); });
  rows.add<double>("tangential_force", 3, [&](std::size_t i) { return c[i].tangentialForce(); });
  rows.addNames("link", [&](std::size_t i) { return use.model().tool->linkName(c[i].link); });
  rows.add<std::int32_t>("shape", [&](std::size_t i) { return c[i].shape; });
  rows.addNames("kind", [&](std::size_t i) { return c[i].kind == ToolContact::Kind::Grip ? "grip" : "contact"; });
  rows.add<std::int32_t>("triangle", [&](std::size_t i) { return c[i].triangle; });
  rows.add<std::int32_t>(
      "nodes", 3, [&](std::size_t i) -> auto& { return c[i].surface.node; });
  rows.add<double>(
      "weights", 3, [&](std::size_t i) -> auto& { return c[i].surface.weight; });
  rows.add<std::uint8_t>("region", [&](std::size_t i) { return c[i].region; });
  rows.add<std::uint8_t>("wall", [&](std::size_t i) { return c[i].wall; });
  return rows.take();
}

py::dict wallContacts(SimulationHandle& handle) {
  const Use use(handle);
  const std::vector<WallContact>& c = use->simulation.wallContacts();
  Rows rows(c.size());
  rows.add<double>("point", 3, [&](std::size_t i) { return c[i].point; });
  rows.add<double>("normal", 3, [&](std::size_t i) { return c[i].normal; });
  rows.add<double>("distance", [&](std::size_t i) { return c[i].distance; });
  rows.add<double>("normal_force", [&](std::size_t i) { return c[i].force; });
  rows.add<std::int32_t>(
      "nodes", 4, [&](std::size_t i) -> auto& { return c[i].node; });
  rows.add<double>(
      "weights", 4, [&](std::size_t i) -> auto& { return c[i].weight; });
  return rows.take();
}

py::dict threadContactsOf(SimulationHandle& handle) {
  const Use use(handle);
  const std::vector<ThreadContact> c = use->simulation.threadContacts();
  Rows rows(c.size());
  rows.add<double>("point", 3, [&](std::size_t i) { return c[i].point; });
  rows.add<double>("force", 3, [&](std::size_t i) { return c[i].force; });
  rows.add<std::int32_t>("thread", [&](std::size_t i) { return c[i].suture; });
  rows.add<std::int32_t>("bite", [&](std::size_t i) { return c[i].bite; });
  return rows.take();
}

}  // namespace

void bindContacts(SimulationClass& simulation) {
  simulation
      .def(
          "contacts", &contacts,
          "Forces of the tissue on the tool in the last step; empty before it, and after restore() and reset(). A "
          "dictionary of new arrays, with a row per contact, all in world: point (n, 3), of the wall at the end of the "
          "step [m]; normal (n, 3), unit, out of the tool, zero for the grip of the helix; gap (n,), from the tool to "
          "the face of the wall, below 0: squeezed by as much [m]; force (n, 3), mean over the step, whose sum is the "
          "force of wrench [N]; normal_force (n,) and tangential_force (n, 3), its parts [N]; shape (n,) int32, of the "
          "tool, -1: grip; triangle (n,) int32, -1: none; nodes (n, 3) int32, -1: fewer, and weights (n, 3), whose "
          "mean "
          "is point, none where the helix holds a patch; region, wall (n,) uint8, as those of Model. Beside them link "
          "and kind ('contact' or 'grip'), lists of n names.")
      .def("wall_contacts", &wallContacts,
           "Where the wall presses on itself in the present state; looked for in this call only. A dictionary of new "
           "arrays: point (n, 3), half way between two points of the wall, world [m]; normal (n, 3), unit, from the "
           "second "
           "to the first; distance (n,), of the two on the middle of the wall [m]; normal_force (n,), without friction "
           "[N]; nodes (n, 4) int32, -1: fewer, and weights (n, 4): above 0 at the first point, below 0 at the second.")
      .def("thread_contacts", &threadContactsOf,
           "What threads that pull do to the wall at their bites, with the tensions of the last step. A dictionary of "
           "new "
           "arrays: point (n, 3), world [m]; force (n, 3), on the wall, world [N]; thread, bite (n,) int32, numbers in "
           "threads() and of the bite.");
}

}  // namespace vibe::python
