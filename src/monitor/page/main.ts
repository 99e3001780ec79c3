import {CardBox} from './card_box';
import {linkCard} from './cards';
import {RobotColours} from './colours';
import {actOnKey} from './keys';
import {follow} from './live';
import type {Hit} from './hit';
import {edgeKeys, linkKeys, type Picture, rampEnds, rampKey, scaleLength} from './legend';
import {FleetMap, type Layer} from './map';
import type {ColourMode} from './point_material';
import {edgeOfRegistration} from './edges';
import {Measure} from './measure';
import {colourOf, count, counted, duration, endOf, placeMark, type State} from './model';
import {cutGaps, gapNote} from './times';
import {setText} from './patch';
import {FleetNow} from './fleet_now';
import {RobotMarks} from './robot_marks';
import {PairView} from './pair_view';
import {el} from './dom';
import {Selection} from './selection';
import {FleetPanel} from './fleet_panel';
import {WhyPanel} from './why_panel';
import {RadioPanel} from './radio';
import {RadioHistoryPanel} from './radio_history';
import {joinTabs} from './tabs';

const byId = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
const kCrossReach = 18; // pixels
const canvas = byId<HTMLCanvasElement>('canvas');

let state: State | undefined;
let shownBy: string | undefined; // the running robot that sends its status
let map: FleetMap | undefined;
try {
  map = new FleetMap(canvas);
} catch {
  byId('no-map').hidden = false;
  byId('no-map').textContent =
    'This browser draws no 3D graphics (WebGL 2 is off), so there is no map; the panel has all the rest.';
}
const measure =
  map &&
  new Measure(map, document.getElementById('overlay') as unknown as SVGSVGElement, (content) => card.show(content));
const marks = map && new RobotMarks(map, document.getElementById('robots') as unknown as SVGSVGElement);
const pairView = map && new PairView(map);
const actions = {
  selectNode: (id: string) => select({node: id}, true),
  selectRegistration: (index: number) => select({edge: edgeOfRegistration(state!, index)}, true),
};
const why = new WhyPanel(byId('why'), actions);
const now = new FleetNow();
const fleet = new FleetPanel(byId('fleet'), actions, now.root);
let radio: RadioPanel | RadioHistoryPanel | undefined; // of a running robot, or of a run

// The state.

const colours = new RobotColours();
function showState(next: State): void {
  next.colours = colours.of(next.robots.map((robot) => robot.id));
  const gaps = cutGaps(next);
  if (gaps > 0) next.notes.push(gapNote(gaps));
  const before = state;
  state = next;
  document.title = `${next.title} – fleetmap`;
  setText(byId('title'), next.title);
  setText(
    byId('summary'),
    [
      counted(next.robots.length, 'robot'),
      counted(next.nodes.length, 'node'),
      counted(next.alignments.length, 'alignment'),
    ].join(' · '),
  );
  map?.show(next);
  selection.refresh(before, next);
  why.show(next);
  fleet.show(next);
  if (next.radio && !shownBy) {
    radio = radio instanceof RadioHistoryPanel ? radio : new RadioHistoryPanel(byId('radio'));
    radio.show(next.radio, next.robots);
    byId('tab-radio').hidden = false;
  }
  setTime();
}

follow({
  onState: showState,
  onLive(live) {
    byId('tab-radio').hidden = false;
    colours.of(live.robots.map((robot) => robot.id)); // also of those that are not heard yet
    if (!state) setText(byId('summary'), `${counted(live.robots.length, 'robot')} · no nodes yet`);
    now.show(live, state);
    fleet.showNow(live);
    why.showNow(live);
    marks?.showLive(live);
    shownBy = live.self;
    radio = radio instanceof RadioPanel ? radio : new RadioPanel(byId('radio'));
    radio.show(live);
  },
  onConnection(trouble) {
    setText(byId('connection'), trouble);
    if (trouble && !state && !shownBy) setText(byId('summary'), 'Nothing came yet.');
  },
});

// Selection.

const card = new CardBox(byId('card'), byId('map'), () => {
  measure?.stop();
  pressed('measure', false);
  select(undefined);
});
const selection = new Selection(card, map, pairView, (index) => why.mark(index));
const select = (hit: Hit | undefined, fromList = false) => selection.select(state, hit, fromList);

// The map's tools.

function pressed(id: string, on: boolean): void {
  byId(id).setAttribute('aria-pressed', String(on));
}

