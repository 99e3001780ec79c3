import type {MapCamera} from './map_camera';

/** The map's acts that keys call beside those of its eye. */
export interface KeyActs {
  fit(): void;
  setPlanar(planar: boolean): void;
  measure(): void;
  pick(): void; // at the cross in the middle
  step(by: 1 | -1): void; // to the next node or the one before
  end(): void;
}

const kTurn = Math.PI / 18;

/** Acts on a key of the map; false: it has no meaning there. */
export function actOnKey(event: KeyboardEvent, eye: MapCamera, acts: KeyActs): boolean {
  if (event.ctrlKey || event.metaKey || event.altKey) return false;
  const turning: Record<string, () => void> = {
    ArrowLeft: () => eye.turn(-kTurn, 0),
    ArrowRight: () => eye.turn(kTurn, 0),
    ArrowUp: () => eye.turn(0, -kTurn),
    ArrowDown: () => eye.turn(0, kTurn),
  };
  const keys: Record<string, () => void> = {
    ArrowLeft: () => eye.pan(-1, 0),
    ArrowRight: () => eye.pan(1, 0),
    ArrowUp: () => eye.pan(0, 1),
    ArrowDown: () => eye.pan(0, -1),
    '+': () => eye.zoom(1.25),
    '=': () => eye.zoom(1.25),
    '-': () => eye.zoom(0.8),
    f: acts.fit,
    p: () => acts.setPlanar(!eye.planar),
    m: acts.measure,
    Enter: acts.pick,
    n: () => acts.step(1),
    b: () => acts.step(-1),
    Escape: acts.end,
  };
  const act = (event.shiftKey && turning[event.key]) || keys[event.key];
  if (!act) return false;
  event.preventDefault();
  act();
  return true;
}
