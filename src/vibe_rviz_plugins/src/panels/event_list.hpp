#pragma once
#include <vibe_msgs/ProcedureEvent.h>

#include <QListWidget>
#include <string>

namespace vibe {

/// What happened last, newest first, each with the symbol of its severity. Keeps a bounded number. A note that comes
/// again with nothing in between stands there once, with its last time.
class EventList : public QListWidget {
 public:
  static constexpr int kMax = 200;

  explicit EventList(QWidget* parent = nullptr);

  /// @param origin  stamp that counts as 0 s in what is shown [s]
  void add(const vibe_msgs::ProcedureEvent& event, double origin);
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return sizeHint(); }

 private:
  std::string newest_;  // sentence of the uppermost entry
};

}  // namespace vibe
