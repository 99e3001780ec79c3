import * as THREE from 'three';
import {tonesOf, turboTexture} from './ramp';

export type ColourMode = 'robot' | 'height' | 'intensity' | 'age' | 'sigma';
/** Values of PointStyle's mode; age and sigma put each submap as a whole on the ramp. */
export const kModes: Record<ColourMode, number> = {robot: 0, height: 1, intensity: 2, age: 3, sigma: 3};

/** The style that all points share. */
export interface PointStyle {
  mode: {value: number}; // 0 robot, 1 height, 2 intensity, 3 the submap's own share
  low: {value: number}; // m, of the colours of height
  high: {value: number};
  lowTone: {value: number}; // of a robot's colour at these heights (ramp.ts)
  highTone: {value: number};
  pixelsPerMetre: {value: number}; // in plan view; at 1 m in perspective
  planar: {value: number};
  ratio: {value: number}; // device pixels per pixel
}

export const kPointSize = {metres: 0.11, min: 1.7, max: 6}; // the latter two in pixels

export function pointStyle(): PointStyle {
  const [lowTone, highTone] = tonesOf(false);
  return {
    mode: {value: 0},
    low: {value: 0},
    high: {value: 1},
    lowTone: {value: lowTone},
    highTone: {value: highTone},
    pixelsPerMetre: {value: 1},
    planar: {value: 0},
    ratio: {value: 1},
  };
}

const kVertex = /* glsl */ `
attribute float intensity;
uniform sampler2D styles;  // of each block of 256 points: three rows of its matrix, then colour and share
uniform sampler2D turbo;
uniform float mode, low, high, lowTone, highTone, pixelsPerMetre, planar, ratio;
varying vec3 vColour;

vec3 ramp(float x) { return texture2D(turbo, vec2(x * 255.0 / 256.0 + 0.5 / 256.0, 0.5)).rgb; }
vec3 toned(vec3 colour, float tone) { return tone < 0.0 ? colour * (1.0 + tone) : mix(colour, vec3(1.0), tone); }

void main() {
  int block = gl_VertexID >> 8;
  ivec2 at = ivec2((block & 63) << 2, block >> 6);
  vec4 steps = vec4(position, 1.0);
  vec3 world = vec3(dot(texelFetch(styles, at, 0), steps), dot(texelFetch(styles, at + ivec2(1, 0), 0), steps),
                    dot(texelFetch(styles, at + ivec2(2, 0), 0), steps));
  vec4 own = texelFetch(styles, at + ivec2(3, 0), 0);
  vec4 view = viewMatrix * vec4(world, 1.0);
  gl_Position = projectionMatrix * view;
  float scale = planar > 0.5 ? pixelsPerMetre : pixelsPerMetre / max(0.5, -view.z);
  gl_PointSize = ratio * clamp(${kPointSize.metres} * scale, ${kPointSize.min}, ${kPointSize.max.toFixed(1)});
  float height = clamp((world.z - low) / max(0.1, high - low), 0.0, 1.0);
  if (mode < 0.5) vColour = mix(toned(own.rgb, lowTone), toned(own.rgb, highTone), height);
  else if (mode < 1.5) vColour = ramp(height);
  else if (mode > 2.5) vColour = ramp(own.a);
  else vColour = ramp(0.08 + 0.84 * clamp(intensity, 0.0, 1.0));
}`;

const kFragment = /* glsl */ `
varying vec3 vColour;
void main() { gl_FragColor = vec4(vColour, 1.0); }`;

/** Drawn as written, without tone curves. */
export const rgbOf = (colour: string) => new THREE.Color().setStyle(colour, THREE.LinearSRGBColorSpace);

export function pointMaterial(style: PointStyle): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({
    vertexShader: kVertex,
    fragmentShader: kFragment,
    uniforms: {...style, styles: {value: null}, turbo: {value: turboTexture()}},
  });
}
