import uPlot from 'uplot';
import {ago, bytes, linkName, type FleetMaps, type Live, type Radio} from './model';
import {el} from './dom';
import {patch, setText} from './patch';

const kSeconds = 300;

/** Traffic of the radio against the budget, by kind and by robot, and what waits. */
export class RadioPanel {
  private headline = el('p', {class: 'headline', 'data-of': 'budget'});
  private access = el('p', {class: 'facts', 'data-of': 'access'});
  private maps = el('p', {class: 'facts', 'data-of': 'maps'});
  private fleetMaps = el('p', {class: 'facts', 'data-of': 'fleet-maps'});
  private chart = el('div', {class: 'chart'});
  private tables = el('div');
  private plot?: uPlot;
  private begin?: number;
  private points: [number[], number[], number[], number[]] = [[], [], [], []];

  constructor(private root: HTMLElement) {
    root.append(
      this.headline,
      this.access,
      this.maps,
      this.fleetMaps,
      el('h2', {}, 'Bytes per second on the radio'),
      this.chart,
      this.tables,
    );
    new ResizeObserver(() => this.resize()).observe(root);
  }

  show(live: Live): void {
    const radio = live.radio,
      now = performance.now() / 1000;
    this.begin ??= now;
    [now - this.begin, radio.sent, radio.received, radio.share].forEach((value, k) => this.points[k].push(value));
    while (this.points[0].length > kSeconds) for (const values of this.points) values.shift();
    const share = radio.share > 0 ? Math.round((100 * radio.sent) / radio.share) : 0;
    setText(
      this.headline,
      `Sends ${bytes(radio.sent)}/s of ${bytes(radio.share)}/s that it may (${share} %); ` +
        `all robots together may send ${bytes(radio.fleet_budget)}/s. ${queueText(radio)}`,
    );
    setText(this.access, accessText(live));
    setText(this.maps, mapsText(radio));
    setText(this.fleetMaps, fleetMapsText(live.maps));
    patch(this.tables, [...this.kinds(radio), ...this.peers(radio), ...this.queues(radio)]);
    if (!this.root.hidden) this.draw();
  }

  redraw(): void {
    this.plot?.destroy();
    this.plot = undefined;
    if (this.points[0].length > 0 && !this.root.hidden) this.draw();
  }

  private kinds(radio: Radio): HTMLElement[] {
    const rows = [...radio.kinds]
      .sort((a, b) => b.sent + b.received - a.sent - a.received)
      .map((one) => [
        one.kind.replaceAll('_', ' '),
        linkName(one.link),
        `${bytes(one.sent)}/s`,
        `${bytes(one.received)}/s`,
      ]);
    return table('By kind of message', ['kind', 'link', 'sent', 'received'], rows, 'kinds');
  }

  private peers(radio: Radio): HTMLElement[] {
    const rows = radio.peers.map((one) => [
      one.robot,
      linkName(one.link),
      `${bytes(one.received)}/s`,
      `${(100 * one.loss).toFixed(1)} %`,
      one.delay_s === null ? '–' : `${(1000 * one.delay_s).toFixed(0)} ms`,
    ]);
    return table('By robot', ['from', 'link', 'received', 'lost', 'delay'], rows, 'peers');
  }

  private queues(radio: Radio): HTMLElement[] {
    const rows = radio.queues
      .filter((one) => one.waiting + one.dropped > 0)
      .map((one) => [one.priority, String(one.waiting), String(one.dropped)]);
    return table('Messages that wait for the radio', ['class', 'waiting', 'dropped so far'], rows, 'queues');
  }

  private draw(): void {
    if (this.plot) return this.plot.setData(this.points);
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
      value: (_: uPlot, v: number | null) => (v === null ? '' : `${bytes(v)}/s`),
    });
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
        series: [
          {label: 'time', value: (_, t) => (t === null ? '' : ago(t))},
          line('sent', '#2f7de1'),
          line('received', '#1fa774'),
          line('may send', colour('--soft'), [6, 4]),
        ],
      },
      this.points,
      this.chart,
    );
    const canvas = this.chart.querySelector('canvas')!;
    canvas.setAttribute('role', 'img');
    canvas.setAttribute(
      'aria-label',
      'Bytes per second sent and received over the radio, and what this robot may send; ' +
        'the present numbers are in the sentence above',
    );
  }

  private width(): number {
    return Math.max(200, this.root.clientWidth - 24);
  }

  private resize(): void {
    if (this.root.clientWidth > 0) this.plot?.setSize({width: this.width(), height: 170});
  }
}

function queueText(radio: Radio): string {
  if (radio.backlog_bytes === 0) return 'Nothing waits.';
  return `${bytes(radio.backlog_bytes)} wait${radio.backlog_s === null ? '' : `, sent in ${ago(radio.backlog_s)}`}.`;
}

function accessText({self, radio}: Live): string {
  return radio.who_may_join === 'anyone'
    ? `Anyone on the radios may join, read all and send anything: ${self} has no keys.`
    : `Only ${radio.who_may_join} may join.`;
}

function mapsText(radio: Radio): string {
  if (radio.missing_submaps === 0) return 'Every submap of the nodes held here is held too.';
  const left = radio.seconds_to_equal_map;
  const when = left === null ? 'none arrive now' : `at the present rate they are here in ${ago(left)}`;
  return `${radio.missing_submaps} submaps are missing here (${bytes(radio.missing_bytes)}); ${when}.`;
}

function fleetMapsText(maps: FleetMaps): string {
  const without = maps.not_counted.length > 0 ? ` Without ${maps.not_counted.join(', ')}, lost or not heard yet.` : '';
  if (maps.last === null)
    return `By their counts no robot holds fewer submaps; that they hold the same ones, counts do not show.${without}`;
  const left = maps.seconds_to_equal;
  const when = left === null ? 'none came there lately' : `at the present rates it has as many in ${ago(left)}`;
  const fewer = `it counts ${maps.missing_submaps} submaps fewer than there are nodes`;
  return `${maps.last} will be the last: ${fewer}; ${when}.${without}`;
}

function table(title: string, columns: string[], rows: string[][], name: string): HTMLElement[] {
  const head = el('tr', {}, ...columns.map((column) => el('th', {scope: 'col'}, column)));
  const body = rows.map((row) =>
    el('tr', {}, el('th', {scope: 'row'}, row[0]), ...row.slice(1).map((cell) => el('td', {}, cell))),
  );
  const content =
    rows.length > 0
      ? el('table', {class: 'plain', 'aria-label': title}, el('thead', {}, head), el('tbody', {}, ...body))
      : el('p', {class: 'hint'}, 'None now.');
  return [
    el('h2', {}, title),
    el('div', {class: 'scroll', tabindex: '0', role: 'region', 'aria-label': title, 'data-of': name}, content),
  ];
}
