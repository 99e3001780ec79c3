import * as THREE from 'three';
import type {PointPool} from './point_pool';
import type {PointPicture, View} from './shading';

/** Draws points by WebGL into textures. */
export class GlPoints {
  private target = new THREE.WebGLRenderTarget(1, 1, {minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter});
  private scene = new THREE.Scene();

  constructor(
    pool: PointPool,
    private renderer: THREE.WebGLRenderer,
  ) {
    this.target.depthTexture = new THREE.DepthTexture(1, 1, THREE.UnsignedIntType);
    this.scene.add(pool.object);
  }

  render({camera, width, height}: View): PointPicture {
    if (this.target.width !== width || this.target.height !== height) this.target.setSize(width, height);
    this.renderer.setRenderTarget(this.target);
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.clear();
    this.renderer.render(this.scene, camera);
    this.renderer.setRenderTarget(null);
    return {colours: this.target.texture, depths: this.target.depthTexture!};
  }
}
