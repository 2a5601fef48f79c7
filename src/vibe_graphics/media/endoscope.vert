#version 120
uniform mat4 worldViewProj;

varying vec2 place;

void main() {
  gl_Position = worldViewProj * gl_Vertex;
  place = gl_MultiTexCoord0.xy;
}
