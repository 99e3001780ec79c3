// WGS84: between the site's ENU frame and latitude, longitude and altitude, as GeographicLib's LocalCartesian does.

const kA = 6378137.0;
const kF = 1 / 298.257223563;
const kE2 = kF * (2 - kF);

export interface Geo {
  latitude_deg: number;
  longitude_deg: number;
  altitude_m: number;
}

export function toGeo(origin: Geo, [e, n, u]: readonly number[]): Geo {
  const lat0 = (origin.latitude_deg * Math.PI) / 180,
    lon0 = (origin.longitude_deg * Math.PI) / 180;
  const sa = Math.sin(lat0),
    ca = Math.cos(lat0),
    so = Math.sin(lon0),
    co = Math.cos(lon0);
  const N0 = kA / Math.sqrt(1 - kE2 * sa * sa);
  const x = (N0 + origin.altitude_m) * ca * co - so * e - sa * co * n + ca * co * u;
  const y = (N0 + origin.altitude_m) * ca * so + co * e - sa * so * n + ca * so * u;
  const z = (N0 * (1 - kE2) + origin.altitude_m) * sa + ca * n + sa * u;
  const p = Math.hypot(x, y);
  let lat = Math.atan2(z, p * (1 - kE2)),
    h = 0;
  for (let k = 0; k < 8; ++k) {
    const s = Math.sin(lat),
      N = kA / Math.sqrt(1 - kE2 * s * s);
    // Without the division by cos(lat), which fails at the poles.
    h = p * Math.cos(lat) + z * s - (kA * kA) / N;
    lat = Math.atan2(z, p * (1 - (kE2 * N) / (N + h)));
  }
  return {latitude_deg: (lat * 180) / Math.PI, longitude_deg: (Math.atan2(y, x) * 180) / Math.PI, altitude_m: h};
}

/** From the middle of the Earth. */
function toEcef({latitude_deg, longitude_deg, altitude_m}: Geo): [number, number, number] {
  const lat = (latitude_deg * Math.PI) / 180,
    lon = (longitude_deg * Math.PI) / 180,
    s = Math.sin(lat),
    N = kA / Math.sqrt(1 - kE2 * s * s);
  const across = (N + altitude_m) * Math.cos(lat);
  return [across * Math.cos(lon), across * Math.sin(lon), (N * (1 - kE2) + altitude_m) * s];
}

/** The inverse of toGeo(). */
export function toEnu(origin: Geo, geo: Geo): [number, number, number] {
  const [x, y, z] = toEcef(geo),
    [x0, y0, z0] = toEcef(origin);
  const [dx, dy, dz] = [x - x0, y - y0, z - z0];
  const lat0 = (origin.latitude_deg * Math.PI) / 180,
    lon0 = (origin.longitude_deg * Math.PI) / 180;
  const east = -Math.sin(lon0) * dx + Math.cos(lon0) * dy,
    outwards = Math.cos(lon0) * dx + Math.sin(lon0) * dy; // in the plane of the equator
  return [
    east,
    -Math.sin(lat0) * outwards + Math.cos(lat0) * dz,
    Math.cos(lat0) * outwards + Math.sin(lat0) * dz,
  ];
}

/** Universal Transverse Mercator; outside of 80° S to 84° N there is none. */
export interface Utm {
  zone: number;
  north: boolean;
  easting_m: number;
  northing_m: number;
}

function zoneOf(latitude_deg: number, longitude_deg: number): number {
  const longitude = ((((longitude_deg + 180) % 360) + 360) % 360) - 180;
  const zone = Math.floor((longitude + 180) / 6) + 1;
  // South-west Norway, and Svalbard with its four wide zones.
  if (latitude_deg >= 56 && latitude_deg < 64 && zone === 31 && longitude >= 3) return 32;
  if (latitude_deg >= 72 && longitude >= 0 && longitude < 42) return [31, 33, 35, 37][Math.floor((longitude + 3) / 12)];
  return zone;
}

/** Krüger's series to the fourth power of n (Karney 2011), good to a micrometre within a zone. */
export function toUtm({latitude_deg, longitude_deg}: Geo): Utm | null {
  if (latitude_deg < -80 || latitude_deg >= 84) return null;
  const zone = zoneOf(latitude_deg, longitude_deg);
  const n = kF / (2 - kF),
    e = Math.sqrt(kE2);
  const radius = (kA / (1 + n)) * (1 + n ** 2 / 4 + n ** 4 / 64);
  const alpha = [
    n / 2 - (2 / 3) * n ** 2 + (5 / 16) * n ** 3 + (41 / 180) * n ** 4,
    (13 / 48) * n ** 2 - (3 / 5) * n ** 3 + (557 / 1440) * n ** 4,
    (61 / 240) * n ** 3 - (103 / 140) * n ** 4,
    (49561 / 161280) * n ** 4,
  ];
  const s = Math.sin((latitude_deg * Math.PI) / 180);
  let east_deg = longitude_deg - (6 * zone - 183);
  east_deg = ((((east_deg + 180) % 360) + 360) % 360) - 180;
  const lambda = (east_deg * Math.PI) / 180;
  const t = Math.sinh(Math.atanh(s) - e * Math.atanh(e * s)); // tangent of the conformal latitude
  const xi0 = Math.atan2(t, Math.cos(lambda)),
    eta0 = Math.asinh(Math.sin(lambda) / Math.hypot(t, Math.cos(lambda)));
  let xi = xi0,
    eta = eta0;
  alpha.forEach((a, k) => {
    const j = 2 * (k + 1);
    xi += a * Math.sin(j * xi0) * Math.cosh(j * eta0);
    eta += a * Math.cos(j * xi0) * Math.sinh(j * eta0);
  });
  const kScale = 0.9996,
    north = latitude_deg >= 0;
  return {
    zone,
    north,
    easting_m: 500_000 + kScale * radius * eta,
    northing_m: kScale * radius * xi + (north ? 0 : 10_000_000),
  };
}

export function utmText(geo: Geo): string {
  const utm = toUtm(geo);
  return utm
    ? `UTM ${utm.zone}${utm.north ? 'N' : 'S'} ${utm.easting_m.toFixed(2)} ${utm.northing_m.toFixed(2)}`
    : 'no UTM at the poles';
}

export function geoText(geo: Geo): string {
  return `${geo.latitude_deg.toFixed(7)}°, ${geo.longitude_deg.toFixed(7)}°, ${geo.altitude_m.toFixed(2)} m`;
}
