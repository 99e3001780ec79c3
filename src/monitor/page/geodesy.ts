// WGS84: from the site's ENU frame to latitude, longitude and altitude, as GeographicLib's LocalCartesian does.

const kA = 6378137.0;
const kF = 1 / 298.257223563;
const kE2 = kF * (2 - kF);

export interface Geo {
  latitude_deg: number;
  longitude_deg: number;
  altitude_m: number;
}

export function toGeo(origin: Geo, [e, n, u]: readonly number[]): Geo {
  const lat0 = (origin.latitude_deg * Math.PI) / 180, lon0 = (origin.longitude_deg * Math.PI) / 180;
  const sa = Math.sin(lat0), ca = Math.cos(lat0), so = Math.sin(lon0), co = Math.cos(lon0);
  const N0 = kA / Math.sqrt(1 - kE2 * sa * sa);
  const x = (N0 + origin.altitude_m) * ca * co - so * e - sa * co * n + ca * co * u;
  const y = (N0 + origin.altitude_m) * ca * so + co * e - sa * so * n + ca * so * u;
  const z = (N0 * (1 - kE2) + origin.altitude_m) * sa + ca * n + sa * u;
  const p = Math.hypot(x, y);
  let lat = Math.atan2(z, p * (1 - kE2)), h = 0;
  for (let k = 0; k < 8; ++k) {
    const s = Math.sin(lat), N = kA / Math.sqrt(1 - kE2 * s * s);
    // Without the division by cos(lat), which fails at the poles.
    h = p * Math.cos(lat) + z * s - (kA * kA) / N;
    lat = Math.atan2(z, p * (1 - (kE2 * N) / (N + h)));
  }
  return {latitude_deg: (lat * 180) / Math.PI, longitude_deg: (Math.atan2(y, x) * 180) / Math.PI, altitude_m: h};
}

export function geoText(geo: Geo): string {
  return `${geo.latitude_deg.toFixed(7)}°, ${geo.longitude_deg.toFixed(7)}°, ${geo.altitude_m.toFixed(2)} m`;
}
