#pragma once
#include <geometry_msgs/WrenchStamped.h>
#include <vibe_msgs/ProcedureState.h>
#include <vibe_msgs/SkillMetrics.h>
#include <vibe_msgs/SolverStatistics.h>
#include <vibe_msgs/SutureArray.h>
#include <vibe_msgs/TraineeProgress.h>

namespace vibe::rviz_plugins {

/// The last message of every topic that the panel shows; null: none has come.
struct PanelMessages {
  vibe_msgs::ProcedureStateConstPtr state;
  vibe_msgs::SkillMetricsConstPtr skill;
  vibe_msgs::SutureArrayConstPtr sutures;
  vibe_msgs::SolverStatisticsConstPtr solver_statistics;
  geometry_msgs::WrenchStampedConstPtr force;
  vibe_msgs::TraineeProgressConstPtr progress;
};

/// How fresh they are.
struct Freshness {
  double age = 0;    ///< of the last message of a moving thing, on the wall clock; NaN: none has come [s]
  double delay = 0;  ///< from the sample to its arrival; NaN: not known, stamps are simulated time [s]
};

}  // namespace vibe::rviz_plugins
