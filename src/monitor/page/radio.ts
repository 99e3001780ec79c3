import {ago, bytes, counted, linkName, type FleetMaps, type Live, type Radio} from './model';
import {el} from './dom';
import {patch, setText} from './patch';
import {radioTable} from './radio_table';
import {RateChart} from './rate_chart';

/** Traffic of the robot that shows the page, on its radio against the budget and on Wi-Fi, and what waits. */
export class RadioPanel {
  private headline = el('p', {class: 'headline', 'data-of': 'budget'});
  private wifi = el('p', {class: 'facts', 'data-of': 'wifi'});
  private access = el('p', {class: 'facts', 'data-of': 'access'});
  private maps = el('p', {class: 'facts', 'data-of': 'maps'});
  private fleetMaps = el('p', {class: 'facts', 'data-of': 'fleet-maps'});
  private title = el('h2');
  private wifiTitle = el('h2');
  private chart = new RateChart(
    'Bytes per second sent and received over the long-range radio, and what may be sent; ' +
      'the present numbers are in the first sentence',
    () => this.width(),
    ['sent', 'received', 'may send'],
  );
  private wifiChart = new RateChart(
    'Bytes per second sent and received over Wi-Fi; the present numbers are in the second sentence',
    () => this.width(),
    ['sent', 'received'],
  );
  private tables = el('div');
  private begin?: number;

  constructor(private root: HTMLElement) {
    root.replaceChildren(
      this.headline,
      this.wifi,
      this.access,
      this.maps,
      this.fleetMaps,
      this.title,
      this.chart.root,
      this.wifiTitle,
      this.wifiChart.root,
      this.tables,
    );
    new ResizeObserver(() => this.resize()).observe(root);
  }

  show(live: Live): void {
    const radio = live.radio,
      now = performance.now() / 1000;
    this.begin ??= now;
    const wifi = onWifi(radio);
    this.chart.add(now - this.begin, radio.sent, radio.received, radio.share);
    this.wifiChart.add(now - this.begin, wifi.sent, wifi.received);
    setText(this.headline, radioText(live));
    setText(
      this.wifi,
      `Wi-Fi: ${live.self} sends ${bytes(wifi.sent)}/s and receives ${bytes(wifi.received)}/s, ` +
        'as the mean of the last seconds.',
    );
    setText(this.title, `Bytes per second of ${live.self} on the long-range radio`);
    setText(this.wifiTitle, `Bytes per second of ${live.self} on Wi-Fi`);
    setText(this.access, accessText(live));
    setText(this.maps, mapsText(live));
    setText(this.fleetMaps, fleetMapsText(live.maps));
    patch(this.tables, [...this.kinds(radio), ...this.peers(radio), ...this.queues(radio)]);
    this.draw();
  }

  redraw(): void {
    if (this.root.hidden) return;
    for (const chart of [this.chart, this.wifiChart]) chart.redraw();
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
    return radioTable('By kind of message', ['kind', 'link', 'sent', 'received'], rows, 'kinds');
  }

  private peers(radio: Radio): HTMLElement[] {
    const rows = radio.peers.map((one) => [
      one.robot,
      linkName(one.link),
      `${bytes(one.received)}/s`,
      `${(100 * one.loss).toFixed(1)} %`,
      one.delay_s === null ? '–' : `${(1000 * one.delay_s).toFixed(0)} ms`,
    ]);
    return radioTable('By robot', ['from', 'link', 'received', 'lost', 'delay'], rows, 'peers');
  }

  private queues(radio: Radio): HTMLElement[] {
    const rows = radio.queues
      .filter((one) => one.waiting + one.dropped > 0)
      .map((one) => [one.priority, String(one.waiting), String(one.dropped)]);
    return radioTable('Messages that wait for the radio', ['class', 'waiting', 'dropped so far'], rows, 'queues');
  }

  private draw(): void {
    if (this.root.hidden) return;
    for (const chart of [this.chart, this.wifiChart]) chart.draw();
  }

  private width(): number {
    return Math.max(200, this.root.clientWidth - 24);
  }

  private resize(): void {
    if (this.root.clientWidth > 0) for (const chart of [this.chart, this.wifiChart]) chart.resize();
  }
}

function radioText({self, radio}: Live): string {
  const share = radio.share > 0 ? Math.round((100 * radio.sent) / radio.share) : 0;
  return (
    `Long-range radio: ${self} sends ${bytes(radio.sent)}/s of ${bytes(radio.share)}/s that it may (${share} %) ` +
    `and receives ${bytes(radio.received)}/s; all robots together may send ${bytes(radio.fleet_budget)}/s. ` +
    queueText(radio)
  );
}

/** Bytes per second of all kinds of messages on Wi-Fi. */
function onWifi(radio: Radio): {sent: number; received: number} {
  const kinds = radio.kinds.filter((one) => one.link === 'short_range');
  const sum = (of: 'sent' | 'received') => kinds.reduce((all, one) => all + one[of], 0);
  return {sent: sum('sent'), received: sum('received')};
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

function mapsText({self, radio}: Live): string {
  if (radio.missing_submaps === 0) return `${self} holds the submap of every node that it holds.`;
  const left = radio.seconds_to_equal_map;
  const when = left === null ? 'none arrives now' : `at the present rate it has all in ${ago(left)}`;
  const missing = counted(radio.missing_submaps, 'submap');
  return `${self} lacks ${missing} of the nodes that it holds (${bytes(radio.missing_bytes)}); ${when}.`;
}

function fleetMapsText(maps: FleetMaps): string {
  const without = maps.not_counted.length > 0 ? ` Without ${maps.not_counted.join(', ')}, lost or not heard yet.` : '';
  if (maps.last === null)
    return (
      "By the robots' own counts none lacks a submap. Counts do not show whether all hold the same submaps." + without
    );
  const left = maps.seconds_to_equal;
  const when = left === null ? 'none arrived there lately' : `at the present rates it has all in ${ago(left)}`;
  const lacks = `by the robots' own counts it lacks ${counted(maps.missing_submaps, 'submap')}`;
  return `${maps.last} will be the last to have the whole map: ${lacks}; ${when}.${without}`;
}
