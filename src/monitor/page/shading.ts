import * as THREE from 'three';

/** A picture of points, with nothing (alpha 0) where there is none, and its depths as WebGL has them. */
export interface PointPicture {
  colours: THREE.Texture;
  depths: THREE.Texture;
}

/** The view of a picture, and its device pixels. */
export interface View {
  camera: THREE.PerspectiveCamera | THREE.OrthographicCamera;
  width: number;
  height: number;
}

// Eye-dome lighting (C. Boucheny, 2009): a point is darkened by how far it lies behind its neighbours on the screen, in
// units of a pixel's size there, so that edges and slopes read without normals.
const kFragment = /* glsl */ `
uniform sampler2D colours, depths;
uniform vec2 texel;
uniform float near, far, planar, pixelAtOne, radius, strength;
varying vec2 at;

float depthAt(vec2 p) {
  float d = texture2D(depths, p).x;
  if (planar > 0.5) return near + d * (far - near);
  return near * far / (far - d * (far - near));
}

void main() {
  vec4 colour = texture2D(colours, at);
  if (colour.a < 0.5) discard;
  if (strength == 0.0) {
    gl_FragColor = colour;
    return;
  }
  float depth = depthAt(at);
  float pixel = pixelAtOne * (planar > 0.5 ? 1.0 : depth);
  float shade = 0.0;
  for (int k = 0; k < 8; ++k) {
    float angle = 0.785398 * float(k);
    vec2 next = at + radius * texel * vec2(cos(angle), sin(angle));
    if (texture2D(colours, next).a < 0.5) { shade += 0.12; continue; }
    shade += clamp((depth - depthAt(next)) / (pixel * 14.0), 0.0, 1.0);
  }
  gl_FragColor = vec4(colour.rgb * exp(-strength * shade / 8.0), 1.0);
}`;
const kStrength = 1.15;

/** Brings a picture of points into the renderer's canvas, on what is there. */
export class Shading {
  private material: THREE.ShaderMaterial;
  private scene = new THREE.Scene();
  private camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);

  constructor() {
    const uniform = (value: unknown) => ({value});
    this.material = new THREE.ShaderMaterial({
      vertexShader: 'varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }',
      fragmentShader: kFragment,
      depthTest: false,
      depthWrite: false,
      uniforms: {
        colours: uniform(null),
        depths: uniform(null),
        texel: uniform(new THREE.Vector2()),
        near: uniform(0),
        far: uniform(1),
        planar: uniform(0),
        pixelAtOne: uniform(1),
        radius: uniform(1),
        strength: uniform(0),
      },
    });
    const quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), this.material);
    quad.frustumCulled = false;
    this.scene.add(quad);
  }

  /** `pixelAtOne`: m that a pixel spans at a distance of 1 m. */
  draw(
    renderer: THREE.WebGLRenderer,
    picture: PointPicture,
    {camera, width, height}: View,
    pixelAtOne: number,
    shaded: boolean,
  ): void {
    const u = this.material.uniforms;
    u.colours.value = picture.colours;
    u.depths.value = picture.depths;
    u.texel.value.set(1 / width, 1 / height);
    u.near.value = camera.near;
    u.far.value = camera.far;
    u.planar.value = camera instanceof THREE.OrthographicCamera ? 1 : 0;
    u.pixelAtOne.value = pixelAtOne;
    u.radius.value = renderer.getPixelRatio();
    u.strength.value = shaded ? kStrength : 0;
    renderer.render(this.scene, this.camera);
  }
}
