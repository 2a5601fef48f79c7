// Numbers of the rooms tool, self_contact, tool_contact and constraints, for step_policy.hpp: name, default, unit,
// meaning, source or measurement.