function setPlanar(planar: boolean): void {
  map?.eye.setPlanar(planar);
  pressed('view-plan', planar);
  pressed('view-3d', !planar);
}
byId('view-plan').onclick = () => setPlanar(true);
byId('view-3d').onclick = () => setPlanar(false);
byId('fit').onclick = () => map?.fit();

let colour: ColourMode = 'robot';
for (const button of document.querySelectorAll<HTMLElement>('[data-colour]')) {
  button.onclick = () => {
    colour = button.dataset.colour as ColourMode;
    for (const other of document.querySelectorAll('[data-colour]'))
      other.setAttribute('aria-pressed', String(other === button));
    map?.setColour(colour);
  };
}

function toggleMeasure(): void {
  if (!measure) return;
  if (measure.active) measure.stop();
  else {
    select(undefined);
    measure.start();
  }
  pressed('measure', measure.active);
}
byId('measure').onclick = toggleMeasure;

for (const layer of ['points', 'paths', 'nodes', 'used', 'unused', 'rejected'] as Layer[]) {
  byId<HTMLInputElement>(`layer-${layer}`).onchange = (event) => {
    if (!map) return;
    map.layers[layer] = (event.target as HTMLInputElement).checked;
    map.remark();
  };
}

byId<HTMLInputElement>('layer-robots').onchange = (event) => {
  if (!marks) return;
  marks.shown = (event.target as HTMLInputElement).checked;
  marks.draw();
};

// A phone draws less than a laptop; whoever drives the slider decides.
const budget = byId<HTMLInputElement>('budget');
const memory = (navigator as {deviceMemory?: number}).deviceMemory ?? 4;
const small = matchMedia('(pointer: coarse)').matches || Math.min(screen.width, screen.height) < 600 || memory < 4;
budget.value = String(Math.log10(small ? 300_000 : 1_500_000));
const setBudget = () => {
  const points = Math.round(10 ** Number(budget.value));
  setText(byId('budget-value'), count(points));
  if (map) map.budget = points;
};
budget.oninput = setBudget;
setBudget();

let until: number | undefined; // s, which stays while the mission goes on; undefined: its end

function setTime(): void {
  if (!state) return;
  const end = endOf(state),
    t = Math.min(end, until ?? end);
  byId<HTMLInputElement>('time').value = String(end > 0 && until !== undefined ? Math.round((1000 * t) / end) : 1000);
  setText(byId('time-value'), duration(t));
  byId('time').setAttribute('aria-valuetext', duration(t));
  if (radio instanceof RadioHistoryPanel) radio.showTime(t);
  if (map) {
    map.until = until ?? Infinity;
    map.remark();
    marks?.show(state, map.until);
  }
}
byId('time').oninput = () => {
  const share = Number(byId<HTMLInputElement>('time').value) / 1000;
  until = share >= 1 || !state ? undefined : share * endOf(state);
  setTime();
};

if (map) map.onPicture = showPicture;
function showPicture(picture: Picture): void {
  byId('map').classList.toggle('coarse', picture.coarse);
  if (!picture.coarse) {
    measure?.draw();
    marks?.draw();
  }
  canvas.dataset.drawn = String(picture.drawn);
  if (picture.moving) return;
  setText(
    byId('drawn'),
    `${count(picture.drawn)} of ${count(picture.total)} points drawn${picture.loading ? ', loading' : ''}`,
  );
  canvas.dataset.loading = String(picture.loading);
  canvas.setAttribute(
    'aria-label',
    `Map of ${state?.title ?? 'the fleet'}: ${picture.planar ? 'plan' : '3D'} view, ${count(picture.drawn)} points`,
  );
  showScale(picture);
  showLegend(picture);
}

function showScale(picture: Picture): void {
  const length = scaleLength(picture.metresPerPixel);
  byId('scale').hidden = length < 0.01; // there is nothing to measure yet
  byId('scale').querySelector('i')!.style.width = `${length / picture.metresPerPixel}px`;
  const text = length >= 1 ? `${length} m` : `${Math.round(100 * length)} cm`;
  setText(byId('scale').querySelector('span')!, text);
}

