// The shaders of vibe_graphics, as WebGL 2 reads them. They are written for the GLSL of Ogre (1.20); what differs is the
// name of what comes in and goes out. Nothing of their look is here.

import { GLSL3, RawShaderMaterial, type IUniform, type Side } from 'three';

const sources = import.meta.glob<string>('@media/*.{glsl,vert,frag}', { query: '?raw', import: 'default', eager: true });

function sourceOf(name: string): string {
  const path = Object.keys(sources).find((each) => each.endsWith('/' + name));
  if (!path) throw new Error(`vibe_graphics has no shader ${name}.`);
  return sources[path].replace(/#include "(.+)"/g, (_, included) => sourceOf(included));
}

const inputs: [RegExp, string, string][] = [
  [/\bgl_Vertex\b/g, 'vec4(position, 1.0)', 'in vec3 position;'],
  [/\bgl_Normal\b/g, 'normal', 'in vec3 normal;'],
  [/\bgl_Color\b/g, 'vertex_colour', 'in vec4 vertex_colour;'],
  ...[0, 1, 2, 3, 4].map((k): [RegExp, string, string] => [
    new RegExp(`\\bgl_MultiTexCoord${k}\\b`, 'g'), `texcoord${k}`, `in vec4 texcoord${k};`]),
];

const head = 'precision highp float;\nprecision highp int;\nprecision highp sampler3D;\n';

// A body of several links moves by its bones, one per vertex, whose matrices three.js keeps in a texture.
const kBones = `in vec4 skinIndex;
uniform sampler2D boneTexture;
uniform mat4 bindMatrixInverse;
mat4 bone() {
  int first = 4 * int(skinIndex.x), width = textureSize(boneTexture, 0).x;
  ivec2 at = ivec2(first % width, first / width);
  return bindMatrixInverse * mat4(texelFetch(boneTexture, at, 0), texelFetch(boneTexture, at + ivec2(1, 0), 0),
                                  texelFetch(boneTexture, at + ivec2(2, 0), 0), texelFetch(boneTexture, at + ivec2(3, 0), 0));
}
`;

function vertexShader(name: string, parts: string[]): string {
  let text = sourceOf(name).replace(/#version.*/, '').replace(/\bvarying\b/g, 'out');
  let declared = 'uniform mat4 projectionMatrix;\nuniform mat4 modelViewMatrix;\n';
  if (parts.length > 0) {
    text = text.replace(/\bgl_Vertex\b/g, '(bone() * gl_Vertex)').replace(/\bgl_Normal\b/g, '(mat3(bone()) * gl_Normal)');
    declared += kBones + parts.map((name) => `in vec3 part_${name};\nflat out vec3 of_${name};\n`).join('');
    text = text.replace('void main() {', 'void main() {' + parts.map((name) => `of_${name} = part_${name};`).join(' '));
  }
  for (const [word, replacement, declaration] of inputs) {
    if (text.search(word) >= 0) declared += declaration + '\n';
    text = text.replace(word, replacement);
  }
  text = text.replace(/uniform mat4 worldView(Proj)?;/g, '');
  text = text.replace(/\bworldViewProj\b/g, '(projectionMatrix * modelViewMatrix)').replace(/\bworldView\b/g, 'modelViewMatrix');
  return head + declared + text;
}

function fragmentShader(name: string, parts: string[]): string {
  let text = sourceOf(name).replace(/#version.*/, '').replace(/\bvarying\b/g, 'in');
  for (const part of parts)
    text = text.replace(new RegExp(`uniform (vec3|float) ${part};`), (_, type) =>
      `flat in vec3 of_${part};\n#define ${part} of_${part}${type === 'float' ? '.x' : ''}`);
  return head + 'out vec4 fragment;\n' + text.replace(/\btexture[23]D\b/g, 'texture').replace(/\bgl_FragColor\b/g, 'fragment');
}

export interface Look {
  vertex: string;
  fragment: string;
  uniforms: Record<string, IUniform>;
  side: Side;
  transparent?: boolean;
  defines?: Record<string, string>;
  parts?: string[]; // uniforms of the fragment shader that are attributes here, of a body of several links: part_NAME
}

/** A material of these two files of vibe_graphics/media; their names end in .vert and .frag. */
export function materialOf(look: Look): RawShaderMaterial {
  return new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: vertexShader(look.vertex, look.parts ?? []),
    fragmentShader: fragmentShader(look.fragment, look.parts ?? []),
    uniforms: look.uniforms,
    side: look.side,
    transparent: look.transparent ?? false,
    depthWrite: !look.transparent,
    defines: { USUAL: '1', ...look.defines },
  });
}

/** What all materials lit by the endoscope share, as in vibe.program. */
export const smoke: IUniform = { value: [0, 0, 0, 0] };
export const kReach = 0.06; // of the light, as in vibe.program [m]
