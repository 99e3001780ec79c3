import {
  ago,
  bytes,
  counted,
  duration,
  type HeardLink,
  type LinkName,
  linkName,
  type RadioHistory,
  type Robot,
} from './model';
import {el} from './dom';
import {linksAt} from './links';
import {patch, setText} from './patch';
import {radioTable} from './radio_table';
import {RateChart} from './rate_chart';

const kLinks: LinkName[] = ['long_range', 'short_range'];
const kFew = 20; // messages, of which a share says little
const medium = (link: LinkName) => (link === 'long_range' ? 'the radio' : 'Wi-Fi');

/** Traffic of a run, as the robots logged it: over time, by kind of message and by robot. */
export class RadioHistoryPanel {
  private headline = el('p', {class: 'headline', 'data-of': 'heard'});
  private busiest = el('p', {class: 'facts', 'data-of': 'busiest'});
  private links = el('p', {class: 'facts', 'data-of': 'links', role: 'status'});
  private charts = kLinks.map((link) => ({
    link,
    title: el('h2'),
    chart: new RateChart(
      `Bytes per second heard over ${medium(link)} in the time of the run; ` +
        'sums and the busiest time are in the first sentences',
      () => this.width(),
      ['heard'],
    ),
  }));
  private tables = el('div');
  private history?: RadioHistory;

  constructor(private root: HTMLElement) {
    root.replaceChildren(
      this.headline,
      this.busiest,
      this.links,
      ...this.charts.flatMap(({title, chart}) => [title, chart.root]),
      this.tables,
    );
    new ResizeObserver(() => this.resize()).observe(root);
  }

  show(history: RadioHistory, robots: Robot[]): void {
    this.history = history;
    setText(this.headline, heardText(history, robots));
    setText(this.busiest, busiestText(history));
    for (const {link, title, chart} of this.charts) {
      const rates = ratesOf(history, link);
      title.hidden = chart.root.hidden = rates.length === 0;
      setText(title, `Bytes per second that ${history.traces.join(', ')} heard over ${medium(link)}`);
      chart.replace([rates.map((_, k) => timeOf(history, k)), rates]);
    }
    patch(this.tables, [...kindTable(history), ...pairTable(history, robots)]);
    this.redraw();
  }

  /** `t`: of the slider, s. */
  showTime(t: number): void {
    const begin_s = this.history?.begin_s;
    this.links.hidden = begin_s === undefined;
    if (begin_s === undefined) return;
    const links = linksAt(this.history!, t).map(({from, to, text}) => `${from} and ${to}: ${text}`);
    setText(this.links, `Links at ${duration(t)}: ${links.length > 0 ? links.join('; ') : 'none is logged'}.`);
  }

  redraw(): void {
    if (this.root.hidden) return;
    for (const {chart} of this.charts) chart.redraw();
  }

  private width(): number {
    return Math.max(200, this.root.clientWidth - 24);
  }

  private resize(): void {
    if (this.root.clientWidth > 0) for (const {chart} of this.charts) chart.resize();
  }
}

/** A step's time, s: as on the slider, else after the first row. */
const timeOf = ({begin_s, step_s}: RadioHistory, step: number) => (begin_s ?? 0) + step * step_s;

/** B/s by step, of all traces together; empty: nobody logged this link. */
function ratesOf({links, steps}: RadioHistory, link: LinkName): number[] {
  const those = links.filter((one) => one.link === link);
  if (those.length === 0) return [];
  return Array.from({length: steps}, (_, k) => those.reduce((sum, one) => sum + one.received[k], 0));
}

const sumOf = (links: HeardLink[], link: LinkName) =>
  links.filter((one) => one.link === link).reduce((sum, one) => sum + one.bytes, 0);

function heardText({traces, steps, step_s, links, begin_s}: RadioHistory, robots: Robot[]): string {
  if (traces.length === 0)
    return (
      'No robot left a link_trace.csv here, so nothing is known of single links and times: a run in virtual time ' +
      'writes none.'
    );
  const sums = kLinks.map((link) => `${bytes(sumOf(links, link))} over ${medium(link)}`).join(' and ');
  const missing = robots.filter(({id}) => !traces.includes(id)).map(({id}) => id);
  const without = missing.length > 0 ? ` Without ${missing.join(', ')}, of which no link_trace.csv is here.` : '';
  const who = traces.length > 1 ? `${traces.join(', ')} together` : traces[0];
  const clock = begin_s === undefined ? ' Times are from the first line: the nodes have those of another clock.' : '';
  return `In the last mission, ${ago(steps * step_s)}, ${who} heard ${sums}, in whole packets.${without}${clock}`;
}

function busiestText(history: RadioHistory): string {
  const said = kLinks.flatMap((link) => {
    const rates = ratesOf(history, link),
      most = rates.reduce((a, b) => Math.max(a, b), 0);
    if (rates.length === 0) return [];
    const t = timeOf(history, rates.indexOf(most));
    return [`${bytes(most)}/s over ${medium(link)} at ${t < 0 ? '-' : ''}${duration(Math.abs(t))}`];
  });
  const step = history.step_s === 1 ? '1 s' : counted(history.step_s, 'second');
  return said.length === 0 ? '' : `The busiest, as the mean of ${step}: ${said.join(', ')}.`;
}

function kindTable({kinds, reports}: RadioHistory): HTMLElement[] {
  const receptions = kinds.some((one) => one.received > 0);
  const rows = kinds
    .filter((one) => one.sent + one.received > 0)
    .sort((a, b) => b.sent + b.received - a.sent - a.received)
    .map((one) => [
      one.kind.replaceAll('_', ' '),
      linkName(one.link),
      bytes(one.sent),
      ...(receptions ? [bytes(one.received)] : []),
    ]);
  const title = receptions
    ? `By kind of message, payload since the last start of ${reports.join(', ')}`
    : 'By kind of message, of all robots';
  const columns = ['kind', 'link', 'sent', ...(receptions ? ['received'] : [])];
  return radioTable(title, columns, rows, 'kinds', 'No robot left a report here.');
}

/** A share of few messages is told by their numbers. */
function lostText({messages, loss}: HeardLink): string {
  const lost = loss < 1 ? Math.round((messages * loss) / (1 - loss)) : 0;
  return messages + lost < kFew ? `${lost} of ${messages + lost}` : `${(100 * loss).toFixed(1)} %`;
}

function delayText(delay_s: number | null): string {
  if (delay_s === null) return '–';
  return Math.abs(delay_s) < 1e-3 ? '< 1 ms' : `${(1000 * delay_s).toFixed(0)} ms`;
}

/** Also the ways over the radio on which nothing was heard. */
function pairTable({links, traces}: RadioHistory, robots: Robot[]): HTMLElement[] {
  if (traces.length === 0) return [];
  const rows = links.map((one) => [
    `${one.from} to ${one.to}`,
    linkName(one.link),
    bytes(one.bytes),
    String(one.messages),
    lostText(one),
    delayText(one.delay_s),
  ]);
  for (const {id} of robots)
    for (const to of traces)
      if (id !== to && !links.some((one) => one.from === id && one.to === to && one.link === 'long_range'))
        rows.push([`${id} to ${to}`, linkName('long_range'), 'nothing', '0', '–', '–']);
  return radioTable('By robot', ['from', 'link', 'heard', 'messages', 'lost', 'delay'], rows, 'peers');
}
