#pragma once
#include <QProcess>
#include <QStringList>
#include <QWidget>
#include <string>

class QLabel;
class QLineEdit;
class QPushButton;

namespace vibe::rviz_plugins {

/// A button that records the graph with vibe_record, and what became of it. The recording ends with the second press or
/// with the box.
class RecordBox : public QWidget {
 public:
  /// @param command  the recorder; it gets --last, the topic of the inputs, and the file
  explicit RecordBox(QStringList command = {"rosrun", "vibe_sim", "vibe_record"}, QWidget* parent = nullptr);
  ~RecordBox() override;

  /// Whose inputs the recording begins with; empty: that of rviz.
  void setNamespace(const std::string& name) { name_space_ = name; }
  /// Where recordings are put; relative to where rviz was started.
  void setFolder(const QString& folder);
  QString folder() const;

  /// Shows the size of the file; call now and then.
  void refresh();
  QString file() const { return file_; }  ///< of the present or last recording

 private:
  QStringList command_;
  QPushButton* record_;
  QLineEdit* folder_;
  QLabel* state_;
  QProcess process_;
  QString file_;
  std::string name_space_;

  void begin();
  void end();
  void takeEnd(int status);
  void show(const QString& sentence, bool failed);
};

}  // namespace vibe::rviz_plugins
