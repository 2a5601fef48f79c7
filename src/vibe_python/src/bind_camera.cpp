#include <pybind11/pybind11.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "ray_caster.hpp"
#include "shading.hpp"
#include "tool.hpp"
#include "tool_picture.hpp"
#include "unlocked.hpp"
#include "vibe_core/simulation/tool_queries.hpp"

namespace vibe::python {

namespace {

constexpr int kMaxPixels = 4096;  // per side

/// What a picture is taken with.
struct Taking {
  double field_of_view;                   // from the left to the right edge [rad]
  double lamp;                            // where a white wall that faces it has the radiance 1 [m]
  std::optional<Eigen::Isometry3d> pose;  // in world; none: at the end of the scope
};

void checkPicture(int width, int height, const Taking& taking) {
  if (width < 1 || height < 1 || width > kMaxPixels || height > kMaxPixels)
    throw Error("'width' or 'height' is not from 1 to 4096; give the pixels of the image.");
  if (!(taking.field_of_view > 0.01 && taking.field_of_view < 3.1))
    throw Error("'field_of_view' is not from 0.01 to 3.1; give the angle from the left to the right edge [rad].");
  if (!(taking.lamp > 0 && taking.lamp <= 100))
    throw Error("'lamp' is not above 0 and at most 100; give the distance at which it lights a wall well [m].");
}

std::optional<Eigen::Isometry3d> poseOf(const py::handle& value) {
  if (value.is_none()) return std::nullopt;
  const auto given = numbers(value, "pose", {4, 4});
  const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(given.data());
  const Eigen::Matrix3d turn = matrix.topLeftCorner<3, 3>();
  if (!(turn.transpose() * turn).isIdentity(1e-6) || turn.determinant() < 0 ||
      !matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1)))
    throw Error("'pose' is not a rotation and a place; give the pose (4, 4) of the camera in world [m], or None.");
  return Eigen::Isometry3d(matrix);
}

/// The triangles of a surface for a camera outside: the wall is open where it shows it its outside.
std::vector<std::array<int, 3>> opened(const SurfaceView& surface, std::size_t walls, const Eigen::Vector3d& eye) {
  std::vector<std::array<int, 3>> triangles = surface.triangles;
  for (std::size_t i = 0; i < walls; ++i) {
    std::array<int, 3>& t = triangles[i];
    const Eigen::Vector3d a = surface.position(t[0]), b = surface.position(t[1]), c = surface.position(t[2]);
    if ((b - a).cross(c - a).dot(eye - a) > 0) t.fill(t[0]);  // a point, which no ray meets
  }
  return triangles;
}

/// A new array (height, width, 3) if it is wanted, else nothing.
template <class T>
py::array_t<T> inColour(int width, int height, bool wanted) {
  return py::array_t<T>(wanted ? std::vector<py::ssize_t>{height, width, 3} : std::vector<py::ssize_t>{0});
}

/// 0 nothing, 1 + region of the wall, or what `scenery` says. Triangles of the picture that are not of the wall become
/// -1.
void findLabels(const Organ& organ, const Scenery& scenery, CastImage& image, std::uint8_t* labels) {
  const int walls = static_cast<int>(organ.surface.triangles.size());
  for (int i = 0; i < image.width * image.height; ++i) {
    std::int32_t& seen = image.triangle[i];
    if (seen < 0) {
      labels[i] = 0;
    } else if (seen < walls) {
      const auto corner = static_cast<std::size_t>(organ.surface.triangles[seen][0]);
      labels[i] = static_cast<std::uint8_t>(1 + static_cast<int>(organ.region[corner]));
    } else {
      labels[i] = scenery.label[static_cast<std::size_t>(seen - walls)];
      seen = -1;
    }
  }
}

/// @param colour  null: not wanted
void look(const Use& use, const Taking& taking, bool tool, CastImage& image, std::uint8_t* labels,
          std::uint8_t* colour) {
  const Model& model = use.model();
  const State& state = use.state();
  const std::size_t walls = model.organ.surface.triangles.size();
  const Instruments shown = taking.pose ? Instruments::All : Instruments::BeforeTheLens;
  const Scenery scenery = sceneryOf(model, state, tool ? shown : Instruments::None);
  const SurfaceView surface = scenery.surface();
  const Eigen::Isometry3d pose =
      taking.pose ? *taking.pose : linkPose(model, state, model.tool->linkIndex("scope_camera_optical"));
  const auto triangles = taking.pose ? opened(surface, walls, pose.translation()) : surface.triangles;
  castRays({triangles, surface.x, surface.y, surface.z}, pose, taking.field_of_view, image);
  if (colour != nullptr) {
    std::vector<Eigen::Vector3d> albedo = wallAlbedo(model, state);
    albedo.insert(albedo.end(), scenery.albedo.begin(), scenery.albedo.end());
    shade(surface, static_cast<int>(walls), albedo, pose, taking.field_of_view, taking.lamp, image, colour);
  }
  findLabels(model.organ, scenery, image, labels);
}

