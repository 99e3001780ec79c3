import * as THREE from 'three';
import type {Submap} from './submap';

/** In pixels of the canvas, and the depth, -1 to 1. */
export interface Place {
  x: number;
  y: number;
  depth: number;
}

/** The place where a point is seen; nothing behind the camera. */
export function placeOf(p: THREE.Vector3, camera: THREE.Camera, canvas: HTMLCanvasElement): Place | undefined {
  const q = p.clone().project(camera);
  if (q.z < -1 || q.z > 1) return undefined;
  return {x: ((q.x + 1) / 2) * canvas.clientWidth, y: ((1 - q.y) / 2) * canvas.clientHeight, depth: q.z};
}

/** A drawn point, m of ENU, and the submap that it is of. */
export interface Picked {
  p: THREE.Vector3;
  submap: Submap;
}

/** The drawn point that is seen at a pixel: the nearest to the eye of those within `reach`. */
export function pointAt(
  submaps: Iterable<Submap>,
  camera: THREE.Camera,
  canvas: HTMLCanvasElement,
  x: number,
  y: number,
  reach: number,
): Picked | undefined {
  const p = new THREE.Vector3(),
    q = new THREE.Vector3();
  const view = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
  const w = canvas.clientWidth,
    h = canvas.clientHeight;
  let best: Picked | undefined,
    minCost = Infinity;
  for (const submap of submaps) {
    for (let k = 0; k < submap.drawn; ++k) {
      submap.point(k, p);
      q.copy(p).applyMatrix4(view);
      const dx = ((q.x + 1) / 2) * w - x,
        dy = ((1 - q.y) / 2) * h - y;
      const off2 = dx * dx + dy * dy;
      if (off2 > reach * reach || q.z < -1 || q.z > 1) continue;
      // A point in front wins by far; of those at one depth that under the pointer.
      const cost = q.z * 1e6 + off2;
      if (cost < minCost) [minCost, best] = [cost, {p: p.clone(), submap}];
    }
  }
  return best;
}
