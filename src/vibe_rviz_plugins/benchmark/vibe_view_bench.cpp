// What drawing tissue costs per frame: CPU time of the thread that draws, by part of the work. Needs a display (a
// virtual one will do) and a ROS master, for rviz does; scripts/bench_view brings both.
#include <OgreRenderSystem.h>
#include <OgreRoot.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <ros/ros.h>
#include <rviz/render_panel.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/visualization_manager.h>
#include <time.h>

#include <QApplication>
#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <memory>

#include "bench_organ.hpp"
#include "vibe_graphics/geometry/deformable_surface.hpp"
#include "vibe_graphics/geometry/surface_colours.hpp"
#include "vibe_graphics/graphics/dynamic_mesh.hpp"
#include "vibe_graphics/graphics/resources.hpp"
#include "vibe_graphics/messages/tissue_messages.hpp"
#include "vibe_ros_utils/startup.hpp"

namespace {

using namespace vibe;
using namespace vibe::rviz_plugins;

constexpr int kWarmUp = 10, kFrames = 100;
constexpr double kMasterPatience = 10;  // [s]
constexpr double kGoal = 0.5;           // for geometry and upload [ms]

enum Part { Read, Geometry, Colours, Upload, Rest, Whole, kPartCount };
constexpr std::array<const char*, kPartCount> kPartNames{"reading", "geometry", "colours", "upload", "rest", "process"};

using Samples = std::array<std::vector<double>, kPartCount>;  // [ms]

/// Time that a clock of processor time shows [s]: other programs on the machine lengthen it little.
double clockTime(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Of this thread.
double threadTime() {
  return clockTime(CLOCK_THREAD_CPUTIME_ID);
}

/// Of all threads of this process together.
double processTime() {
  return clockTime(CLOCK_PROCESS_CPUTIME_ID);
}

struct Case {
  const char* name;
  bool subdivided;
  Motion motion;
};

/// The central part of rviz: everything that it does in a frame, without its panels.
struct Viewer {
  Viewer() {
    panel.resize(1280, 720);
    manager = std::make_unique<rviz::VisualizationManager>(&panel);
    panel.initialize(manager->getSceneManager(), manager.get());
    manager->initialize();
    panel.show();
    QApplication::processEvents();
    graphics::loadResources();
    auto* view = manager->getViewManager()->getCurrent();
    view->subProp("Distance")->setValue(0.3);
  }
  void drawFrame() {
    manager->queueRender();
    QMetaObject::invokeMethod(manager.get(), "onUpdate", Qt::DirectConnection);
  }
  rviz::RenderPanel panel;
  std::unique_ptr<rviz::VisualizationManager> manager;
};

/// What TissueVisual does with a message, with a look at the clock between its parts.
class Stages {
 public:
  Stages(Viewer& viewer, const graphics::TissueMesh& mesh)
      : viewer_(viewer),
        mesh_(mesh),
        surface_(mesh_),
        colours_(mesh_),
        node_(*viewer.manager->getSceneManager()->getRootSceneNode()->createChildSceneNode()),
        inside_(graphics::copyMaterial("vibe/tissue_inside")),
        outside_(graphics::copyMaterial("vibe/tissue_outside")),
        drawn_(std::make_unique<graphics::DynamicMesh>(node_, std::vector<Ogre::MaterialPtr>{inside_, outside_})) {
    colours_.choose(graphics::Colouring::Strain, graphics::ColourMap());
    drawn_->setTopology(mesh_.triangles, mesh_.vertex_count, mesh_.rest);
  }
  ~Stages() {
    drawn_.reset();
    viewer_.manager->getSceneManager()->destroySceneNode(&node_);
    graphics::dropMaterial(inside_), graphics::dropMaterial(outside_);
  }

  std::array<double, kPartCount> drawFrame(const sensor_msgs::PointCloud2& cloud) {
    std::array<double, kPartCount> times{};
    const double begin = processTime();
    double last = threadTime();
    const auto lap = [&](Part part) {
      const double now = threadTime();
      times[part] += 1e3 * (now - last);
      last = now;
    };
    const std::string wrong = graphics::readParticles(cloud, mesh_, frame_);
    if (!wrong.empty()) throw std::runtime_error(wrong);
    lap(Read);
    const graphics::VertexSpan moved = surface_.update(frame_.positions);
    lap(Geometry);
    const graphics::VertexSpan coloured = colours_.update(frame_);
    lap(Colours);
    send(moved, coloured);
    lap(Upload);
    viewer_.drawFrame();
    lap(Rest);
    times[Whole] = 1e3 * (processTime() - begin);
    return times;
  }

 private:
  void send(const graphics::VertexSpan& moved, const graphics::VertexSpan& coloured) {
    if (!moved.empty()) {
      drawn_->setVertices(surface_.vertices().data() + moved.first, moved.first, moved.count());
      const Eigen::Vector3f min = surface_.bounds().min(), max = surface_.bounds().max();
      drawn_->setBounds({min.x(), min.y(), min.z(), max.x(), max.y(), max.z()});
    }
    drawn_->setColours(colours_.colours().data() + coloured.first, coloured.first, coloured.count());
  }

  Viewer& viewer_;
  graphics::TissueMesh mesh_;
  graphics::TissueFrame frame_;
  graphics::DeformableSurface surface_;
  graphics::SurfaceColours colours_;
  Ogre::SceneNode& node_;
  Ogre::MaterialPtr inside_, outside_;
  std::unique_ptr<graphics::DynamicMesh> drawn_;
};

Samples measure(Viewer& viewer, const Case& c) {
  const graphics::TissueMesh mesh = benchOrgan(c.subdivided);
  Stages stages(viewer, mesh);
  Samples samples;
  for (int frame = 0; frame < kWarmUp + kFrames; ++frame) {
    const auto times = stages.drawFrame(benchCloud(mesh, c.motion, frame));
    for (int part = 0; part < kPartCount && frame >= kWarmUp; ++part) samples[part].push_back(times[part]);
    QApplication::processEvents();
  }
  for (auto& values : samples) std::sort(values.begin(), values.end());
  return samples;
}

double median(const std::vector<double>& sorted) {
  return sorted[sorted.size() / 2];
}

// The time that this package adds to a frame.
double added(const Samples& samples) {
  return median(samples[Geometry]) + median(samples[Colours]) + median(samples[Upload]);
}

void printRow(const Case& c, const graphics::TissueMesh& mesh, const Samples& samples) {
  std::printf("| %s | %zu |", c.name, mesh.triangles.size() / 3);
  for (const auto& values : samples) std::printf(" %.3f (%.3f) |", median(values), values.front());
  std::printf(" %.3f |\n", added(samples));
}

std::string processorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

int run() {
  Viewer viewer;
  std::printf("%s, %s; 1280x720, %d frames; CPU time per frame [ms], median (least)\n\n", processorName().c_str(),
              Ogre::Root::getSingleton().getRenderSystem()->getCapabilities()->getDeviceName().c_str(), kFrames);
  std::printf("| 3,618 particles | triangles |");
  for (const char* name : kPartNames) std::printf(" %s |", name);
  std::printf(" geometry + colours + upload |\n|---|---|---|---|---|---|---|---|---|\n");
  const Case cases[] = {{"everything moves", false, Motion::Everything},
                        {"5 % of it move", false, Motion::Patch},
                        {"nothing moves", false, Motion::Nothing},
                        {"everything moves, with a render_surface", true, Motion::Everything},
                        {"5 % of it move, with a render_surface", true, Motion::Patch},
                        {"nothing moves, with a render_surface", true, Motion::Nothing}};
  double worst = 0;
  for (const Case& c : cases) {
    const Samples samples = measure(viewer, c);
    printRow(c, benchOrgan(c.subdivided), samples);
    if (!c.subdivided) worst = std::max(worst, added(samples));
  }
  std::printf("\ngeometry, colours and upload of the plain surface: %.3f ms at most, goal %.1f ms: %s\n", worst, kGoal,
              worst <= kGoal ? "met" : "missed");
  return worst <= kGoal ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    vibe::ros_utils::init(argc, argv, "vibe_view_bench", ros::init_options::AnonymousName);
    vibe::ros_utils::waitForMaster(kMasterPatience);
    const QApplication application(argc, argv);
    return run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vibe_view_bench: %s\n", error.what());
    return 2;
  }
}
