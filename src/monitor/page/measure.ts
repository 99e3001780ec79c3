import type * as THREE from 'three';
import {geoText, toGeo, utmText, type Geo} from './geodesy';
import type {FleetMap} from './map';
import {comparable, kNoDistance, kNotGeoreferenced, metres} from './model';
import {el, shape} from './dom';

/** Two clicks on points of the map: distance, height and coordinates. */
export class Measure {
  active = false;
  private picked: {p: THREE.Vector3; floating?: number}[] = [];

  constructor(
    private map: FleetMap,
    private overlay: SVGSVGElement,
    private show: (content: HTMLElement[] | null) => void,
  ) {}

  start(): void {
    this.active = true;
    this.picked = [];
    this.show([
      el('h2', {}, 'Measure'),
      el('p', {class: 'hint'}, 'Click two points of the map, or bring the cross to them by keys and press Enter.'),
    ]);
    this.draw();
  }

  stop(): void {
    if (!this.active) return;
    this.active = false;
    this.picked = [];
    this.show(null);
    this.draw();
  }

  /** Takes the point at a pixel; false: there is none. */
  click(x: number, y: number, reach: number, origin: Geo): boolean {
    const at = this.map.pointAt(x, y, reach);
    if (!at) return false;
    const one = {p: at.p, floating: at.submap.floating};
    this.picked = this.picked.length === 2 ? [one] : [...this.picked, one];
    const rows = this.picked.flatMap(({p, floating}, k) => {
      const geo = toGeo(origin, p.toArray()),
        enu = p
          .toArray()
          .map((v) => v.toFixed(2))
          .join(', ');
      const place =
        floating === undefined
          ? [geoText(geo), el('br'), utmText(geo), el('br'), `ENU ${enu} m`]
          : [`Place on Earth ${kNotGeoreferenced}`, el('br'), `on the map ${enu} m`];
      return [el('dt', {}, 'AB'[k]), el('dd', {}, ...place)];
    });
    const [a, b] = this.picked.map(({p}) => p);
    if (b && !comparable(this.picked[0], this.picked[1])) rows.push(el('dt', {}, 'A to B'), el('dd', {}, kNoDistance));
    else if (b) {
      const flat = Math.hypot(b.x - a.x, b.y - a.y);
      rows.push(
        el('dt', {}, 'distance'),
        el('dd', {class: 'big'}, metres(a.distanceTo(b))),
        el('dt', {}, 'on the plan'),
        el('dd', {}, metres(flat)),
        el('dt', {}, 'height'),
        el('dd', {}, `${b.z >= a.z ? '+' : '−'}${metres(Math.abs(b.z - a.z))}`),
      );
    }
    this.show([el('h2', {}, 'Measure'), el('dl', {}, ...rows)]);
    this.draw();
    return true;
  }

  draw(): void {
    const places = this.picked.map(({p}) => this.map.project(p));
    const [a, b] = places;
    const shapes = a && b ? [shape('line', {x1: a.x, y1: a.y, x2: b.x, y2: b.y})] : [];
    places.forEach((q, k) => {
      if (!q) return;
      shapes.push(shape('circle', {cx: q.x, cy: q.y, r: 5}), shape('text', {x: q.x + 9, y: q.y - 7}, 'AB'[k]));
    });
    this.overlay.replaceChildren(...shapes);
  }
}
