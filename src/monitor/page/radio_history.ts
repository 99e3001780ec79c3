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
import {patch, setText} from './patch';
import {radioTable} from './radio_table';
import {RateChart} from './rate_chart';

const kLinks: LinkName[] = ['long_range', 'short_range'];
const medium = (link: LinkName) => (link === 'long_range' ? 'the radio' : 'Wi-Fi');

/** Traffic of a run, as the robots logged it: over time, by kind of message and by robot. */
export class RadioHistoryPanel {
  private headline = el('p', {class: 'headline', 'data-of': 'heard'});
  private busiest = el('p', {class: 'facts', 'data-of': 'busiest'});
  private charts = kLinks.map((link) => ({
    link,
    title: el('h2', {}, `Bytes per second that all robots heard over ${medium(link)}`),
    chart: new RateChart(
      `Bytes per second that all robots heard over ${medium(link)} in the time of the run; ` +
        'sums and the busiest time are in the first sentences',
      () => this.width(),
      ['heard'],
    ),
  }));
  private tables = el('div');

  constructor(private root: HTMLElement) {
    root.replaceChildren(
      this.headline,
      this.busiest,
      ...this.charts.flatMap(({title, chart}) => [title, chart.root]),
      this.tables,
    );
    new ResizeObserver(() => this.resize()).observe(root);
  }

  show(history: RadioHistory, robots: Robot[]): void {
    setText(this.headline, heardText(history, robots));
    setText(this.busiest, busiestText(history));
    for (const {link, title, chart} of this.charts) {
      const rates = ratesOf(history, link);
      title.hidden = chart.root.hidden = rates.length === 0;
      chart.replace([rates.map((_, k) => k * history.step_s), rates]);
    }
    patch(this.tables, [...kindTable(history), ...pairTable(history)]);
    this.redraw();
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

/** B/s by step, of all robots together; empty: nobody logged this link. */
function ratesOf({links, steps}: RadioHistory, link: LinkName): number[] {
  const those = links.filter((one) => one.link === link);
  if (those.length === 0) return [];
  return Array.from({length: steps}, (_, k) => those.reduce((sum, one) => sum + one.received[k], 0));
}

const sumOf = (links: HeardLink[], link: LinkName) =>
  links.filter((one) => one.link === link).reduce((sum, one) => sum + one.bytes, 0);

function heardText({traces, steps, step_s, links}: RadioHistory, robots: Robot[]): string {
  if (traces.length === 0)
    return (
      'No robot left a link_trace.csv here, so nothing is known of single links and times: a run in virtual time ' +
      'writes none.'
    );
  const sums = kLinks.map((link) => `${bytes(sumOf(links, link))} over ${medium(link)}`).join(' and ');
  const missing = robots.filter(({id}) => !traces.includes(id)).map(({id}) => id);
  const without = missing.length > 0 ? ` Without ${missing.join(', ')}, of which no link_trace.csv is here.` : '';
  const who = traces.length > 1 ? `${traces.join(', ')} together` : traces[0];
  return `In the last mission, ${ago(steps * step_s)}, ${who} heard ${sums}.${without}`;
}

function busiestText(history: RadioHistory): string {
  const said = kLinks.flatMap((link) => {
    const rates = ratesOf(history, link),
      most = Math.max(...rates);
    if (rates.length === 0) return [];
    return [`${bytes(most)}/s over ${medium(link)} at ${duration(rates.indexOf(most) * history.step_s)}`];
  });
  const step = history.step_s === 1 ? '1 s' : counted(history.step_s, 'second');
  return said.length === 0 ? '' : `The busiest, as the mean of ${step}: ${said.join(', ')}.`;
}

function kindTable({kinds, reports}: RadioHistory): HTMLElement[] {
  const receptions = kinds.some((one) => one.received > 0);
  const rows = [...kinds]
    .sort((a, b) => b.sent + b.received - a.sent - a.received)
    .map((one) => [
      one.kind.replaceAll('_', ' '),
      linkName(one.link),
      bytes(one.sent),
      receptions ? bytes(one.received) : '–',
    ]);
  const title = reports.length > 0 ? `By kind of message, of ${reports.join(', ')}` : 'By kind of message';
  return radioTable(title, ['kind', 'link', 'sent', 'received'], rows, 'kinds', 'No robot left a report here.');
}

function pairTable({links}: RadioHistory): HTMLElement[] {
  const rows = links.map((one) => [
    `${one.from} to ${one.to}`,
    linkName(one.link),
    bytes(one.bytes),
    `${(100 * one.loss).toFixed(1)} %`,
    one.delay_s === null ? '–' : `${(1000 * one.delay_s).toFixed(0)} ms`,
  ]);
  return radioTable('By robot', ['from', 'link', 'heard', 'lost', 'delay'], rows, 'peers', 'Not known.');
}
