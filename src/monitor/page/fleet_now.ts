import {
  ago,
  bytes,
  colourOf,
  counted,
  linkName,
  metres,
  type Live,
  type RobotNow,
  type Sensor,
  type State,
} from './model';
import {el, unbroken} from './dom';
import {OrderButton} from './order_button';
import {patch, setText} from './patch';

interface Card {
  article: HTMLElement;
  badge: HTMLElement;
  activity: HTMLElement;
  facts: HTMLElement;
  problems: HTMLElement;
  past: HTMLElement;
  hold: OrderButton;
  home: OrderButton;
  give: HTMLElement;
  row: HTMLSelectElement;
  to: HTMLSelectElement;
}

const kTogether_s = 5; // robots send their status every few seconds

type Order = 'hold' | 'resume' | 'home' | 'give';

/**
 * Each robot's present state in words. Cards stay and their texts change, so that focus and reading position stay too.
 */
export class FleetNow {
  readonly root = el('section', {'aria-label': 'Robots now', hidden: ''});
  private cards = new Map<string, Card>();
  private list = el('div');
  private all = el('div', {class: 'orders', role: 'group', 'aria-label': 'Orders for all robots', hidden: ''});
  private sensors = el('div');
  private said = el('p', {class: 'unseen', role: 'status', 'aria-live': 'polite'});
  private answer = el('p', {class: 'hint', role: 'status', 'aria-live': 'polite'});
  private live?: Live;
  private since = 0;
  private lost = new Set<string>();
  private buttons: OrderButton[] = [];

  constructor() {
    this.all.append(
      this.orderButton(
        'Hold all',
        () => this.order('hold'),
        () => 'Really hold all?',
      ).root,
      this.orderButton(
        'Call all home',
        () => this.order('home'),
        () => 'Really call all home?',
      ).root,
      this.orderButton('Resume all', () => this.order('resume')).root,
    );
    this.root.append(
      el('h2', {}, 'Now'),
      this.all,
      this.answer,
      this.list,
      el('h2', {id: 'sensors-title'}, 'Sensors'),
      this.sensors,
      this.said,
    );
    setInterval(() => this.refresh(), 1000);
  }

  show(live: Live, state?: State): void {
    this.live = live;
    this.since = performance.now();
    this.root.hidden = false;
    this.all.hidden = !live.operated || !live.robots.some((robot) => robot.driven);
    for (const robot of live.robots) {
      const card = this.cardOf(robot.id);
      if (state) card.article.style.borderLeftColor = colourOf(state, robot.id);
    }
    patch(this.sensors, [this.sensorTable(live)]);
    this.refresh();
    for (const button of this.buttons) button.answered();
  }

  /** Also without a newer status: a robot that falls silent, or this one, turns to lost all the same. */
  private refresh(): void {
    if (!this.live) return;
    for (const robot of this.live.robots) this.showRobot(this.live, robot);
    for (const button of this.buttons) button.refresh();
  }

  private cardOf(id: string): Card {
    const known = this.cards.get(id);
    if (known) return known;
    const badge = el('span', {class: 'badge'}),
      activity = el('p', {class: 'activity'}),
      facts = el('p', {class: 'facts'}),
      problems = el('ul', {class: 'problems'}),
      past = el('ul', {class: 'past', 'aria-label': `Past problems of ${id}`});
    const robot = () => this.live?.robots.find((one) => one.id === id);
    const hold = this.orderButton('', () => this.order(robot()?.ordered_to_hold ? 'resume' : 'hold', id));
    const home = this.orderButton(
      '',
      () => this.order(robot()?.called_home ? 'resume' : 'home', id),
      () => (robot()?.called_home ? undefined : 'Really call home?'),
    );
    const row = el('select', {'aria-label': `Row of ${id}`}),
      to = el('select', {'aria-label': `Robot that drives the row of ${id}`});
    const give = el(
      'p',
      {class: 'give', role: 'group', 'aria-label': `Give a row of ${id} away`},
      'Give row ',
      row,
      ' to ',
      to,
      ' ',
      this.orderButton(
        'Give',
        () => this.order('give', id, {row: row.value, ...(to.value ? {to: to.value} : {})}),
        () => `Really give row ${row.value}?`,
      ).root,
    );
    const article = el(
      'article',
      {class: 'robot now', 'data-robot': id, 'aria-label': `${id} now`},
      el('h3', {}, id, badge, hold.root, home.root),
      activity,
      problems,
      past,
      facts,
      give,
    );
    const card = {article, badge, activity, facts, problems, past, hold, home, give, row, to};
    this.cards.set(id, card);
    this.list.append(article);
    return card;
  }

