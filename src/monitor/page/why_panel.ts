import {type Actions, dot, el} from './dom';
import {patch} from './patch';
import {
  type Candidates,
  counted,
  duration,
  findPair,
  type Live,
  metres,
  type Pair,
  type Registration,
  registrationKeys,
  type State,
} from './model';

const kVerdicts = ['accepted', 'ambiguous', 'rejected', 'failed'] as const;
const kRows = 100;
const kRecent_s = 60;

/** Registrations and their reasons, and what joins each pair of robots. */
export class WhyPanel {
  private state?: State;
  private live: Candidates[] = []; // of robots that run
  private pair?: [string, string];
  private hasSelected = false; // the reader, a pair or none
  private verdict: string = 'all';
  private robot: string = 'all';
  private recent = false; // those of the last minute alone
  private rows = kRows;
  private selected?: string; // its key: numbers change as logs of other robots grow

  constructor(
    private root: HTMLElement,
    private actions: Actions,
  ) {}

  show(state: State): void {
    const apart = this.hasSelected || this.pair ? undefined : state.pairs.find((pair) => !pair.joined);
    if (apart) this.pair = [apart.a, apart.b];
    this.state = state;
    this.render();
  }

  /** Candidates of robots that run change without a new state. */
  showNow(live: Live): void {
    const before = this.live.map((one) => one.sentence).join();
    this.live = live.candidates;
    if (this.state && this.live.map((one) => one.sentence).join() !== before) this.render();
  }

  mark(index: number): void {
    this.selected = registrationKeys(this.state!)[index];
    for (const row of this.root.querySelectorAll('.registration'))
      row.setAttribute('aria-current', String(row.getAttribute('data-index') === String(index)));
    this.root.querySelector(`.registration[data-index="${index}"]`)?.scrollIntoView({block: 'nearest'});
  }

  private render(): void {
    const state = this.state!;
    patch(this.root, [
      this.headline(state),
      this.matrix(state),
      this.answer(state),
      this.filters(state),
      this.list(state),
    ]);
  }

  private headline(state: State): HTMLElement {
    const apart = state.pairs.filter((pair) => !pair.joined).length;
    const robots = state.robots.length,
      used = state.alignments.filter((one) => one.status === 'used').length;
    const loose = state.loose_sessions.join(', ');
    if (robots < 2) {
      const but = loose === '' ? '' : ` But ${loose}.`;
      return el(
        'p',
        {class: 'headline'},
        `One robot: ${counted(used, 'alignment')} of its own path ${used === 1 ? 'is' : 'are'} in use.${but}`,
      );
    }
    if (apart === 0 && loose !== '')
      return el('p', {class: 'headline bad'}, `All ${robots} robots are joined, but not all sessions: ${loose}.`);
    if (apart === 0)
      return el(
        'p',
        {class: 'headline good'},
        `All ${robots} robots are joined: ${counted(used, 'alignment')} ${used === 1 ? 'is' : 'are'} in use.`,
      );
    const pairs = counted(state.pairs.length, 'pair');
    const text = `${apart} of ${pairs} of robots ${apart === 1 ? 'is' : 'are'} not joined.`;
    return el('p', {class: 'headline bad'}, loose === '' ? text : `${text} Besides, ${loose}.`);
  }

  private matrix(state: State): HTMLElement {
    const names = state.robots.map((robot) => robot.id);
    const head = el(
      'tr',
      {},
      el('td'),
      ...names.slice(0, -1).map((name) => el('th', {scope: 'col'}, dot(state, name), name)),
    );
    const rows = names
      .slice(1)
      .map((b, k) =>
        el(
          'tr',
          {},
          el('th', {scope: 'row'}, dot(state, b), b),
          ...names.slice(0, k + 1).map((a) => el('td', {}, this.cell(state, a, b))),
        ),
      );
    const name = 'What joins each pair of robots';
    const table = el('table', {class: 'pairs', 'aria-label': name}, el('thead', {}, head), el('tbody', {}, ...rows));
    return el('div', {class: 'scroll', tabindex: '0', role: 'region', 'aria-label': name}, table);
  }

