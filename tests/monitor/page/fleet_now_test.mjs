// Cards of the robots at present (src/monitor/page/fleet_now.ts).
import assert from 'node:assert/strict';
import {openPage, textOf} from './fake_page.mjs';
import {pageModule} from './page_module.mjs';
import {live, robotNow} from './states.mjs';

const page = await openPage(process.argv[2]);
let clock = 0;
const asked = [];
let reply = {ok: true};
const real = {performance: globalThis.performance, fetch: globalThis.fetch};
Object.defineProperty(globalThis, 'performance', {configurable: true, value: {now: () => clock}});
globalThis.fetch = async (target, {method}) => {
  asked.push(`${method} ${target}`);
  if (!reply) throw new Error('offline');
  return reply;
};
try {
  const {FleetNow} = await pageModule(process.argv[2], 'fleet_now');
  const fleet = new FleetNow();
  const show = (r2, more) => fleet.show(live([robotNow('r1'), robotNow('r2', r2)], more));
  const card = (id) => fleet.root.querySelector(`[data-robot=${id}]`);
  const button = (name) => fleet.root.querySelector(`button[aria-label="${name}"]`);
  const press = async (one, times = 1) => {
    for (let k = 0; k < times; ++k) one.click();
    await new Promise((later) => setTimeout(later));
    return textOf(fleet.root.querySelector('.hint'));
  };

  // Present words; a robot that is silent too long is lost, also without a newer status.
  show({
    heard: [{link: 'long_range', seconds_ago: 3}],
    battery: 0.625,
    sigma_m: 0.034,
    nodes: 4,
    submaps: 3,
    alignments: 2,
  });
  assert.match(textOf(card('r2')), /r2in contact.*r2 drives row 7\./);
  assert.match(
    textOf(card('r2')),
    /Last heard 3 s ago by radio; battery 63 %; position known to 0\.03 m \(1 σ\) now, by its EKF;/,
  );
  assert.match(textOf(card('r2')), /holds 4 nodes, 3 submaps, 2 alignments\./);
  assert.match(textOf(card('r1')), /shows this page/);
  clock += 58_000;
  page.intervals[0]();
  assert.match(textOf(card('r2')), /lost.*r2 is lost\. Known last: drives row 7\..*Last heard 61 s ago/);
  assert.equal(fleet.root.querySelector('.unseen').textContent, 'r2 is lost.', 'said once to who cannot see');
  assert.doesNotMatch(textOf(card('r1')), /is lost/);
  const before = card('r2'),
    sensors = fleet.root.querySelector('.scroll');
  show({heard: [{link: 'short_range', seconds_ago: 0}], problems: ['no GPS'], clock: {sensor: 'gps', behind_s: -0.25}});
  assert.equal(card('r2'), before, 'cards stay, so focus stays');
  assert.equal(fleet.root.querySelector('.scroll'), sensors);
  assert.match(textOf(card('r2')), /in contact.*no GPS.*The clock of its gps is about 250 ms ahead/i);

  // The robot that shows the page has the offset itself; the silence of one link is no fault.
  const lidar = {name: 'lidar', samples: 5, per_second: 10, clock_behind_s: 0.12, clock_slow_ppm: null, findings: []};
  const clocks = {clock: {sensor: 'lidar', behind_s: 0.128}};
  const heard = [
    {link: 'short_range', seconds_ago: 2},
    {link: 'long_range', seconds_ago: 36},
  ];
  fleet.show(
    live([robotNow('r1', clocks), robotNow('r2', {...clocks, heard, nodes: 1, submaps: 1, alignments: 1})], {
      sensors: [lidar],
    }),
  );
  assert.match(textOf(card('r1')), /The clock of its lidar is 120 ms behind/);
  assert.match(textOf(card('r2')), /the clock of its lidar is about 128 ms behind/);
  assert.match(textOf(card('r2')), /Last heard 2 s ago by Wi-Fi, before that 36 s ago by radio;/);
  assert.match(textOf(card('r2')), /holds 1 node, 1 submap, 1 alignment\./);
  show({heard: heard.map((one) => ({...one, seconds_ago: 1}))});
  assert.match(textOf(card('r2')), /Last heard 1 s ago by Wi-Fi and radio\./);

  // Problems that are over are past ones.
  show({
    past_problems: [
      {text: 'no scan for 9 s', total: false, seconds_ago: 30},
      {text: 'finding', total: false, seconds_ago: null},
      {text: 'the disk refused 3 writes', total: true, seconds_ago: 200},
      {text: 'its disk refused writes', total: true, seconds_ago: null},
    ],
  });
  const items = (list) => [...card('r2').querySelectorAll(`.${list} li`)].map(textOf);
  assert.deepEqual(items('problems'), []);
  assert.ok(card('r2').querySelector('.problems').hidden);
  assert.deepEqual(items('past'), [
    'was until 30 s ago: no scan for 9 s',
    'was: finding',
    'the disk refused 3 writes, the last time 3:20 min ago',
    'its disk refused writes, at some time since it started',
  ]);
  clock += 5000;
  page.intervals[0]();
  assert.equal(items('past')[0], 'was until 35 s ago: no scan for 9 s');
  const sensor = {name: 'imu', samples: 5, per_second: 1, clock_behind_s: 0, clock_slow_ppm: null};
  const findings = [
    {text: 'imu: stamps are 5 s behind', over: true},
    {text: 'IMU: samples are missing', over: false},
  ];
  show(
    {},
    {
      sensors: [
        {...sensor, findings},
        {...sensor, name: 'gps', findings: []},
      ],
    },
  );
  const cells = (name) => [...fleet.root.querySelectorAll(`[data-sensor=${name}] td`)].at(-1);
  assert.deepEqual(
    [...cells('imu').querySelectorAll('div')].map((one) => `${one.className} ${textOf(one)}`),
    ['over was: imu: stamps are 5 s behind', 'bad IMU: samples are missing'],
  );
  assert.equal(cells('gps').textContent, '–');
  assert.ok(card('r2').querySelector('.past').hidden);

  show({});
  assert.match(textOf(card('r2')), /not heard yet/);

  // Orders, by what is in force.
  assert.equal(await press(button('Hold r2')), 'Ordered: hold r2.');
  show({ordered_to_hold: true});
  assert.equal(await press(button('Resume r2')), 'Ordered: resume r2.');
  show({});
  assert.equal(await press(button('Call r2 home')), 'Press again within 5 s: Call r2 home.');
  assert.equal(asked.length, 2, 'one press calls nobody home');
  await press(card('r2').querySelector('.sure'));
  show({called_home: true});
  assert.equal(button('Resume r2').textContent, 'Resume');
  assert.equal(textOf(card('r2').querySelector('h3')).match(/Hold/)?.[0], 'Hold', 'on its way home it can be held');
  await press(button('Resume r2'));
  assert.deepEqual(
    asked,
    ['hold', 'resume', 'home', 'resume'].map((one) => `POST /operator/${one}?robot=r2`),
  );

  // Held on its way home: one button, which lets it go on home.
  show({called_home: true, ordered_to_hold: true});
  const buttons = [...card('r2').querySelectorAll('h3 button')].filter((one) => !one.hidden);
  assert.deepEqual(
    buttons.map((one) => one.getAttribute('aria-label')),
    ['Resume r2 on its way home'],
  );
  assert.equal(await press(buttons[0]), 'Ordered: resume r2. It goes on home; another resume, 60 s later, ends that.');
  assert.equal(asked.at(-1), 'POST /operator/resume?robot=r2');

  // A second press before the next status is none.
  assert.equal(buttons[0].disabled, true);
  page.intervals[0]();
  assert.equal(buttons[0].disabled, true, 'time alone tells nothing new');
  show({called_home: true});
  assert.equal(buttons[0].disabled, false);

  // Rows are given to one robot or to any.
  show({rows: [7, 9]});
  const [row, to] = card('r2').querySelectorAll('select');
  row.value = '9';
  const give = [...card('r2').querySelectorAll('button')].at(-1);
  assert.equal(await press(give, 2), 'Ordered: r2 gives row 9 to any other robot.');
  to.value = 'r1';
  show({rows: [7, 9, 11]});
  assert.equal(row.value, '9', 'what is chosen stays when rows come');
  assert.equal(await press(give, 2), 'Ordered: r2 gives row 9 to r1.');
  assert.deepEqual(asked.slice(-2), ['POST /operator/give?robot=r2&row=9', 'POST /operator/give?robot=r2&row=9&to=r1']);

  // The page tells if an order does not work.
  reply = {ok: false, text: async () => 'no radio\n'};
  assert.equal(await press(button('Hold r2')), 'Not ordered (hold r2): no radio');
  assert.equal(button('Hold r2').disabled, false, 'it can be tried again at once');
  reply = undefined;
  assert.equal(await press(button('Hold r2')), 'Not ordered (hold r2): the robot does not answer.');

  // Nobody orders a page that only reads, or a robot that fleetmap does not drive.
  show({driven: false});
  assert.equal(button('Hold r2').hidden, true);
  assert.equal(button('Hold r1').hidden, false);
  show({rows: [7]}, {operated: false});
  for (const one of fleet.root.querySelectorAll('h3 button')) assert.equal(one.hidden, true);
  assert.equal(card('r2').querySelector('.give').hidden, true);
  assert.equal(fleet.root.querySelector('.orders').hidden, true);

  const gps = {name: 'gps', samples: 9, per_second: 4.96, clock_behind_s: -0.2, clock_slow_ppm: 30, findings: []};
  show({}, {sensors: [gps]});
  assert.equal(textOf(fleet.root.querySelector('[data-sensor=gps]')), 'gps5.0 /s200 ms ahead, 30 ppm slow–');
} finally {
  Object.defineProperty(globalThis, 'performance', {configurable: true, value: real.performance});
  globalThis.fetch = real.fetch;
}
