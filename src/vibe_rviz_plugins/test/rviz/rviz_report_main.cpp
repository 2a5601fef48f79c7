// rviz as it is, which also writes down, twice a second, what it thinks of its displays: for tests that cannot look.
//
// usage: rviz_report FILE [options of rviz]
// FILE holds one JSON object: frames (drawn so far), memory (resident [B]), tool (the current one) and
// statuses, a list of {of, what, level, text} with the level "Ok", "Warn" or "Error", and in help the number of
// properties of this package's displays, tools and view, and the names of those without a help sentence.
// Standard input takes keys and motions of the mouse, see rviz_events.hpp.
#include <rviz/display_group.h>
#include <rviz/failed_display.h>
#include <rviz/failed_panel.h>
#include <rviz/failed_tool.h>
#include <rviz/failed_view_controller.h>
#include <rviz/properties/status_list.h>
#include <rviz/tool.h>
#include <rviz/tool_manager.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/visualization_frame.h>
#include <rviz/visualization_manager.h>
#include <rviz/visualizer_app.h>
#include <unistd.h>

#include <QApplication>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QSaveFile>
#include <QTimer>
#include <cstdio>
#include <fstream>
#include <utility>
#include <vector>

#include "rviz_events.hpp"
#include "vibe_rviz_plugins/display_base/topic_display.hpp"

namespace {

constexpr int kInterval = 500;  // between two reports [ms]

QJsonObject entry(const QString& of, const QString& what, rviz::StatusLevel level, const QString& text) {
  return {{"of", of}, {"what", what}, {"level", rviz::StatusProperty::statusWord(level)}, {"text", text}};
}

void addStatusesOf(rviz::Property& parent, const QString& of, QJsonArray& statuses) {
  for (int i = 0; i < parent.numChildren(); ++i) {
    rviz::Property* child = parent.childAt(i);
    if (auto* status = dynamic_cast<rviz::StatusProperty*>(child)) {
      if (dynamic_cast<rviz::StatusList*>(status) == nullptr)
        statuses.append(entry(of, status->getName(), status->getLevel(), status->getValue().toString()));
      addStatusesOf(*status, of, statuses);
    }
  }
}

void addDisplays(rviz::DisplayGroup& group, QJsonArray& statuses) {
  for (int i = 0; i < group.numDisplays(); ++i) {
    rviz::Display* display = group.getDisplayAt(i);
    if (dynamic_cast<rviz::FailedDisplay*>(display) != nullptr)
      statuses.append(entry(display->getName(), "Class", rviz::StatusProperty::Error, "The plugin was not loaded."));
    if (display->isEnabled()) addStatusesOf(*display, display->getName(), statuses);
    if (auto* inner = dynamic_cast<rviz::DisplayGroup*>(display)) addDisplays(*inner, statuses);
  }
}

// Plugins that could not be loaded; rviz puts others in their place, which say so only when somebody looks.
void addFailedPlugins(rviz::VisualizationFrame& frame, QJsonArray& statuses) {
  const auto failed = [&statuses](const QString& what) {
    statuses.append(entry(what, "Class", rviz::StatusProperty::Error, "The plugin was not loaded."));
  };
  rviz::VisualizationManager& manager = *frame.getManager();
  rviz::ToolManager& tools = *manager.getToolManager();
  for (int i = 0; i < tools.numTools(); ++i)
    if (dynamic_cast<rviz::FailedTool*>(tools.getTool(i)) != nullptr) failed(tools.getTool(i)->getName());
  if (dynamic_cast<rviz::FailedViewController*>(manager.getViewManager()->getCurrent()) != nullptr) failed("view");
  for (rviz::FailedPanel* panel : frame.findChildren<rviz::FailedPanel*>()) failed(panel->getName());
}

bool isOurs(const QString& class_id) {
  return class_id.startsWith("vibe_rviz_plugins/");
}

// What of this package's displays, tools and view has properties.
std::vector<std::pair<const rviz::Property*, QString>> ownParents(rviz::VisualizationManager& manager) {
  std::vector<std::pair<const rviz::Property*, QString>> parents;
  rviz::DisplayGroup& displays = *manager.getRootDisplayGroup();
  for (int i = 0; i < displays.numDisplays(); ++i)
    if (isOurs(displays.getDisplayAt(i)->getClassId()))
      parents.emplace_back(displays.getDisplayAt(i), displays.getDisplayAt(i)->getName());
  rviz::ToolManager& tools = *manager.getToolManager();
  for (int i = 0; i < tools.numTools(); ++i)
    if (isOurs(tools.getTool(i)->getClassId()))
      parents.emplace_back(tools.getTool(i)->getPropertyContainer(), tools.getTool(i)->getName());
  rviz::ViewController* view = manager.getViewManager()->getCurrent();
  if (isOurs(view->getClassId())) parents.emplace_back(view, view->getName());
  return parents;
}

QJsonObject helpOf(rviz::VisualizationManager& manager) {
  int count = 0;
  QJsonArray missing;
  for (const auto& [parent, name] : ownParents(manager)) {
    const vibe::rviz_plugins::PropertyHelp help = vibe::rviz_plugins::checkPropertyHelp(*parent, name.toStdString());
    count += help.count;
    for (const std::string& path : help.missing) missing.append(QString::fromStdString(path));
  }
  return {{"properties", count}, {"without_help", missing}};
}

double residentMemory() {
  std::ifstream file("/proc/self/statm");
  double size = 0, resident = 0;
  file >> size >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

rviz::VisualizationFrame* findFrame() {
  for (QWidget* widget : QApplication::topLevelWidgets())
    if (auto* frame = dynamic_cast<rviz::VisualizationFrame*>(widget)) return frame;
  return nullptr;
}

void report(const QString& file_name) {
  rviz::VisualizationFrame* frame = findFrame();
  if (frame == nullptr || frame->getManager() == nullptr) return;
  QJsonArray statuses;
  addDisplays(*frame->getManager()->getRootDisplayGroup(), statuses);
  addFailedPlugins(*frame, statuses);
  const QJsonObject told{{"frames", static_cast<double>(frame->getManager()->getFrameCount())},
                         {"memory", residentMemory()},
                         {"tool", frame->getManager()->getToolManager()->getCurrentTool()->getName()},
                         {"help", helpOf(*frame->getManager())},
                         {"statuses", statuses}};
  QSaveFile file(file_name);  // readers see the old report or the new one
  if (file.open(QIODevice::WriteOnly)) {
    file.write(QJsonDocument(told).toJson());
    file.commit();
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: rviz_report FILE [options of rviz]\n");
    return 2;
  }
  const QString file_name = QString::fromLocal8Bit(argv[1]);
  for (int i = 1; i < argc; ++i) argv[i] = argv[i + 1];  // the last one is the null after the arguments
  --argc;
  QApplication application(argc, argv);
  rviz::VisualizerApp rviz_application;
  rviz_application.setApp(&application);
  if (!rviz_application.init(argc, argv)) return 1;
  vibe::rviz_plugins::RvizEvents events(*findFrame()->getManager());
  QTimer timer;
  QObject::connect(&timer, &QTimer::timeout, [&file_name] { report(file_name); });
  timer.start(kInterval);
  return application.exec();
}
