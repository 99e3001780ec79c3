// Reads what `fleetmap map export` writes as LAS with two readers of others (npm's copc and @loaders.gl/las) and
// compares it with the PLY of the same store: a point for each, the same shape, within its header's bounds.
//   node las_readers_test.mjs FLEETMAP FOLDER
// Exit code 77: skipped, since npm cannot install the readers into FOLDER.
import assert from 'node:assert/strict';
import {mkdtempSync, readdirSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {dirname, join, resolve} from 'node:path';
import {fileURLToPath, pathToFileURL} from 'node:url';
import {installed, installReaders, run} from '../../support/npm_readers.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const {Las} = installReaders(import.meta.url)('copc');
const loadersGl = pathToFileURL(join(resolve(installed), 'node_modules/@loaders.gl/las/dist/index.js'));
const {LAZRsLoader} = await import(loadersGl.href);
const folder = mkdtempSync(join(tmpdir(), 'fleetmap_las_'));

/** Header, records by name, and the points' dimensions as functions of an index. */
async function readLas(file) {
  const bytes = readFileSync(file);
  const header = Las.Header.parse(bytes);
  const vlrs = await Las.Vlr.walk(async (begin, end) => bytes.subarray(begin, end), header);
  const view = Las.View.create(bytes.subarray(header.pointDataOffset), header);
  const record = (user, id) => {
    const vlr = vlrs.find(({userId, recordId}) => userId === user && recordId === id);
    return bytes.subarray(vlr.contentOffset, vlr.contentOffset + vlr.contentLength - 1).toString();
  };
  return {header, view, wkt: record('LASF_Projection', 2112), text: record('LASF_Spec', 3)};
}

/**
 * The same by @loaders.gl/las. Its default loader reads no LAS 1.4; the other one does, and fetches its WebAssembly,
 * which Node does not from files.
 */
async function readByLoadersGl(file) {
  const bytes = readFileSync(file);
  const {fetch} = globalThis;
  globalThis.fetch = async (url) =>
    new Response(readFileSync(fileURLToPath(url)), {headers: {'content-type': 'application/wasm'}});
  try {
    const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
    return await LAZRsLoader.parse(buffer, {las: {fp64: true, shape: 'mesh', colorDepth: 'auto'}});
  } finally {
    globalThis.fetch = fetch;
  }
}

/** x, y, z of each point; the files here are binary, of float32. */
function readPly(file) {
  const bytes = readFileSync(file);
  const end = bytes.indexOf('end_header\n') + 'end_header\n'.length;
  const header = bytes.subarray(0, end).toString();
  const count = Number(header.match(/element vertex (\d+)/)[1]);
  const stride = 4 * header.match(/property float/g).length;
  return {
    header,
    points: Array.from({length: count}, (_, k) => [0, 4, 8].map((at) => bytes.readFloatLE(end + k * stride + at))),
  };
}

function checkPoints({header, view}, bounds = header) {
  const get = ['X', 'Y', 'Z'].map((name) => view.getter(name));
  assert.equal(view.pointCount, header.pointCount);
  const points = Array.from({length: header.pointCount}, (_, k) => get.map((coordinate) => coordinate(k)));
  for (const point of points) {
    point.forEach((value, axis) =>
      assert.ok(value >= bounds.min[axis] - 1e-9 && value <= bounds.max[axis] + 1e-9, `${point}`),
    );
  }
  return points;
}

try {
  const source = join(here, '../../../config/fleets/farm_small.yaml');
  run('run', '-c', source, '--agents', '1', '--set', 'max_time=15', '--out', join(folder, 'run'));
  const store = join(folder, 'run/r1/store.db');
  const said = run('map', 'export', store, '--out', join(folder, 'map.las'));
  run('map', 'export', store, '--out', join(folder, 'enu.las'), '--crs', 'enu');
  run('map', 'export', store, '--out', join(folder, 'map.ply'));
  run('map', 'export', store, '--out', join(folder, 'tiles'), '--tile', '20');

  const utm = await readLas(join(folder, 'map.las'));
  const {points: ply} = readPly(join(folder, 'map.ply'));
  assert.ok(ply.length > 1000);
  assert.deepEqual([utm.header.majorVersion, utm.header.minorVersion, utm.header.pointDataRecordFormat], [1, 4, 6]);
  assert.equal(utm.header.pointCount, ply.length);
  assert.match(utm.header.generatingSoftware, /^fleetmap /);
  assert.match(utm.wkt, /^COMPD_CS\["WGS 84 \/ UTM zone \d+[NS] \+ Ellipsoid \(metre\)"/);
  assert.match(utm.text, /above the WGS 84 ellipsoid/);
  assert.match(said, /EPSG:32\d{3}/);
  const points = checkPoints(utm);
  const mesh = await readByLoadersGl(join(folder, 'map.las'));
  assert.deepEqual([mesh.loaderData.versionAsString, mesh.loaderData.pointsFormatId], ['1.4', 6]);
  assert.equal(mesh.header.vertexCount, points.length);
  const positions = mesh.attributes.POSITION.value;
  points.forEach((point, k) =>
    point.forEach((value, axis) => assert.ok(Math.abs(value - positions[3 * k + axis]) < 1e-6, `${k}: ${value}`)),
  );

  const enu = await readLas(join(folder, 'enu.las'));
  checkPoints(enu).forEach((point, k) =>
    point.forEach((value, axis) => assert.ok(Math.abs(value - ply[k][axis]) < 0.00051, `${point} ${ply[k]}`)),
  );
  assert.match(enu.wkt, /^LOCAL_CS\["East-north-up frame at /);

  // Lengths on the map are those in ENU times the scale that is printed, to the curvature of the Earth over this site.
  const scale = Number(said.match(/Scale at the origin: ([\d.]+)/)[1]);
  const level = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
  for (let k = 1; k < ply.length; k += 97) {
    const length = level(ply[0], ply[k]);
    assert.ok(Math.abs(level(points[0], points[k]) - scale * length) < 0.002 + 2e-4 * length, `${k}`);
  }

  let count = 0;
  for (const name of readdirSync(join(folder, 'tiles'))) {
    const tile = await readLas(join(folder, 'tiles', name));
    const [east, north] = name
      .match(/^(-?\d+)_(-?\d+)\.las$/)
      .slice(1)
      .map(Number);
    checkPoints(tile, {min: [east, north, -1e4], max: [east + 19.999, north + 19.999, 1e4]});
    count += tile.header.pointCount;
  }
  assert.equal(count, ply.length);
  console.log(`${ply.length} points are the same to copc and to @loaders.gl/las`);
} finally {
  rmSync(folder, {recursive: true, force: true});
}
