import uPlot from 'uplot';
import {type Actions, type Child, dot, el} from './dom';
import {patch} from './patch';
import {colourOf, counted, duration, isNumber, type Live, metres, placeMark, type Robot, type State} from './model';

/** A robot's number of nodes at each of `times`, which ascend. */
function nodesUntil(state: State, robot: Robot, times: number[]): number[] {
  const own = state.nodes
    .filter((node) => node.robot === robot.id)
    .map((node) => node.t)
    .sort((a, b) => a - b);
  let k = 0;
  return times.map((t) => {
    while (k < own.length && own[k] <= t) ++k;
    return k;
  });
}

/** Each robot in words, who holds what, and nodes over time. */
export class FleetPanel {
  private plot?: uPlot;
  private chart = el('div', {class: 'chart', 'data-key': 'chart'});
  private state?: State;
  private live?: Live;
  private totals = el('tbody');
  private root: HTMLElement;

  /** `now` stays above what the state shows. */
  constructor(
    root: HTMLElement,
    private actions: Actions,
    now: HTMLElement,
  ) {
    this.root = el('div', {class: 'from-state'});
    root.append(now, this.root);
    new ResizeObserver(() => this.resize()).observe(root);
  }

  show(state: State): void {
    this.state = state;
    const notes = state.notes.map((note) => el('p', {class: 'note', 'data-key': note}, note));
    patch(this.root, [
      ...notes,
      el('h2', {}, 'Their maps'),
      ...state.robots.map((robot) => this.card(state, robot)),
      el('h2', {}, 'Who holds whose nodes and submaps'),
      this.holdings(state),
      el('h2', {}, 'Nodes over the mission'),
      this.chart,
    ]);
    this.draw(state);
    if (this.live) this.showNow(this.live);
  }

  /** Robots whose stores are elsewhere report how much they hold, but not of whom. */
  showNow(live: Live): void {
    this.live = live;
    const state = this.state;
    if (!state) return;
    const known = new Set(state.holdings.map((one) => one.holder));
    const all = live.robots.reduce((max, robot) => Math.max(max, robot.nodes), state.nodes.length);
    const others = live.robots.filter((robot) => robot.nodes > 0 && !known.has(robot.id));
    this.totals.replaceChildren(
      ...others.map((robot) =>
        el(
          'tr',
          {},
          el('th', {scope: 'row'}, dot(state, robot.id), robot.id),
          el(
            'td',
            {
              colspan: String(state.robots.length),
              title:
                `${robot.id} lacks ${counted(all - robot.nodes, 'node')} and ` +
                `${counted(all - robot.submaps, 'submap')} of ${all} in all`,
            },
            el(
              'div',
              {class: 'fill'},
              el('i', {style: `width:${((100 * robot.submaps) / all).toFixed(1)}%`}),
              el('span', {}, `${robot.nodes} / ${robot.submaps} of all robots, as it reports`),
            ),
          ),
        ),
      ),
    );
  }

  private card(state: State, robot: Robot): HTMLElement {
    const last = robot.last_node;
    const words: Child[] = [];
    if (robot.nodes > 0)
      words.push(
        `${counted(robot.nodes, 'node')} on ${metres(robot.path_m)} of path, `,
        `from ${duration(robot.first_s ?? 0)} to ${duration(robot.last_s ?? 0)}`,
      );
    else words.push('made no node that is held here');
    if (robot.sessions > 1) words.push(`, in ${robot.sessions} sessions`);
    const facts = el('p', {class: 'facts'}, ...words, '.');
    if (last) {
      const button = el('button', {type: 'button', class: 'link'}, last);
      button.onclick = () => this.actions.selectNode(last);
      facts.append(
        ' Last at ',
        button,
        isNumber(robot.sigma_m) ? `, known to ${metres(robot.sigma_m)} (1 σ) in the graph.` : '.',
      );
    }
    if (robot.alignments_used !== undefined)
      facts.append(alignmentWords(robot.alignments_used, robot.alignments_rejected ?? 0));
    const joined = state.pairs
      .filter((pair) => pair.joined && (pair.a === robot.id || pair.b === robot.id))
      .map((pair) => (pair.a === robot.id ? pair.b : pair.a));
    const badges = [
      el(
        'span',
        {class: joined.length > 0 ? 'badge good' : 'badge bad'},
        joined.length > 0
          ? `joined with ${joined.join(', ')}`
          : state.robots.length > 1
            ? 'joined with nobody'
            : 'alone',
      ),
    ];
    if (placeMark(robot)) badges.push(el('span', {class: 'badge bad'}, placeMark(robot)));
    if (robot.quarantined) badges.push(el('span', {class: 'badge bad'}, 'quarantined'));
    if (robot.id === state.self) badges.push(el('span', {class: 'badge'}, 'its map is shown'));
    return el(
      'article',
      {class: 'robot', 'data-key': robot.id, style: `border-left-color:${colourOf(state, robot.id)}`},
      el('h3', {}, robot.id, ...badges),
      facts,
    );
  }

