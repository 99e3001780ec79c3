import * as THREE from 'three';
import type {Edge} from './edges';
import type {FleetMap} from './map';
import type {State} from './model';
import {el} from './dom';
import {matrixOf, type Submap} from './submap';

const kTarget = '#2f7de1',
  kSource = '#d05a1b';

/** The two clouds of a registration alone on the map: before it, at each pose that it found, and as placed. */
export class PairView {
  private shown: Submap[] = [];

  constructor(private map: FleetMap) {}

  end(): void {
    for (const submap of this.shown) {
      submap.move(undefined);
      submap.tint(undefined);
    }
    this.shown = [];
    this.map.showOnly(undefined);
  }

  /** Buttons that choose where the source is drawn; null where a cloud is not here. */
  buttons(state: State, edge: Edge): HTMLElement | null {
    const target = this.find(state, edge.a),
      source = this.find(state, edge.b);
    if (!target || !source) return null;
    const alignment = edge.alignment === undefined ? undefined : state.alignments[edge.alignment];
    const places: [string, string, THREE.Matrix4 | undefined][] = [['placed', 'as placed', undefined]];
    if (target.node.gps && source.node.gps) {
      const T_target_source = matrixOf(target.node.gps).invert().multiply(matrixOf(source.node.gps));
      places.push(['gps', 'before, by GPS', T_target_source]);
    }
    alignment?.poses.forEach((pose, k) =>
      places.push([`pose-${k}`, alignment.poses.length > 1 ? `pose ${k + 1}` : 'as registered', matrixOf(pose)]),
    );
    const registration = edge.registration === undefined ? undefined : state.registrations[edge.registration];
    if (!alignment && registration?.pose) {
      const rejected = registration.verdict === 'rejected' || registration.verdict === 'failed';
      places.push(['rejected', rejected ? 'as rejected' : 'as registered', matrixOf(registration.pose)]);
    }
    const buttons = places.map(([id, label, T]) => {
      const button = el('button', {type: 'button', 'data-compare': id, 'aria-pressed': 'false'}, label);
      button.onclick = () => {
        for (const other of buttons) other.setAttribute('aria-pressed', String(other === button));
        this.show(target.submap, source.submap, T && matrixOf(target.node.T!).multiply(T));
      };
      return button;
    });
    const key = (colour: string, id: string) =>
      el('span', {}, el('i', {class: 'dot', style: `background:${colour}`}), id);
    return el(
      'div',
      {class: 'compare'},
      el('p', {class: 'hint'}, 'Both clouds: ', key(kTarget, edge.a), ' ', key(kSource, edge.b)),
      el('div', {class: 'group'}, ...buttons),
    );
  }

  private find(state: State, id: string) {
    const node = state.nodes.find((one) => one.id === id);
    const submap = node?.submap && node.T ? this.map.submaps.all.get(node.submap) : undefined;
    return node && submap && {node, submap};
  }

  private show(target: Submap, source: Submap, T_enu_source: THREE.Matrix4 | undefined): void {
    this.shown = [target, source];
    target.tint(kTarget);
    source.tint(kSource);
    source.move(T_enu_source);
    this.map.showOnly(new Set([target.hash, source.hash]));
  }
}
