// Reads what `fleetmap run --record` writes as MCAP with a reader of others (npm's @mcap/core, which checks the
// checksums) and decodes every message by the schema in the file, with a decoder of others.
//   node mcap_readers_test.mjs FLEETMAP FOLDER
// Exit code 77: skipped, since npm cannot install the readers into FOLDER.
import assert from 'node:assert/strict';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {crc32} from 'node:zlib';
import {installReaders, run} from '../../support/npm_readers.mjs';

const require = installReaders(import.meta.url);
const {McapIndexedReader, McapStreamReader} = require('@mcap/core');
const {parse} = require('@foxglove/rosmsg');
const {ros2humble} = require('@foxglove/rosmsg-msgs-common');
const {MessageReader} = require('@foxglove/rosmsg2-serialization');
const {crc32: crcOf} = createRequire(require.resolve('@mcap/core'))('@foxglove/crc');
const zstd = require('@foxglove/wasm-zstd');
const lz4 = require('@foxglove/wasm-lz4');
await Promise.all([zstd.isLoaded, lz4.isLoaded]);
const decompressHandlers = {
  zstd: (bytes, size) => zstd.decompress(bytes, Number(size)),
  lz4: (bytes, size) => lz4(bytes, Number(size)),
};
const here = dirname(fileURLToPath(import.meta.url));
const checksum = crc32 ?? crcOf;
const folder = mkdtempSync(join(tmpdir(), 'fleetmap_mcap_'));
/** Topics of sensors; all others keep their last messages for readers that come late. */
const LIVE = ['/points', '/imu', '/fix', '/wheel_odometry', '/battery_state'];

/** Members of a type, without constants; the first of a schema's definitions has no name. */
const members = ({definitions}) =>
  definitions
    .filter(({isConstant}) => !isConstant)
    .map(({name, type, isArray, arrayLength}) => `${type}${isArray ? `[${arrayLength ?? ''}]` : ''} ${name}`);

/** Compares names, types and order of all members with those of ROS 2 Humble. */
function checkSchema(name, definitions) {
  for (const definition of definitions) {
    const known = definition.name ?? name.replace('/msg/', '/');
    assert.ok(ros2humble[known], known);
    assert.deepEqual(members(definition), members(ros2humble[known]), known);
  }
}

/** Durability that a rosbag2 player offers: 1 transient local, 2 volatile. */
function durability(channel) {
  const profile = channel.metadata.get('offered_qos_profiles');
  assert.match(profile, /^- history: 1\n {2}depth: \d+\n {2}reliability: 1\n {2}durability: [12]\n {2}deadline:\n/);
  return Number(profile.match(/durability: (\d)/)[1]);
}

/** Reads by the index; returns the number of messages by topic, and the offset of the last byte of a chunk. */
async function readIndexed(bytes, compression) {
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
  };
  const reader = await McapIndexedReader.Initialize({readable, decompressHandlers});
  assert.equal(reader.header.profile, 'ros2');
  assert.notEqual(reader.footer.summaryCrc, 0);
  assert.equal(reader.dataSectionCrc, checksum(bytes.subarray(0, Number(reader.dataEndOffset))));
  assert.ok(reader.chunkIndexes.length > 5 && reader.chunkIndexes.every((chunk) => chunk.compression === compression));
  const decoders = new Map();
  for (const schema of reader.schemasById.values()) {
    assert.equal(schema.encoding, 'ros2msg', schema.name);
    const definitions = parse(new TextDecoder().decode(schema.data), {ros2: true});
    checkSchema(schema.name, definitions);
    decoders.set(schema.id, new MessageReader(definitions));
  }
  for (const channel of reader.channelsById.values()) {
    assert.equal(channel.messageEncoding, 'cdr');
    assert.equal(durability(channel), LIVE.includes(channel.topic) ? 2 : 1, channel.topic);
  }
  const counts = new Map();
  const last = new Map();
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    last.set(channel.topic, decoders.get(channel.schemaId).readMessage(message.data));
    counts.set(channel.topic, (counts.get(channel.topic) ?? 0) + 1);
    assert.ok(message.sequence > 0, channel.topic);
  }
  for (const [id, channel] of reader.channelsById)
    assert.equal(reader.statistics.channelMessageCounts.get(id), BigInt(counts.get(channel.topic) ?? 0));
  assert.equal(reader.statistics.chunkCount, reader.chunkIndexes.length);
  assert.ok(reader.summaryOffsetsByOpcode.size >= 4);
  checkContent(last);
  const {chunkStartOffset, chunkLength} = reader.chunkIndexes[reader.chunkIndexes.length >> 1];
  return {counts, inChunk: Number(chunkStartOffset + chunkLength) - 1};
}

