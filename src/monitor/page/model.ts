// The fleet's state as the program sends it (src/monitor/state_json.cpp).
import {kStranger} from './colours';

export interface Robot {
  id: string;
  nodes: number;
  sessions: number;
  path_m: number;
  first_s?: number;
  last_s?: number;
  last_node?: string;
  sigma_m?: number;
  covariance_m2?: [number, number, number]; // of the last node's place: xx, xy, yy
  alignments_used?: number;
  alignments_rejected?: number;
  quarantined?: boolean;
  sessions_not_georeferenced: number;
}

/** x, y, z in m of ENU, and a unit quaternion x, y, z, w. */
export type PoseValues = [number, number, number, number, number, number, number];

export interface FleetNode {
  id: string;
  robot: string;
  session: number;
  t: number; // s after the first node, without long gaps (times.ts)
  stamp_s?: number; // the same with them, where there are any
  bytes: number;
  T?: PoseValues;
  gps?: PoseValues; // its own G, which nothing aligned
  submap?: string;
  gps_sigma_m?: number;
  sigma_m?: number;
  floating?: number; // its component, where nothing ties that to a place on Earth: its T is an assumption
}

export interface Alignment {
  i: string;
  j: string;
  by: string;
  status: string;
  modes: number;
  poses: PoseValues[]; // T_i_j of each mode, best first
  rmse_m: number;
  sentence: string;
}

export interface Registration {
  target: string;
  source: string;
  by: string;
  verdict: 'accepted' | 'ambiguous' | 'rejected' | 'failed';
  alignment: number | null; // that came of it: index in State.alignments
  status: string | null;
  rmse_m: number | null;
  inlier_fraction: number | null;
  overlap: number | null;
  reason: string;
  sentence: string;
  t?: number; // when it was done, s after the first node; older programs did not log it
  pose?: PoseValues; // T_target_source of its best mode, also where it was rejected
}

export interface Holding {
  holder: string;
  maker: string;
  nodes: number;
  submaps: number;
  alignments: number;
}

export interface Pair {
  a: string;
  b: string;
  joined: boolean;
  state: string;
  text: string;
  attempts: number;
  accepted: number;
  used: number;
  missing_logs: string[]; // of the two: what these registered is not known here
  nearest_m: number | null;
  nearest?: [string, string];
}

/** The candidates of one robot with another: also those that were never registered. */
export interface Candidates {
  by: string;
  with: string;
  sentence: string;
}

/** Messages of robot `from` that robot `to` heard on one link. */
export interface HeardLink {
  from: string;
  to: string;
  link: LinkName;
  bytes: number;
  messages: number;
  loss: number; // share
  delay_s: number | null;
  received: number[]; // B/s, by step
  loss_in: (number | null)[]; // by step; null: nothing was logged, 1: it fell silent
}

/** The traffic of a mission, as the robots' files tell of it. */
export interface RadioHistory {
  traces: string[]; // robots whose link_trace.csv is there
  reports: string[]; // robots whose report tells of the kinds
  begin_s?: number; // of the first step, after the first node; without: of another time than the nodes
  step_s: number;
  steps: number;
  links: HeardLink[];
  kinds: {link: LinkName; kind: string; sent: number; received: number}[]; // B
}

export interface State {
  title: string;
  self: string;
  begin_s: number; // the stamp of the first node
  origin: {latitude_deg: number; longitude_deg: number; altitude_m: number};
  robots: Robot[];
  nodes: FleetNode[];
  alignments: Alignment[];
  registrations: Registration[];
  logs: string[]; // robots whose registrations are known
  holdings: Holding[];
  pairs: Pair[];
  candidates: Candidates[]; // of robots that ended
  radio: RadioHistory | null; // of a run, where files tell of it
  loose_sessions: string[]; // clauses on sessions of a robot that nothing joins
  notes: string[];
  colours: ReadonlyMap<string, string>; // of robots; the page adds them (colours.ts)
}

export function colourOf(state: State, robot: string): string {
  return state.colours.get(robot) ?? kStranger;
}

export const kNotGeoreferenced = 'not known: no GPS fix and no alignment ties it to a place on Earth';
export const kNoDistance = 'distance not known: nothing ties their frames to each other';

/** Why the coordinates of a robot's nodes do not count, all or some; empty where they do. */
export function placeMark({nodes, sessions, sessions_not_georeferenced: without}: Robot): string {
  if (nodes === 0 || without === 0) return '';
  return without < sessions ? `${without} of ${sessions} sessions not georeferenced` : 'not georeferenced';
}

/** The distance of two places on the map is one on the site. */
export function comparable(a: {floating?: number} | undefined, b: {floating?: number} | undefined): boolean {
  return a?.floating === b?.floating;
}

/** Time of the last node, s. */
export const endOf = ({nodes}: State) => nodes.reduce((last, {t}) => Math.max(last, t), 0);

/** JSON has null for what is infinite or no number. */
export const isNumber = (value: unknown): value is number => Number.isFinite(value);

