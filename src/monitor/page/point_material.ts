import * as THREE from 'three';

/** What all points share; a change is seen by every submap at once. */
export interface PointLook {
  mode: {value: number};       // 0 robot, 1 height, 2 intensity, 3 the submap's own share
  low: {value: number};        // m, of the colours of height
  high: {value: number};
  pixelsPerMetre: {value: number};  // in plan view; at 1 m in perspective
  planar: {value: number};
  ratio: {value: number};      // device pixels per pixel
}

export function pointLook(): PointLook {
  return {mode: {value: 0}, low: {value: 0}, high: {value: 1}, pixelsPerMetre: {value: 1}, planar: {value: 0}, ratio: {value: 1}};
}

const kVertex = /* glsl */ `
attribute float intensity;
uniform vec3 colour;
uniform float mode, share, low, high, pixelsPerMetre, planar, ratio;
varying vec3 vColour;

// Turbo (A. Mikhailov, 2019), by a polynomial.
vec3 turbo(float x) {
  const vec4 r4 = vec4(0.13572138, 4.61539260, -42.66032258, 132.13108234);
  const vec4 g4 = vec4(0.09140261, 2.19418839, 4.84296658, -14.18503333);
  const vec4 b4 = vec4(0.10667330, 12.64194608, -60.58204836, 110.36276771);
  const vec2 r2 = vec2(-152.94239396, 59.28637943);
  const vec2 g2 = vec2(4.27729857, 2.82956604);
  const vec2 b2 = vec2(-89.90310912, 27.34824973);
  vec4 v4 = vec4(1.0, x, x * x, x * x * x);
  vec2 v2 = v4.zw * v4.z;
  return vec3(dot(v4, r4) + dot(v2, r2), dot(v4, g4) + dot(v2, g2), dot(v4, b4) + dot(v2, b2));
}

void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vec4 view = viewMatrix * world;
  gl_Position = projectionMatrix * view;
  float scale = planar > 0.5 ? pixelsPerMetre : pixelsPerMetre / max(0.5, -view.z);
  gl_PointSize = ratio * clamp(0.11 * scale, 1.7, 6.0);
  if (mode < 0.5) {
    // A little lighter with height, so that shapes show in one colour.
    float h = clamp((world.z - low) / max(0.1, high - low), 0.0, 1.0);
    vColour = mix(colour * 0.72, mix(colour, vec3(1.0), 0.42), h);
  } else if (mode < 1.5) {
    vColour = turbo(clamp((world.z - low) / max(0.1, high - low), 0.0, 1.0));
  } else if (mode > 2.5) {
    vColour = turbo(share);
  } else {
    vColour = turbo(0.08 + 0.84 * clamp(intensity, 0.0, 1.0));
  }
}`;

const kFragment = /* glsl */ `
varying vec3 vColour;
void main() { gl_FragColor = vec4(vColour, 1.0); }`;

/** Drawn as written, without tone curves. */
export const rgbOf = (colour: string) => new THREE.Color().setStyle(colour, THREE.LinearSRGBColorSpace);

export function pointMaterial(look: PointLook, colour: string): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({
    vertexShader: kVertex,
    fragmentShader: kFragment,
    uniforms: {...look, colour: {value: rgbOf(colour)}, share: {value: 0}},
  });
}
