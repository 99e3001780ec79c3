// The connection to the program (src/monitor/page/live.ts).
import assert from 'node:assert/strict';
import {pageModule} from './page_module.mjs';

const {follow} = await pageModule(process.argv[2], 'live');
const sockets = [],
  waits = [],
  seen = [];
let again;
globalThis.location = {host: 'robot:8080'};
globalThis.WebSocket = class {
  constructor(address) {
    this.address = address;
    sockets.push(this);
  }
  tell(content) {
    this.onmessage({data: JSON.stringify(content)});
  }
};
const {setTimeout: real} = globalThis;
globalThis.setTimeout = (act, wait) => {
  again = act;
  waits.push(wait);
};
try {
  follow({
    onState: (state) => seen.push(['state', state.title]),
    onLive: (live) => seen.push(['live', live.self]),
    onConnection: (connected) => seen.push(connected),
  });
  assert.equal(sockets[0].address, 'ws://robot:8080/live');
  sockets[0].tell({});
  assert.deepEqual(seen, [], 'nothing was published yet');
  sockets[0].tell({title: 'a', nodes: []});
  sockets[0].tell({live: {self: 'r1'}});
  assert.deepEqual(seen, [true, ['state', 'a'], true, ['live', 'r1']]);

  // It tries again, more and more seldom, until something comes.
  for (let k = 0; k < 7; ++k) {
    sockets.at(-1).onclose();
    assert.equal(seen.at(-1), false);
    again();
  }
  assert.deepEqual(waits, [500, 1000, 2000, 4000, 8000, 10_000, 10_000]);
  sockets.at(-1).tell({title: 'b', nodes: []});
  sockets.at(-1).onclose();
  assert.equal(waits.at(-1), 500);
} finally {
  globalThis.setTimeout = real;
  delete globalThis.WebSocket;
  delete globalThis.location;
}