  private showRobot(live: Live, robot: RobotNow): void {
    const card = this.cardOf(robot.id),
      later = (performance.now() - this.since) / 1000;
    const isSelf = robot.id === live.self;
    const silence = isSelf ? later : robot.heard.length > 0 ? robot.heard[0].seconds_ago + later : undefined;
    const lost = silence !== undefined && silence > live.lost_after_s;
    setText(
      card.badge,
      lost ? 'lost' : isSelf ? 'shows this page' : silence === undefined ? 'not heard yet' : 'in contact',
    );
    card.badge.className = `badge ${lost ? 'bad' : silence === undefined || isSelf ? '' : 'good'}`;
    setText(
      card.activity,
      lost ? `${robot.id} is lost. Known last: ${robot.activity}.` : `${robot.id} ${robot.activity}.`,
    );
    setText(card.facts, this.facts(robot, isSelf, later));
    setItems(card.problems, robot.problems);
    setItems(
      card.past,
      robot.past_problems.map((one) => pastWords(one, later)),
    );
    this.showOrders(live, robot, card);
    if (lost && !this.lost.has(robot.id)) this.said.textContent = `${robot.id} is lost.`;
    if (lost) this.lost.add(robot.id);
    else this.lost.delete(robot.id);
  }

  private showOrders(live: Live, robot: RobotNow, card: Card): void {
    const ordered = live.operated && robot.driven;
    card.hold.root.hidden = !ordered;
    card.hold.label(robot.ordered_to_hold ? 'Resume' : 'Hold', holdLabel(robot));
    // If it is held on its way home, the other button lets it go on home.
    card.home.root.hidden = !ordered || (robot.called_home && robot.ordered_to_hold);
    if (robot.called_home) card.home.label('Resume', `Resume ${robot.id}`);
    else card.home.label('Call home', `Call ${robot.id} home`);
    card.give.hidden = !ordered || robot.rows.length === 0 || live.robots.length < 2;
    setOptions(
      card.row,
      robot.rows.map((row) => [String(row), String(row)]),
    );
    setOptions(card.to, [
      ['', 'any other robot'],
      ...live.robots.filter((one) => one.id !== robot.id).map((one): [string, string] => [one.id, one.id]),
    ]);
  }

  private facts(robot: RobotNow, isSelf: boolean, later: number): string {
    const facts: string[] = [];
    if (!isSelf && robot.heard.length > 0) facts.push(heardWords(robot.heard, later));
    if (robot.battery !== null) facts.push(`battery ${Math.round(100 * robot.battery)} %`);
    if (robot.sigma_m !== null) facts.push(`position known to ${metres(robot.sigma_m)} (1 σ) now, by its EKF`);
    const measured = isSelf && this.live?.sensors.find(({name}) => name === robot.clock?.sensor)?.clock_behind_s;
    if (robot.clock) facts.push(clockWords(robot.clock, measured || undefined));
    if (robot.nodes > 0)
      facts.push(
        `holds ${counted(robot.nodes, 'node')}, ${counted(robot.submaps, 'submap')}, ` +
          counted(robot.alignments, 'alignment'),
      );
    if (robot.backlog_bytes > 0) facts.push(`${bytes(robot.backlog_bytes)} wait for its radio`);
    const text = facts.join('; ');
    return text && `${text[0].toUpperCase()}${text.slice(1)}.`;
  }

  private sensorTable(live: Live): HTMLElement {
    const rows = live.sensors.map((one) =>
      el(
        'tr',
        {'data-sensor': one.name},
        el('th', {scope: 'row'}, one.name),
        el('td', {}, one.samples === 0 ? 'none yet' : `${one.per_second.toFixed(one.per_second < 10 ? 1 : 0)} /s`),
        el('td', {}, clockText(one)),
        el('td', {}, ...findingsOf(one)),
      ),
    );
    return el(
      'div',
      {class: 'scroll', tabindex: '0', role: 'region', 'aria-labelledby': 'sensors-title'},
      el(
        'table',
        {class: 'plain'},
        el(
          'thead',
          {},
          el(
            'tr',
            {},
            ...['of ' + live.self, 'samples', 'clock', 'findings'].map((name) => el('th', {scope: 'col'}, name)),
          ),
        ),
        el('tbody', {}, ...rows),
      ),
    );
  }

  private orderButton(
    text: string,
    order: () => Promise<boolean>,
    question: () => string | undefined = () => undefined,
  ): OrderButton {
    const button = new OrderButton(order, question, (words) => setText(this.answer, words));
    button.label(text);
    this.buttons.push(button);
    return button;
  }

