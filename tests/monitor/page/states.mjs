// States of a made-up fleet, as the program sends them.

/** Node `k` of a robot, `k` seconds after the first one, at x, y, z (m of ENU). */
export const node = (robot, k, [x, y, z] = [0, 0, 0], more = {}) => ({
  id: `${robot}#${k}`,
  robot,
  session: 0,
  t: k,
  bytes: 1000,
  T: [x, y, z, 0, 0, 0, 1],
  submap: `${robot}${k}`.padEnd(32, '0'),
  ...more,
});

export const robot = (id, more = {}) => ({
  id,
  nodes: 2,
  sessions: 1,
  path_m: 12.34,
  sessions_not_georeferenced: 0,
  ...more,
});

export const registration = (target, source, verdict, more = {}) => ({
  target,
  source,
  by: target.split('#')[0],
  verdict,
  alignment: null,
  status: null,
  rmse_m: null,
  inlier_fraction: null,
  overlap: null,
  reason: '',
  sentence: `${source} onto ${target}: ${verdict}`,
  ...more,
});

export const alignment = (i, j, status, more = {}) => ({
  i,
  j,
  by: i.split('#')[0],
  status,
  modes: 1,
  poses: [[1, 0, 0, 0, 0, 0, 1]],
  rmse_m: 0.05,
  sentence: `${j} onto ${i}: ${status}`,
  ...more,
});

export const pair = (a, b, joined, more = {}) => ({
  a,
  b,
  joined,
  state: joined ? 'joined' : 'never_near',
  text: `${a} and ${b}: why`,
  attempts: 0,
  accepted: 0,
  used: 0,
  missing_logs: [],
  nearest_m: null,
  ...more,
});

export const state = (more = {}) => ({
  title: 'made up',
  self: 'r1',
  begin_s: 1000,
  origin: {latitude_deg: 49, longitude_deg: 8.4, altitude_m: 110},
  robots: [robot('r1'), robot('r2')],
  nodes: [node('r1', 0), node('r1', 1, [10, 0, 0]), node('r2', 0, [0, 10, 0]), node('r2', 1, [10, 10, 0])],
  alignments: [],
  registrations: [],
  logs: ['r1', 'r2'],
  holdings: [],
  pairs: [pair('r1', 'r2', false)],
  candidates: [],
  radio: null,
  loose_sessions: [],
  notes: [],
  colours: new Map([
    ['r1', '#2f7de1'],
    ['r2', '#d05a1b'],
  ]),
  ...more,
});

export const robotNow = (id, more = {}) => ({
  id,
  activity: 'drives row 7',
  problems: [],
  past_problems: [],
  heard: [],
  battery: null,
  sigma_m: null,
  place: null,
  clock: null,
  nodes: 0,
  alignments: 0,
  submaps: 0,
  backlog_bytes: 0,
  ordered_to_hold: false,
  called_home: false,
  rows: [],
  driven: true,
  ...more,
});

export const live = (robots, more = {}) => ({
  self: 'r1',
  lost_after_s: 60,
  robots,
  sensors: [],
  candidates: [],
  operated: true,
  radio: {
    who_may_join: 'anyone',
    sent: 500,
    received: 250,
    share: 1000,
    fleet_budget: 20_000,
    backlog_bytes: 0,
    backlog_s: null,
    queues: [],
    kinds: [],
    peers: [],
    missing_submaps: 0,
    missing_bytes: 0,
    seconds_to_equal_map: null,
  },
  maps: {last: null, missing_submaps: 0, seconds_to_equal: 0, not_counted: []},
  ...more,
});

/** A link of `steps` steps; `loss_in` and `received` name those that are not empty. */
export const heardLink = (from, to, link, steps, {loss_in = {}, received = {}, ...more} = {}) => ({
  from,
  to,
  link,
  bytes: 1000,
  messages: 10,
  loss: 0.1,
  delay_s: null,
  received: Array.from({length: steps}, (_, k) => received[k] ?? 0),
  loss_in: Array.from({length: steps}, (_, k) => loss_in[k] ?? null),
  ...more,
});

export const radioHistory = (more = {}) => ({
  traces: ['r1', 'r2'],
  reports: ['r1', 'r2'],
  step_s: 1,
  steps: 0,
  links: [],
  kinds: [],
  ...more,
});
