import type {Vector3} from 'three';
import type {Edge} from './edges';

/** A choice on the map: a node, also by a point seen from it or by the way from it to the `next`; or an edge. */
export type Hit = {node: string; point?: Vector3; next?: string} | {edge: Edge};

export interface Pixel {
  x: number;
  y: number;
}

/**
 * The node, else the edge, else the step of a trajectory within `reach` pixels of a place. `nodes`: their pixels; a
 * node behind the camera has none, and edges to nodes that are not among them are not there.
 */
export function hitAt(
  at: Pixel,
  nodes: ReadonlyMap<string, Pixel | undefined>,
  nodesShown: boolean,
  edges: readonly Edge[],
  reach: number,
  steps: readonly [string, string][] = [],
): Hit | undefined {
  let best: Hit | undefined;
  let nearest = reach;
  const take = (distance: number, hit: Hit) => {
    if (distance < nearest) [nearest, best] = [distance, hit];
  };
  if (nodesShown) {
    for (const [node, pixel] of nodes) if (pixel) take(Math.hypot(pixel.x - at.x, pixel.y - at.y), {node});
  }
  if (best) return best;
  for (const edge of edges) {
    const a = nodes.get(edge.a);
    const b = nodes.get(edge.b);
    if (a && b) take(distanceToSegment(at, a, b), {edge});
  }
  if (best) return best;
  for (const [node, next] of steps) {
    const a = nodes.get(node);
    const b = nodes.get(next);
    if (a && b) take(distanceToSegment(at, a, b), {node, next});
  }
  return best;
}

export function distanceToSegment(p: Pixel, a: Pixel, b: Pixel): number {
  const x = b.x - a.x;
  const y = b.y - a.y;
  const length2 = x * x + y * y;
  const s = length2 > 0 ? Math.min(1, Math.max(0, ((p.x - a.x) * x + (p.y - a.y) * y) / length2)) : 0;
  return Math.hypot(a.x + s * x - p.x, a.y + s * y - p.y);
}