  /** Whether it was ordered. The robot's next status shows what came of it. */
  private async order(order: Order, robot?: string, more: Record<string, string> = {}): Promise<boolean> {
    const whom = robot ?? 'all robots';
    const what =
      order === 'give'
        ? `${whom} gives row ${more.row} to ${more.to ?? 'any other robot'}`
        : order === 'home'
          ? `call ${whom} home`
          : `${order} ${whom}`;
    const query = new URLSearchParams({...(robot ? {robot} : {}), ...more}).toString();
    const target = `/operator/${order}${query && `?${query}`}`;
    const home = this.live?.robots.some((one) => one.id === robot && one.ordered_to_hold && one.called_home);
    const then = order === 'resume' && home ? ' It goes on home; another resume, 60 s later, ends that.' : '';
    try {
      const answer = await fetch(target, {method: 'POST'});
      this.answer.textContent = answer.ok
        ? `Ordered: ${what}.${then}`
        : `Not ordered (${what}): ${(await answer.text()).trim()}`;
      return answer.ok;
    } catch {
      this.answer.textContent = `Not ordered (${what}): the robot does not answer.`;
      return false;
    }
  }
}

/** By the link that was heard last. Others are silent while the messages go by that one, which is no fault. */
function heardWords(heard: RobotNow['heard'], later: number): string {
  const [last] = heard;
  const together = heard.filter((one) => one.seconds_ago - last.seconds_ago < kTogether_s);
  const others = heard.filter((one) => !together.includes(one));
  return [
    `last heard ${ago(last.seconds_ago + later)} ago by ${together.map((one) => linkName(one.link)).join(' and ')}`,
    ...others.map((one) => `${ago(one.seconds_ago + later)} ago by ${linkName(one.link)}`),
  ].join(', before that ');
}

function setItems(list: HTMLElement, texts: string[]): void {
  list.hidden = texts.length === 0;
  if (list.textContent !== unbroken(texts.join(''))) list.replaceChildren(...texts.map((text) => el('li', {}, text)));
}

/** A problem whose cause has ended. The page's own clock may be another than the robots'. */
function pastWords({text, total, seconds_ago}: RobotNow['past_problems'][number], later: number): string {
  const when = seconds_ago === null ? '' : `${ago(seconds_ago + later)} ago`;
  if (total) return when ? `${text}, the last time ${when}` : `${text}, at some time since it started`;
  return when ? `was until ${when}: ${text}` : `was: ${text}`;
}

function holdLabel(robot: RobotNow): string {
  if (!robot.ordered_to_hold) return `Hold ${robot.id}`;
  return robot.called_home ? `Resume ${robot.id} on its way home` : `Resume ${robot.id}`;
}

/** A status has a clock's offset within a factor of 1.4; `measured` is the offset itself, where it is known here. */
function clockWords(clock: {sensor: string; behind_s: number}, measured?: number): string {
  const behind = measured ?? clock.behind_s,
    off = Math.abs(behind);
  if (off < 0.01) return 'the clocks of its sensors agree';
  const time = off < 1 ? `${Math.round(1000 * off)} ms` : ago(off);
  return `the clock of its ${clock.sensor} is ${measured ? '' : 'about '}${time} ${behind < 0 ? 'ahead' : 'behind'}`;
}

/** Keeps what is selected as long as it is still there; leaves a menu alone that shows the same already. */
function setOptions(select: HTMLSelectElement, options: [string, string][]): void {
  if (select.options.length === options.length && options.every(([value], k) => select.options[k].value === value))
    return;
  const selected = select.value;
  select.replaceChildren(...options.map(([value, text]) => new Option(text, value)));
  if (options.some(([value]) => value === selected)) select.value = selected;
}

function findingsOf({findings}: Sensor): (HTMLElement | string)[] {
  if (findings.length === 0) return ['–'];
  return findings.map(({text, over}) => el('div', {class: over ? 'over' : 'bad'}, over ? `was: ${text}` : text));
}

function clockText(sensor: Sensor): string {
  const words: string[] = [];
  if (sensor.clock_behind_s !== null)
    words.push(
      `${Math.abs(1000 * sensor.clock_behind_s).toFixed(0)} ms ${sensor.clock_behind_s < 0 ? 'ahead' : 'behind'}`,
    );
  if (sensor.clock_slow_ppm !== null)
    words.push(`${Math.abs(sensor.clock_slow_ppm).toFixed(0)} ppm ${sensor.clock_slow_ppm < 0 ? 'fast' : 'slow'}`);
  return words.join(', ') || '–';
}
