#include <pybind11/pybind11.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "ray_caster.hpp"
#include "tool.hpp"

namespace vibe::python {

namespace {

constexpr int kMaxPixels = 4096;  // per side

py::dict camera(SimulationHandle& handle, int width, int height, double field_of_view, bool normals) {
  if (width < 1 || height < 1 || width > kMaxPixels || height > kMaxPixels)
    throw Error("'width' or 'height' is not from 1 to 4096; give the pixels of the image.");
  if (!(field_of_view > 0.01 && field_of_view < 3.1))
    throw Error("'field_of_view' is not from 0.01 to 3.1; give the angle from the left to the right edge [rad].");
  const Use use(handle);
  needTool(use.model());
  const std::vector<py::ssize_t> shape{height, width};
  py::array_t<float> depth(shape),
      normal(normals ? std::vector<py::ssize_t>{height, width, 3} : std::vector<py::ssize_t>{0, 0, 3});
  py::array_t<std::int32_t> triangle(shape);
  py::array_t<std::uint8_t> label(shape);
  const Organ& organ = use.model().organ;
  const State& state = use.state();
  CastImage image{width, height, depth.mutable_data(), triangle.mutable_data(),
                  normals ? normal.mutable_data() : nullptr};
  std::uint8_t* const labels = label.mutable_data();
  {
    const py::gil_scoped_release released;
    const int link = use.model().tool->linkIndex("scope_camera_optical");
    castRays({organ.surface.triangles, state.x, state.y, state.z}, linkPose(use.model(), state, link), field_of_view,
             image);
    for (int i = 0; i < width * height; ++i) {
      const int seen = image.triangle[i];
      const auto corner = seen < 0 ? 0 : static_cast<std::size_t>(organ.surface.triangles[seen][0]);
      labels[i] = seen < 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(1 + static_cast<int>(organ.region[corner]));
    }
  }
  py::dict found;
  found["depth"] = depth;
  found["label"] = label;
  found["triangle"] = triangle;
  if (normals) found["normal"] = normal;
  return found;
}

}  // namespace

void bindCamera(SimulationClass& simulation) {
  simulation.def("camera", &camera, py::arg("width") = 128, py::arg("height") = 128, py::arg("field_of_view") = 1.7,
                 py::arg("normals") = false,
                 "What a pinhole camera at the endoscope's lens sees of the wall, by exact rays and without a display; "
                 "the tool itself is not in the picture. field_of_view: from the left to the right edge [rad]. A "
                 "dictionary of arrays (height, width): depth float32 along the optical axis [m], NaN: nothing; label "
                 "uint8: 0 nothing, else 1 + region (1 cardia, 2 fundus, 3 body, 4 antrum, 5 pylorus); triangle int32, "
                 "-1: nothing; on request normal (height, width, 3) float32 in the camera, towards it.");
}

}  // namespace vibe::python
