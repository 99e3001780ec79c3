// Writes frames.bin, the same messages as MAVLink v1, v2 and signed v2, by an independent implementation:
//   npm install node-mavlink@2.3.0 && node make_golden.mjs > frames.bin
import { createHash } from 'node:crypto';
import mavlink from 'node-mavlink';
const { MavLinkProtocolV1, MavLinkProtocolV2, minimal, common } = mavlink;

const fill = (message, values) => Object.assign(message, values);
const messages = [
  fill(new minimal.Heartbeat(), { type: 10, autopilot: 12, baseMode: 81, systemStatus: 4, mavlinkVersion: 3 }),
  fill(new common.SystemTime(), { timeUnixUsec: 1795630359500000n, timeBootMs: 123456 }),
  fill(new common.VfrHud(), { airspeed: 1.5, groundspeed: 1.25, heading: 90 }), // of a type that is not decoded
  fill(new common.GpsRawInt(), {
    timeUsec: 123400000n, fixType: 6, lat: 389876543, lon: -39876543, alt: 651234, eph: 80, epv: 120, vel: 130,
    cog: 9000, satellitesVisible: 17, altEllipsoid: 703456, hAcc: 14, vAcc: 21, velAcc: 50, hdgAcc: 0, yaw: 0,
  }),
  fill(new common.AttitudeQuaternion(), {
    timeBootMs: 123450, q1: Math.SQRT1_2, q2: 0, q3: 0, q4: Math.SQRT1_2, rollspeed: 0, pitchspeed: 0, yawspeed: 0,
    reprOffsetQ: [0, 0, 0, 0],
  }),
  fill(new common.ScaledImu(), {
    timeBootMs: 123460, xacc: 20, yacc: -30, zacc: -1001, xgyro: 11, ygyro: -12, zgyro: 13, xmag: 1, ymag: 2, zmag: 3,
    temperature: 3012,
  }),
  fill(new common.HighresImu(), {
    timeUsec: 123470000n, xacc: 0.25, yacc: -0.5, zacc: -9.75, xgyro: 0.125, ygyro: -0.25, zgyro: 0.5, xmag: 0.1,
    ymag: 0.2, zmag: 0.3, absPressure: 950, diffPressure: 0, pressureAlt: 600, temperature: 30, fieldsUpdated: 63,
    id: 0,
  }),
  fill(new common.TimeSync(), { tc1: 123480000000n, ts1: 1795630359523000000n }),
];
const plain = new MavLinkProtocolV2(7, 1), key = createHash('sha256').update('fleetmap').digest();
const protocols = [
  (message, sequence) => new MavLinkProtocolV1(7, 1).serialize(message, sequence),
  (message, sequence) => plain.serialize(message, sequence),
  (message, sequence) => {
    const signed = new MavLinkProtocolV2(7, 1, MavLinkProtocolV2.IFLAG_SIGNED);
    return signed.sign(signed.serialize(message, sequence), 1, key, 1795630359500);
  },
];
let sequence = 0;
for (const serialize of protocols)
  for (const message of messages) process.stdout.write(serialize(message, sequence++ % 256));