let legendOf = '';
function showLegend(picture: Picture): void {
  if (!state) return;
  const ends = rampEnds(picture, colour);
  const kinds = (['used', 'unused', 'rejected'] as const).filter(
    (kind) => map?.layers[kind] && map.edges.some((edge) => edge.kind === kind),
  );
  const drawn: NonNullable<typeof marks>['qualities'] = marks?.qualities ?? new Set();
  const names = state.robots.map((robot) => robot.id + placeMark(robot));
  const key = [colour, shownBy, ...kinds, ...drawn, ...ends, ...names].join();
  if (key === legendOf) return;
  legendOf = key;
  const robots = state.robots.map((robot) =>
    el(
      'span',
      {},
      el('i', {class: 'dot', style: `background:${colourOf(state!, robot.id)}`}),
      placeMark(robot) ? `${robot.id} (${placeMark(robot)})` : robot.id,
    ),
  );
  const ramp = rampKey(picture, colour);
  const traces = state.radio?.traces ?? [];
  const all = state.robots.every(({id}) => traces.includes(id));
  const links = linkKeys(drawn, shownBy ? {running: shownBy} : {traces, all});
  byId('legend').replaceChildren(...robots, ...edgeKeys(kinds), ...links, ...(ramp ? [ramp] : []));
}

// Pointer and keys.

let down: {x: number; y: number} | undefined;
canvas.addEventListener('pointerdown', (event) => {
  down = {x: event.offsetX, y: event.offsetY};
});
canvas.addEventListener('pointerup', (event) => {
  if (!map || !down || Math.hypot(event.offsetX - down.x, event.offsetY - down.y) > 5) return;
  const reach = event.pointerType === 'touch' ? 18 : 10;
  if (measure?.active) return measure.click(event.offsetX, event.offsetY, reach, state!.origin);
  pickAt(event.offsetX, event.offsetY, reach);
});
/** Describes the node or edge at a pixel, else the link between two robots, else the point. False: nothing is there. */
function pickAt(x: number, y: number, reach: number): boolean {
  const link = map?.hitAt(x, y, reach) ? undefined : marks?.linkAt(x, y, reach),
    hit = link ? undefined : map?.pick(x, y, reach);
  select(hit);
  if (link) card.show(linkCard(link, shownBy));
  return Boolean(link ?? hit);
}
canvas.addEventListener('pointermove', (event) => {
  if (!map || event.buttons !== 0) return;
  canvas.style.cursor = measure?.active
    ? 'crosshair'
    : (map.hitAt(event.offsetX, event.offsetY, 10) ?? marks?.linkAt(event.offsetX, event.offsetY, 10))
      ? 'pointer'
      : 'grab';
});
const acts = {
  fit: () => map?.fit(),
  setPlanar,
  measure: toggleMeasure,
  pick: pickAtCross,
  step: stepNode,
  end() {
    measure?.stop();
    pressed('measure', false);
    select(undefined);
  },
};
canvas.addEventListener('keydown', (event) => map && actOnKey(event, map.eye, acts));

const say = (text: string) => (byId('said').textContent = text);

/** As a click in the middle of the map, where the cross is. */
function pickAtCross(): void {
  if (!map || !state) return;
  const x = canvas.clientWidth / 2,
    y = canvas.clientHeight / 2;
  if (!measure?.active) {
    return void say(pickAt(x, y, kCrossReach) ? '' : 'Nothing is at the cross.');
  }
  say(measure.click(x, y, kCrossReach, state.origin) ? '' : 'No point is at the cross.');
}

/** To the node after or before the selected one: in time, robot by robot. */
function stepNode(by: 1 | -1): void {
  const nodes = (state?.nodes ?? [])
    .filter(({id}) => map?.place(id))
    .sort((a, b) => (a.robot === b.robot ? a.t - b.t : a.robot < b.robot ? -1 : 1));
  if (nodes.length === 0) return;
  const at = nodes.findIndex(({id}) => id === selection.node);
  const next = at < 0 ? (by > 0 ? 0 : nodes.length - 1) : (at + by + nodes.length) % nodes.length;
  select({node: nodes[next].id}, true);
}

const redraw = () => {
  fleet.redraw();
  radio?.redraw();
};
joinTabs([byId('tab-why'), byId('tab-fleet'), byId('tab-radio')], redraw);

const isDark = () => getComputedStyle(document.documentElement).colorScheme === 'dark';
byId('theme').onclick = () => {
  document.documentElement.dataset.theme = isDark() ? 'light' : 'dark';
  redraw();
  map?.setDark(isDark());
};
map?.setDark(isDark());
matchMedia('(prefers-color-scheme: dark)').onchange = () => map?.setDark(isDark());
