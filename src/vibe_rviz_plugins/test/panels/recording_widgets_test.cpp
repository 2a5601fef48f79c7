// The record button with a recorder that only tells what it is called with, and the bar of the replay panel.
#include <gtest/gtest.h>

#include <QFile>
#include <QLabel>
#include <QLineEdit>
#include <QMouseEvent>
#include <QPushButton>
#include <QTemporaryDir>
#include <QTest>

#include "offscreen.hpp"
#include "panels/record_box.hpp"
#include "panels/replay_panel.hpp"

namespace vibe::rviz_plugins::recording_widgets_test {
namespace {

constexpr int kPatience = 10000;  // [ms]

struct RecordingWidgets : testing::Test {
  RecordingWidgets() { offscreenApplication(); }
  QTemporaryDir folder;

  // A recorder that writes what it is called with, and ends on SIGTERM like vibe_record.
  static QStringList recorder(int status) {
    const QString script =
        "printf '%%s ' \"$@\" > \"$3.active\"; trap 'mv \"$3.active\" \"$3\"; echo first; echo the end; exit %1' TERM;"
        "while true; do sleep 0.05; done";
    return {"bash", "-c", script.arg(status).replace("%%", "%"), "recorder"};
  }

  static QString sentence(const RecordBox& box) { return box.findChild<QLabel*>("recording")->text(); }
  static void press(RecordBox& box) { box.findChild<QPushButton*>("record")->click(); }
  static QString read(const QString& name) {
    QFile file(name);
    return file.open(QIODevice::ReadOnly) ? QString::fromUtf8(file.readAll()) : QString();
  }
};

TEST_F(RecordingWidgets, theButtonStartsAndEndsTheRecorder) {
  RecordBox box(recorder(0));
  box.setFolder(folder.filePath("new"));
  box.setNamespace("/left");
  press(box);
  EXPECT_TRUE(QTest::qWaitFor([&] { return !read(box.file() + ".active").isEmpty(); }, kPatience));
  EXPECT_EQ(read(box.file() + ".active"), "--last /left/applied_input " + box.file() + " ");
  const auto shows_size = [&] {
    box.refresh();  // says nothing until Qt, too, knows that the recorder runs
    return sentence(box).contains(" MB");
  };
  EXPECT_TRUE(QTest::qWaitFor(shows_size, kPatience)) << sentence(box).toStdString();
  EXPECT_EQ(box.findChild<QPushButton*>("record")->text(), "Stop recording");
  press(box);
  EXPECT_TRUE(QTest::qWaitFor([&] { return sentence(box) == "the end"; }, kPatience)) << sentence(box).toStdString();
  EXPECT_TRUE(QFile::exists(box.file()));
  EXPECT_EQ(box.findChild<QPushButton*>("record")->text(), "Record");
}

TEST_F(RecordingWidgets, whatIsRecordedIsKeptWhenTheWindowCloses) {
  QString file;
  {
    RecordBox box(recorder(0));
    box.setFolder(folder.path());
    press(box);
    file = box.file();
    ASSERT_TRUE(QTest::qWaitFor([&] { return !read(file + ".active").isEmpty(); }, kPatience));
  }
  EXPECT_TRUE(QFile::exists(file));
}

TEST_F(RecordingWidgets, aRecorderThatFailsOrIsNotThereIsReported) {
  RecordBox box({"/nowhere/vibe_record"});
  box.setFolder(folder.path());
  press(box);
  EXPECT_TRUE(QTest::qWaitFor([&] { return sentence(box).contains("cannot be started"); }, kPatience));
  RecordBox nowhere(recorder(0));
  nowhere.setFolder("/proc/recordings");
  press(nowhere);
  EXPECT_TRUE(sentence(nowhere).contains("/proc/recordings"));
}

TEST_F(RecordingWidgets, theBarAsksRoughlyWhileDraggedAndExactlyAtTheEnd) {
  std::vector<std::pair<double, bool>> asked;
  ReplaySlider slider([&](double time, bool exact) { asked.emplace_back(time, exact); });
  slider.resize(416, 44);
  QTest::mousePress(&slider, Qt::LeftButton, {}, {208, 27});
  EXPECT_TRUE(asked.empty()) << "there is no recording yet";
  QTest::mouseRelease(&slider, Qt::LeftButton, {}, {208, 27});
  slider.display(0, 100, {{20, "suture", true}, {30, "bite", false}});
  QTest::mousePress(&slider, Qt::LeftButton, {}, {208, 27});
  QTest::mouseRelease(&slider, Qt::LeftButton, {}, {1000, 27});
  ASSERT_EQ(asked.size(), 2U);
  EXPECT_NEAR(asked[0].first, 50, 0.5);
  EXPECT_FALSE(asked[0].second);
  EXPECT_EQ(asked[1].first, 100);
  EXPECT_TRUE(asked[1].second);
}

}  // namespace
}  // namespace vibe::rviz_plugins::recording_widgets_test
