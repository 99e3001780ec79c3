import {ago, linkName, type LinkName, type Live, type RadioHistory} from './model';

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

/**
 * Links between any two robots at `t`, s after the first node: over Wi-Fi while that is heard, else over the radio; the
 * worse of both ways. Nothing is known of a way to a robot without a link trace.
 */
export function linksAt(history: RadioHistory, t: number): RobotLink[] {
  if (history.begin_s === undefined || t < history.begin_s) return [];
  const step = Math.floor((t - history.begin_s) / history.step_s);
  const heard = new Map<string, Way[]>(); // by pair
  for (const {from, to, link, loss_in} of history.links) {
    const last = lastHeard(loss_in, step, Math.max(1, Math.ceil(kRemembered_s[link] / history.step_s)));
    const pair = [from, to].sort().join(' ');
    if (last) heard.set(pair, [...(heard.get(pair) ?? []), {from, to, link, ...last}]);
  }
  return [...heard.values()].map((ways) => linkOf(ways, history));
}

interface Way {
  from: string;
  to: string;
  link: LinkName;
  loss: number;
  steps: number; // since it was heard
}

function linkOf(all: Way[], {traces, step_s}: RadioHistory): RobotLink {
  const near = all.filter((way) => way.link === 'short_range'),
    ways = near.length > 0 ? near : all;
  const worst = ways.reduce((a, b) => (b.loss > a.loss ? b : a));
  const {from, to, link} = worst;
  if (ways.length === 1 && traces.includes(from))
    return {from, to, quality: 'poor', text: `${linkName(link)}, ${to} alone hears the other`};
  const latest = Math.min(...ways.map((way) => way.steps)) * step_s;
  const since = latest > kLate_s ? `, heard ${ago(latest)} before` : '';
  const {quality, text} = byLoss(link, worst.loss);
  return {from, to, quality, text: text + since};
}

/** The last of the steps in which something was heard, unless that is longer ago than `memory` or it fell silent. */
function lastHeard(loss_in: (number | null)[], step: number, memory: number): Pick<Way, 'loss' | 'steps'> | undefined {
  for (let k = step; k >= Math.max(0, step - memory); --k) {
    const loss = loss_in[k] ?? null;
    if (loss !== null) return loss < 1 ? {loss, steps: step - k} : undefined;
  }
  return undefined;
}

function byLoss(link: LinkName, loss: number): {quality: 'good' | 'poor'; text: string} {
  const text = `${linkName(link)}, ${(100 * loss).toFixed(loss < 0.1 ? 1 : 0)} % lost`;
  return {quality: loss >= kPoorLoss ? 'poor' : 'good', text};
}