/** By node, m: its own sigma, else that of its robot's node before that has one, else after; only some are computed. */
export function sigmasOf(nodes: FleetNode[]): Map<string, number> {
  const sigmas = new Map<string, number>();
  for (const order of [nodes, [...nodes].reverse()]) {
    const last = new Map<string, number>();
    for (const {id, robot, sigma_m} of order) {
      if (isNumber(sigma_m)) last.set(robot, sigma_m);
      const near = last.get(robot);
      if (near !== undefined && !sigmas.has(id)) sigmas.set(id, near);
    }
  }
  return sigmas;
}

export function duration(seconds: number): string {
  const whole = Math.round(seconds);
  const two = (n: number) => String(n).padStart(2, '0');
  const h = Math.floor(whole / 3600),
    m = Math.floor(whole / 60) % 60,
    s = whole % 60;
  return h > 0 ? `${h}:${two(m)}:${two(s)}` : `${m}:${two(s)}`;
}

export function count(n: number): string {
  if (n >= 1e6) return `${(n / 1e6).toFixed(2)} M`;
  if (n >= 1e4) return `${Math.round(n / 1e3)} k`;
  return n.toLocaleString('en');
}

/** "1 node", "2 nodes" */
export const counted = (n: number, what: string) => `${n} ${what}${n === 1 ? '' : 's'}`;

export function metres(m: number | null | undefined): string {
  if (!isNumber(m)) return 'an unknown length';
  return m < 10 ? `${m.toFixed(2)} m` : m < 1000 ? `${m.toFixed(1)} m` : `${(m / 1000).toFixed(2)} km`;
}

export function findPair(state: State, a: string, b: string): Pair | undefined {
  return state.pairs.find((pair) => (pair.a === a && pair.b === b) || (pair.a === b && pair.b === a));
}

/** Names of the registrations that stay when more are logged: who ran it, its nodes, and which time it is. */
export function registrationKeys(state: State): string[] {
  const times = new Map<string, number>();
  return state.registrations.map(({by, target, source}) => {
    const pair = `${by} ${target} ${source}`;
    const time = (times.get(pair) ?? 0) + 1;
    times.set(pair, time);
    return `${pair} ${time}`;
  });
}

// A running robot sends this once a second beyond its store (src/monitor/live_status.cpp).

export type LinkName = 'long_range' | 'short_range';

export interface RobotNow {
  id: string;
  activity: string;
  problems: string[]; // that are there now
  past_problems: {text: string; total: boolean; seconds_ago: number | null}[]; // total: counted since it started
  heard: {link: LinkName; seconds_ago: number}[];
  battery: number | null;
  sigma_m: number | null;
  place: [number, number, number, number, number] | null; // by its EKF: WGS84 (deg, m), heading (rad), stamp (s)
  clock: {sensor: string; behind_s: number} | null; // that is off most, within a factor of 1.4
  nodes: number;
  alignments: number;
  submaps: number;
  backlog_bytes: number;
  ordered_to_hold: boolean; // with called_home: resume lets it go on home
  called_home: boolean;
  rows: number[]; // that it still has to drive
  driven: boolean;
}

export interface Sensor {
  name: string;
  samples: number;
  per_second: number;
  clock_behind_s: number | null;
  clock_slow_ppm: number | null;
  findings: {text: string; over: boolean}[];
}

export interface Radio {
  who_may_join: string;
  sent: number;
  received: number;
  share: number;
  fleet_budget: number;
  backlog_bytes: number;
  backlog_s: number | null;
  queues: {priority: string; waiting: number; dropped: number}[];
  kinds: {link: LinkName; kind: string; sent: number; received: number}[];
  peers: {robot: string; link: LinkName; received: number; loss: number; delay_s: number | null}[];
  missing_submaps: number;
  missing_bytes: number;
  seconds_to_equal_map: number | null;
}

export interface FleetMaps {
  last: string | null; // will lack submaps for the longest
  missing_submaps: number; // of that robot
  seconds_to_equal: number | null;
  not_counted: string[]; // lost, or not heard yet
}

export interface Live {
  self: string;
  lost_after_s: number;
  robots: RobotNow[];
  sensors: Sensor[];
  radio: Radio;
  maps: FleetMaps;
  candidates: Candidates[]; // of this robot, and of others in the same process
  operated: boolean;
}

export const linkName = (link: LinkName) => (link === 'long_range' ? 'radio' : 'Wi-Fi');

/** 950 B, 1.2 kB, 3.4 MB */
export function bytes(n: number): string {
  if (n >= 1e6) return `${(n / 1e6).toFixed(1)} MB`;
  return n >= 1e3 ? `${(n / 1e3).toFixed(1)} kB` : `${Math.round(n)} B`;
}

/** "3 s", "4:10 min" */
export function ago(seconds: number): string {
  return seconds < 100 ? `${Math.round(seconds)} s` : `${duration(seconds)} ${seconds < 3600 ? 'min' : 'h'}`;
}
