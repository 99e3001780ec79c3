// In place of map.ts: notes what the page's program does with the map.
export const calls = (globalThis.mapCalls ??= []);
const note =
  (name) =>
  (...args) =>
    void calls.push([name, ...args]);

export class FleetMap {
  layers = {points: true, paths: true, nodes: true, used: true, unused: true, rejected: true};
  edges = [];
  until = Infinity;
  onPicture = () => {};
  submaps = {all: new Map()};
  hit = undefined; // under the pointer
  places = new Map();
  eye = {
    planar: false,
    setPlanar: (planar) => {
      this.eye.planar = planar;
      calls.push(['setPlanar', planar]);
    },
    goTo: (p) => calls.push(['goTo', ...p.toArray()]),
    pan: note('pan'),
    zoom: note('zoom'),
  };
  show = note('show');
  remark = () => calls.push(['remark', this.until, {...this.layers}]);
  setColour = note('setColour');
  setDark = note('setDark');
  showOnly = note('showOnly');
  select = note('select');
  fit = note('fit');
  draw = note('draw');
  constructor() {
    globalThis.fakeMap = this;
  }
  set budget(points) {
    calls.push(['budget', points]);
  }
  place(id) {
    return this.places.get(id);
  }
  project() {
    return undefined;
  }
  hitAt() {
    return this.hit;
  }
  pick() {
    return this.hit;
  }
  pointAt() {
    return undefined;
  }
}
