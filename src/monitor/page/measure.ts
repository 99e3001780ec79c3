import type * as THREE from 'three';
import {geoText, toGeo, utmText, type Geo} from './geodesy';
import type {FleetMap} from './map';
import {metres} from './model';
import {el} from './dom';

const kSvg = 'http://www.w3.org/2000/svg';

/** Two clicks on points of the map: distance, height and coordinates. */
export class Measure {
  active = false;
  private picked: THREE.Vector3[] = [];

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
    const p = this.map.pointAt(x, y, reach);
    if (!p) return false;
    this.picked = this.picked.length === 2 ? [p] : [...this.picked, p];
    const rows = this.picked.flatMap((point, k) => {
      const geo = toGeo(origin, point.toArray()),
        enu = point
          .toArray()
          .map((v) => v.toFixed(2))
          .join(', ');
      return [el('dt', {}, 'AB'[k]), el('dd', {}, geoText(geo), el('br'), utmText(geo), el('br'), `ENU ${enu} m`)];
    });
    const [a, b] = this.picked;
    if (b) {
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
    const places = this.picked.map((p) => this.map.project(p));
    const shapes: SVGElement[] = [];
    const shape = (name: string, attributes: Record<string, string | number>, text = '') => {
      const one = document.createElementNS(kSvg, name);
      for (const [key, value] of Object.entries(attributes)) one.setAttribute(key, String(value));
      one.textContent = text;
      shapes.push(one);
    };
    const [a, b] = places;
    if (a && b) shape('line', {x1: a.x, y1: a.y, x2: b.x, y2: b.y});
    places.forEach((q, k) => {
      if (!q) return;
      shape('circle', {cx: q.x, cy: q.y, r: 5});
      shape('text', {x: q.x + 9, y: q.y - 7}, 'AB'[k]);
    });
    this.overlay.replaceChildren(...shapes);
  }
}