  private cell(state: State, a: string, b: string): HTMLElement {
    const pair = findPair(state, a, b)!;
    const kind = pair.used > 0 ? 'used' : pair.joined ? 'through' : 'apart';
    const apart = pair.attempts > 0 ? `✕ ${pair.attempts}` : '–';
    const text = pair.used > 0 ? String(pair.used) : pair.joined ? '↷' : apart;
    const button = el(
      'button',
      {
        type: 'button',
        id: `pair-${pair.a}-${pair.b}`,
        class: `pair ${kind}`,
        'aria-pressed': String(this.isPair(pair)),
        'aria-label': `${pair.a} and ${pair.b}: ${pair.state}`,
        title: pair.state,
      },
      text,
    );
    button.onclick = () => {
      this.pair = this.isPair(pair) ? undefined : [pair.a, pair.b];
      this.hasSelected = true;
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
    if (!pair)
      return el(
        'p',
        {class: 'hint'},
        state.pairs.length > 0 ? 'Choose a pair to see what joins it, or why nothing does.' : '',
      );
    const box = el(
      'section',
      {class: `answer ${pair.joined ? 'good' : 'bad'}`, 'aria-live': 'polite'},
      el(
        'h2',
        {},
        pair.joined ? `${pair.a} and ${pair.b}: ${pair.state}` : `Why are ${pair.a} and ${pair.b} not joined?`,
      ),
      el('p', {}, pair.text),
    );
    const facts = el(
      'p',
      {class: 'facts'},
      `${counted(pair.attempts, 'registration')}${knownOf(pair)}, ${pair.accepted} accepted, ${pair.used} in use`,
      pair.nearest_m !== null && `; nearest nodes ${metres(pair.nearest_m)} apart: `,
    );
    for (const id of pair.nearest ?? []) {
      const button = el('button', {type: 'button', class: 'link'}, id);
      button.onclick = () => this.actions.selectNode(id);
      facts.append(button, ' ');
    }
    box.append(facts, ...this.candidates(state, pair));
    return box;
  }

  /** Each of the two counts its own; those of a robot that runs again replace those of its last end. */
  private candidates(state: State, {a, b}: Pair): HTMLElement[] {
    const runs = new Set(this.live.map((one) => one.by));
    return [...this.live, ...state.candidates.filter((one) => !runs.has(one.by))]
      .filter((one) => (one.by === a && one.with === b) || (one.by === b && one.with === a))
      .map((one) => el('p', {class: 'facts candidates', 'data-key': `candidates ${one.by}`}, one.sentence));
  }

  /** Those that the filters let through, but for the verdict: the chips count them. The newest are first. */
  private filtered(state: State): [Registration, number][] {
    const of = (id: string) => id.split(/[#/]/)[0];
    const since = this.recent ? lastMinute(state) : -Infinity;
    const all = state.registrations
      .map((one, k): [Registration, number] => [one, k])
      .filter(([one]) => {
        if (this.recent && !(one.t !== undefined && one.t >= since)) return false;
        const robots = [of(one.target), of(one.source)];
        if (this.pair && !(robots.includes(this.pair[0]) && robots.includes(this.pair[1]))) return false;
        return this.robot === 'all' || robots.includes(this.robot) || one.by === this.robot;
      });
    return all.sort(([a], [b]) => (b.t ?? -Infinity) - (a.t ?? -Infinity) || 0);
  }

  private filters(state: State): HTMLElement {
    const filtered = this.filtered(state);
    const chips = ['all', ...kVerdicts].map((verdict) => {
      const n = verdict === 'all' ? filtered.length : filtered.filter(([one]) => one.verdict === verdict).length;
      if (n === 0 && verdict !== 'all' && verdict !== 'rejected' && this.verdict !== verdict) return null;
      const chip = el(
        'button',
        {
          type: 'button',
          id: `verdict-${verdict}`,
          class: `chip ${verdict}`,
          'aria-pressed': String(this.verdict === verdict),
        },
        verdict === 'all' ? 'All' : verdict[0].toUpperCase() + verdict.slice(1),
        el('b', {}, String(n)),
      );
      chip.onclick = () => {
        this.verdict = verdict;
        this.rows = kRows;
        this.render();
      };
      return chip;
    });
    return el(
      'div',
      {class: 'filters'},
      el('h2', {}, this.pair ? `Registrations of ${this.pair.join(' and ')}` : 'Registrations'),
      el('div', {class: 'chips'}, ...chips, this.lastMinuteChip(state), this.robotFilter(state)),
    );
  }

  private lastMinuteChip(state: State): HTMLElement {
    const recent = el(
      'button',
      {type: 'button', id: 'last-minute', class: 'chip', 'aria-pressed': String(this.recent)},
      'Last minute',
    );
    recent.hidden = state.registrations.every((one) => one.t === undefined);
    recent.onclick = () => {
      this.recent = !this.recent;
      this.rows = kRows;
      this.render();
    };
    return recent;
  }

  private robotFilter(state: State): HTMLElement {
    const select = el(
      'select',
      {id: 'robot-filter', 'aria-label': 'Robot'},
      el('option', {value: 'all'}, 'any robot'),
      ...state.robots.map((robot) => el('option', {value: robot.id}, robot.id)),
    );
    select.value = this.robot;
    select.onchange = (event) => {
      this.robot = (event.target as HTMLSelectElement).value;
      this.rows = kRows;
      this.render();
    };
    return select;
  }

  private list(state: State): HTMLElement {
    const shown = this.filtered(state).filter(([one]) => this.verdict === 'all' || one.verdict === this.verdict);
    const keys = registrationKeys(state);
    const list = el('ul', {class: 'registrations', 'aria-label': 'Registrations'});
    for (const [one, index] of shown.slice(0, this.rows)) {
      const button = el(
        'button',
        {
          type: 'button',
          class: 'registration',
          'data-key': keys[index],
          'data-index': String(index),
          'data-verdict': one.verdict,
          'aria-current': String(keys[index] === this.selected),
        },
        el('span', {class: `verdict ${one.verdict}`}, one.verdict),
        el('span', {class: 'who'}, `${one.source} → ${one.target}`),
        one.t !== undefined && el('time', {class: 'when', title: 'after the first node'}, duration(one.t)),
        el('span', {class: 'sentence'}, one.sentence),
      );
      button.onclick = () => this.actions.selectRegistration(index);
      list.append(el('li', {'data-key': keys[index]}, button));
    }
    if (shown.length > this.rows) {
      const more = el(
        'button',
        {type: 'button', class: 'more'},
        `Show ${Math.min(kRows, shown.length - this.rows)} more of ${shown.length}`,
      );
      more.onclick = () => {
        this.rows += kRows;
        this.render();
      };
      list.append(el('li', {'data-key': 'more'}, more));
    }
    if (shown.length === 0)
      list.append(
        el(
          'li',
          {class: 'hint'},
          state.registrations.length > 0
            ? 'None of these.'
            : state.logs.length > 0
              ? `None yet by ${state.logs.join(', ')}, whose registrations are known here.`
              : 'No registrations.csv lies beside the store.',
        ),
      );
    return list;
  }
}

/** Begin of the last minute of all that is shown. */
function lastMinute(state: State): number {
  const times = [...state.nodes, ...state.registrations].map((one) => one.t ?? -Infinity);
  return times.reduce((max, t) => Math.max(max, t), -Infinity) - kRecent_s;
}

/** There may be more registrations in a log that is not here. */
function knownOf({missing_logs}: Pair): string {
  return missing_logs.length > 0 ? ` known here (without those of ${missing_logs.join(' and ')})` : '';
}
