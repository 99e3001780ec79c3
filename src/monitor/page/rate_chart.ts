import uPlot from 'uplot';
import {ago, bytes} from './model';
import {el, unbroken} from './dom';

const kSeconds = 300;

/** Bytes per second over one link: of the last minutes as they come, or of a whole mission. */
export class RateChart {
  readonly root = el('div', {class: 'chart'});
  private plot?: uPlot;
  private points: number[][] = []; // time, and the values of each line

  /** `name` describes it for screen readers; `labels`: the lines. */
  constructor(
    private name: string,
    private width: () => number,
    private labels: string[],
  ) {}

  add(...values: number[]): void {
    values.forEach((value, k) => (this.points[k] ??= []).push(value));
    while (this.points[0].length > kSeconds) for (const one of this.points) one.shift();
  }

  /** Shows these instead of what came before. */
  replace(points: number[][]): void {
    this.points = points;
  }

  redraw(): void {
    this.plot?.destroy();
    this.plot = undefined;
    if (this.points[0]?.length) this.draw();
  }

  resize(): void {
    this.plot?.setSize({width: this.width(), height: 170});
  }

  draw(): void {
    const points = this.points as uPlot.AlignedData;
    if (this.plot) return this.plot.setData(points);
    const style = getComputedStyle(document.documentElement),
      colour = (name: string) => style.getPropertyValue(name);
    const axis = {
      stroke: colour('--soft'),
      grid: {stroke: colour('--line'), width: 1},
      ticks: {show: false},
      font: '11px system-ui',
    };
    const line = (label: string, stroke: string, dash?: number[]) => ({
      label,
      stroke,
      dash,
      width: 2,
      points: {show: false},
      value: (_: uPlot, v: number | null) => (v === null ? '–' : unbroken(`${bytes(v)}/s`)),
    });
    const looks: [string, number[]?][] = [['#2f7de1'], ['#1fa774'], [colour('--soft'), [6, 4]]];
    const lines = this.labels.map((label, k) => line(label, ...looks[k]));
    this.plot = new uPlot(
      {
        width: this.width(),
        height: 170,
        cursor: {drag: {x: false, y: false}},
        scales: {x: {time: false}, y: {range: (_, __, max) => [0, Math.max(100, 1.1 * max)]}},
        axes: [
          {...axis, values: (_, values) => values.map((t) => `${Math.round(t)} s`), size: 28},
          {...axis, values: (_, values) => values.map(bytes), size: 56},
        ],
        series: [{label: 'time', value: (_, t) => (t === null ? '–' : ago(t))}, ...lines],
      },
      points,
      this.root,
    );
    const canvas = this.root.querySelector('canvas')!;
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', this.name);
  }
}