  private holdings(state: State): HTMLElement {
    const holders = [...new Set(state.holdings.map((one) => one.holder))],
      makers = state.robots.map((robot) => robot.id);
    const nodesOf = new Map<string, number>();
    for (const one of state.holdings) nodesOf.set(one.maker, Math.max(nodesOf.get(one.maker) ?? 0, one.nodes));
    const head = el(
      'tr',
      {},
      el('th', {scope: 'col'}, 'holds of'),
      ...makers.map((name) => el('th', {scope: 'col'}, dot(state, name), name)),
    );
    const rows = holders.map((holder) =>
      el(
        'tr',
        {},
        el('th', {scope: 'row'}, dot(state, holder), holder),
        ...makers.map((maker) => {
          const one = state.holdings.find((h) => h.holder === holder && h.maker === maker);
          const all = nodesOf.get(maker) ?? 0,
            share = all > 0 ? (one?.submaps ?? 0) / all : 0;
          return el(
            'td',
            {
              title:
                `${holder} holds ${one?.nodes ?? 0} of ${all} nodes of ${maker}, ` +
                `and ${one?.submaps ?? 0} of their submaps`,
            },
            el(
              'div',
              {class: 'fill'},
              el('i', {style: `width:${(100 * share).toFixed(1)}%`}),
              el('span', {}, all > 0 ? `${one?.nodes ?? 0} / ${one?.submaps ?? 0}` : '–'),
            ),
          );
        }),
      ),
    );
    return el(
      'div',
      {class: 'scroll', tabindex: '0', role: 'region', 'aria-label': 'Who holds whose nodes and submaps'},
      el('table', {class: 'holdings'}, el('thead', {}, head), el('tbody', {}, ...rows), this.totals),
      el('p', {class: 'hint'}, 'nodes / submaps; the bar is the share of submaps held'),
    );
  }

  private draw(state: State): void {
    const times = [...new Set(state.nodes.map((node) => node.t))].sort((a, b) => a - b);
    const series = state.robots.map((robot) => nodesUntil(state, robot, times));
    this.plot?.destroy();
    if (times.length === 0) return;
    const style = getComputedStyle(document.documentElement);
    const axis = {
      stroke: style.getPropertyValue('--soft'),
      grid: {stroke: style.getPropertyValue('--line'), width: 1},
      ticks: {show: false},
      font: '11px system-ui',
    };
    this.plot = new uPlot(
      {
        width: Math.max(200, this.root.clientWidth),
        height: 170,
        cursor: {drag: {x: false, y: false}},
        legend: {live: true},
        scales: {x: {time: false}},
        axes: [
          {...axis, values: (_, values) => values.map(duration), size: 28},
          {...axis, size: 34},
        ],
        series: [
          {label: 'time', value: (_, t) => (t === null ? '' : duration(t))},
          ...state.robots.map((robot) => ({
            label: robot.id,
            stroke: colourOf(state, robot.id),
            width: 2,
            points: {show: false},
            paths: uPlot.paths.stepped!({align: 1}),
          })),
        ],
      },
      [times, ...series],
      this.chart,
    );
    const canvas = this.chart.querySelector('canvas')!;
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', 'Nodes of each robot over the mission; the numbers are in the cards above');
  }

  redraw(): void {
    if (this.state) this.draw(this.state);
  }

  private resize(): void {
    if (this.plot && this.root.clientWidth > 0)
      this.plot.setSize({width: Math.max(200, this.root.clientWidth), height: 170});
  }
}

const alignmentWords = (used: number, rejected: number) =>
  ` ${used} of its alignments ${used === 1 ? 'is' : 'are'} in use, ` +
  `${rejected} ${rejected === 1 ? 'contradicts' : 'contradict'}.`;
