import * as THREE from 'three';

const kSteps = 256;

/** Turbo (A. Mikhailov, 2019) by a polynomial, 0 to 1. */
export function turbo(x: number): [number, number, number] {
  const value = (...c: number[]) =>
    Math.min(
      1,
      Math.max(
        0,
        c.reduceRight((sum, one) => sum * x + one, 0),
      ),
    );
  return [
    value(0.13572138, 4.6153926, -42.66032258, 132.13108234, -152.94239396, 59.28637943),
    value(0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604),
    value(0.1066733, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973),
  ];
}

/** Lightness of a robot's points at the lower and the upper end: -1 is black, 0 the robot's colour, 1 white. */
export type Tones = [number, number];

/** Tones that stand out from the map's ground. */
export const tonesOf = (dark: boolean): Tones => (dark ? [-0.15, 0.42] : [-0.5, 0]);

/** The ramp of a robot: lighter with height, so that shapes show in one colour. */
export function shaded(colour: THREE.Color, height: number, [low, high]: Tones): [number, number, number] {
  const toned = (c: number, tone: number) => (tone < 0 ? c * (1 + tone) : c + tone * (1 - c));
  const mix = (c: number) => toned(c, low) * (1 - height) + toned(c, high) * height;
  return [mix(colour.r), mix(colour.g), mix(colour.b)];
}

/** The colours of a function of 0 to 1, as bytes R, G, B, A. */
export function rampOf(colourAt: (x: number) => [number, number, number]): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(4 * kSteps);
  for (let k = 0; k < kSteps; ++k)
    bytes.set([...colourAt(k / (kSteps - 1)).map((c) => Math.round(255 * c)), 255], 4 * k);
  return bytes;
}

export function turboTexture(): THREE.DataTexture {
  const texture = new THREE.DataTexture(rampOf(turbo), kSteps, 1);
  texture.magFilter = texture.minFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}