function checkContent(last) {
  const imu = last.get('/imu');
  assert.ok(Math.abs(Math.hypot(...Object.values(imu.linear_acceleration)) - 9.81) < 3, 'm/s^2');
  const points = last.get('/points');
  assert.deepEqual(
    points.fields.slice(0, 3).map(({name}) => name),
    ['x', 'y', 'z'],
  );
  assert.equal(points.data.length, points.row_step * points.height);
  assert.ok(last.get('/fix').latitude !== 0);
  assert.equal(last.get('/odometry').pose.covariance.length, 36);
  assert.ok(last.get('/tf').transforms.length > 0);
  assert.ok(last.get('/fleetmap/map').width > 100);
  assert.ok(last.get('/fleetmap/markers').markers.length > 0);
  assert.ok(last.get('/diagnostics').status.length > 0);
}

/** Reads from the front, as of a file without an index; the records' order and the chunks' checksums are checked. */
function readStream(bytes) {
  const reader = new McapStreamReader({decompressHandlers, validateCrcs: true});
  reader.append(bytes);
  let messages = 0;
  for (let record; (record = reader.nextRecord());) messages += record.type === 'Message';
  return {messages, done: reader.done()};
}

try {
  const config = join(here, '../../../config/fleets/farm_small.yaml');
  let first;
  for (const compression of ['zstd', 'lz4', 'none']) {
    const bag = join(folder, compression);
    run(
      'run',
      '-c',
      config,
      '--agents',
      '1',
      '--set',
      'max_time=15',
      '--out',
      join(folder, `run_${compression}`),
      '--record',
      bag,
      '--record-compression',
      compression,
    );
    const bytes = readFileSync(join(bag, 'r1/r1_0.mcap'));
    const {counts, inChunk} = await readIndexed(bytes, compression === 'none' ? '' : compression);
    const all = [...counts.values()].reduce((sum, count) => sum + count, 0);
    assert.deepEqual(readStream(bytes), {messages: all, done: true});
    first ??= counts;
    assert.deepEqual(counts, first);
    const cut = readStream(bytes.subarray(0, (bytes.length * 3) >> 2));
    assert.ok(!cut.done && cut.messages > all / 4, `${compression}: ${cut.messages} of ${all}`);
    // Last, since npm's lz4 does not recover from it.
    const damaged = Buffer.from(bytes);
    damaged[inChunk] ^= 1;
    assert.throws(() => readStream(damaged), `${compression}: damage is found`);
    const metadata = readFileSync(join(bag, 'r1/metadata.yaml'), 'utf8');
    for (const line of [
      'version: 5',
      'storage_identifier: mcap',
      'compression_format: ""',
      'compression_mode: ""',
      `message_count: ${all}`,
      '- r1_0.mcap',
      'serialization_format: cdr',
    ])
      assert.ok(metadata.includes(line), line);
    const kept = [...counts.keys()].filter((topic) => !LIVE.includes(topic));
    assert.equal(metadata.match(/durability: 1\\n/g).length, kept.length);
    console.log(`${compression}: ${all} messages on ${counts.size} topics, ${bytes.length} bytes`);
  }
} finally {
  rmSync(folder, {recursive: true, force: true});
}
