// Opens a short run of the twin with `fleetmap monitor` as Foxglove does, by Foxglove's own packages: the client of the
// WebSocket protocol, the parser of the schemas and the reader of the messages. The map's points are compared with
// those that the page gets of the same submaps.
//   node foxglove_test.mjs FLEETMAP PAGE_FOLDER
// FLEETMAP_RUN of the environment is a run to open instead of a new one.
import assert from 'node:assert/strict';
import {mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {join, resolve} from 'node:path';
import {makeRun, serve} from './shown_run.mjs';

const [fleetmap, pageFolder] = process.argv.slice(2);
const require = createRequire(resolve(pageFolder, 'package.json'));
const {FoxgloveClient} = require('@foxglove/ws-protocol');
const {parseIDL} = require('@foxglove/omgidl-parser');
const {MessageReader} = require('@foxglove/omgidl-serialization');
const {WebSocket} = require('ws');

const kMaxPoints = 300_000;
const kToken = '0123456789abcdef';
const folder = mkdtempSync(join(tmpdir(), 'fleetmap_foxglove_'));

const socketUrl = (url) => url.replace(/^http:/, 'ws:');

/** The protocol that the server chose, or the status by which it refused. */
function handshake(url, offered, headers = {}) {
  return new Promise((done) => {
    const socket = new WebSocket(socketUrl(url), offered, {headers});
    socket.on('open', () => {
      done(socket.protocol);
      socket.close();
    });
    socket.on('unexpected-response', (_, response) => {
      done(response.statusCode);
      socket.terminate();
    });
    socket.on('error', () => {});
  });
}

/** Subscribes to every channel: the first message of each by topic, decoded by its schema. */
function listen(url, subprotocol) {
  return new Promise((done, failed) => {
    const socket = new WebSocket(socketUrl(url), [subprotocol]);
    const client = new FoxgloveClient({ws: socket});
    const bySubscription = new Map(),
      messages = {};
    let info,
      bytes = 0;
    client.on('serverInfo', (event) => {
      info = event;
    });
    client.on('error', failed);
    client.on('status', (event) => failed(new Error(event.message)));
    client.on('advertise', (channels) => {
      for (const channel of channels) {
        assert.equal(channel.encoding, 'cdr');
        assert.equal(channel.schemaEncoding, 'omgidl');
        const reader = new MessageReader(channel.schemaName, parseIDL(channel.schema));
        bySubscription.set(client.subscribe(channel.id), {channel, reader});
      }
    });
    client.on('message', ({subscriptionId, timestamp, data}) => {
      const {channel, reader} = bySubscription.get(subscriptionId);
      assert.ok(Math.abs(Number(timestamp / 1_000_000n) - Date.now()) < 600_000, 'received now');
      messages[channel.topic] = {schema: channel.schemaName, ...reader.readMessage(data)};
      bytes += data.byteLength;
      if (Object.keys(messages).length < bySubscription.size) return;
      client.close();
      done({info, messages, bytes});
    });
  });
}

const rotated = ([qx, qy, qz, qw], [x, y, z]) => {
  const tx = 2 * (qy * z - qz * y),
    ty = 2 * (qz * x - qx * z),
    tz = 2 * (qx * y - qy * x);
  return [x + qw * tx + qy * tz - qz * ty, y + qw * ty + qz * tx - qx * tz, z + qw * tz + qx * ty - qy * tx];
};

/** A submap as the page gets it: its points in the node's frame, coarse to fine. */
async function submapOf(url, hash) {
  const bytes = await (await fetch(new URL(`submap/${hash}?from=0&count=200000`, url))).arrayBuffer();
  const head = new DataView(bytes),
    steps = new Int16Array(bytes, 36);
  const centre = [4, 8, 12].map((at) => head.getFloat32(at, true)),
    scale = head.getFloat32(16, true);
  const count = head.getUint32(28, true);
  assert.equal(count, head.getUint32(20, true), 'the whole submap');
  return {
    count,
    point: (k) => centre.map((c, axis) => c + scale * steps[4 * k + axis]),
    intensity: (k) => steps[4 * k + 3],
  };
}

/** The expected points of the map, by the page's data. */
async function expectedMap(url, state) {
  const sequence = (id) => Number(id.split('/')[1]),
    session = (id) => Number(id.match(/#(\d+)/)?.[1] ?? 0);
  const placed = state.nodes.filter((node) => node.T && node.submap);
  placed.sort((a, b) =>
    a.robot < b.robot ? -1 : a.robot > b.robot ? 1 : session(a.id) - session(b.id) || sequence(a.id) - sequence(b.id),
  );
  const points = [];
  for (const [k, node] of placed.entries()) {
    const submap = await submapOf(url, node.submap);
    const share = Math.min(submap.count, Math.floor((kMaxPoints - points.length) / (placed.length - k)));
    for (let p = 0; p < share; ++p) {
      const turned = rotated(node.T.slice(3), submap.point(p));
      points.push([
        ...turned.map((value, axis) => value + node.T[axis]),
        submap.intensity(p),
        state.robots.findIndex((one) => one.id === node.robot),
      ]);
    }
  }
  return points;
}

function checkMap(cloud, expected) {
  assert.equal(cloud.schema, 'foxglove::PointCloud');
  assert.equal(cloud.frame_id, 'enu');
  assert.deepEqual(cloud.pose.orientation, {x: 0, y: 0, z: 0, w: 1});
  const kinds = {3: (view, at) => view.getUint16(at, true), 7: (view, at) => view.getFloat32(at, true)};
  assert.deepEqual(
    cloud.fields.map((field) => field.name),
    ['x', 'y', 'z', 'intensity', 'robot'],
  );
  const count = cloud.data.length / cloud.point_stride;
  assert.equal(count, expected.length);
  assert.ok(count > 1000 && count <= kMaxPoints, `${count} points`);
  const view = new DataView(cloud.data.buffer, cloud.data.byteOffset, cloud.data.byteLength);
  let worst = 0;
  for (let k = 0; k < count; ++k) {
    const point = cloud.fields.map((field) => kinds[field.type](view, k * cloud.point_stride + field.offset));
    for (let axis = 0; axis < 3; ++axis) worst = Math.max(worst, Math.abs(point[axis] - expected[k][axis]));
    assert.deepEqual(point.slice(3), expected[k].slice(3), `intensity and robot of point ${k}`);
  }
  assert.ok(worst < 1e-3, `a point is off by ${worst} m`); // the page's poses are rounded
  return count;
}

function checkRobots(messages, state) {
  const transforms = Object.fromEntries(
    messages['/fleet/transforms'].transforms.map((one) => [one.child_frame_id, one]),
  );
  const trajectories = Object.fromEntries(messages['/fleet/trajectories'].entities.map((one) => [one.id, one]));
  for (const robot of state.robots) {
    const last = state.nodes.find((node) => node.id === robot.last_node);
    const {parent_frame_id: parent, translation, rotation} = transforms[robot.id];
    assert.equal(parent, 'enu');
    for (const [axis, value] of [translation.x, translation.y, translation.z].entries())
      assert.ok(Math.abs(value - last.T[axis]) < 1e-3);
    assert.ok(Math.abs(Math.hypot(rotation.x, rotation.y, rotation.z, rotation.w) - 1) < 1e-9);
    const fix = messages[`/${robot.id}/fix`];
    assert.equal(fix.schema, 'foxglove::LocationFix');
    // Metres per degree, which is good for the size of a farm.
    assert.ok(
      Math.abs((fix.latitude - state.origin.latitude_deg) * 111_200 - last.T[1]) < 2,
      `${robot.id} at ${fix.latitude}°`,
    );
    assert.ok(Math.abs(fix.altitude - state.origin.altitude_m - last.T[2]) < 0.5);
    assert.equal(fix.position_covariance.length, 9);
    assert.equal(
      trajectories[robot.id].spheres.length,
      state.nodes.filter((node) => node.robot === robot.id && node.T).length,
    );
    assert.equal(trajectories[robot.id].lines[0].type, 0);
  }
  const lines = messages['/fleet/alignments'].entities.flatMap((entity) =>
    entity.lines.map((line) => [entity.id, line.points.length / 2]),
  );
  for (const [status, count] of lines) {
    assert.equal(count, state.alignments.filter((one) => one.status === status).length, status);
  }
}

async function testToken(run) {
  const tokenFile = join(folder, 'token');
  writeFileSync(tokenFile, kToken);
  const {server, url} = await serve(fleetmap, run, ['--token-file', tokenFile]);
  try {
    const offered = ['foxglove.sdk.v1'],
      bare = new URL('/', url).href;
    assert.match(url, /\?token=/);
    assert.equal(await handshake(url, offered), 'foxglove.sdk.v1');
    assert.equal(await handshake(url, offered, {Origin: 'https://app.foxglove.dev'}), 'foxglove.sdk.v1');
    assert.equal(await handshake(bare, offered), 403);
    assert.equal(await handshake(`${bare}?token=0123456789abcdee`, offered), 403);
    const {messages} = await listen(url, offered[0]);
    assert.ok('/fleet/map' in messages);
  } finally {
    server.kill('SIGINT');
  }
}

let server;
try {
  const run = process.env.FLEETMAP_RUN ?? makeRun(fleetmap, folder);
  let url;
  ({server, url} = await serve(fleetmap, run));
  const state = await (await fetch(new URL('state.json', url))).json();
  assert.equal(await handshake(url, ['foxglove.websocket.v1', 'foxglove.sdk.v1']), 'foxglove.sdk.v1');
  assert.equal(await handshake(url, ['chat']), 404);
  assert.equal(await handshake(url, ['foxglove.sdk.v1'], {Origin: 'https://app.foxglove.dev'}), 403);
  const expected = await expectedMap(url, state);
  let points, sent;
  for (const subprotocol of ['foxglove.websocket.v1', 'foxglove.sdk.v1']) {
    const {info, messages, bytes} = await listen(url, subprotocol);
    assert.equal(info.name, 'fleetmap monitor');
    assert.deepEqual(info.capabilities, []);
    points = checkMap(messages['/fleet/map'], expected);
    checkRobots(messages, state);
    sent = bytes;
  }
  await testToken(run);
  console.log(`passed: ${state.nodes.length} nodes, ${points} points, ${sent} bytes of messages`);
} finally {
  server?.kill('SIGINT');
  rmSync(folder, {recursive: true, force: true});
}
