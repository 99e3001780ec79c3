/** A plot that draws nothing and remembers what it was given. */
export default class FakePlot {
  static shown = [];
  static paths = {stepped: () => undefined};

  constructor(options, data, root) {
    Object.assign(this, {options, data, root, destroyed: false});
    root.append(document.createElement('canvas'));
    FakePlot.shown.push(this);
  }
  setData(data) {
    this.data = data;
  }
  setSize(size) {
    Object.assign(this.options, size);
  }
  destroy() {
    this.destroyed = true;
    this.root.replaceChildren();
  }
}
globalThis.FakePlot = FakePlot;
