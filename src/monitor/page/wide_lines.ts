import * as THREE from 'three';

const kVertex = /* glsl */ `
attribute vec3 other;
attribute float side;
uniform vec2 resolution;
uniform float width;

void main() {
  vec4 a = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  vec4 b = projectionMatrix * modelViewMatrix * vec4(other, 1.0);
  const float near = 0.01;  // an end behind the eye is moved before it
  if (a.w < near && b.w > near) a = mix(a, b, (near - a.w) / (b.w - a.w));
  else if (b.w < near && a.w > near) b = mix(b, a, (near - b.w) / (a.w - b.w));
  vec2 along = (b.xy / b.w - a.xy / a.w) * resolution;
  along = length(along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
  // Half a width beyond each end, so that pieces of a path meet.
  a.xy += (vec2(-along.y, along.x) * side - along) * width / resolution * a.w;
  gl_Position = a;
}`;

const kFragment = /* glsl */ `
uniform vec3 colour;
uniform float opacity;
void main() { gl_FragColor = vec4(colour, opacity); }`;

/**
 * Segments of so many pixels of width, in front of everything. Each is two triangles of one mesh: instances of a
 * segment, as three's LineSegments2 draws them, take 0.2 ms each if WebGL draws on the CPU.
 */
export class WideLines {
  readonly object: THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial>;

  /** `ends`: x, y, z of both ends of each segment. `size`: of the picture in pixels, followed as it changes. */
  constructor(ends: number[], colour: THREE.Color, width: number, opacity: number, size: THREE.Vector2) {
    const segments = ends.length / 6;
    const here = new Float32Array(12 * segments),
      other = new Float32Array(12 * segments),
      side = new Float32Array(4 * segments);
    const index = new Uint32Array(6 * segments);
    for (let k = 0; k < segments; ++k) {
      const a = ends.slice(6 * k, 6 * k + 3),
        b = ends.slice(6 * k + 3, 6 * k + 6);
      here.set([...a, ...a, ...b, ...b], 12 * k);
      other.set([...b, ...b, ...a, ...a], 12 * k);
      side.set([1, -1, -1, 1], 4 * k); // seen from the other end, left is right
      index.set(
        [0, 1, 2, 2, 1, 3].map((corner) => 4 * k + corner),
        6 * k,
      );
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(here, 3));
    geometry.setAttribute('other', new THREE.BufferAttribute(other, 3));
    geometry.setAttribute('side', new THREE.BufferAttribute(side, 1));
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    this.object = new THREE.Mesh(
      geometry,
      new THREE.ShaderMaterial({
        vertexShader: kVertex,
        fragmentShader: kFragment,
        transparent: true,
        depthTest: false,
        depthWrite: false,
        side: THREE.DoubleSide,
        uniforms: {
          resolution: {value: size},
          width: {value: width},
          colour: {value: colour},
          opacity: {value: opacity},
        },
      }),
    );
    this.object.frustumCulled = false;
  }

  dispose(): void {
    this.object.geometry.dispose();
    this.object.material.dispose();
  }
}
