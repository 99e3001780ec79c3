// The connection to the program (src/monitor/page/live.ts).
import assert from 'node:assert/strict';
import {pageModule} from './page_module.mjs';

const {follow} = await pageModule(process.argv[2], 'live');
const sockets = [],
  waits = [],
  events = [],
  errors = [];
let again, watch, answer;
globalThis.location = {host: 'robot:8080'};
globalThis.WebSocket = class {
  constructor(address) {
    this.address = address;
    sockets.push(this);
  }
  close() {
    this.closed = true;
  }
  tell(content) {
    this.onmessage({data: typeof content === 'string' ? content : JSON.stringify(content)});
  }
};
const real = {setTimeout, clearTimeout, fetch, error: console.error};
globalThis.setTimeout = (act, wait) => {
  if (wait === 15_000) return (watch = act);
  again = act;
  waits.push(wait);
};
globalThis.clearTimeout = () => (watch = undefined);
globalThis.fetch = async (address) => {
  assert.equal(address, '/live');
  if (!answer) throw new Error('offline');
  return answer;
};
console.error = (error) => errors.push(error);
const refused = (status, text) => ({status, text: async () => `${text}\n`});
const settled = () => new Promise((done) => setImmediate(done));
try {
  let broken = false;
  follow({
    onState(state) {
      if (broken) throw new Error('no number');
      events.push(['state', state.title]);
    },
    onLive: (live) => events.push(['live', live.self]),
    onConnection: (trouble) => events.push(trouble),
  });
  assert.equal(sockets[0].address, 'ws://robot:8080/live');
  sockets[0].tell({});
  assert.deepEqual(events, [], 'nothing was published yet');
  sockets[0].tell({title: 'a', nodes: []});
  assert.equal(watch, undefined, 'a finished run may be silent');
  sockets[0].tell({live: {self: 'r1'}});
  assert.deepEqual(events, [['state', 'a'], '', ['live', 'r1'], '']);

  // A state that the page cannot show is said, and the next one is shown.
  broken = true;
  sockets[0].tell({title: 'b', nodes: []});
  assert.match(events.at(-1), /cannot show the newest state \(no number\); reload/);
  sockets[0].tell('{"nodes": [');
  assert.match(events.at(-1), /cannot show/);
  assert.equal(errors.length, 2);
  broken = false;
  sockets[0].tell({title: 'c', nodes: []});
  assert.deepEqual(events.slice(-2), [['state', 'c'], '']);

  // A robot that falls silent without closing: its status is due each second.
  sockets[0].tell({live: {self: 'r1'}});
  watch();
  assert.match(events.at(-1), /connection is lost/);
  assert.ok(sockets[0].closed && sockets[0].onclose === null);
  again();
  assert.equal(sockets.length, 2);
  waits.length = 0;
  sockets[1].tell({title: 'd', nodes: []});

  // It tries again, more and more seldom, until something comes.
  for (let k = 0; k < 7; ++k) {
    sockets.at(-1).onclose();
    await settled();
    assert.notEqual(events.at(-1), '');
    again();
  }
  assert.deepEqual(waits, [500, 1000, 2000, 4000, 8000, 10_000, 10_000]);
  assert.match(events.at(-1), /does not answer: is it running/);

  // A refusal comes with its reason, and goes when something comes.
  for (const [status, text] of [
    [503, 'too many pages are open; close one'],
    [403, 'a token is needed: open the address that the program printed'],
  ]) {
    answer = refused(status, text);
    sockets.at(-1).onclose();
    await settled();
    assert.equal(events.at(-1), `Refused: ${text}. This page tries again.`);
    again();
  }
  answer = refused(426, 'x');
  sockets.at(-1).onclose();
  await settled();
  assert.match(events.at(-1), /connection is lost/);
  again();
  sockets.at(-1).tell({title: 'e', nodes: []});
  assert.equal(events.at(-1), '');
  sockets.at(-1).onclose();
  assert.equal(waits.at(-1), 500);
} finally {
  Object.assign(globalThis, {setTimeout: real.setTimeout, clearTimeout: real.clearTimeout, fetch: real.fetch});
  console.error = real.error;
  delete globalThis.WebSocket;
  delete globalThis.location;
}
