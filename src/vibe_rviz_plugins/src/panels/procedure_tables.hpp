#pragma once

#include <QListWidget>
#include <QTableWidget>
#include <string>

#include <vibe_msgs/ProcedureEvent.h>

#include "vibe_operator/messages/table_rows.hpp"

namespace vibe::rviz_plugins {

/// Recent events, newest first, each with the symbol of its severity. Their number is limited. A note that repeats
/// without another event in between is listed once, with its last time.
class EventList : public QListWidget {
 public:
  static constexpr int kMax = 200;

  explicit EventList(QWidget* parent = nullptr);

  /// @param origin  stamp that counts as 0 s in what is shown [s]
  void add(const vibe_msgs::ProcedureEvent& event, double origin);
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return sizeHint(); }

 private:
  std::string newest_;  // sentence of the top entry
};

/// One row per set of bites.
class SutureTable : public QTableWidget {
 public:
  explicit SutureTable(QWidget* parent = nullptr);

  void display(const std::vector<operating::SutureRow>& rows);
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return sizeHint(); }

 private:
  void displayRow(int row, const operating::SutureRow& content);
};

}  // namespace vibe::rviz_plugins
