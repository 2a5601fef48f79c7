// Publishes lumen/pressure (sensor_msgs/FluidPressure): the absolute pressure of the gas in the lumen [Pa], with the
// stamps of procedure/state. Parameter ~ambient_pressure [Pa], default 101325 (standard atmosphere).

// [recipe]
#include <ros/ros.h>
#include <sensor_msgs/FluidPressure.h>
#include <vibe_msgs/ProcedureState.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "lumen_pressure");
  ros::NodeHandle handle;
  const double ambient = ros::param::param("~ambient_pressure", 101325.0);
  const ros::Publisher publisher = handle.advertise<sensor_msgs::FluidPressure>("lumen/pressure", 10, true);
  const boost::function<void(const vibe_msgs::ProcedureState&)> publish = [&](const vibe_msgs::ProcedureState& state) {
    sensor_msgs::FluidPressure message;
    message.header.stamp = state.header.stamp;  // the time of the sample, not of sending
    message.header.frame_id = "stomach";
    message.fluid_pressure = ambient + state.pressure;  // the simulator gives gauge pressure
    publisher.publish(message);
  };
  const ros::Subscriber subscriber = handle.subscribe<vibe_msgs::ProcedureState>("procedure/state", 10, publish);
  ros::spin();
}
// [/recipe]
