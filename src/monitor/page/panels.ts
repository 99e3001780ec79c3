import uPlot from 'uplot';
import {colourOf, duration, metres, type Pair, type Registration, type Robot, type State} from './model';

type Child = Node | string | null | undefined | false;

export function el<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Record<string, string> = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name === 'style') element.style.cssText = value;
    else element.setAttribute(name, value);
  }
  for (const child of children) if (child) element.append(child);
  return element;
}

export const dot = (state: State, robot: string) => el('i', {class: 'dot', style: `background:${colourOf(state, robot)}`, 'aria-hidden': 'true'});

export interface Actions {
  selectNode(id: string): void;
  selectRegistration(index: number): void;
}

const kVerdicts = ['accepted', 'ambiguous', 'rejected', 'failed'] as const;
const kRows = 100;

/** Registrations and their reasons, and what joins each pair of robots. */
export class WhyPanel {
  private state?: State;
  private pair?: [string, string];
  private verdict: string = 'all';
  private robot: string = 'all';
  private rows = kRows;
  private selected = -1;

  constructor(private root: HTMLElement, private actions: Actions) {}

  show(state: State): void {
    this.state = state;
    if (!this.pair) {
      const worst = state.pairs.find((pair) => !pair.joined);
      if (worst) this.pair = [worst.a, worst.b];
    }
    this.render();
  }

  mark(index: number): void {
    this.selected = index;
    for (const row of this.root.querySelectorAll('.registration')) row.setAttribute('aria-current', String(row.getAttribute('data-index') === String(index)));
    this.root.querySelector(`.registration[data-index="${index}"]`)?.scrollIntoView({block: 'nearest'});
  }

  private render(): void {
    const state = this.state!;
    const focus = document.activeElement?.id;
    const scroll = this.root.querySelector('.registrations')?.scrollTop ?? 0;
    this.root.replaceChildren(this.headline(state), this.matrix(state), this.answer(state), this.filters(state), this.list(state));
    this.root.querySelector('.registrations')!.scrollTop = scroll;
    if (focus) document.getElementById(focus)?.focus({preventScroll: true});
  }

  private headline(state: State): HTMLElement {
    const apart = state.pairs.filter((pair) => !pair.joined).length;
    const robots = state.robots.length, used = state.alignments.filter((one) => one.status === 'used').length;
    if (robots < 2) return el('p', {class: 'headline'}, `One robot: ${used} alignments of its own path are in use.`);
    if (apart === 0) return el('p', {class: 'headline good'}, `All ${robots} robots are joined: ${used} alignments are in use.`);
    return el('p', {class: 'headline bad'}, `${apart} of ${state.pairs.length} pairs of robots are not joined.`);
  }

  private matrix(state: State): HTMLElement {
    const names = state.robots.map((robot) => robot.id);
    const head = el('tr', {}, el('td'), ...names.slice(0, -1).map((name) => el('th', {scope: 'col'}, dot(state, name), name)));
    const rows = names.slice(1).map((b, k) => el('tr', {}, el('th', {scope: 'row'}, dot(state, b), b),
      ...names.slice(0, k + 1).map((a) => el('td', {}, this.cell(state, a, b)))));
    return el('table', {class: 'pairs', 'aria-label': 'What joins each pair of robots'}, el('thead', {}, head), el('tbody', {}, ...rows));
  }

  private cell(state: State, a: string, b: string): HTMLElement {
    const pair = findPair(state, a, b)!;
    const kind = pair.used > 0 ? 'used' : pair.joined ? 'through' : 'apart';
    const text = pair.used > 0 ? String(pair.used) : pair.joined ? '↷' : pair.attempts > 0 ? `✕ ${pair.attempts}` : '–';
    const button = el('button', {
      type: 'button', id: `pair-${pair.a}-${pair.b}`, class: `pair ${kind}`, 'aria-pressed': String(this.isPair(pair)),
      'aria-label': `${pair.a} and ${pair.b}: ${pair.state}`, title: pair.state,
    }, text);
    button.onclick = () => {
      this.pair = this.isPair(pair) ? undefined : [pair.a, pair.b];
      this.rows = kRows;
      this.render();
    };
    return button;
  }

  private isPair(pair: Pair): boolean {
    return this.pair?.[0] === pair.a && this.pair[1] === pair.b;
  }

  private answer(state: State): HTMLElement {
    const pair = this.pair && findPair(state, ...this.pair);
    if (!pair) return el('p', {class: 'hint'}, state.pairs.length > 0 ? 'Choose a pair to see what joins it, or why nothing does.' : '');
    const box = el('section', {class: `answer ${pair.joined ? 'good' : 'bad'}`, 'aria-live': 'polite'},
      el('h2', {}, pair.joined ? `${pair.a} and ${pair.b}: ${pair.state}` : `Why are ${pair.a} and ${pair.b} not joined?`), el('p', {}, pair.text));
    const facts = el('p', {class: 'facts'}, `${pair.attempts} registrations, ${pair.accepted} accepted, ${pair.used} in use`,
      pair.nearest_m !== null && `; nearest nodes ${metres(pair.nearest_m)} apart: `);
    for (const id of pair.nearest ?? []) {
      const button = el('button', {type: 'button', class: 'link'}, id);
      button.onclick = () => this.actions.selectNode(id);
      facts.append(button, ' ');
    }
    box.append(facts);
    return box;
  }

