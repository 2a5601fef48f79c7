#pragma once
#include <QTableWidget>

#include "messages/suture_rows.hpp"

namespace vibe::rviz_plugins {

/// One row per set of bites.
class SutureTable : public QTableWidget {
 public:
  explicit SutureTable(QWidget* parent = nullptr);

  void display(const std::vector<SutureRow>& rows);
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return sizeHint(); }

 private:
  void displayRow(int row, const SutureRow& content);
};

}  // namespace vibe::rviz_plugins
