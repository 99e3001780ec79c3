import {ago, linkName, type Live} from './model';

/** Whether the robot that shows the page hears another one, by the better of its links. */
export interface RobotLink {
  robot: string;
  quality: 'good' | 'poor' | 'silent';
  text: string;
}

const kPoorLoss = 0.2; // share of messages
const kLate_s = 10; // a robot sends its status every few seconds

/** Links to all robots that were ever heard, `later` seconds after the status. */
export function linksOf(live: Live, later: number): RobotLink[] {
  return live.robots
    .filter((robot) => robot.id !== live.self && robot.heard.length > 0)
    .map(({id, heard}) => {
      const silence = Math.min(...heard.map((one) => one.seconds_ago)) + later;
      if (silence > live.lost_after_s) return {robot: id, quality: 'silent', text: `silent for ${ago(silence)}`};
      if (silence > Math.min(kLate_s, live.lost_after_s))
        return {robot: id, quality: 'poor', text: `heard ${ago(silence)} ago`};
      const peers = live.radio.peers.filter((one) => one.robot === id).sort((a, b) => a.loss - b.loss);
      if (peers.length === 0) return {robot: id, quality: 'good', text: `heard ${ago(silence)} ago`};
      const {link, loss} = peers[0];
      const text = `${linkName(link)}, ${(100 * loss).toFixed(loss < 0.1 ? 1 : 0)} % lost`;
      return {robot: id, quality: loss >= kPoorLoss ? 'poor' : 'good', text};
    });
}
