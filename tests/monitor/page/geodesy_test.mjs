// The page's WGS84 and UTM (src/monitor/page/geodesy.ts) against GeographicLib's, in reference_points.csv.
//   node geodesy_test.mjs PAGE_FOLDER
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {pageModule} from './page_module.mjs';

const {toEnu, toGeo, toUtm} = await pageModule(process.argv[2], 'geodesy');

const near = (value, expected, tolerance, what) =>
  assert.ok(Math.abs(value - expected) <= tolerance, `${what}: ${value}, expected ${expected}`);

const [, ...lines] = readFileSync(new URL('reference_points.csv', import.meta.url), 'utf8')
  .trim()
  .split('\n');
assert.ok(lines.length >= 10);
for (const line of lines) {
  const [lat0, lon0, h0, e, n, u, lat, lon, h, zone, north, easting, northing] = line.split(',').map(Number);
  const geo = toGeo({latitude_deg: lat0, longitude_deg: lon0, altitude_m: h0}, [e, n, u]);
  near(geo.latitude_deg, lat, 1e-10, line);
  near(geo.longitude_deg, lon, 1e-9, line);
  near(geo.altitude_m, h, 1e-6, line);
  const enu = toEnu(
    {latitude_deg: lat0, longitude_deg: lon0, altitude_m: h0},
    {latitude_deg: lat, longitude_deg: lon, altitude_m: h},
  );
  [e, n, u].forEach((value, k) => near(enu[k], value, 1e-4, line));
  const utm = toUtm({latitude_deg: lat, longitude_deg: lon, altitude_m: h});
  if (zone === 0) {
    assert.equal(utm, null, line);
    continue;
  }
  assert.equal(utm.zone, zone, line);
  assert.equal(utm.north, north === 1, line);
  near(utm.easting_m, easting, 1e-5, line);
  near(utm.northing_m, northing, 1e-5, line);
}
