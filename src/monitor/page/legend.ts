import {el} from './dom';
import type {RobotLink} from './links';
import {duration, metres} from './model';
import type {ColourMode} from './point_material';

/** State of the map after each picture. */
export interface Picture {
  drawn: number;
  total: number;
  loading: boolean;
  moving: boolean; // the view; what people read may wait until it stands still
  coarse: boolean; // it moves, and frames take long: marks are left out until it stands still
  metresPerPixel: number;
  planar: boolean;
  heights: [number, number];
  range: [number, number]; // of the submaps' ages, s, or sigmas, m
}

const kScale_px = 110;

/** The longest of 1, 2 and 5 times a power of ten, m, that the scale has room for. */
export function scaleLength(metresPerPixel: number): number {
  const max_m = kScale_px * metresPerPixel;
  const power = 10 ** Math.floor(Math.log10(max_m));
  return [5, 2, 1].map((k) => k * power).find((one) => one <= max_m) ?? power;
}

/** The words at both ends of the ramp of colours. */
export function rampEnds({heights, range}: Picture, colour: ColourMode): string[] {
  if (colour === 'height') return heights.map((h) => `${h.toFixed(1)} m`);
  if (colour === 'age') return range.map(duration);
  if (colour === 'sigma') return range.map(metres);
  return ['weak', 'strong'];
}

const kRampNames: Record<ColourMode, string> = {
  robot: '',
  height: 'Height',
  intensity: 'Intensity',
  age: 'Time',
  sigma: 'Place, 1 sigma, horizontal',
};

/** The ramp of colours with its name, and the words at both ends; null where robots have colours of their own. */
export function rampKey(picture: Picture, colour: ColourMode): HTMLElement | null {
  if (colour === 'robot') return null;
  const [low, high] = rampEnds(picture, colour);
  return el('span', {class: 'ramp'}, `${kRampNames[colour]}: `, low, el('i', {class: 'turbo'}), high);
}

const kEdgeNames = {used: 'alignment in use', unused: 'alignment not used', rejected: 'rejected registration'};

/** The lines between nodes that are on the map. */
export function edgeKeys(kinds: readonly (keyof typeof kEdgeNames)[]): HTMLElement[] {
  return kinds.map((kind) => el('span', {}, el('i', {class: `key ${kind}`}), kEdgeNames[kind]));
}

type Quality = RobotLink['quality'];

/**
 * The lines between robots on the map of these qualities. `of`: the robot that shows the page, as it hears the others,
 * since it does not know how these hear each other; or the robots of a run that logged what they heard.
 */
export function linkKeys(drawn: ReadonlySet<Quality>, of: {running: string} | {traces: string[]; all: boolean}) {
  const words: Record<Quality, string> =
    'running' in of
      ? {good: `heard by ${of.running}`, poor: 'loses a fifth, or late', silent: 'lost'}
      : {good: 'heard then', poor: 'a fifth lost, or one way', silent: ''};
  const alone = 'running' in of ? of.running : of.all ? '' : of.traces.join(', ');
  const keys = (['good', 'poor', 'silent'] as const)
    .filter((quality) => drawn.has(quality))
    .map((quality) => el('span', {}, el('i', {class: `key link-${quality}`}), words[quality]));
  return keys.length > 0 && alone ? [...keys, el('span', {}, `(links of ${alone} alone)`)] : keys;
}
