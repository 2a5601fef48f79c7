#include "panels/record_box.hpp"

#include <QDateTime>
#include <QDir>
#include <QFileInfo>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>

#include "panels/panel_style.hpp"

namespace vibe::rviz_plugins {
namespace {

constexpr int kCloseTimeout = 10000;  // for the recorder to write what it holds, when rviz is closed [ms]

}  // namespace

RecordBox::RecordBox(QStringList command, QWidget* parent)
    : QWidget(parent),
      command_(std::move(command)),
      record_(new QPushButton("Record")),
      folder_(new QLineEdit("recordings")),
      state_(wrappingLabel()) {
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->addWidget(record_, 0, 0);
  grid->addWidget(folder_, 0, 1);
  grid->addWidget(state_, 1, 0, 1, 2);
  record_->setObjectName("record");
  record_->setToolTip("Records inputs, events and all that a replay needs, until the button is pressed again.");
  folder_->setObjectName("recordings");
  folder_->setToolTip("Folder of the recordings, relative to where rviz was started.");
  state_->setObjectName("recording");
  state_->hide();
  process_.setProcessChannelMode(QProcess::MergedChannels);
  QObject::connect(record_, &QPushButton::clicked, this, [this] {
    if (process_.state() == QProcess::NotRunning)
      begin();
    else
      end();
  });
  QObject::connect(
      &process_, QOverload<int, QProcess::ExitStatus>::of(&QProcess::finished), this,
      [this](int status, QProcess::ExitStatus how) { takeEnd(how == QProcess::NormalExit ? status : -1); });
  QObject::connect(&process_, &QProcess::errorOccurred, this, [this](QProcess::ProcessError error) {
    if (error == QProcess::FailedToStart) show("The recorder cannot be started: " + process_.errorString() + ".", true);
  });
}

RecordBox::~RecordBox() {
  process_.disconnect();
  if (process_.state() == QProcess::NotRunning) return;
  process_.terminate();
  process_.waitForFinished(kCloseTimeout);
}

void RecordBox::setFolder(const QString& folder) {
  folder_->setText(folder);
}

QString RecordBox::folder() const {
  return folder_->text();
}

void RecordBox::begin() {
  const QDir folder(QDir::current().filePath(folder_->text()));
  if (!folder.mkpath(".")) {
    show("The folder " + folder.absolutePath() + " cannot be made; choose another one.", true);
    return;
  }
  file_ = folder.absoluteFilePath(QDateTime::currentDateTime().toString("yyyy-MM-dd-HHmmss") + ".bag");
  const QString inputs = QString::fromStdString(name_space_.empty() ? "" : name_space_ + "/") + "applied_input";
  QStringList words = command_;
  const QString program = words.takeFirst();
  words << "--last" << inputs << file_;
  process_.start(program, words);
  record_->setText("Stop recording");
  folder_->setEnabled(false);
  show("Recording to " + file_, false);
}

void RecordBox::end() {
  record_->setEnabled(false);
  show("Ending the recording...", false);
  process_.terminate();
}

void RecordBox::takeEnd(int status) {
  record_->setText("Record");
  record_->setEnabled(true);
  folder_->setEnabled(true);
  const QStringList said = QString::fromUtf8(process_.readAll()).split('\n', Qt::SkipEmptyParts);
  const QString last = said.isEmpty() ? QString("The recorder ended with status %1.").arg(status) : said.last();
  show(last, status != 0);
}

void RecordBox::refresh() {
  if (process_.state() != QProcess::Running || !record_->isEnabled()) return;
  const double size = 1e-6 * static_cast<double>(QFileInfo(file_ + ".active").size());
  show(QString("Recording to %1: %2 MB").arg(file_).arg(size, 0, 'f', 1), false);
}

void RecordBox::show(const QString& sentence, bool failed) {
  QPalette colours = palette();
  if (failed) colours.setColor(QPalette::WindowText, dangerColour(colours));
  state_->setPalette(colours);
  state_->setText(sentence);
  state_->show();
}

}  // namespace vibe::rviz_plugins
