#version 120
// Position and normal in the camera frame, vertex colour, and position on the organ at rest.
uniform mat4 worldViewProj;
uniform mat4 worldView;

varying vec3 view_position;
varying vec3 view_normal;
varying vec4 colour;
varying vec3 rest;

void main() {
  gl_Position = worldViewProj * gl_Vertex;
  view_position = (worldView * gl_Vertex).xyz;
  view_normal = (worldView * vec4(gl_Normal, 0.0)).xyz;
  colour = gl_Color;
  rest = gl_MultiTexCoord0.xyz;
}
