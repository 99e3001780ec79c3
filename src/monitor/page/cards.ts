import type {Vector3} from 'three';
import {el} from './dom';
import type {Edge} from './edges';
import {geoText, toGeo} from './geodesy';
import type {RobotLink} from './links';
import {
  comparable,
  duration,
  type FleetNode,
  isNumber,
  kNoDistance,
  kNotGeoreferenced,
  metres,
  type State,
} from './model';

const kVerdicts = {
  accepted: 'Accepted registration, whose alignment is not held here',
  ambiguous: 'Ambiguous registration, whose alignment is not held here',
  rejected: 'Rejected registration',
  failed: 'Failed registration',
};

/** Describes a node, which the map has at `p` (m of ENU); null if there is no such node. */
export function nodeCard(state: State, id: string, p: Vector3 | undefined): HTMLElement[] | null {
  const node = state.nodes.find((one) => one.id === id);
  if (!node) return null;
  const rows = [madeRow(node), ...(p ? placeRows(state, node, p) : [])];
  const sigma = node.gps_sigma_m;
  rows.push([
    'GPS',
    sigma === undefined
      ? 'none'
      : !isNumber(sigma)
        ? 'of unknown accuracy'
        : `known to ${sigma.toFixed(2)} m (1 σ) before alignment`,
  ]);
  const missing = node.bytes > 0 ? 'not held here' : 'empty';
  rows.push(['submap', node.submap ? `${Math.round(node.bytes / 1000)} kB, held` : missing]);
  const tied = state.alignments.filter((one) => one.i === id || one.j === id).length;
  rows.push(['alignments', String(tied)]);
  return [el('h2', {}, `Node ${id}`), table(rows)];
}

/** Describes a link between two robots; `shownBy`: the running robot that hears the other, else it is of a run. */
export function linkCard({from, to, text}: RobotLink, shownBy?: string): HTMLElement[] {
  const when = shownBy ? `now, as ${shownBy} hears it` : 'at the time of the slider, by the worse of both ways';
  return [
    el('h2', {}, `Link of ${from} and ${to}`),
    table([
      ['state', text],
      ['known', when],
    ]),
  ];
}

const madeRow = (node: FleetNode): [string, string] => [
  'made',
  `${duration(node.stamp_s ?? node.t)} after the first node, by ${node.robot}`,
];

function placeRows(state: State, node: FleetNode, p: Vector3): [string, string][] {
  const enu = p.toArray().map((v) => v.toFixed(2));
  if (node.floating !== undefined)
    return [
      ['on the map', `${enu.join(', ')} m`],
      ['on Earth', kNotGeoreferenced],
    ];
  return [
    ['ENU', `${enu.join(', ')} m`],
    ['WGS84', geoText(toGeo(state.origin, p.toArray()))],
  ];
}

/** Describes a point at `p` (m of ENU) of a node's submap. */
export function pointCard(state: State, id: string, p: Vector3): HTMLElement[] | null {
  const node = state.nodes.find((one) => one.id === id);
  if (!node) return null;
  return [el('h2', {}, `Point of the submap of node ${id}`), table([...placeRows(state, node, p), madeRow(node)])];
}

/** Describes the way of a robot from a node to the next one, `apart` (m) from it. */
export function stepCard(state: State, from: string, to: string, apart: number | undefined): HTMLElement[] | null {
  const [a, b] = [from, to].map((id) => state.nodes.find((one) => one.id === id));
  if (!a || !b) return null;
  const times = [a, b].map((node) => duration(node.stamp_s ?? node.t)).join(' to ');
  const rows: [string, string][] = [
    ['from', from],
    ['to', to],
    ['driven', `${times} after the first node`],
  ];
  if (apart !== undefined) rows.push(['length', metres(apart)]);
  return [el('h2', {}, `Trajectory of ${a.robot}`), table(rows)];
}

/** Describes an edge whose nodes are `apart` (m) on the map, if both are there. */
export function edgeCard(state: State, edge: Edge, apart: number | undefined): HTMLElement[] {
  const registration = edge.registration === undefined ? undefined : state.registrations[edge.registration];
  const alignment = edge.alignment === undefined ? undefined : state.alignments[edge.alignment];
  const use = edge.kind === 'used' ? 'Alignment in use' : 'Alignment not used';
  const title = alignment || !registration ? use : kVerdicts[registration.verdict];
  const rows: [string, string][] = [];
  const [a, b] = [edge.a, edge.b].map((id) => state.nodes.find((one) => one.id === id));
  if (apart !== undefined) rows.push(['nodes', comparable(a, b) ? `${metres(apart)} apart as placed` : kNoDistance]);
  if (alignment && alignment.modes > 1) rows.push(['poses', `${alignment.modes} fit`]);
  return [
    el('h2', {}, el('i', {class: `key ${edge.kind}`}), `${title}: ${edge.b} → ${edge.a}`),
    el('p', {}, registration?.sentence ?? alignment?.sentence ?? ''),
    table(rows),
  ];
}

function table(rows: [string, string][]): HTMLElement {
  return el('dl', {}, ...rows.flatMap(([name, value]) => [el('dt', {}, name), el('dd', {}, value)]));
}