  /** Those that the filters let through, but for the verdict: the chips count them. */
  private chosen(state: State): [Registration, number][] {
    const of = (id: string) => id.split(/[#/]/)[0];
    return state.registrations.map((one, k): [Registration, number] => [one, k]).filter(([one]) => {
      const robots = [of(one.target), of(one.source)];
      if (this.pair && !(robots.includes(this.pair[0]) && robots.includes(this.pair[1]))) return false;
      return this.robot === 'all' || robots.includes(this.robot) || one.by === this.robot;
    });
  }

  private filters(state: State): HTMLElement {
    const chosen = this.chosen(state);
    const chips = ['all', ...kVerdicts].map((verdict) => {
      const n = verdict === 'all' ? chosen.length : chosen.filter(([one]) => one.verdict === verdict).length;
      if (n === 0 && verdict !== 'all' && verdict !== 'rejected' && this.verdict !== verdict) return null;
      const chip = el('button', {type: 'button', id: `verdict-${verdict}`, class: `chip ${verdict}`, 'aria-pressed': String(this.verdict === verdict)},
        verdict === 'all' ? 'All' : verdict[0].toUpperCase() + verdict.slice(1), el('b', {}, String(n)));
      chip.onclick = () => {
        this.verdict = verdict;
        this.rows = kRows;
        this.render();
      };
      return chip;
    });
    const select = el('select', {id: 'robot-filter', 'aria-label': 'Robot'}, el('option', {value: 'all'}, 'any robot'), ...state.robots.map((robot) => el('option', {value: robot.id}, robot.id)));
    select.value = this.robot;
    select.onchange = () => {
      this.robot = select.value;
      this.render();
    };
    return el('div', {class: 'filters'}, el('h2', {}, this.pair ? `Registrations of ${this.pair.join(' and ')}` : 'Registrations'), el('div', {class: 'chips'}, ...chips, select));
  }

  private list(state: State): HTMLElement {
    const shown = this.chosen(state).filter(([one]) => this.verdict === 'all' || one.verdict === this.verdict);
    const list = el('ul', {class: 'registrations', 'aria-label': 'Registrations'});
    for (const [one, index] of shown.slice(0, this.rows)) {
      const button = el('button', {type: 'button', class: 'registration', 'data-index': String(index), 'data-verdict': one.verdict, 'aria-current': String(index === this.selected)},
        el('span', {class: `verdict ${one.verdict}`}, one.verdict), el('span', {class: 'who'}, `${one.source} → ${one.target}`), el('span', {class: 'sentence'}, one.sentence));
      button.onclick = () => this.actions.selectRegistration(index);
      list.append(el('li', {}, button));
    }
    if (shown.length > this.rows) {
      const more = el('button', {type: 'button', class: 'more'}, `Show ${Math.min(kRows, shown.length - this.rows)} more of ${shown.length}`);
      more.onclick = () => {
        this.rows += kRows;
        this.render();
      };
      list.append(el('li', {}, more));
    }
    if (shown.length === 0) list.append(el('li', {class: 'hint'}, state.registrations.length > 0 ? 'None of these.' : 'No registrations.csv lies beside the store.'));
    return list;
  }
}

export function findPair(state: State, a: string, b: string): Pair | undefined {
  return state.pairs.find((pair) => (pair.a === a && pair.b === b) || (pair.a === b && pair.b === a));
}

/** Each robot in words, who holds what, and nodes over time. */
export class FleetPanel {
  private plot?: uPlot;
  private chart = el('div', {class: 'chart'});
  private state?: State;
  private root: HTMLElement;

  /** `now` stays above what the state shows. */
  constructor(root: HTMLElement, private actions: Actions, now: HTMLElement) {
    this.root = el('div', {class: 'from-state'});
    root.append(now, this.root);
    new ResizeObserver(() => this.resize()).observe(root);
  }

  show(state: State): void {
    this.state = state;
    const notes = state.notes.map((note) => el('p', {class: 'note'}, note));
    this.root.replaceChildren(...notes, el('h2', {}, 'Their maps'), ...state.robots.map((robot) => this.card(state, robot)), el('h2', {}, 'Who holds whose nodes and submaps'), this.holdings(state),
      el('h2', {}, 'Nodes over the mission'), this.chart);
    this.draw(state);
  }

  private card(state: State, robot: Robot): HTMLElement {
    const last = robot.last_node;
    const words: Child[] = [];
    if (robot.nodes > 0) words.push(`${robot.nodes} nodes on ${metres(robot.path_m)} of path, from ${duration(robot.first_s ?? 0)} to ${duration(robot.last_s ?? 0)}`);
    else words.push('made no node that is held here');
    if (robot.sessions > 1) words.push(`, in ${robot.sessions} sessions`);
    const facts = el('p', {class: 'facts'}, ...words, '.');
    if (last) {
      const button = el('button', {type: 'button', class: 'link'}, last);
      button.onclick = () => this.actions.selectNode(last);
      facts.append(' Last at ', button, robot.sigma_m !== undefined ? `, known to ${(100 * robot.sigma_m).toFixed(1)} cm (1 σ).` : '.');
    }
    if (robot.alignments_used !== undefined) facts.append(` ${robot.alignments_used} of its alignments are in use, ${robot.alignments_rejected ?? 0} contradict.`);
    const joined = state.pairs.filter((pair) => pair.joined && (pair.a === robot.id || pair.b === robot.id)).map((pair) => (pair.a === robot.id ? pair.b : pair.a));
    const badges = [el('span', {class: joined.length > 0 ? 'badge good' : 'badge bad'}, joined.length > 0 ? `joined with ${joined.join(', ')}` : state.robots.length > 1 ? 'joined with nobody' : 'alone')];
    if (robot.nodes > 0 && !robot.georeferenced) badges.push(el('span', {class: 'badge bad'}, 'no place on Earth'));
    if (robot.quarantined) badges.push(el('span', {class: 'badge bad'}, 'quarantined'));
    if (robot.id === state.self) badges.push(el('span', {class: 'badge'}, 'its map is shown'));
    return el('article', {class: 'robot', style: `border-left-color:${colourOf(state, robot.id)}`}, el('h3', {}, robot.id, ...badges), facts);
  }

  private holdings(state: State): HTMLElement {
    const holders = [...new Set(state.holdings.map((one) => one.holder))], makers = state.robots.map((robot) => robot.id);
    const most = new Map<string, number>();
    for (const one of state.holdings) most.set(one.maker, Math.max(most.get(one.maker) ?? 0, one.nodes));
    const head = el('tr', {}, el('th', {scope: 'col'}, 'holds of'), ...makers.map((name) => el('th', {scope: 'col'}, dot(state, name), name)));
    const rows = holders.map((holder) => el('tr', {}, el('th', {scope: 'row'}, dot(state, holder), holder), ...makers.map((maker) => {
      const one = state.holdings.find((h) => h.holder === holder && h.maker === maker);
      const all = most.get(maker) ?? 0, share = all > 0 ? (one?.submaps ?? 0) / all : 0;
      return el('td', {title: `${holder} holds ${one?.nodes ?? 0} of ${all} nodes of ${maker}, and ${one?.submaps ?? 0} of their submaps`},
        el('div', {class: 'fill'}, el('i', {style: `width:${(100 * share).toFixed(1)}%`}), el('span', {}, all > 0 ? `${one?.nodes ?? 0} / ${one?.submaps ?? 0}` : '–')));
    })));
    return el('div', {class: 'scroll', tabindex: '0', role: 'region', 'aria-label': 'Who holds whose nodes and submaps'},
      el('table', {class: 'holdings'}, el('thead', {}, head), el('tbody', {}, ...rows)), el('p', {class: 'hint'}, 'nodes / submaps; the bar is the share of submaps held'));
  }

  private draw(state: State): void {
    const times = [...new Set(state.nodes.map((node) => node.t))].sort((a, b) => a - b);
    const series = state.robots.map((robot) => {
      const own = state.nodes.filter((node) => node.robot === robot.id).map((node) => node.t).sort((a, b) => a - b);
      let k = 0;
      return times.map((t) => {
        while (k < own.length && own[k] <= t) ++k;
        return k;
      });
    });
    this.plot?.destroy();
    if (times.length === 0) return;
    const style = getComputedStyle(document.documentElement);
    const axis = {stroke: style.getPropertyValue('--soft'), grid: {stroke: style.getPropertyValue('--line'), width: 1}, ticks: {show: false}, font: '11px system-ui'};
    this.plot = new uPlot({
      width: Math.max(200, this.root.clientWidth), height: 170, cursor: {drag: {x: false, y: false}}, legend: {live: true},
      scales: {x: {time: false}},
      axes: [{...axis, values: (_, values) => values.map(duration), size: 28}, {...axis, size: 34}],
      series: [{label: 'time', value: (_, t) => (t === null ? '' : duration(t))}, ...state.robots.map((robot) => ({label: robot.id, stroke: colourOf(state, robot.id), width: 2, points: {show: false}, paths: uPlot.paths.stepped!({align: 1})}))],
    }, [times, ...series], this.chart);
    const canvas = this.chart.querySelector('canvas')!;
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', 'Nodes of each robot over the mission; the numbers are in the cards above');
  }

  redraw(): void {
    if (this.state) this.draw(this.state);
  }

  private resize(): void {
    if (this.plot && this.root.clientWidth > 0) this.plot.setSize({width: Math.max(200, this.root.clientWidth), height: 170});
  }
}
