import * as THREE from 'three';

// Eye-dome lighting (C. Boucheny, 2009): a point is darkened by how far it lies behind its neighbours on the screen, in units
// of a pixel's size there, so that edges and slopes read without normals.
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

export class Shading {
  private target: THREE.WebGLRenderTarget;
  private material: THREE.ShaderMaterial;
  private scene = new THREE.Scene();
  private camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);

  constructor() {
    this.target = new THREE.WebGLRenderTarget(1, 1, {minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter});
    this.target.depthTexture = new THREE.DepthTexture(1, 1, THREE.UnsignedIntType);
    const uniform = (value: unknown) => ({value});
    this.material = new THREE.ShaderMaterial({
      vertexShader: 'varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }',
      fragmentShader: kFragment,
      depthTest: false,
      depthWrite: false,
      uniforms: {
        colours: uniform(this.target.texture), depths: uniform(this.target.depthTexture), texel: uniform(new THREE.Vector2()),
        near: uniform(0), far: uniform(1), planar: uniform(0), pixelAtOne: uniform(1), radius: uniform(1), strength: uniform(1.15),
      },
    });
    const quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), this.material);
    quad.frustumCulled = false;
    this.scene.add(quad);
  }

  resize(width: number, height: number): void {
    this.target.setSize(Math.max(1, width), Math.max(1, height));
  }

  /** Draws `points` into the renderer's canvas, on what is there. `pixelAtOne`: m that a pixel spans at a distance of 1 m. */
  draw(renderer: THREE.WebGLRenderer, points: THREE.Scene, camera: THREE.PerspectiveCamera | THREE.OrthographicCamera, pixelAtOne: number): void {
    renderer.setRenderTarget(this.target);
    renderer.setClearColor(0x000000, 0);
    renderer.clear();
    renderer.render(points, camera);
    renderer.setRenderTarget(null);
    const u = this.material.uniforms;
    u.texel.value.set(1 / this.target.width, 1 / this.target.height);
    u.near.value = camera.near;
    u.far.value = camera.far;
    u.planar.value = camera instanceof THREE.OrthographicCamera ? 1 : 0;
    u.pixelAtOne.value = pixelAtOne;
    u.radius.value = 1.0 * renderer.getPixelRatio();
    renderer.render(this.scene, this.camera);
  }
}