py::dict camera(SimulationHandle& handle, int width, int height, double field_of_view, bool normals, bool colour,
                bool tool, const py::object& pose, double lamp) {
  const Taking taking{field_of_view, lamp, poseOf(pose)};
  checkPicture(width, height, taking);
  const Use use(handle);
  if (tool || !taking.pose) needTool(use.model());
  py::array_t<float> depth({height, width}), normal = inColour<float>(width, height, normals);
  py::array_t<std::int32_t> triangle({height, width});
  py::array_t<std::uint8_t> label({height, width}), shaded = inColour<std::uint8_t>(width, height, colour);
  CastImage image{width, height, depth.mutable_data(), triangle.mutable_data(),
                  normals ? normal.mutable_data() : nullptr};
  std::uint8_t* const labels = label.mutable_data();
  std::uint8_t* const colours = colour ? shaded.mutable_data() : nullptr;
  {
    const Unlocked others;
    look(use, taking, tool, image, labels, colours);
  }
  py::dict found;
  found["depth"] = depth;
  found["label"] = label;
  found["triangle"] = triangle;
  if (normals) found["normal"] = normal;
  if (colour) found["colour"] = shaded;
  return found;
}

/// The scene's, or the defaults, but for what is given.
InspectionScene inspectionOf(const Model& model, std::optional<double> field_of_view, std::optional<double> distance,
                             std::optional<double> angle) {
  InspectionScene inspection = model.scene.inspection.value_or(InspectionScene{});
  const auto take = [](std::optional<double> given, const char* name, double high, double& value) {
    if (!given) return;
    value = *given;
    if (!(value > 0 && value <= high))
      throw Error(std::string("'") + name + "' is not above 0 and at most " + std::to_string(high) +
                  "; give it in rad or metres, or None.");
  };
  take(field_of_view, "field_of_view", M_PI, inspection.field_of_view);
  take(distance, "distance", 1, inspection.distance);
  take(angle, "angle", M_PI / 2, inspection.angle);
  return inspection;
}

std::vector<char> flagsOf(const py::object& given, std::size_t count) {
  std::vector<char> flags(count, 0);
  if (given.is_none()) return flags;
  const auto array = numbers(given, "leave_out", {static_cast<py::ssize_t>(count)});
  for (std::size_t i = 0; i < count; ++i) flags[i] = array.data()[i] != 0 ? 1 : 0;
  return flags;
}

py::array_t<bool> sees(SimulationHandle& handle, const py::object& leave_out, std::optional<double> field_of_view,
                       std::optional<double> distance, std::optional<double> angle) {
  const Use use(handle);
  const Model& model = use.model();
  const State& state = use.state();
  needTool(model);
  const InspectionScene inspection = inspectionOf(model, field_of_view, distance, angle);
  const std::vector<char> left_out = flagsOf(leave_out, state.x.size());
  py::array_t<bool> seen(static_cast<py::ssize_t>(state.x.size()));
  std::fill_n(seen.mutable_data(), state.x.size(), false);
  const Unlocked others;
  if (!use->lens || !use->lens->isOf(inspection)) use->lens = std::make_unique<InspectionLens>(model, inspection);
  const SurfaceView wall{model.organ.surface.triangles, state.x, state.y, state.z};
  for (const int i : use->lens->look(tipPose(model, state), wall, left_out)) seen.mutable_data()[i] = true;
  return seen;
}

}  // namespace

void bindCamera(SimulationClass& simulation) {
  simulation.def_property_readonly(
      "first_seen",
      [](SimulationHandle& handle) -> py::object {
        const Use use(handle);
        const WallCoverage* coverage = use->simulation.coverage();
        if (coverage == nullptr) return py::none();
        return listOf(coverage->firstSeen());
      },
      "New array (particles,) float32: when the lens saw each particle first since the start or the last restore() "
      "[s], "
      "NaN: not yet. None in scenes without inspection, and with metrics=False.");
  simulation.def(
      "camera", &camera, py::arg("width") = 128, py::arg("height") = 128, py::arg("field_of_view") = 1.7,
      flag("normals", false), flag("colour", false), flag("tool", false), py::arg("pose") = py::none(),
      py::arg("lamp") = kLampReach,
      "What a pinhole camera at the endoscope's lens sees of the wall, by exact rays and without a display; "
      "tool: with the suturing device and the threads. field_of_view: from the left to the right edge [rad]. A "
      "dictionary of arrays (height, width): depth float32 along the optical axis [m], NaN: nothing; label "
      "uint8: 0 nothing, else 1 + region (1 cardia, 2 fundus, 3 body, 4 antrum, 5 pylorus), 6 device, 7 thread; "
      "triangle "
      "int32, -1: not the wall; on request normal (height, width, 3) float32 in the camera, towards it; and colour "
      "(height, width, 3) uint8: red, green, blue of a matt wall that a lamp at the lens lights, 0: nothing. "
      "The colour is 255 sqrt(r / (1 + r)), r = albedo cos(angle of incidence) (lamp / distance)^2 with lamp [m]; it "
      "is "
      "not the look of rviz. pose: (4, 4) of a camera elsewhere in world, z along its optical axis, x to the right, "
      "y down [m]; from outside it sees through the near wall, and tool is the whole scope.");
  simulation.def(
      "sees", &sees, py::arg("leave_out") = py::none(), py::arg("field_of_view") = py::none(),
      py::arg("distance") = py::none(), py::arg("angle") = py::none(),
      "New array (particles,) bool: which particles of the wall the lens sees now, as docs/metrics.md#coverage defines "
      "it: within the field_of_view of the round picture [rad], no farther than distance [m], within angle of the "
      "normal [rad], hidden by no fold and not by the device; None: as the section inspection of the scene says, else "
      "its defaults. leave_out: (particles,) True where nobody wants to know, which saves time.");
}

}  // namespace vibe::python
