import {ago, type HeardLink, linkName, type LinkName, type Live, type RadioHistory} from './model';

/** Whether robot `to` hears robot `from`, by the better of its links. */
export interface RobotLink {
  from: string;
  to: string;
  quality: 'good' | 'poor' | 'silent';
  text: string;
}

const kPoorLoss = 0.2; // share of messages
const kLate_s = 10; // a robot sends its status every few seconds

const kRemembered_s = {long_range: 65, short_range: 6}; // a robot says something every 20 s, and on Wi-Fi every second

/** Links of the robot that shows the page to all that it ever heard, `later` seconds after its status. */
export function linksOf(live: Live, later: number): RobotLink[] {
  return live.robots
    .filter((robot) => robot.id !== live.self && robot.heard.length > 0)
    .map(({id, heard}) => {
      const ends = {from: live.self, to: id};
      const silence = Math.min(...heard.map((one) => one.seconds_ago)) + later;
      if (silence > live.lost_after_s) return {...ends, quality: 'silent', text: `silent for ${ago(silence)}`};
      if (silence > Math.min(kLate_s, live.lost_after_s))
        return {...ends, quality: 'poor', text: `heard ${ago(silence)} ago`};
      const peers = live.radio.peers.filter((one) => one.robot === id).sort((a, b) => a.loss - b.loss);
      if (peers.length === 0) return {...ends, quality: 'good', text: `heard ${ago(silence)} ago`};
      const {link, loss} = peers[0];
      return {...ends, ...byLoss(link, loss)};
    });
}

/** Links between any two robots at `t`, s after the first node: the better of both ways and of both links. */
export function linksAt(history: RadioHistory, t: number): RobotLink[] {
  if (history.begin_s === undefined || t < history.begin_s) return [];
  const step = Math.min(Math.floor((t - history.begin_s) / history.step_s), history.steps - 1);
  const best = new Map<string, {one: HeardLink; loss: number}>();
  for (const one of history.links) {
    const loss = lastLoss(one, step, history.step_s);
    const pair = [one.from, one.to].sort().join(' ');
    if (loss !== undefined && loss < (best.get(pair)?.loss ?? 1)) best.set(pair, {one, loss});
  }
  return [...best.values()].map(({one, loss}) => ({from: one.from, to: one.to, ...byLoss(one.link, loss)}));
}

/** In the last step in which something was logged, unless that is long ago; 1: it fell silent. */
function lastLoss({link, loss_in}: HeardLink, step: number, step_s: number): number | undefined {
  const oldest = step - Math.ceil(kRemembered_s[link] / step_s);
  for (let k = step; k >= Math.max(0, oldest); --k) {
    const loss = loss_in[k];
    if (loss !== null) return loss;
  }
  return undefined;
}

function byLoss(link: LinkName, loss: number): {quality: 'good' | 'poor'; text: string} {
  const text = `${linkName(link)}, ${(100 * loss).toFixed(loss < 0.1 ? 1 : 0)} % lost`;
  return {quality: loss >= kPoorLoss ? 'poor' : 'good', text};
}
