import type {State} from './model';

const kGap_s = 86_400; // one without any node is left out
const kLeft_s = 60; // of it

/**
 * Leaves gaps of more than a day out of the nodes' times, so that the slider and the colours of time show those that
 * are left: a clock that jumps, or starts in 1970, puts decades between two nodes. Returns how many seconds are left
 * out; 0: there is no such gap.
 */
export function cutGaps(state: State): number {
  const times = [...new Set(state.nodes.map((node) => node.t))].sort((a, b) => a - b);
  const cut = new Map<number, number>(); // of each time, what lies before it and is left out
  let sum = 0;
  times.forEach((t, k) => {
    const gap = k > 0 ? t - times[k - 1] : 0;
    if (gap > kGap_s) sum += gap - kLeft_s;
    cut.set(t, sum);
  });
  if (sum === 0) return 0;
  delete state.radio?.begin_s; // its times are not those of the slider then
  for (const node of state.nodes) {
    node.stamp_s = node.t;
    node.t -= cut.get(node.t)!;
  }
  return sum;
}

/** Tells what was left out, for the notes of the state. */
export function gapNote(seconds: number): string {
  return (
    `${Math.round(seconds / kGap_s).toLocaleString('en')} days without any node are left out of the slider and the ` +
    'colours of time: there were missions before, or the clock of a robot jumped.'
  );
}
